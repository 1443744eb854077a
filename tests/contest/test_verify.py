"""Tests of the check of a published contest: an honest one passes, a forged one does not."""

import shutil
from itertools import combinations
from math import comb
from pathlib import Path

import pytest
from benchmarks import contest_forging, contest_played, game_forger
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from lacoc_server.contest import organiser
from lacoc_server.contest import sheet as sheets
from lacoc_server.contest.kept.folder import ContestFolder, file_hash
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Closed,
    Drawn,
    Entered,
    FilesChanged,
    Planned,
    Played,
    Recalled,
    Replaced,
    Replay,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.publish import SHEET, tables
from lacoc_server.contest.verify.check import check
from lacoc_server.contest.verify.games import check_game, games_of
from lacoc_server.contest.verify.history import (
    call_of,
    check_earlier,
    check_history,
    decisions,
    files_of,
)
from lacoc_server.contest.verify.published import check_published, read
from lacoc_server.contest.verify.sampling import CONFIDENCE, least_forged, missed, sample
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.replay import resume
from lacoc_shared.codec import decode
from lacoc_shared.decisions import Abort
from lacoc_shared.inputs import Decide
from lacoc_shared.messages import Frame
from lacoc_shared.record.pack import Message, write
from lacoc_shared.record.pack import read as packed
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase


def findings(folder: Path, proven: bool = False) -> list[str]:
    """Check a published folder and its games; return the codes of all findings."""
    facts = read(folder)
    found = [*check_published(folder, facts)]
    for game in games_of(facts):
        found += check_game(folder, game, proven).wrong
    return [one.code for one in found]


def numbered(*facts: AnyFact) -> tuple[AnyFact, ...]:
    """Return the facts with numbers and ids; all get the same time."""
    return tuple(replace(one, id=f"f{n}", number=n, at_ms=9) for n, one in enumerate(facts, 1))


@pytest.mark.slow
@pytest.mark.parametrize("forgeries", [15, pytest.param(60, marks=pytest.mark.long)])
def test_no_forgery_is_missed(played: Path, tmp_path: Path, forgeries: int) -> None:
    """All forgeries of facts, entries, records and tables are found."""
    bots = dict(zip(contest_played.BOTS, [*contest_played.BOTS.values()][::-1], strict=True))
    other = contest_played.enter(tmp_path / "other", bots=bots)
    contest_played.play(other)
    honest, there = played / "published", contest_played.publish(other)
    found = contest_forging.forge(honest, there, forgeries, seed=7)
    assert (found.missed, found.fitting_missed) == ([], [])
    assert len(found.kinds) > forgeries // 5


@pytest.mark.slow
def test_a_record_that_was_written_again_is_no_forgery(copied: Path) -> None:
    """A record that the forger reads and writes again without a change passes the check."""
    folder = copied.parent / "published"
    facts = [*read(folder)]
    at = next(at for at, fact in enumerate(facts) if isinstance(fact, Played))
    played = facts[at]
    assert isinstance(played, Played)
    path = folder / "records" / played.record
    record = Record.read(path)
    path.unlink()
    game_forger.written(record, path)
    facts[at] = replace(played, record_hash=file_hash(path))
    (folder / "facts.json").write_bytes(league_facts.encode(facts))
    assert findings(folder, proven=True) == []


@pytest.mark.slow
def test_an_honest_contest_with_decisions_passes(copied: Path) -> None:
    """A contest with a replay, new files, a corrected result and a withdrawal passes the check.

    The check lists these decisions.
    """
    where = ContestFolder(copied)
    with FactStore(where.facts) as store:
        last = next(fact for fact in reversed(store.facts()) if isinstance(fact, Played))
        what = {name: getattr(last, name) for name in ("pairing", "game", "teams")}
        store.append(new(Replay, reason="net down", **what))
        bot = "nearest" if contest_played.BOTS[last.teams[0]] == "straight" else "straight"
        organiser.enter(copied, last.teams[0], None, bot, "broken robot")
    contest_played.play(copied)
    with FactStore(where.facts) as store:
        score = {"scores": (1, 0), "outcome": "left"}
        store.append(new(Replaced, reason="foul", **what, **score))
    organiser.take_out(copied, "Ann", "ill", disqualified=False)
    contest_played.play(copied)
    folder = contest_played.publish(copied)
    assert findings(folder) == []
    found = check(folder, lambda done, there: None, sampled=1, seed=3, jobs=1)
    assert found.findings == ()
    what = [one.values["what"] for one in found.decisions]
    assert [one.code for one in what if isinstance(one, Phrase)] == [
        "decided.replay",
        "decided.files-changed",
        "decided.replaced",
        "decided.withdrawn",
    ]


@pytest.mark.slow
def test_a_game_that_was_voided_in_play_passes(copied: Path) -> None:
    """A game that a referee aborted is void for the office; its record has the score until then."""
    folder = copied.parent / "published"
    facts = [*read(folder)]
    at = next(n for n, fact in enumerate(facts) if isinstance(fact, Played) and any(fact.scores))
    played = facts[at]
    assert isinstance(played, Played)
    path = folder / "records" / played.record
    messages: list[Message] = []
    record = Record.read(path, lambda *message: messages.append(message))
    frames = {beat: decode(data, Frame) for beat, data in record.frames}
    playing = [beat for beat, frame in frames.items() if frame.phase == Phase.PLAYING]
    match = resume(record.until(playing[-1])).match
    journal = Journal(match, copied.parent / "scratch", segment=1)
    journal.beat([Decide("Kim", "the net fell", Abort())])
    journal.close()
    assert journal.writer is not None
    before = [one for one in messages if one[1] <= playing[-1] and one[0] != "/lacoc/result"]
    path.unlink()
    write([*before, *packed([journal.writer.path])], path)
    shown = Record.read(path).result
    assert shown is not None
    assert (shown.official, any(shown.scores)) == ("void", True)
    facts[at] = replace(played, outcome="void", scores=(0, 0), record_hash=file_hash(path))
    game = next(game for game in games_of(facts) if game.played is facts[at])
    assert [one.code for one in check_game(folder, game, proven=True).wrong] == []
    facts[at] = replace(facts[at], scores=(1, 0))
    game = next(game for game in games_of(facts) if game.played is facts[at])
    assert [one.code for one in check_game(folder, game, proven=False).wrong] == [
        "verify.other-game"
    ]


@pytest.mark.slow
def test_a_clock_that_was_corrected_changes_nothing(copied: Path) -> None:
    """Facts are ordered by their numbers, so a contest passes even if their times go back."""
    folder = copied.parent / "published"
    facts = read(folder)
    back = [replace(fact, at_ms=10**12 - 1000 * fact.number) for fact in facts]
    (folder / "facts.json").write_bytes(league_facts.encode(back))
    sheet = sheets.sheet_of("Cup", back, FORMATS)
    for name, content in {SHEET: sheets.encode(sheet), **tables(sheet)}.items():
        (folder / name).write_bytes(content)
    assert findings(folder) == []


@pytest.mark.slow
def test_no_code_of_a_stranger_runs(copied: Path, tmp_path: Path) -> None:
    """The check runs no arena that is a folder, and no program of a bot."""
    folder = copied.parent / "published"
    evil = tmp_path / "evil"
    shutil.copytree(Path(contest_forging.__file__).parents[1] / "arenas/lacoc_arenas/othello", evil)
    (evil / "__init__.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\n")
    facts = [
        replace(fact, arena=str(evil)) if isinstance(fact, Planned) else fact
        for fact in read(folder)
    ]
    (folder / "facts.json").write_bytes(league_facts.encode(facts))
    assert "verify.bad-record" in findings(folder, proven=True)
    for path in (folder / "entries").glob("*/bot.py"):
        path.write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\n")
    assert "contest.entry-changed" in findings(folder, proven=True)
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize("name", ["", "..", "a/b.mcap", "x.mcap", "\0", "x" * 5000, "."])
def test_any_name_of_a_record_can_be_checked(tmp_path: Path, name: str) -> None:
    """A missing record, or a name that can't be a record's, is a finding and raises no error."""
    plan = new(Planned, stage="a", format="round-robin", arena="othello")
    facts = numbered(
        new(Entered, team="A", files="f" * 32),
        new(Entered, team="B", files="../.."),
        plan,
        new(Closed),
        new(Drawn, stage="a", entries=("A", "B")),
        new(
            Played,
            pairing="a:a1.1",
            game=1,
            teams=("A", "B"),
            scores=(0, 0),
            outcome="draw",
            record=name,
        ),
    )
    (game,) = games_of(facts)
    assert game.plan is not None
    assert check_game(tmp_path, game, proven=True).wrong


def test_earlier_facts_must_still_be_there() -> None:
    """A later publication must begin with all facts of an earlier one, unchanged."""
    facts = numbered(new(Entered, team="A"), new(Entered, team="B"), new(Closed))
    assert [*check_earlier(facts[:2], facts)] == [*check_earlier(facts, facts)] == []
    for now in (facts[:1], numbered(facts[1], facts[0]), (facts[0], replace(facts[1], team="C"))):
        (found,) = check_earlier(facts[:2], now)
        assert found.code == "verify.rewritten"


def test_files_count_from_when_they_were_entered() -> None:
    """A team played a game with its newest files before the game began.

    At a court it may also have played with files that came after the call, before the result.
    """
    what = {"pairing": "a", "game": 1, "teams": ("A", "B")}
    game = new(Played, pairing="a", game=1, teams=("A", "B"), scores=(0, 0), outcome="draw")
    facts = numbered(
        new(Entered, team="A", files="1"),
        new(FilesChanged, team="A", files="2"),
        new(Closed),
        game,
        new(FilesChanged, team="A", files="3", reason="x"),
        game,
        new(Called, court="main", **what),
        new(FilesChanged, team="A", files="4", reason="x"),
        game,
    )
    games = [fact for fact in facts if isinstance(fact, Played)]
    files = [files_of(facts, call_of(facts, game), game, "A") for game in games]
    assert files == [("2",), ("3",), ("3", "4")]
    assert [dict(one.values)["fact"] for one in decisions(facts)] == ["f5", "f8"]


def test_a_call_ends_with_its_result_or_when_it_is_taken_back() -> None:
    """A game belongs to the newest call before it, unless that was taken back or has a result."""
    what = {"pairing": "a", "game": 1}
    of_teams = {**what, "teams": ("A", "B")}
    call = new(Called, court="main", **of_teams)
    game = new(Played, scores=(0, 0), outcome="void", **of_teams)
    facts = numbered(game, call, game, game, call, new(Recalled, **what), game, call, call, game)
    games = [fact for fact in facts if isinstance(fact, Played)]
    calls = [call_of(facts, one) for one in games]
    assert [one and one.id for one in calls] == [None, "f2", None, None, "f9"]


@pytest.mark.parametrize(
    ("facts", "code"),
    [
        ([new(Closed), new(Entered, team="A")], "verify.entered-late"),
        (
            [new(Entered, team="A"), new(Closed), new(FilesChanged, team="A", files="")],
            "verify.no-reason",
        ),
        ([new(Drawn, stage="a", entries=())], "verify.never-closed"),
        ([new(Drawn, stage="a", entries=())], "verify.other-draw"),
        ([new(Entered, team="A"), new(Entered, team="A")], "verify.unused"),
    ],
)
def test_the_order_of_facts_is_checked(facts: list[AnyFact], code: str) -> None:
    """Facts in an order that an honest contest can't have are found."""
    history = numbered(*facts)
    assert code in {one.code for one in check_history(history, compute(history, FORMATS))}


def test_a_gap_in_the_numbers_is_found() -> None:
    """A fact that was taken out leaves a gap in the numbers."""
    facts = numbered(*(new(Entered, team=team) for team in "ABC"))
    for at in range(2):
        left = (*facts[:at], *facts[at + 1 :])
        assert [one.code for one in check_history(left, compute(left, FORMATS))] == ["verify.gap"]


# A check of some games.


@given(st.integers(1, 10), st.data())
def test_the_promised_number_of_forgeries_is_found_as_often_as_promised(
    games: int, data: st.DataObject
) -> None:
    """If `least_forged` games are forged, at least 95 % of all samples have one of them.

    If one game less is forged, fewer than 95 % have one.
    """
    checked = data.draw(st.integers(1, games))
    least = least_forged(games, checked)
    samples = [*combinations(range(games), checked)]
    for forged in {least, least - 1} & {*range(1, games + 1)}:
        found = sum(any(game < forged for game in one) for one in samples)
        assert missed(games, forged, checked) == pytest.approx(1 - found / len(samples))
        assert (found / len(samples) >= CONFIDENCE - 1e-12) == (forged >= least)
    assert least <= games - checked + 1


def test_a_sample_takes_each_pair_equally_often() -> None:
    """All pairs of 5 games are drawn about equally often; one seed always draws the same pair."""
    counts = dict.fromkeys(combinations(range(5), 2), 0)
    for seed in range(5000):
        one, two = sorted(sample(range(5), 2, seed))
        counts[one, two] += 1
    expected = 5000 / comb(5, 2)
    assert all(abs(count - expected) < 0.2 * expected for count in counts.values())
    assert sample(range(5), 2, 1) == sample(range(5), 2, 1)
    assert sorted(sample(range(5), 9, 1)) == [*range(5)]
    assert least_forged(0, 0) == 1
    assert least_forged(7, 0) == 8
