"""A court on another machine: its records are copied, and the office stands in for it."""

import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from lacoc_process import started
from ports import free_port
from processes import cut_power
from waiting import LIMIT_S, until

from lacoc_server.commands.contest.checking import NOT_PROVEN
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.stand_ins import stand_in
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import Called, Played, Recalled
from lacoc_server.contest.live.away import AwayCourt
from lacoc_shared.command.child import NOT_AGAIN
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import NoMatch, Record
from lacoc_shared.words import Phrase, say

CONTEST = """
[contest]
name = "Away"
[court.blue]
arena = "othello"
listen = ["127.0.0.1:{here}"]
elsewhere = "tcp/127.0.0.1:{there}"
[stage.final]
format = "single-knockout"
games = 3
settings.match = {{ duration_s = 12.0, countdown_s = 0.5, start = "ready" }}
"""
SPEED = "3"
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def processes() -> Iterator[ExitStack]:
    """Give a stack that ends the processes of a test."""
    with ExitStack() as stack:
        yield stack


def start(stack: ExitStack, *words: str) -> "subprocess.Popen[Any]":
    """Start a command; it ends with the test."""
    process = started(*words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def end() -> None:
        process.terminate()
        process.communicate(timeout=LIMIT_S)

    stack.callback(end)
    return process


def test_only_courts_with_an_address_elsewhere_run_elsewhere(tmp_path: Path, lacoc: Run) -> None:
    """`lacoc contest courts` names the entry that a contest file lacks."""
    file = tmp_path / "contest.toml"
    text = CONTEST.format(here=free_port(), there=free_port())
    lines = (line for line in text.splitlines() if not line.startswith("elsewhere"))
    file.write_text("\n".join(lines))
    code, _, told = lacoc("contest", "courts", "--contest", file)
    assert code == 2
    assert "No court in" in told
    code, _, told = lacoc("contest", "courts", "blue", "--contest", file)
    assert code == 2
    assert 'elsewhere = "tcp/ADDRESS-OF-THIS-MACHINE:7447"' in told


def test_a_court_that_can_not_be_opened_here_keeps_its_game_no_longer(tmp_path: Path) -> None:
    """The office expects the court until the first attempt to open it has failed."""
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST.format(here=free_port(), there=free_port()))
    where = ContestFolder(file)
    stand_in(where.stand_ins, "blue")
    expected: list[str] = []
    told: list[Phrase] = []
    office = cast(Any, SimpleNamespace(expect=expected.append))

    def open_here(_: str) -> Any:
        raise UserError(say("plain.text", text="the port is taken"))

    with AwayCourt(where, "blue", cast(Any, None), open_here, told.append) as court:
        court.step(office)
        assert expected == ["blue"]

        def is_known() -> bool:
            """Return whether a look at the court makes the office expect it no more."""
            before = len(expected)
            court.step(office)
            return len(expected) == before

        until(is_known)
    assert [phrase.code for phrase in told] == ["away.can-not-open"]


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_a_match_goes_on_here_if_its_machine_is_gone(tmp_path: Path, processes: ExitStack) -> None:
    """The first game is copied whole; in the second one the court's machine is lost.

    The office opens the court itself, from the copy, and the contest ends. When the other machine
    comes back meanwhile, its court ends.
    """
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    file = here / "contest.toml"
    file.write_text(CONTEST.format(here=free_port(), there=free_port()))
    for team, bot in {"Ann": "straight", "Bob": "nearest"}.items():
        organiser.enter(file, team, None, bot, "")
    there.mkdir()
    ContestFolder(file).contest.secrets.referee("blue")
    shutil.copy(file, there)
    shutil.copy(ContestFolder(file).secrets, there)

    office = start(processes, "contest", "run", str(file), "--until-over", "--speed", SPEED)
    words = ("--contest", str(there / "contest.toml"), "--speed", SPEED)
    machine = start(processes, "contest", "courts", *words)
    where = ContestFolder(file)
    with FactStore(where.facts) as store:

        def records() -> list[str]:
            return [fact.record for fact in store.facts() if isinstance(fact, Played)]

        until(records, 240)
        until(lambda: beats(where.records, but=records()[0]) > 150, 240)
        cut_power(machine)
        until(lambda: (here / "contest.stand-ins.txt").exists(), 240)
        again = start(processes, "serve", "--court", "blue", *words)
        until(lambda: again.poll() is not None, 240)
        assert again.returncode == NOT_AGAIN
        until(lambda: office.poll() is not None, 240)
        facts = store.facts()

    assert office.returncode == 0, office.stdout and office.stdout.read()
    assert not [fact for fact in facts if isinstance(fact, Recalled)]
    played = [fact for fact in facts if isinstance(fact, Played)]
    assert len([fact for fact in facts if isinstance(fact, Called)]) == len(played)
    assert {path.name for path in where.records.iterdir()} == {one.record for one in played}
    resumed = [len(Record.read(where.records / one.record).headers) for one in played]
    assert resumed[:2] == [1, 2]
    organiser.publish_to(file, tmp_path / "cup")
    checked = run(tmp_path / "cup")
    assert checked.returncode == NOT_PROVEN, checked.stdout  # bots played at a court


def beats(folder: Path, but: str) -> int:
    """Return how many beats are recorded of a match whose record is not named `but`."""
    found = [path for path in folder.glob("*.live.mcap") if f"{path.name[:-14]}.mcap" != but]
    try:
        return len(Record.read(found).frames) if found else 0
    except NoMatch:  # the copy has begun, and has not the whole header yet
        return 0


def run(folder: Path) -> "subprocess.CompletedProcess[str]":
    """Verify a published folder."""
    process = started("contest", "verify", str(folder), stdout=subprocess.PIPE, text=True)
    out, _ = process.communicate(timeout=LIMIT_S)
    return subprocess.CompletedProcess((), process.returncode, out)
