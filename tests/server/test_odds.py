"""Tests of odds: the chance from margins of forks, the choice of moments, and the kept file."""

from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

import pytest
from _pytest.monkeypatch import MonkeyPatch
from bot_matches import bot_match
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from stage import setup
from test_forks import MATCH, QUICK
from typer.testing import CliRunner

from lacoc_arenas import arena as arenas
from lacoc_client.film.moments import from_file
from lacoc_server.commands.replay.highlights import app as highlights_app
from lacoc_server.simulate import player, simulate, software
from lacoc_server.simulate.forks import chances, odds
from lacoc_server.simulate.forks.chances import ChanceJob, Odds, Wish, compute_odds, margin, margins
from lacoc_server.simulate.forks.kept import read_odds, write_odds
from lacoc_server.simulate.forks.odds import MomentOdds
from lacoc_server.simulate.forks.origin import read_source
from lacoc_shared.record.files import odds_path
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase

MARGINS = st.lists(st.integers(-36, 36), min_size=1, max_size=12)


@given(MARGINS)
def test_the_chances_of_both_seats_add_up(found: list[int]) -> None:
    """Each seat's chance to win is from 0 to 1, and the chances of both seats add up to 1."""
    one, other = odds.chance(found), odds.chance([-margin for margin in found])
    assert 0 <= one <= 1
    assert one + other == pytest.approx(1)
    assert (one > 0.5) == (sum(found) > 0) or sum(found) == 0


@given(MARGINS, st.integers(1, 20))
def test_more_points_are_a_better_chance(found: list[int], more: int) -> None:
    """If a seat gets more points in every fork, its chance to win does not become smaller."""
    assert odds.chance([margin + more for margin in found]) >= odds.chance(found)


@pytest.mark.parametrize(
    ("t", "freedom", "expected"),
    [(1.0, 1, 0.75), (2.92, 2, 0.95), (2.015, 5, 0.95), (1.812, 10, 0.95), (0.0, 7, 0.5)],
)
def test_student(t: float, freedom: int, expected: float) -> None:
    """`student` gives the values of printed tables of Student's distribution."""
    assert odds.student(t, freedom) == pytest.approx(expected, abs=5e-4)


def moment(beat: int, chance: float) -> MomentOdds:
    return MomentOdds(beat=beat, clock_s=beat / 50, margins=(), chance=chance)


def test_swings() -> None:
    """In a swing the odds only grow or only fall; its slow ends are left out."""
    chances = (0.5, 0.52, 0.7, 0.95, 0.93, 0.6, 0.6, 0.65)
    found = [moment(100 * number, chance) for number, chance in enumerate(chances)]
    first, second, third = odds.swings(found)
    assert [(one.before.beat, one.after.beat) for one in (first, second, third)] == [
        (100, 300),
        (400, 500),
        (600, 700),
    ]
    assert first.change == pytest.approx(0.43)
    assert [*odds.highlights(found, 2)] == [first, second]
    assert odds.highlights(found, least=0.4) == [first]
    assert odds.swings(found[:1]) == []


def test_five_seconds_are_near() -> None:
    """Moments five seconds apart share their forks, wherever they are in the match."""
    for beat in range(0, 4000, 7):
        pair = [
            MomentOdds(beat=at, clock_s=at * BEAT_S, margins=(margin,), chance=0.0, key="k")
            for at, margin in ((beat, 1.0), (beat + round(odds.NEAR_S / BEAT_S), -1.0))
        ]
        assert [one.chance for one in odds.pooled(pair)] == [0.5, 0.5]


def test_neighbours_share_their_forks() -> None:
    """Forks of the moments before and after count, but not far ones, and not at the end."""
    margins = {0: (3.0, 1.0), 50: (-2.0, -4.0), 100: (1.0, 1.0), 400: (7.0, 7.0)}
    found = [
        MomentOdds(beat=beat, clock_s=beat / 50, margins=some, chance=0.0, key="k")
        for beat, some in margins.items()
    ]
    end = MomentOdds(beat=410, clock_s=8.2, margins=(9.0,), chance=0.5)
    pooled = odds.pooled([end, *found])
    assert [one.beat for one in pooled] == [0, 50, 100, 400, 410]
    assert [one.chance for one in pooled] == [
        odds.chance([3.0, 1.0, -2.0, -4.0]),
        odds.chance([3.0, 1.0, -2.0, -4.0, 1.0, 1.0]),
        odds.chance([-2.0, -4.0, 1.0, 1.0]),
        odds.chance([7.0, 7.0]),
        0.5,
    ]
    assert [one.margins for one in pooled[:-1]] == [*margins.values()]
    near = [[-2.0, -4.0], [3.0, 1.0, 1.0, 1.0], [-2.0, -4.0], [], []]
    assert odds.near_margins(pooled) == near


class Counting:
    """Plays forks here, and counts them."""

    def __init__(self) -> None:
        self.forks = 0

    def submit(
        self, function: Callable[[ChanceJob], tuple[float, ...] | Phrase], job: ChanceJob, /
    ) -> "Future[tuple[float, ...] | Phrase]":
        self.forks += len(job.variants)
        done: Future[tuple[float, ...] | Phrase] = Future()
        done.set_result(function(job))
        return done


@pytest.mark.slow
@pytest.mark.long
def test_the_odds_of_a_record(tmp_path: Path) -> None:
    """The last odds come from the result, and kept forks are not played again."""
    arena = arenas.load("othello", QUICK)
    players = [player(arena, 0, "planner"), player(arena, 1, "straight")]
    result = simulate(replace(setup("othello", QUICK), match_id=MATCH), players, tmp_path)
    file = tmp_path / f"{MATCH}.mcap"
    wish = Wish(file=str(file), bots=("planner", "nearest"), forks=2, step_s=2.0)
    engine, told = Counting(), []
    *_, found = compute_odds(wish, engine, None, lambda done, of: told.append((done, of)))
    assert engine.forks == 2 * (len(found.moments) - 1)
    assert told[-1][0] == told[-1][1] == len(found.moments) == 3
    assert found.moments[-1].margins == (margin(result, ("left", "right")),)
    assert found.moments[-1].chance in (0.0, 0.5, 1.0)
    assert found.record_hash == read_source(file).hash
    assert [one.beat for one in found.moments] == sorted(one.beat for one in found.moments)

    path = odds_path(file, MATCH)
    write_odds(path, found)
    assert read_odds(path) == found
    more = Counting()
    *_, again = compute_odds(replace(wish, forks=3), more, read_odds(path), lambda done, of: None)
    assert more.forks <= engine.forks  # of each moment that stays, one more fork
    for one in again.moments[:-1]:
        known = next((old for old in found.moments if old.beat == one.beat), None)
        assert known is None or one.margins[:2] == known.margins
    other = Counting()
    wished = replace(wish, bots=("straight", "nearest"))
    assert [*compute_odds(wished, other, read_odds(path), lambda done, of: None)]
    assert other.forks == 4

    job = ChanceJob(file=str(file), beat=found.moments[0].beat, bots=wish.bots, variants=(1, 2))
    assert margins(job) == margins(job) == found.moments[0].margins, "also twice in one process"

    path.write_text("{}")
    assert read_odds(path) is None


@pytest.mark.long
def test_the_command_lists_highlights(tmp_path: Path) -> None:
    """`highlights` computes the odds in processes, keeps them, and prints moments for a film."""
    bot_match(tmp_path, "othello", ("planner", "straight"), QUICK, match_id=MATCH)
    file = tmp_path / f"{MATCH}.mcap"
    said = CliRunner().invoke(
        highlights_app,
        [str(file), "--every", "2", "--times", "2", "--players", "planner,straight", "--json"],
    )
    assert said.exit_code == 0
    told = tmp_path / "moments.json"
    told.write_text(said.stdout)
    moments = from_file(told)
    swings = [moment.swing for moment in moments]
    assert swings == sorted(swings, reverse=True)
    assert all(0 < swing <= 1 for swing in swings)
    assert read_odds(odds_path(file, MATCH)) is not None


def test_an_error_comes_back_as_words(tmp_path: Path) -> None:
    """An error that a user can correct, such as a missing record, is returned and not raised."""
    job = ChanceJob(file=str(tmp_path / "none.mcap"), beat=1, bots=("a", "b"), variants=(1,))
    assert isinstance(margins(job), Phrase)


def test_the_key_has_what_decides_the_forks(tmp_path: Path, monkeypatch: MonkeyPatch) -> None:
    """The hash of kept forks changes when anything changes that decides how forks end.

    This can be a bot's file, a ghost's record, the folder of the game, or the software.
    """
    bot_match(tmp_path, "othello", ("straight", "straight"), QUICK, match_id=MATCH)
    source = read_source(tmp_path / f"{MATCH}.mcap")
    bot, ghost, folder = (tmp_path / name for name in ("my_bot.py", "ghost.mcap", "game"))
    folder.mkdir()

    def now() -> str:
        return chances.key(source, 50, (str(bot), f"ghost:{ghost}"), str(folder))

    keys = {now()}
    for change in (
        lambda: bot.write_text("one = 1"),
        lambda: ghost.write_bytes(b"other"),
        lambda: (folder / "game.py").write_text("two = 2"),
        lambda: monkeypatch.setattr(chances, "software", lambda: "other"),
    ):
        change()
        keys.add(now())
    assert len(keys) == 5
    monkeypatch.setattr(software, "_others", lambda: ["handed_in"])
    assert software.software.__wrapped__() != software.software()


def test_odds_of_another_version_are_not_used(tmp_path: Path) -> None:
    """A file of odds that has another format is not read."""
    path = tmp_path / "m.odds.json"
    odds_ = Odds(
        format=0, match_id="m", record_hash="", seats=("l", "r"), bots=("a", "b"), moments=()
    )
    write_odds(path, odds_)
    assert read_odds(path) is None
