"""Loses the machines of a contest's office one after another, in the middle of games.

A part of `tests.campaigns.kill.contest`.
"""

import random
import shutil
import statistics
import subprocess
import time
from contextlib import ExitStack
from pathlib import Path

from lacoc_process import Running, contest_run
from processes import LACOC, everything_of, started

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import AnyFact, Played
from lacoc_shared.codec import decode
from lacoc_shared.contest.file import secrets_path
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import segment_name, segment_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEAT_S

_LOOK_S = 0.1
_LIMIT_S = 120.0
_LATER_S = 6.0
"""A machine is lost at most so long after all courts play."""


class Relay:
    """A contest whose office goes from machine to machine.

    Args:
        file: the contest file at the first machine.
        speed: how much faster than real time the courts play.
        courts: how many courts it has.
        chance: chooses the moments.
    """

    def __init__(self, file: Path, speed: float, courts: int, chance: random.Random) -> None:
        self._file = file
        self._speed = speed
        self._courts = courts
        self._chance = chance
        self._open_s: list[float] = []
        """From each loss to the office at the second machine, with its courts and pages."""
        self._on_s: list[float] = []
        """From each loss until all games that were in play are played on."""
        self._again_s: list[float] = []
        """How much of each game in play was played twice, in time of the match."""
        self._results: dict[tuple[str, int], Played] = {}
        """Results that some machine had when it was lost."""

    def run(self, machines: int) -> Path:
        """Play the contest to its end; return the contest file at the last machine.

        Args:
            machines: how many machines are lost, if the contest is long enough.
        """
        with ExitStack() as stack:
            office = self._office(stack)
            for number in range(1, machines + 1):
                second = self._file.parent.parent / f"machine-{number}" / self._file.name
                second.parent.mkdir()
                for file in (self._file, secrets_path(self._file)):
                    shutil.copy(file, second.with_name(file.name))
                words = ("contest", "standby", str(second))
                copier = stack.enter_context(started(LACOC, *words, quiet=True))
                if not self._wait(office, copier, second):
                    break
                office = self._lose(stack, office, second)
                copier.wait(_LIMIT_S)
            office.hush()
            office.process.wait()
        return self._file

    def _office(self, stack: ExitStack, *more: str) -> Running:
        words = (*more, "--until-over", "--speed", str(self._speed))
        office = contest_run(self._file, *words, fresh=True, stderr=subprocess.DEVNULL)
        return stack.enter_context(office)

    def _wait(self, office: Running, copier: subprocess.Popen[str], second: Path) -> bool:
        """Wait for a random moment in which all courts play; False: the contest is over."""
        later_s = 0.0
        while office.process.poll() is None:
            if copier.poll() is not None:
                raise RuntimeError(f"the standby at {second} ended with {copier.returncode}")
            if len(_in_play(second)) == self._courts:
                if later_s and time.monotonic() > later_s:
                    return True
                later_s = later_s or time.monotonic() + self._chance.uniform(0, _LATER_S)
            time.sleep(_LOOK_S)
        return False

    def _lose(self, stack: ExitStack, office: Running, second: Path) -> Running:
        """Lose the office's machine; return the office at the second one, when it plays on."""
        for process in everything_of(office.process):
            process.kill()
        lost_s = time.monotonic()
        office.process.wait()
        played = _in_play(self._file)
        self._results |= _results(_facts(self._file))
        self._file.parent.rename(self._file.parent.with_suffix(".gone"))
        self._file = second
        copied = {match_id: segment_paths(_records(second), match_id) for match_id in played}
        before = {match_id: _clock(paths) for match_id, paths in copied.items()}
        again = self._office(stack, "--take-over")
        self._open_s.append(time.monotonic() - lost_s)
        for match_id, clock in played.items():
            self._again_s.append((clock - before[match_id]) * BEAT_S)
            newest = max(segment_name(one)[1] for one in copied[match_id] if segment_name(one))
            while not _goes_on(_records(second), match_id, newest, before[match_id]):
                if time.monotonic() - lost_s > _LIMIT_S:
                    raise RuntimeError(f"{match_id} does not go on at {second}")
                time.sleep(_LOOK_S)
        self._on_s.append(time.monotonic() - lost_s)
        print(
            f"machine {len(self._on_s)}: open after {self._open_s[-1]:.1f} s, "
            f"plays on after {self._on_s[-1]:.1f} s",
            flush=True,
        )
        return again

    def report(self, last: Path) -> bool:
        """Print what was measured; return whether a machine was lost and no result.

        Args:
            last: the contest file at the last machine.
        """
        now = _results(_facts(last))
        lost = [
            game
            for game, one in self._results.items()
            if game not in now or now[game].scores != one.scores
        ]
        organiser.publish_to(last, last.parent / "cup")
        with started(LACOC, "contest", "verify", str(last.parent / "cup"), quiet=True) as verify:
            verify.communicate()
        found = {
            "machines_lost": len(self._on_s),
            "office_open_s": _figures(self._open_s),
            "plays_on_s": _figures(self._on_s),
            "played_twice_s": _figures(self._again_s),
            "results_lost": len(lost),
            "verify": verify.returncode,
        }
        print(found)
        return bool(self._on_s) and not lost and verify.returncode in (0, 3)


def _figures(values: list[float]) -> str:
    if not values:
        return "none"
    return f"{statistics.median(values):.2f}, at most {max(values):.2f}"


def _records(file: Path) -> Path:
    return ContestFolder(file).records


def _facts(file: Path) -> tuple[AnyFact, ...]:
    with FactStore(ContestFolder(file).facts) as store:
        return store.facts()


def _results(facts: tuple[AnyFact, ...]) -> dict[tuple[str, int], Played]:
    """Return the results that are not void, by game."""
    return {
        (one.pairing, one.game): one
        for one in facts
        if isinstance(one, Played) and one.outcome != "void"
    }


def _in_play(file: Path) -> dict[str, int]:
    """Return the used time of each match in play, in ticks, by its id."""
    folder = _records(file)
    names = (segment_name(path) for path in folder.glob("*.live.mcap"))
    clocks = {
        name[0]: (_clock(segment_paths(folder, name[0])), _length(folder, name[0]))
        for name in names
        if name is not None
    }
    return {match_id: clock for match_id, (clock, length) in clocks.items() if 0 < clock < length}


def _clock(segments: list[Path]) -> int:
    """Return the used time of a match, in ticks; 0: it has not begun."""
    try:
        frames = Record.read(segments).frames
    except UserError:  # it has no header yet, or was packed just now
        return 0
    return decode(frames[-1][1], Frame).clock_ticks if frames else 0


def _length(folder: Path, match_id: str) -> int:
    try:
        settings = Record.read(segment_paths(folder, match_id)).header.setup.settings
    except UserError:
        return 0
    return round(settings["match"]["duration_s"] / BEAT_S)


def _goes_on(folder: Path, match_id: str, newest: int, clock: int) -> bool:
    """Return whether a match is played on: in a later segment its time has passed."""
    segments = segment_paths(folder, match_id)
    if not segments:  # it has ended and was packed
        return True
    number = segment_name(segments[-1])
    return number is not None and number[1] > newest and _clock(segments) > clock
