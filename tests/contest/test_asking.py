"""Tests of commands that ask at a terminal before they change a contest."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from small_contest import CONTEST, FINAL, SWISS

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import note_plans
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import AnyFact, Closed, Drawn, Withdrawn, new

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such terminal.")

Run = Callable[..., tuple[int, str, str]]
Answer = Callable[[str], None]


@pytest.fixture
def answer(monkeypatch: pytest.MonkeyPatch) -> Answer:
    """Give a function that opens a terminal at which somebody has typed an answer."""

    def type_in(text: str) -> None:
        typing, terminal = os.openpty()
        os.write(typing, text.encode())
        monkeypatch.setattr(sys, "stdin", os.fdopen(terminal))

    return type_in


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Give the file of a contest that two teams have entered."""
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST + SWISS + FINAL, "utf-8")
    for team in ("Ants", "Bees"):
        organiser.enter(file, team, None, "planner", "")
    return file


def facts(file: Path) -> tuple[AnyFact, ...]:
    """Read all facts."""
    with FactStore(ContestFolder(file).facts) as store:
        return store.facts()


def test_withdraw_asks_first(file: Path, lacoc: Run, answer: Answer) -> None:
    """The command says what would change; only a yes, or --yes, takes the team out."""
    before = facts(file)
    words = ("contest", "withdraw", "Bees", "--contest", file, "--reason", "ill")
    answer("n\n")
    code, said, note = lacoc(*words)
    assert code == 0
    assert "Bees leaves the contest. Then 1 team is left." in said
    assert "Decide this?" in said
    assert "Nothing was decided" in note
    assert facts(file) == before
    answer("y\n")
    assert "Bees has left the contest" in lacoc(*words)[1]
    (fact,) = facts(file)[len(before) :]
    assert isinstance(fact, Withdrawn)
    assert (fact.team, fact.reason) == ("Bees", "ill")
    answer("")  # nothing to ask: the team has left already
    assert "Decide this?" not in lacoc(*words)[1]


def test_draw_shows_the_teams_and_asks(file: Path, lacoc: Run, answer: Answer) -> None:
    """Only a stage that waits for the organiser is drawn by the command, and only after a yes."""
    words = ("contest", "draw", "--contest", file)
    code, _, note = lacoc(*words)
    assert (code, "No stage waits" in note) == (2, True)
    file.write_text(file.read_text("utf-8").replace("rounds = 2", 'draw = "organiser"'), "utf-8")
    with FactStore(ContestFolder(file).facts) as store:
        note_plans(store, ContestFolder(file).plans)
        store.append(new(Closed))
    before = facts(file)
    answer("n\n")
    assert "These teams go into Swiss rounds, the best seed first: Ants, Bees." in lacoc(*words)[1]
    assert facts(file) == before
    answer("y\n")
    assert "Swiss rounds is drawn with 2 teams." in lacoc(*words)[1]
    (fact,) = facts(file)[len(before) :]
    assert isinstance(fact, Drawn)
    assert fact.entries == ("Ants", "Bees")


def test_withdraw_without_a_terminal_needs_yes(file: Path, lacoc: Run) -> None:
    """Where nobody can be asked, nothing changes without --yes."""
    before = facts(file)
    words = ("contest", "withdraw", "Bees", "--contest", file)
    code, _, note = lacoc(*words)
    assert (code, "--yes" in note) == (0, True)
    assert facts(file) == before
    assert lacoc(*words, "--yes")[0] == 0
    assert len(facts(file)) == len(before) + 1
