"""Tests of a court whose disk is full or slow, or reports errors.

docs/decisions/0013-full-disk.md says what the court then does.
"""

import resource
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import msgspec
import pytest
from every_third import every_third
from running import Party, party, served, write_contest
from waiting import LIMIT_S

from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_shared.codec import decode
from lacoc_shared.decisions import Abort, Halt, Next, Resume
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S, SILENT_AFTER_S, Phase
from lacoc_shared.words import Phrase, render

pytestmark = pytest.mark.slow


class Disk(NamedTuple):
    """The records of a running court, and functions that fill their disk and make room on it."""

    fill: Callable[[], None]
    make_room: Callable[[], None]
    records: Path


@contextmanager
def limited(contest: Path, folder: Path) -> Iterator[Disk]:
    """Run a court; `fill` lets its records grow by only 1000 bytes more (RLIMIT_FSIZE)."""
    records = folder / "recordings"
    with served(contest, records) as court:

        def fill() -> None:
            size = max(path.stat().st_size for path in records.iterdir())
            _, most = resource.prlimit(court.pid, resource.RLIMIT_FSIZE)
            resource.prlimit(court.pid, resource.RLIMIT_FSIZE, (size + 1000, most))

        def make_room() -> None:
            _, most = resource.prlimit(court.pid, resource.RLIMIT_FSIZE)
            resource.prlimit(court.pid, resource.RLIMIT_FSIZE, (most, most))

        yield Disk(fill, make_room, records)


@contextmanager
def small(contest: Path, folder: Path) -> Iterator[Disk]:
    """Run a court that records on a disk of 16 MiB in memory; `fill` fills it with another file."""
    mount = folder / "disk"
    mount.mkdir()
    inside = ["unshare", "--user", "--map-root-user", "--mount", "--"]
    mounting = f"mount -t tmpfs -o size=16m tmpfs {mount}"
    if subprocess.run([*inside, "sh", "-c", mounting], capture_output=True).returncode:
        pytest.skip("this system lets no user mount a disk of memory")
    before = [*inside, "sh", "-c", f'{mounting} && exec "$@"', "sh"]
    with served(contest, mount / "recordings", before=before) as court:
        seen = Path(f"/proc/{court.pid}/root{mount}")

        def fill() -> None:
            with (seen / "other").open("wb", buffering=0) as other:
                for size in (1 << 20, 1 << 12, 1):  # to the disk's last byte
                    while True:
                        try:
                            other.write(bytes(size))
                        except OSError:
                            break

        def make_room() -> None:
            (seen / "other").unlink()

        yield Disk(fill, make_room, seen / "recordings")


def read(folder: Path) -> Record:
    """Return the record of the only match in a folder."""
    return Record.read(next(folder.glob("*.live.mcap")))


def is_given(those: Party, reason: str) -> bool:
    """Return whether an event with this reason has arrived; it may come after its beat's frame."""
    given = (event.data["reason"] for event in those.view.events if "reason" in event.data)
    return any(reason in render(msgspec.convert(one, Phrase | str)) for one in given)


@pytest.mark.parametrize("disk_of", every_third([small, limited]))
def test_a_full_disk_halts_the_match(disk_of: Callable[..., object], tmp_path: Path) -> None:
    """While the disk is full no beat passes; when there is room again, the match is halted.

    Each frame of PLAYING is in the record before it is published. While the disk is full, decisions
    are refused.
    """
    contest = write_contest(tmp_path / "contest.toml")
    seen: dict[int, bytes] = {}
    with ExitStack() as stack:
        disk: Disk = stack.enter_context(disk_of(contest, tmp_path))  # type: ignore[arg-type]
        those = stack.enter_context(party(contest))
        frames = those.session.mailbox("lacoc/main/frame", 10_000)
        those.play()

        for _ in range(2):
            seq = those.left.press(Level.LOCOMOTION, 2)
            those.until(lambda seq=seq: those.frame.seats[0].applied_seq == seq)
            disk.fill()
            those.until(lambda: "can't be written" in those.trouble)
            stopped = those.frame.beat
            lost = those.left.press(Level.LOCOMOTION, 1)
            with pytest.raises(UserError, match=r"The record .* can't be written: .*Make room"):
                those.decide(Halt())
            kept = tmp_path / "while-full"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(disk.records, kept)
            health = those.view.health
            those.until(lambda health=health: those.view.health is not health)
            assert those.frame.beat == stopped
            assert those.phase == Phase.PLAYING
            assert those.frame.seats[0].applied_seq < lost
            while (mail := frames.take()) is not None:
                told = decode(mail.payload, Frame)
                if told.phase == Phase.PLAYING:  # in other phases only changed frames are recorded
                    seen[told.beat] = mail.payload
            recorded = dict(read(kept).frames)
            assert seen
            assert [beat for beat, data in seen.items() if recorded.get(beat) != data] == []

            disk.make_room()
            those.reach(Phase.HALTED)
            those.until(lambda: those.trouble == "")
            those.until(lambda: is_given(those, "can't be written"))
            assert any(e.data.get("after") == "HALTED" for e in those.view.events[-3:])
            those.decide(Resume(), Phase.PLAYING)
        kept = tmp_path / "kept"
        shutil.copytree(disk.records, kept)
    *_, verdict = verify(read(kept))
    assert isinstance(verdict, Verdict)
    assert verdict.kind is VerdictKind.SAME


SYNC = """
import os, runpy, sys, time

flag, what, fsync = sys.argv[1], sys.argv[2], os.fsync

def sync(descriptor):
    if os.path.exists(flag):
        if what == "fails":
            raise OSError(5, "Input/output error")
        time.sleep(float(what))
    fsync(descriptor)

os.fsync = sync
module, sys.argv = sys.argv[5], sys.argv[5:]
runpy.run_module(module, run_name="__main__", alter_sys=True)
"""
"""A program that runs `lacoc`; while a flag file exists, `fsync` fails or takes seconds longer."""


def sync(flag: Path, what: str) -> list[str]:
    """Return words to put before a command line of `lacoc`, so that it runs with a changed `fsync`.

    Args:
        flag: while this file exists, `fsync` is changed.
        what: "fails", or how many seconds longer `fsync` takes.
    """
    return [sys.executable, "-c", SYNC, str(flag), what]


@pytest.mark.long
def test_a_disk_that_reports_errors_later_halts_the_match_once(tmp_path: Path) -> None:
    """If `fsync` reports an error, the match is halted; after a resume it is not halted again."""
    contest, broken = write_contest(tmp_path / "contest.toml"), tmp_path / "broken"
    before = sync(broken, "fails")
    with served(contest, tmp_path / "recordings", before=before), party(contest) as those:
        those.play()
        broken.touch()
        those.reach(Phase.HALTED)
        said = "reports: Input/output error"
        those.until(lambda: is_given(those, said))
        those.until(lambda: said in those.trouble)
        those.decide(Resume(), Phase.PLAYING)
        resumed = those.frame.beat
        # In these two seconds `fsync` was called again and failed again.
        those.until(lambda: those.frame.beat > resumed + 100)
        assert those.phase == Phase.PLAYING


def test_the_next_match_waits_for_its_record(tmp_path: Path) -> None:
    """While the next match can't have a record, the finished match stays, and health says why.

    As soon as the record can be made, the next match opens.
    """
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    with served(contest, folder), party(contest) as those:
        those.decide(Abort())
        folder.rename(tmp_path / "elsewhere")
        folder.touch()
        those.decide(Next())
        those.until(lambda: "No record can be written to" in those.trouble)
        assert (those.phase, those.frame.match) == (Phase.VOID, 1)
        folder.unlink()
        those.until(lambda: (those.phase, those.frame.match) == (Phase.LOBBY, 2))
        those.until(lambda: those.trouble == "")
    assert [path.name[-9:] for path in folder.iterdir()] == ["-002.mcap"]


@pytest.mark.long
def test_the_next_match_does_not_wait_for_a_slow_disk(tmp_path: Path) -> None:
    """While a slow disk stores the finished match, frames of the next come less than 1 s apart."""
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    slow = tmp_path / "slow"
    with served(contest, folder, before=sync(slow, "4")), party(contest) as those:
        slow.touch()
        frames = those.session.mailbox("lacoc/main/frame", 10_000)
        those.decide(Abort())
        those.decide(Next())
        those.until(lambda: (those.phase, those.frame.match) == (Phase.LOBBY, 2))
        those.until(lambda: those.frame.beat > BEATS_PER_S)
        arrivals_s = []
        while (mail := frames.take()) is not None:
            arrivals_s.append(mail.arrived_s)
        assert max(later - one for one, later in pairwise(arrivals_s)) < SILENT_AFTER_S
    assert sorted(path.name[-9:] for path in folder.iterdir()) == ["-001.mcap", "-002.mcap"]
    assert [Record.read(path).cut for path in folder.iterdir()] == [None, None]


@pytest.mark.long
def test_a_court_is_killed_before_its_disk_has_the_last_match(tmp_path: Path) -> None:
    """A court killed before its disk has stored a finished match goes on with the next match.

    Both records are whole in the end.
    """
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    slow = tmp_path / "slow"
    with served(contest, folder, before=sync(slow, "60")) as court, party(contest) as those:
        slow.touch()
        those.decide(Abort())
        those.decide(Next())
        those.until(lambda: (those.phase, those.frame.match) == (Phase.LOBBY, 2))
        court.kill()
    with served(contest, folder), party(contest) as those:
        assert those.frame.match == 2
        those.reach(Phase.READY)
    assert sorted(path.name[-9:] for path in folder.iterdir()) == ["-001.mcap", "-002.mcap"]
    assert [Record.read(path).cut for path in folder.iterdir()] == [None, None]


def test_a_court_does_not_open_on_a_full_disk(tmp_path: Path) -> None:
    """A court does not start on a full disk; it says why and leaves no empty record."""
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    words = [str(contest), "--recordings", str(folder)]
    done = subprocess.run(
        [
            "sh",
            "-c",
            'ulimit -f 1 && exec "$@"',
            "sh",
            sys.executable,
            "-m",
            "tests.processes.alone",
            *words,
        ],
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )
    assert done.returncode == 2
    assert "No record can be written to" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(folder.iterdir()) == []
