"""A disk that is full in the middle of a match (docs/decisions/0013-full-disk.md)."""

import resource
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest
from running import WAIT_S, frame, phase, seated, served, until, write_contest

from lacoc_client.controller import Controller
from lacoc_client.referee import RefereeClient
from lacoc_server.replay import Verdict, verify
from lacoc_shared.codec import decode
from lacoc_shared.contest import load
from lacoc_shared.decisions import Abort, Halt, Next, Resume, Start
from lacoc_shared.gait import Level
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.session import open_client

pytestmark = pytest.mark.slow


class Disk(NamedTuple):
    """Where a running court records, and how to fill it."""

    fill: Callable[[], None]
    make_room: Callable[[], None]
    records: Path


@contextmanager
def limited(contest: Path, folder: Path) -> Iterator[Disk]:
    """The system lets the court's files grow no more."""
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
    """A disk of its own in memory, which another file fills."""
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
                for size in (1 << 20, 1 << 12, 1):  # to the last byte of its last page
                    while True:
                        try:
                            other.write(bytes(size))
                        except OSError:
                            break

        def make_room() -> None:
            (seen / "other").unlink()

        yield Disk(fill, make_room, seen / "recordings")


def read(folder: Path) -> Record:
    """The one match of a folder."""
    return Record.read(next(folder.glob("*.live.mcap")))


def is_given(controller: Controller, reason: str) -> bool:
    """Whether a decision has this reason; an event comes after the frame of its beat."""
    return any(reason in event.data.get("reason", "") for event in controller.view.events)


def trouble(controller: Controller) -> str:
    return "" if controller.view.health is None else controller.view.health.record_trouble


@pytest.mark.parametrize("disk_of", [limited, small])
def test_a_full_disk_halts_the_match(disk_of: Callable[..., object], tmp_path: Path) -> None:
    """Nobody is told what is not recorded; with room again the match goes on, halted."""
    contest = write_contest(tmp_path / "contest.toml")
    name, court = load(contest).court()
    seen: dict[int, bytes] = {}
    with ExitStack() as stack:
        disk: Disk = stack.enter_context(disk_of(contest, tmp_path))  # type: ignore[arg-type]
        session = stack.enter_context(open_client([court.address()]))
        frames = session.mailbox(f"lacoc/{name}/frame", 10_000)
        controllers = seated(session, contest)
        left = controllers[0]
        until(controllers, lambda: phase(left) == Phase.READY)
        referee = RefereeClient(session, name, court.referee.token)
        referee.decide(Start(), "", "Kubota")
        until(controllers, lambda: phase(left) == Phase.PLAYING)

        for _ in range(2):
            seq = left.press(Level.LOCOMOTION, 2)
            until(controllers, lambda seq=seq: frame(left).seats[0].applied_seq == seq)
            disk.fill()
            until(controllers, lambda: "can't be written" in trouble(left))
            stopped = frame(left).beat
            lost = left.press(Level.LOCOMOTION, 1)
            with pytest.raises(UserError, match=r"The record .* can't be written: .*Make room"):
                referee.decide(Halt(), "", "Kubota")
            kept = tmp_path / "while-full"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(disk.records, kept)
            health = left.view.health
            until(controllers, lambda health=health: left.view.health is not health)
            assert frame(left).beat == stopped
            assert frame(left).phase == Phase.PLAYING
            assert frame(left).seats[0].applied_seq < lost
            while (mail := frames.take()) is not None:
                told = decode(mail.payload, Frame)
                if told.phase == Phase.PLAYING:  # others are recorded where they change
                    seen[told.beat] = mail.payload
            recorded = dict(read(kept).frames)
            assert seen
            assert [beat for beat, data in seen.items() if recorded.get(beat) != data] == []

            disk.make_room()
            until(controllers, lambda: phase(left) == Phase.HALTED)
            until(controllers, lambda: trouble(left) == "")
            until(controllers, lambda: is_given(left, "can't be written"))
            assert any(e.data.get("after") == "HALTED" for e in left.view.events[-3:])
            referee.decide(Resume(), "", "Kubota")
            until(controllers, lambda: phase(left) == Phase.PLAYING)
        kept = tmp_path / "kept"
        shutil.copytree(disk.records, kept)
    *_, verdict = verify(read(kept))
    assert isinstance(verdict, Verdict)
    assert verdict.text == "same"


SYNCING_FAILS = """
import os, runpy, sys

flag, fsync = sys.argv[1], os.fsync

def failing(descriptor):
    if os.path.exists(flag):
        raise OSError(5, "Input/output error")
    fsync(descriptor)

os.fsync = failing
sys.argv = sys.argv[4:]
runpy.run_module("lacoc_shared", run_name="__main__", alter_sys=True)
"""
"""Runs the command that follows; the disk keeps nothing while a file is there."""


def test_a_disk_that_reports_errors_later_halts_the_match_once(tmp_path: Path) -> None:
    """The referee hears of it, and may go on: everybody but a power cut has the record."""
    contest, broken = write_contest(tmp_path / "contest.toml"), tmp_path / "broken"
    name, court = load(contest).court()
    before = [sys.executable, "-c", SYNCING_FAILS, str(broken)]
    with (
        served(contest, tmp_path / "recordings", before=before),
        open_client([court.address()]) as session,
    ):
        controllers = seated(session, contest)
        left = controllers[0]
        until(controllers, lambda: phase(left) == Phase.READY)
        referee = RefereeClient(session, name, court.referee.token)
        referee.decide(Start(), "", "Kubota")
        until(controllers, lambda: phase(left) == Phase.PLAYING)
        broken.touch()
        until(controllers, lambda: phase(left) == Phase.HALTED)
        said = "reports: Input/output error"
        until(controllers, lambda: is_given(left, said))
        until(controllers, lambda: said in trouble(left))
        referee.decide(Resume(), "", "Kubota")
        until(controllers, lambda: phase(left) == Phase.PLAYING)
        resumed = frame(left).beat
        # Two seconds, in which the disk was asked again and refused again.
        until(controllers, lambda: frame(left).beat > resumed + 100)
        assert phase(left) == Phase.PLAYING


def test_the_next_match_waits_for_its_record(tmp_path: Path) -> None:
    """Where no file can be made, the match that is over stays, and it is said why."""
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    name, court = load(contest).court()
    with served(contest, folder), open_client([court.address()]) as session:
        controllers = seated(session, contest)
        left = controllers[0]
        referee = RefereeClient(session, name, court.referee.token)
        referee.decide(Abort(), "a test", "Kubota")
        folder.rename(tmp_path / "elsewhere")
        folder.touch()
        referee.decide(Next(), "", "Kubota")
        until(controllers, lambda: "No record can be written to" in trouble(left))
        assert (phase(left), frame(left).match) == (Phase.VOID, 1)
        folder.unlink()
        until(controllers, lambda: (phase(left), frame(left).match) == (Phase.LOBBY, 2))
        until(controllers, lambda: trouble(left) == "")
    assert [path.name[-9:] for path in folder.iterdir()] == ["-002.mcap"]


def test_a_court_does_not_open_on_a_full_disk(tmp_path: Path) -> None:
    """It says why, and leaves no empty record."""
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    words = ["serve", "--contest", str(contest), "--recordings", str(folder)]
    done = subprocess.run(
        [
            "sh",
            "-c",
            'ulimit -f 1 && exec "$@"',
            "sh",
            sys.executable,
            "-m",
            "lacoc_shared",
            *words,
        ],
        capture_output=True,
        text=True,
        timeout=WAIT_S,
        check=False,
    )
    assert done.returncode == 2
    assert "No record can be written to" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(folder.iterdir()) == []
