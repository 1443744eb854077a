"""A contest goes on at a second machine: real processes, and a first machine that is lost."""

import json
import re
import shutil
import signal
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from lacoc_process import run_lacoc, started
from ports import free_port
from processes import cut_power, everything_of
from waiting import LIMIT_S, until

from lacoc_server.commands.contest.checking import NOT_PROVEN
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import AnyFact, Called, Played, Recalled, TakenOver
from lacoc_shared.codec import decode
from lacoc_shared.command.child import NOT_AGAIN
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record

CONTEST = """
[contest]
name = "Two machines"
[standby]
office = "127.0.0.1:{door}"
[court.blue]
arena = "othello"
listen = ["127.0.0.1:{blue}"]
[court.red]
arena = "othello"
listen = ["127.0.0.1:{red}"]
[stage.groups]
format = "round-robin"
settings.match = {{ duration_s = 24.0, countdown_s = 0.5, start = "ready" }}
"""
SPEED = ("--until-over", "--speed", "4")


class Processes:
    """The `lacoc` processes of a test; all of them end with it."""

    def __init__(self) -> None:
        self._stack = ExitStack()

    def __enter__(self) -> "Processes":
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def start(self, *words: object) -> "subprocess.Popen[Any]":
        """Start a command."""
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        process = started("contest", *map(str, words), text=True, **streams)

        def end() -> None:
            if process.poll() is None:
                process.terminate()
            process.communicate(timeout=LIMIT_S)

        self._stack.callback(end)
        return process


@pytest.fixture
def processes() -> Iterator[Processes]:
    """Give the processes of a test."""
    with Processes() as found:
        yield found


def contest(folder: Path) -> Path:
    """Write a contest of four bots on two courts; return its file."""
    folder.mkdir()
    file = folder / "contest.toml"
    ports = {name: free_port() for name in ("door", "blue", "red")}
    file.write_text(CONTEST.format(**ports))
    for team, bot in {
        "Ann": "straight",
        "Bob": "nearest",
        "Cat": "straight",
        "Dan": "nearest",
    }.items():
        organiser.enter(file, team, None, bot, "")
    return file


def second_machine(file: Path, folder: Path) -> Path:
    """Make the folder of the second machine; return its contest file."""
    folder.mkdir()
    ContestFolder(file).contest.secrets.referee("blue")
    shutil.copy(ContestFolder(file).secrets, folder)
    return Path(shutil.copy(file, folder))


def facts(file: Path) -> tuple[AnyFact, ...]:
    """Read the facts of a contest."""
    with FactStore(ContestFolder(file).facts) as store:
        return store.facts()


def in_play(file: Path) -> int:
    """Return how many matches have open records of more than two seconds of play."""
    found = 0
    folder = ContestFolder(file).records
    for match_id in {path.name.split(".")[0] for path in folder.glob("*.live.mcap")}:
        try:
            frames = Record.read(sorted(folder.glob(f"{match_id}.*.live.mcap"))).frames
        except UserError:  # it has no header yet
            continue
        found += bool(frames) and 100 < decode(frames[-1][1], Frame).clock_ticks < 900
    return found


def other_port(_: object) -> str:
    """Return a free port: two machines on one can't listen at the same ones."""
    return str(free_port())


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_the_contest_goes_on_at_the_second_machine(tmp_path: Path, processes: Processes) -> None:
    """All of the first machine is killed, and its folder is gone, with two games in play.

    One command at the second machine goes on: both games from their copied records, with the same
    tokens. Every game has one result, and what is published is right.
    """
    file = contest(tmp_path / "first")
    second = second_machine(file, tmp_path / "second")
    first = processes.start("run", file, *SPEED)
    copier = processes.start("standby", second)
    until(lambda: any(isinstance(one, Played) for one in facts(second)))
    until(lambda: in_play(second) == 2)
    cut_power(first)
    before = facts(file)
    tokens = ContestFolder(file).secrets.read_bytes()
    file.parent.rename(tmp_path / "gone")

    office = processes.start("run", second, "--take-over", *SPEED)
    until(lambda: copier.poll() is not None)
    assert copier.returncode == NOT_AGAIN
    until(lambda: office.poll() is not None)
    assert office.returncode == 0, office.stdout and office.stdout.read()

    where = ContestFolder(second)
    after = facts(second)
    moved = next(one for one in after if isinstance(one, TakenOver))
    copied = after[: moved.number - 1]
    assert copied == before[: len(copied)]
    assert where.secrets.read_bytes() == tokens
    assert not [one for one in after if isinstance(one, Recalled)]
    played = [one for one in after if isinstance(one, Played)]
    assert len({(one.pairing, one.game) for one in played}) == len(played) == 6
    assert len([one for one in after if isinstance(one, Called)]) == 6
    assert {path.name for path in where.records.iterdir()} == {one.record for one in played}
    segments = [len(Record.read(where.records / one.record).headers) for one in played]
    assert sorted(segments) == [1, 1, 1, 1, 2, 2]
    organiser.publish_to(second, tmp_path / "cup")
    checked = run_lacoc("contest", "verify", str(tmp_path / "cup"), timeout_s=LIMIT_S)
    assert checked.returncode == NOT_PROVEN, checked.stdout  # bots played at courts


@pytest.mark.long
@pytest.mark.slow
def test_an_office_that_comes_back_ends(tmp_path: Path, processes: Processes) -> None:
    """An office that was cut off for a while ends as soon as the later one reaches it.

    It can't be started again, and its folder takes nothing any more.
    """
    file = contest(tmp_path / "first")
    second = second_machine(file, tmp_path / "second")
    first = processes.start("run", file, *SPEED)
    copier = processes.start("standby", second, "--json")
    assert copier.stdout is not None
    until(lambda: in_play(second) > 0)
    refused = run_lacoc("contest", "run", str(second), "--take-over", timeout_s=LIMIT_S)
    assert (refused.returncode, "still answers" in refused.stderr) == (2, True)
    refused = run_lacoc("contest", "run", str(second), timeout_s=LIMIT_S)
    assert (refused.returncode, "is run by another program" in refused.stderr) == (2, True)
    cut_off = everything_of(first)
    for process in cut_off:
        process.suspend()
    try:
        copier.send_signal(signal.SIGINT)
        lines = [line for line in copier.communicate(timeout=LIMIT_S)[0].splitlines() if line]
        assert json.loads(next(line for line in lines if line.startswith("{")))["kind"] == "copy"
        second.write_text(re.sub(r"(?<=127\.0\.0\.1:)\d+", other_port, second.read_text()))
        refused = run_lacoc("contest", "run", str(second), timeout_s=LIMIT_S)
        assert (refused.returncode, "is a copy of the office" in refused.stderr) == (2, True)
        office = processes.start("run", second, "--take-over", *SPEED)
        until(lambda: any(isinstance(one, TakenOver) for one in facts(second)))
    finally:
        for process in cut_off:
            process.resume()
    until(lambda: first.poll() is not None)
    assert first.returncode == NOT_AGAIN, first.stdout and first.stdout.read()
    left = facts(file)
    assert not [one for one in left if isinstance(one, TakenOver)]
    again = run_lacoc("contest", "run", str(file), timeout_s=LIMIT_S)
    assert again.returncode == NOT_AGAIN
    refused = run_lacoc("contest", "draw", "--yes", "--contest", str(file), timeout_s=LIMIT_S)
    assert refused.returncode == 2
    assert facts(file) == left
    assert office.poll() is None
