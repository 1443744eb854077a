"""`make soak`: one match after another for an hour; no process may grow or keep what it opened.

A real court, two bots, a gateway, and visitors (spectators and pages that come and go) run in
processes of their own. This process is the referee. Between two matches, when all visitors have
gone, it looks at each process: its memory, threads, files, sockets and children. Every record is
verified (Linux only).

At first, while the processes warm up, many visitors come for short visits. A process may keep the
memory that this crowd needed, but must not grow with later visits.
"""

import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import psutil
from arguments import arguments
from court_process import CourtProcess
from lacoc_process import Running
from processes import LACOC, ask, started

from lacoc_client.play.asking import NoCourt
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_shared.decisions import Decision, Next, Official, Start
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.record.files import packed_path
from lacoc_shared.seat import Phase

MOST_GROWTH = 0.02
WARM_SHARE = 1 / 6
"""The share of the run in which a process may grow: ten minutes of an hour."""
VISITORS = "visitors"
"""The names of the visitors' processes begin with this word."""
_SETTLED_S = 1.0
"""Time from the goodbye of the last visitor to the look at the processes."""
_LEFT_S = 30.0
"""Time within which the threads and sockets of gone visitors end."""
_PACKED_S = 60.0
_TRIES = 5
_SILENT_S = 60.0


class Look(NamedTuple):
    """The resources of a process at one time."""

    at_s: float
    memory_bytes: int
    """Memory that the process has written and that belongs to no file: a leak makes it grow. Memory
    of libraries is left out, because it depends on which other processes use them."""
    threads: int
    files: int
    sockets: int
    children: int


@dataclass
class Figures:
    """The results of a run."""

    minutes: float
    matches: int
    visits: int
    frames: int
    unanswered: int
    """Visits and decisions that got no answer in time: the machine was too busy."""
    same: int
    """Number of records that verify."""
    looks: dict[str, list[Look]]
    """The looks at each process between matches."""
    warm_s: float

    def growth(self, process: str) -> float:
        """Return how much a process's memory grew after the warm-up, as a share of the first value.

        The growth follows from the median of the slopes between all pairs of looks, so that a
        single look has little effect.
        """
        looks = [look for look in self.looks[process] if look.at_s >= self.warm_s]
        slope = statistics.median(
            (b.memory_bytes - a.memory_bytes) / (b.at_s - a.at_s) for a, b in combinations(looks, 2)
        )
        first = statistics.median(look.memory_bytes for look in looks[:3])
        return slope * (looks[-1].at_s - looks[0].at_s) / first

    def left_over(self, process: str) -> dict[str, int]:
        """Return how many threads, files and so on a process has gained since the warm-up."""
        warm = [look for look in self.looks[process] if look.at_s <= self.warm_s]
        last = self.looks[process][-1]
        before = {name: max(getattr(look, name) for look in warm) for name in Look._fields[2:]}
        more = {name: getattr(last, name) - before[name] for name in before}
        return {name: count for name, count in more.items() if count > 0}

    @property
    def held(self) -> bool:
        """Return whether all records verify, and no process grew or kept what it opened.

        The visitors' processes may grow: each makes thousands of visits. Real visits are short
        programs, one for each.
        """
        return self.same == self.matches and all(
            not self.left_over(process)
            and (process.startswith(VISITORS) or self.growth(process) < MOST_GROWTH)
            for process in self.looks
        )


def soak(
    minutes: float,
    match_s: float,
    speed: float,
    warm_minutes: float | None = None,
    visitors_most: int = 10,
) -> Figures:
    """Play matches, with visitors that come and go, until the time is over; return the figures.

    Args:
        minutes: length of the run.
        match_s: length of a match.
        speed: 2 plays twice as fast as real time.
        warm_minutes: time after which nothing may grow; None: a sixth of the run.
        visitors_most: how many visitors of each kind may be there at once.
    """
    warm_s = 60 * (minutes * WARM_SHARE if warm_minutes is None else warm_minutes)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        words = ("--seconds", str(match_s), "--speed", str(speed))
        opened = stack.enter_context(CourtProcess(folder, *words, fresh=True))
        where = ("--connect", opened.address)
        processes = {"court": opened.process}
        for seat, bot in (("left", "planner"), ("right", "nearest")):
            join = ("bot", bot, "--token", opened.tokens[seat], *where)
            processes[f"bot {seat}"] = stack.enter_context(started(LACOC, *join))
        gateway = stack.enter_context(Running("web", "--json", *where, fresh=True))
        processes["gateway"] = gateway.process
        opened.hush()  # these two print all visits and events
        gateway.hush()
        most = ("--most", str(visitors_most))
        visitors = {
            way: stack.enter_context(
                started("tests.campaigns.long.visitors", way, "--address", address, *most)
            )
            for way, address in (("direct", opened.address), ("pages", gateway.opened["url"]))
        }
        processes |= {f"{VISITORS}, {way}": process for way, process in visitors.items()}
        return _Run(opened, processes, visitors).run(60 * minutes, warm_s)


class _Run:
    """The referee, who looks at the processes between matches."""

    def __init__(
        self,
        opened: CourtProcess,
        processes: Mapping[str, subprocess.Popen[str]],
        visitors: Mapping[str, subprocess.Popen[str]],
    ) -> None:
        self._processes = {name: psutil.Process(one.pid) for name, one in processes.items()}
        self._processes["referee"] = psutil.Process()
        self._visitors = visitors
        self._opened = opened
        self._folder = opened.folder / "recordings"
        self._looks: dict[str, list[Look]] = {name: [] for name in self._processes}
        self._matches: list[str] = []
        self._same = self._unanswered = 0
        self._begin_s = time.monotonic()

    def run(self, seconds: float, warm_s: float) -> Figures:
        """Referee matches until the time is over; return the figures of the run."""
        with open_client([self._opened.address]) as session:
            self._view = Spectator(session, self._opened.name)
            self._referee = RefereeClient(session, self._opened.name, self._opened.referee)
            while True:
                self._until(Phase.READY)
                told = [ask(one, "go") for one in self._visitors.values()]
                time.sleep(_SETTLED_S)
                ended = self._passed_s >= seconds
                if ended:
                    self._let_go()
                self._look()
                if ended:
                    break
                for one in self._visitors.values():
                    ask(one, "rush" if self._passed_s < warm_s else "come")
                self._matches.append(self._match_id())
                self._decide(Start(), Phase.READY)
                self._until(Phase.FINISHED)
                self._decide(Official(), Phase.FINISHED)
                self._decide(Next(), Phase.OFFICIAL)
                self._verify(self._matches[-1])
                self._tell()
        return Figures(
            minutes=self._passed_s / 60,
            matches=len(self._matches),
            visits=sum(one["visits"] for one in told),
            frames=sum(one["frames"] for one in told),
            unanswered=self._unanswered + sum(one["unanswered"] for one in told),
            same=self._same,
            looks=self._looks,
            warm_s=warm_s,
        )

    @property
    def _passed_s(self) -> float:
        return time.monotonic() - self._begin_s

    def _until(self, phase: Phase) -> None:
        while (frame := self._view.wait_frame(_SILENT_S)) is not None:
            if frame.phase == phase:
                return
        raise TimeoutError(f"The court says nothing; {phase.name} was waited for.")

    def _decide(self, decision: Decision, phase: Phase) -> None:
        """Make the decision that ends a phase.

        On a busy machine the court may not answer, or not show the new phase in time. Then the
        court is asked again, and refuses the decision if it has already made it.
        """
        refused: UserError | None = None
        for _ in range(_TRIES):
            try:
                self._referee.decide(decision, "a soak", "soak")
            except NoCourt:
                self._unanswered += 1
            except UserError as error:
                refused = error
            if self._ended(phase):
                return
        raise TimeoutError(f"{phase.name} does not end.") from refused

    def _ended(self, phase: Phase) -> bool:
        """Return whether a phase ends within a second."""
        end_s = time.monotonic() + _SETTLED_S
        while time.monotonic() < end_s:
            frame = self._view.wait_frame(_SETTLED_S)
            if frame is not None and frame.phase != phase:
                return True
        return False

    def _match_id(self) -> str:
        """Return the id of the match that is being recorded."""
        *_, newest = sorted(self._folder.glob("*.live.mcap"))
        return newest.name.partition(".")[0]

    def _verify(self, match_id: str) -> None:
        """Verify a match's record, count it if it is right, and delete it."""
        path, end_s = packed_path(self._folder, match_id), time.monotonic() + _PACKED_S
        while not path.exists() and time.monotonic() < end_s:
            time.sleep(0.1)
        words = [sys.executable, "-m", LACOC, "replay", "verify", str(path)]
        self._same += subprocess.run(words, stdout=subprocess.DEVNULL, check=False).returncode == 0
        path.unlink(missing_ok=True)

    def _look(self) -> None:
        at_s = self._passed_s
        for name, process in self._processes.items():
            self._looks[name].append(_look(process, at_s))

    def _let_go(self) -> None:
        """Wait long enough for the threads and sockets of gone visitors to end."""
        end_s = time.monotonic() + _LEFT_S
        while time.monotonic() < end_s:
            self._view.poll()
            time.sleep(0.1)

    def _tell(self) -> None:
        held = (f"{name} {_mb(looks[-1])}" for name, looks in self._looks.items())
        print(
            f"{self._passed_s / 60:6.1f} min, {self._same} of {len(self._matches)} matches same; "
            f"{', '.join(held)}",
            file=sys.stderr,
            flush=True,
        )


def _look(process: psutil.Process, at_s: float) -> Look:
    memory = sum(part.anonymous for part in process.memory_maps())
    with process.oneshot():
        return Look(
            at_s,
            memory,
            process.num_threads(),
            process.num_fds(),
            len(process.net_connections("all")),
            len(process.children()),
        )


def _mb(look: Look) -> str:
    return f"{look.memory_bytes / 1e6:.1f} MB/{look.threads}/{look.files}/{look.sockets}"


def _print(figures: Figures) -> None:
    print(
        f"{figures.minutes:.1f} minutes, {figures.matches} matches, {figures.same} verify; "
        f"{figures.visits} visits, {figures.unanswered} unanswered, {figures.frames} frames seen"
    )
    print("| process | memory when warm | at the end | growth | threads | files | sockets | left |")
    print("|---|---|---|---|---|---|---|---|")
    for name, looks in figures.looks.items():
        warm = next(look for look in looks if look.at_s >= figures.warm_s)
        last = looks[-1]
        left = figures.left_over(name) or "nothing"
        print(
            f"| {name} | {warm.memory_bytes / 1e6:.1f} MB | {last.memory_bytes / 1e6:.1f} MB "
            f"| {figures.growth(name):+.2%} | {last.threads} | {last.files} | {last.sockets} "
            f"| {left} |"
        )


def main() -> None:
    """Run the soak, print the figures, and exit with 1 if a process grew or a record is wrong."""
    options = arguments(
        __doc__,
        minutes=60.0,
        warm_minutes=(float, "by default a sixth of the time"),
        match_seconds=(60.0, "length of a match"),
        speed=(1.0, "2: twice as fast as real time"),
        visitors=(10, "of each kind at once"),
        json=(Path, "write all looks there"),
    )
    figures = soak(
        options.minutes,
        options.match_seconds,
        options.speed,
        options.warm_minutes,
        options.visitors,
    )
    _print(figures)
    if options.json:
        options.json.write_text(json.dumps(figures.looks))
    sys.exit(not figures.held)


if __name__ == "__main__":
    main()
