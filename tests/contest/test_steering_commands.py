"""Commands that steer a day do what the office's page does, by the same code."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lacoc_server.commands.contest import deciding
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import (
    Announced,
    Drawn,
    Moved,
    Replaced,
    Unshifted,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.schedule import due
from lacoc_shared.mistakes import UserError

pytestmark = pytest.mark.slow

Run = Callable[..., tuple[int, str, str]]
_CONTEST = """
[contest]
name = "Cup"
[court.north]
arena = "othello"
listen = ["127.0.0.1:7447"]
[stage.finals]
format = "single-knockout"
draw = "organiser"
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Give a contest of four teams whose entries are closed, and whose draw waits."""
    file = tmp_path / "contest.toml"
    file.write_text(_CONTEST)
    for team in ("Ants", "Bees", "Crabs", "Dogs, Inc."):
        organiser.enter(file, team, None, "", "")
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        organiser.prepare(where, store)
        draw = due(compute(store.facts(), FORMATS), FORMATS)
        assert draw is not None
        store.append(draw)
    return file


def contest(file: Path) -> Contest:
    with FactStore(ContestFolder(file).facts) as store:
        return compute(store.facts(), FORMATS)


def test_a_day_by_commands(file: Path, lacoc: Run) -> None:
    """Draw by lot, take it back, draw by hand, move, pause, go on, shift, tell, substitute."""

    def does(*words: str, says: str) -> None:
        code, out, told = lacoc("contest", *words, "--contest", file)
        assert (code, told) == (0, "")
        assert says in out

    def refuses(*words: str, says: str) -> None:
        code, _, told = lacoc("contest", *words, "--contest", file)
        assert code == 2
        assert says in told

    does("draw", "--lot", "4 2 6", "--yes", says="is drawn")
    refuses("undraw", says="This one can be taken back now: finals")
    does("undraw", "finals", "--reason", "a mistake", "--yes", says="stays undrawn until")
    refuses("undraw", "finals", "--reason", "again", "--yes", says="has not been drawn")
    hand = ("--order", "Dogs, Inc.", "--order", "Crabs,Bees, Ants")
    refuses("draw", "--order", "Ants,Bees", "--yes", says="exactly these teams")
    refuses("draw", *hand, "--yes", says="reason")
    does("draw", *hand, "--reason", "last year", "--by", "Aiko", "--yes", says="is drawn")
    now = contest(file)
    assert now.stages[0].stage.entries == ("Dogs, Inc.", "Crabs", "Bees", "Ants")
    assert [fact.by for fact in now.decisions if isinstance(fact, Drawn)] == ["", "Aiko"]

    does("move", "finals:w2.1", "--court", "north", says="Final is moved to court")
    refuses("move", "finals:w2.1", "--at", "noon", says="14:05")
    refuses("move", "finals:w2.1", "--at", "00:00", says="That time has passed")
    refuses("move", "finals:w7.1", says="w7.1")
    does("pause", "--reason", "a cable", says="Paused")
    refuses("pause", says="paused already")
    does("resume", says="goes on")
    refuses("resume", says="not paused")
    does("shift", "15", "--reason", "a speech", says="later by 15 minutes")
    does("shift", "1", says="later by 1 minute.")
    does("unshift", says="The 1 minute")
    does("announce", "Lunch until one", says="stands on all pages")
    entering = ("enter", "Eels", "--reason", "a reserve", "--club", "North", "--by", "Aiko")
    does(*entering, says="Eels")
    does("substitute", "Ants", "Eels", "--reason", "ill", "--yes", says="Eels takes the place")
    now = contest(file)
    assert "Eels" in now.stages[0].stage.entries
    assert now.announced is not None
    assert now.announced.text == "Lunch until one"
    assert {team.name: team.club for team in now.teams}["Eels"] == "North"
    with FactStore(ContestFolder(file).facts) as store:
        kinds = [type(fact) for fact in store.facts()]
    assert kinds.count(Moved) == kinds.count(Unshifted) == kinds.count(Announced) == 1
    assert now.shifted is not None
    assert now.shifted.by_ms == 15 * 60_000
    does("unshift", says="The 15 minutes are taken back")
    refuses("unshift", says="nothing to take back")

    does("staff", "Ben", says="/office#token=")
    does("staff", "Ben", "--remove", says="opens nothing")
    assert ContestFolder(file).contest.secrets.staff_names == ()


def test_a_decision_does_what_was_shown_or_nothing(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another decision that comes before the answer stops one that would now do something else."""
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        organiser.draw(store, organiser.drawing(compute(store.facts(), FORMATS)))
    match = contest(file).stages[0].matches[0]
    assert match.next_seats is not None
    about = {"pairing": match.pairing.id, "game": 1, "teams": match.next_seats, "reason": "why"}
    won = new(Replaced, scores=(9, 1), outcome="left", **about)

    def answered(*_: object) -> bool:
        with FactStore(where.facts) as store:
            store.append(new(Replaced, scores=(0, 5), outcome="right", **about))
        return True

    monkeypatch.setattr(deciding, "wanted_so", answered)
    with pytest.raises(UserError, match="Meanwhile"):
        deciding.carry_out(file, "", lambda _: [won], asks=True)
    assert contest(file).matches[match.pairing.id].games[0].scores == (0, 5)
