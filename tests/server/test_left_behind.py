"""Tests that a court goes on only with a match that fits it and that no court has ended."""

import os
import signal
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import msgspec
import pytest
from running import party, served, until, write_contest
from stage import LEFT, QUICK, RIGHT, decide, join, setup
from waiting import LIMIT_S

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.recovery import Unfinished, unfinished
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.inputs import ReadySeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files, pack
from lacoc_shared.record.matches import court_matches, is_over
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase

pytestmark = pytest.mark.slow

OTHELLO = arenas.load("othello", QUICK)
TEN = "20260501-100000"
"""Wall time at which the matches of these tests are opened, if not stated otherwise."""
LATER = "20260501-100500"


def held(
    folder: Path, court: str = "main", opened: str = TEN, number: int = 1, arena: str = "othello"
) -> Journal:
    """Play 50 beats of a match, in PLAYING (practice: in LOBBY), and return its open journal."""
    made = msgspec.structs.replace(
        setup(arena, QUICK), match_id=f"{opened}-{court}-{number:03d}", court=court, match=number
    )
    journal = Journal(Match(made, World), folder)
    seats = range(len(journal.match.seats))
    journal.beat([join(seat) for seat in seats])
    if len(seats) == 2:
        journal.beat([ReadySeat(LEFT, True), ReadySeat(RIGHT, True)])
        journal.beat([decide(d.Start())])
    for _ in range(50):
        journal.beat()
    return journal


def killed(
    folder: Path, court: str = "main", opened: str = TEN, number: int = 1, arena: str = "othello"
) -> str:
    """Play a match, leave its record without an end as a kill does; return the match's id."""
    journal = held(folder, court, opened, number, arena)
    journal.leave()
    return journal.match.setup.match_id


def taken_up(folder: Path, court: str, arena: Arena = OTHELLO) -> str | None:
    left = unfinished(folder, court, arena)
    return left and left.match.setup.match_id


def test_a_court_does_not_take_up_the_match_of_another(tmp_path: Path) -> None:
    """A court named "final" does not go on with a match of "semi-final"."""
    match_id = killed(tmp_path, "semi-final")
    assert taken_up(tmp_path, "final") is None
    assert taken_up(tmp_path, "semi-final") == match_id


def test_the_packed_match_of_another_court_hides_none(tmp_path: Path) -> None:
    """An unfinished match goes on unless its own court has a newer match.

    Newer matches of other courts do not count.
    """
    match_id = killed(tmp_path, "final")
    for court in ("semi-final", "final-b", "zoo"):
        (tmp_path / f"{LATER}-{court}-002.mcap").touch()
    assert taken_up(tmp_path, "final") == match_id
    (tmp_path / f"{LATER}-final-001.mcap").touch()
    assert taken_up(tmp_path, "final") is None, "a match came after it"


def test_match_1000_goes_on(tmp_path: Path) -> None:
    """Match 1000 counts as newer than match 999."""
    (tmp_path / f"{TEN}-main-999.mcap").touch()
    match_id = killed(tmp_path, number=1000)
    assert taken_up(tmp_path, "main") == match_id


def test_a_renamed_record_is_told(tmp_path: Path) -> None:
    """A court refuses to go on with a record whose file was renamed to fit another match."""
    match_id = killed(tmp_path, "semi-final")
    path = files.segment_path(tmp_path, match_id, 0)
    path.rename(files.segment_path(tmp_path, f"{TEN}-final-001", 0))
    words = rf'The file is from match "{match_id}" of court "semi-final"\. Give the files.*--fresh'
    with pytest.raises(UserError, match=words):
        unfinished(tmp_path, "final", OTHELLO)


@pytest.mark.parametrize(("there", "here"), [("othello", "practice"), ("practice", "othello")])
def test_a_match_of_another_arena_is_refused(there: str, here: str, tmp_path: Path) -> None:
    """A court refuses to go on with a match of another arena, and does not change its record."""
    match_id = killed(tmp_path, arena=there)
    path = files.segment_path(tmp_path, match_id, 0)
    data = path.read_bytes()
    words = rf'was played in arena "{there}", and this court plays "{here}"\..*--fresh'
    with pytest.raises(UserError, match=words):
        unfinished(tmp_path, "main", arenas.load(here))
    assert path.read_bytes() == data
    assert taken_up(tmp_path, "main", arenas.load(there)) == match_id


def test_a_match_of_other_seats_is_refused(tmp_path: Path) -> None:
    """A court refuses a match with other seats than the court has: no token would open them."""
    killed(tmp_path)
    renamed = [seat | {"id": new} for seat, new in zip(OTHELLO.settings["seat"], "ab", strict=True)]
    other = arenas.load("othello", arenas.merge(QUICK, {"seat": renamed}))
    with pytest.raises(UserError, match=r"has the seats left, right, but this .* a, b\."):
        unfinished(tmp_path, "main", other)


def test_a_match_that_its_court_ended_is_over(tmp_path: Path) -> None:
    """No court goes on with a match that its court ended, even if it is not packed yet.

    If the end of its last segment is cut off, the match can be resumed.
    """
    journal = held(tmp_path)
    journal.close()
    assert unfinished(tmp_path, "main", OTHELLO) is None
    (segment,) = files.segment_paths(tmp_path, journal.match.setup.match_id)
    whole = segment.read_bytes()
    segment.write_bytes(whole[:-8])
    left = unfinished(tmp_path, "main", OTHELLO)
    assert left is not None, "a full disk did not take the end of it"
    assert left.match.beats == journal.match.beats


def test_a_match_that_went_on_loses_nothing_to_a_packer(tmp_path: Path) -> None:
    """A resumed match can't be packed until it is over; then all its segments are packed."""
    first = held(tmp_path)
    first.leave()
    match_id = first.match.setup.match_id
    left = unfinished(tmp_path, "main", OTHELLO)
    assert isinstance(left, Unfinished)
    second = Journal(left.match, tmp_path, left.segment)
    second.beat(left.inputs)
    out = files.packed_path(tmp_path, match_id)
    before = files.segment_paths(tmp_path, match_id)
    for segments in (before, before[:1]):
        with pytest.raises(UserError):
            pack.pack(segments, out)
    for _ in range(300):
        second.beat()
    second.beat([decide(d.Declare("left"))])
    second.beat([decide(d.Official())])
    second.close()
    assert pack.main(str(tmp_path), match_id) == 0
    record = Record.read(out)
    assert record.last_beat == second.match.beats
    assert record.result is not None
    assert record.result.official == "left"


def test_a_match_that_a_court_took_up_is_not_taken_up_twice(tmp_path: Path) -> None:
    """While a court that resumed a match still runs, no other court goes on with the match."""
    killed(tmp_path)
    left = unfinished(tmp_path, "main", OTHELLO)
    assert left is not None
    running = Journal(left.match, tmp_path, left.segment)
    assert unfinished(tmp_path, "main", OTHELLO) is None
    running.leave()
    assert unfinished(tmp_path, "main", OTHELLO) is not None


FAILING = """
import errno, os, runpy, subprocess, sys
from lacoc_server.match.match import Match

flag, what = sys.argv[1:3]
beat, start = Match.beat, subprocess.Popen.__init__

def failing_beat(self, inputs=()):
    made = beat(self, inputs)
    if os.path.exists(flag):
        raise MemoryError("no memory for a beat")
    return made

def failing_start(self, *words, **options):
    if os.path.exists(flag):
        raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
    start(self, *words, **options)

if what == "beat":
    Match.beat = failing_beat
else:
    subprocess.Popen.__init__ = failing_start
module, sys.argv = sys.argv[5], sys.argv[5:]
runpy.run_module(module, run_name="__main__", alter_sys=True)
"""
"""A program that runs `lacoc`; while a flag file exists, beats or starts of processes fail."""


def failing(flag: Path, what: str) -> list[str]:
    return [sys.executable, "-c", FAILING, str(flag), what]


def packed(folder: Path, *numbers: str) -> list[Path]:
    """Wait until a folder holds the packed files of these matches and nothing else; return them."""
    end_s, wanted = time.monotonic() + LIMIT_S, sorted(f"-{number}.mcap" for number in numbers)
    while sorted(path.name[-9:] for path in folder.iterdir()) != wanted:
        assert time.monotonic() < end_s, list(folder.iterdir())
        time.sleep(0.05)
    return sorted(folder.iterdir())


@pytest.mark.long
@pytest.mark.slow(minutes=0.3)
def test_a_match_outlives_an_error_of_its_court(tmp_path: Path) -> None:
    """If an error ends a court, its next start goes on with the match in HALTED."""
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    flag = tmp_path / "flag"
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder, before=failing(flag, "beat")))
        those = stack.enter_context(party(contest))
        those.play()
        those.until(lambda: those.frame.clock_ticks > 20)
        seen = those.frame
        flag.touch()
        assert first.wait(LIMIT_S) not in (0, -signal.SIGKILL)
        flag.unlink()
        assert [path.suffixes[-3:] for path in folder.iterdir()] == [[".000", ".live", ".mcap"]]

        stack.enter_context(served(contest, folder))
        those.reach(Phase.HALTED)
        assert those.frame.match == seen.match
        assert those.frame.clock_ticks >= seen.clock_ticks
        those.decide(d.Abort())
    (record,) = packed(folder, "001")
    *_, verdict = verify(Record.read(record))
    assert isinstance(verdict, Verdict)
    assert verdict.kind is VerdictKind.SAME


@pytest.mark.long
@pytest.mark.slow(minutes=0.3)
def test_a_court_that_can_start_no_process_plays_on(tmp_path: Path) -> None:
    """A court that can't start a packer plays on; the records are packed after the next start."""
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    flag = tmp_path / "flag"
    with ExitStack() as stack:
        process = stack.enter_context(served(contest, folder, before=failing(flag, "start")))
        those = stack.enter_context(party(contest))
        those.reach(Phase.READY)
        flag.touch()
        for number in (2, 3):
            those.decide(d.Abort())
            those.decide(d.Next())
            those.until(lambda number=number: those.frame.match == number)
        assert len(list(folder.glob("*.live.mcap"))) == 3
        assert process.stdout is not None
        process.send_signal(signal.SIGTERM)
        said, _ = process.communicate(timeout=LIMIT_S)
        assert process.returncode == 0
        assert "Records can't be packed now: [Errno 11] Resource temporarily unavailable" in said
        assert len(list(folder.glob("*.live.mcap"))) == 3

        flag.unlink()
        stack.enter_context(served(contest, folder, before=failing(flag, "start")))
        those.until(lambda: len(list(folder.glob("*[0-9].mcap"))) == 3)
    records = packed(folder, "001", "002", "003", "001")
    assert all(Record.read(path).cut is None for path in records)


def test_a_stopped_court_ends_its_match(tmp_path: Path) -> None:
    """SIGTERM makes a court end its match in PLAYING, so its next start opens a new match.

    This also holds if the court is killed as soon as the match has ended.
    """
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    with served(contest, folder) as first, party(contest) as those:
        those.play()
        os.kill(first.pid, signal.SIGTERM)
        until([], lambda: ended(folder))
        first.kill()
        first.wait()
    with served(contest, folder):
        assert unfinished(folder, "main", OTHELLO) is None
    records = packed(folder, "001", "001")
    assert [len(Record.read(path).headers) for path in records] == [1, 1]


def ended(folder: Path) -> bool:
    """Return whether all matches of court "main" in a folder are over."""
    return all(is_over(*match) for match in court_matches(folder, "main").items())
