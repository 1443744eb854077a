"""Tests of the check of a published contest: an honest one passes, a forged one does not."""

import dataclasses
import os
import shutil
import sys
from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from math import comb
from pathlib import Path
from random import Random
from types import SimpleNamespace
from typing import Any, cast

import pytest
import small_contest
from every_third import every_third
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from tests.campaigns.forge import contest as contest_forging
from tests.campaigns.forge import game as game_forger

from lacoc_arenas.arena import load
from lacoc_server.commands.contest import checking
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless.play import outcome
from lacoc_server.contest.headless.pool import setup_of
from lacoc_server.contest.kept.entries import EntryFolder
from lacoc_server.contest.kept.folder import ContestFolder, file_hash
from lacoc_server.contest.kept.publish import SHEET, tables
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league import sheet as sheets
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Closed,
    Drawn,
    Entered,
    FilesChanged,
    Outcome,
    Planned,
    Played,
    Recalled,
    Replaced,
    Replay,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.live.court_link import result_of
from lacoc_server.contest.verify.alone import InputCheck, Side, check_inputs, ends_alike
from lacoc_server.contest.verify.check import ContestCheck, check
from lacoc_server.contest.verify.games import (
    GameCheck,
    GameToCheck,
    _sides,
    check_game,
    games_of,
)
from lacoc_server.contest.verify.history import (
    call_of,
    check_earlier,
    check_history,
    decisions,
    files_of,
)
from lacoc_server.contest.verify.published import check_published, read
from lacoc_server.contest.verify.sampling import CONFIDENCE, least_forged, missed, sample
from lacoc_shared import decisions as decisions_of
from lacoc_shared.codec import decode
from lacoc_shared.decisions import Abort, Adjust
from lacoc_shared.inputs import (
    Advice,
    Decide,
    HeardSeat,
    Input,
    KeySeat,
    LeaveSeat,
    ReadySeat,
    SilentSeat,
)
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, render, say

IDLE = small_contest.IDLE.encode()


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


@pytest.fixture(scope="module")
def other_bots(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the published folder of a contest of the same teams, with other bots."""
    bots = dict(zip(small_contest.BOTS, [*small_contest.BOTS.values()][::-1], strict=True))
    file = small_contest.enter(tmp_path_factory.mktemp("other"), bots=bots)
    small_contest.play(file)
    return small_contest.publish(file)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("forgeries", "only", "seed"),
    [
        (8, (), 7),
        pytest.param(2, [contest_forging.AGAIN], 7, marks=pytest.mark.long),
        pytest.param(15, (), 7, marks=pytest.mark.long(minutes=1)),
        pytest.param(15, (), 8, marks=pytest.mark.long(minutes=1)),
        pytest.param(4, [contest_forging.AGAIN], 8, marks=pytest.mark.long(minutes=1)),
    ],
)
def test_no_forgery_is_missed(
    played: Path, other_bots: Path, forgeries: int, only: list[str], seed: int
) -> None:
    """All forgeries of facts, entries, records and tables are found.

    A game that is played again, with all that follows from it, passes only if it claims the honest
    result.
    """
    found = contest_forging.forge(played / "published", other_bots, forgeries, seed, only)
    assert (found.missed, found.fitting_missed) == ([], [])
    if only:
        assert found.other_results >= forgeries // 4
    else:
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
        bot = "nearest" if small_contest.BOTS[last.teams[0]] == "straight" else "straight"
        organiser.enter(copied, last.teams[0], None, bot, "broken robot")
    small_contest.play(copied)
    with FactStore(where.facts) as store:
        score = {"scores": (1, 0), "outcome": "left"}
        store.append(new(Replaced, reason="foul", **what, **score))
    organiser.take_out(copied, "Ann", "ill", disqualified=False)
    small_contest.play(copied)
    folder = small_contest.publish(copied)
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


def at_a_court(folder: Path, at: int, *, items: Mapping[int, Input]) -> list[AnyFact]:
    """Play a game again as a court's, with further inputs by beat of play; return all facts.

    Args:
        folder: the published folder; only its record is changed.
        at: index of the game's fact.
        items: the inputs.
    """
    facts = [*read(folder)]
    played = facts[at]
    assert isinstance(played, Played)
    game = next(game for game in games_of(facts) if game.played is played)
    assert game.plan is not None
    arena = load(game.plan.arena, game.plan.arena_settings)
    kept = EntryFolder(folder / "entries")
    change = game_forger.Change(
        chance=Random(1),
        arena=arena,
        entries=[kept.load(one[-1]) for one in game.files],
        teams=[*played.teams],
        setup=setup_of(Path(played.record).stem, arena, {}),
        late_ticks=[game.late_ticks] * 2,
        extra={(Phase.PLAYING, beat): [item] for beat, item in items.items()},
    )
    assigned = replace(game_forger.assigned_of(change), call="x")
    change.setup = replace(change.setup, court="main", assigned=assigned)
    path = folder / "records" / played.record
    path.unlink()
    game_forger.play(change, path)
    result = Record.read([path]).result
    assert result is not None
    void = {"outcome": "void", "scores": (0, 0)}
    told = {"outcome": result.official, "scores": result.scores}
    changes = {"record_hash": "", **(void if result.official == "void" else told)}
    call = new(Called, pairing=played.pairing, game=played.game, teams=played.teams, court="main")
    return [*facts[:at], replace(call, id="x", number=played.number), replace(played, **changes)]


def checked(folder: Path, facts: list[AnyFact], proven: bool = True) -> GameCheck:
    """Check the last game of the facts."""
    return check_game(folder, games_of(facts)[-1], proven)


def with_score(folder: Path) -> int:
    """Return the index of the fact of a game with points."""
    facts = read(folder)
    return next(n for n, fact in enumerate(facts) if isinstance(fact, Played) and any(fact.scores))


@pytest.mark.slow
def test_a_game_that_was_voided_in_play_passes(copied: Path) -> None:
    """A game that a referee aborted is void for the office; its record has the score until then."""
    folder = copied.parent / "published"
    abort = Decide("Kim", "the net fell", Abort())
    facts = at_a_court(folder, with_score(folder), items={120: abort})
    result = Record.read(folder / "records" / facts[-1].record).result  # type: ignore[union-attr]
    assert result is not None
    assert (result.official, any(result.scores)) == ("void", True)
    assert checked(folder, facts).wrong == ()
    facts[-1] = replace(facts[-1], scores=(1, 0))
    assert [one.code for one in checked(folder, facts).wrong] == ["verify.other-game"]


def test_a_void_game_has_no_score_for_the_office() -> None:
    """Also if the game had ended, and went on because the referee gave time back."""
    told = [
        ("phase", {"after": "FINISHED"}),
        ("result", {"winner": "left", "scores": [20, 16]}),
        ("phase", {"after": "PLAYING"}),
        ("phase", {"after": "VOID"}),
    ]
    events = [SimpleNamespace(kind=kind, data=data) for kind, data in told]
    sheet = SimpleNamespace(call="f1", match_id="m", seats=[SimpleNamespace(team="Ann")] * 2)
    void = result_of(cast(Any, sheet), cast(Any, events))
    assert void is not None
    assert (void.outcome, void.scores) == ("void", (0, 0))
    ended = result_of(cast(Any, sheet), cast(Any, [*events[:2], *events[3:]]))
    assert ended == void
    events[3].data["after"] = "OFFICIAL"
    official = result_of(cast(Any, sheet), cast(Any, events))
    assert official is not None
    assert (official.outcome, official.scores) == ("left", (20, 16))


@pytest.mark.parametrize(
    ("joined", "outcome", "found"),
    [
        ((0, 1), "left", ["Ann", "Bob"]),
        ((0,), "left", ["Ann"]),
        ((0,), "void", ["Ann", "Bob"]),
        ((), "void", ["Ann", "Bob"]),
    ],
)
def test_who_joined_with_the_files_of_an_entry(
    tmp_path: Path, joined: tuple[int, ...], outcome: Outcome, found: list[str]
) -> None:
    """A void game may lack a team; another team that a match refused is in nobody's way."""
    file = tmp_path / "contest.toml"
    file.write_text(small_contest.CONTEST)
    for team in ("Ann", "Bob"):
        organiser.enter(file, team, None, "", "")
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        files = tuple((one.files,) for one in store.facts() if isinstance(one, Entered))
    kept = where.entries.load(files[0][0])
    inputs = [kept.join(seat, ("Ann", "Bob")[seat]) for seat in joined]
    other = replace(kept.join(1, "Visitors"), robot=None)
    record = SimpleNamespace(inputs={1: inputs, 2: [other]})
    teams = ("Ann", "Bob")
    played = new(Played, pairing="p", game=1, teams=teams, scores=(0, 0), outcome=outcome)
    game = GameToCheck(played=played, about=say("plain.text", text=""), plan=None, files=files)
    assert [one.team for one in _sides(tmp_path, game, cast(Any, record))] == found


@pytest.mark.slow
def test_what_a_referee_decided_in_a_game_is_listed(copied: Path) -> None:
    """The record of a court may hold decisions: they are listed with time, referee and reason.

    The keys of bots that played there can't be checked, and this is told for each.
    """
    folder = copied.parent / "published"
    points = Decide("Kim", "pushed", Adjust("right", 3))
    facts = at_a_court(folder, with_score(folder), items={50: points})
    found = checked(folder, facts)
    (told,) = found.decided
    assert found.wrong == ()
    assert "at 0:01" in render(told)
    assert "Kim" in render(told)
    assert "pushed" in render(told)
    assert {one.values["why"].code for one in found.unchecked} == {"unchecked.court"}  # type: ignore[union-attr]
    facts[-2] = replace(facts[-2], court="other")
    assert [one.code for one in checked(folder, facts).wrong] == ["verify.other-game"]


def forged(folder: Path, place: Path, names: Sequence[str]) -> tuple[bool, GameCheck]:
    """Play the last game of a published contest again with these changes, and check it.

    Details of the changes are drawn until the record claims another result.

    Returns:
        Whether it does, and what the check of the game finds.
    """
    facts = [*read(folder)]
    game = games_of(facts)[-1]
    kept = EntryFolder(folder / "entries")
    entries = [kept.load(one[-1]) for one in game.files]
    (place / "records").mkdir(parents=True)
    shutil.copytree(folder / "entries", place / "entries")
    other, found = False, GameCheck()
    for seed in range(5):
        shutil.rmtree(place / "records")
        (place / "records").mkdir()
        change = game_forger.forge(game, entries, place / "records", Random(seed), names)
        (path,) = (place / "records").iterdir()
        result = Record.read([path]).results[-1]  # also one that a cut record claims
        told = {
            "scores": result.scores,
            "outcome": outcome(("left", "right"), result.official),
            "record_hash": file_hash(path),
            **change.fact,
        }
        played = replace(game.played, **told)
        again = games_of([played if one is game.played else one for one in facts])[-1]
        found = check_game(place, again, proven=True, programs=True)
        other = (played.scores, played.outcome) != (game.played.scores, game.played.outcome)
        if other:
            break
    return other, found


@pytest.mark.slow
@pytest.mark.parametrize(
    "names",
    [
        *every_third(
            [
                ["silent"],
                ["leave"],
                ["points"],
                ["a marker"],
                ["put back"],
                ["a winner"],
                ["frozen"],
                ["time"],
                ["the start"],
                ["a halt"],
                ["physics stops"],
                ["keys left out", "arithmetic"],
                ["another bot", "called"],
                ["no end"],
            ]
        ),
        *(
            pytest.param([change, known], marks=pytest.mark.long)
            for change in ("points", "another bot")
            for known in ("court", "versions")
        ),
    ],
    ids=" and ".join,
)
def test_no_game_claims_another_result(played: Path, tmp_path: Path, names: list[str]) -> None:
    """A game of bots that was played again in another way does not pass with another result.

    What is changed is an input, the start, physics, who steers, or the record's header.
    """
    other, found = forged(played / "published", tmp_path / "forged", names)
    assert found.wrong or found.unchecked or not other


@pytest.mark.slow
@pytest.mark.parametrize("place", ["READY", "PLAYING", "FINISHED"])
def test_each_further_input_is_found(played: Path, tmp_path: Path, place: str) -> None:
    """No kind of input can be added to a game without a network, in any phase."""
    folder = played / "published"
    game = games_of(read(folder))[-1]
    assert game.plan is not None
    arena = load(game.plan.arena, game.plan.arena_settings)
    kept = EntryFolder(folder / "entries")
    entries = [kept.load(one[-1]) for one in game.files]
    sides = [Side(team, entry, "") for team, entry in zip(game.played.teams, entries, strict=True)]
    path = folder / "records" / game.played.record
    honest = Record.read([path])
    late = game.late_ticks
    assert check_inputs(honest, arena, sides, late, programs=True) == ((), ())
    frames = [(beat, decode(data, Frame)) for beat, data in honest.frames]
    beats = [beat for beat, frame in frames if frame.phase == Phase[place]]
    more: list[Input] = [
        SilentSeat(0),
        HeardSeat(1),
        LeaveSeat(0),
        ReadySeat(1, True),
        entries[0].join(0, game.played.teams[0]),
        KeySeat(0, 9, 1, 2),
        Advice(()),
        *(Decide("simulate", "x", one) for one in EVERY_DECISION),
    ]
    for item in more:
        for beat in {beats[0], beats[len(beats) // 2]}:
            inputs = {**honest.inputs, beat: [*honest.inputs.get(beat, ()), item]}
            record = dataclasses.replace(honest, inputs=inputs)
            found = check_inputs(record, arena, sides, late, programs=True)
            assert [one.code for one in found.wrong] == ["verify.of-inputs"], item
    for beat, items in honest.inputs.items():
        inputs = {**honest.inputs, beat: items[1:]}
        found = check_inputs(
            dataclasses.replace(honest, inputs=inputs), arena, sides, late, programs=True
        )
        assert found.wrong, beat


EVERY_DECISION = (
    decisions_of.Ready("left"),
    decisions_of.Start(),
    decisions_of.Halt(),
    decisions_of.Resume(),
    decisions_of.Restart("left"),
    decisions_of.Freeze("left", 1.0),
    decisions_of.Unfreeze("left"),
    decisions_of.Adjust("left", 1),
    decisions_of.Set("c1r1", "left"),
    decisions_of.TakeBack(1),
    decisions_of.Clock(1.0),
    decisions_of.Abort(),
    decisions_of.Declare("left"),
    decisions_of.Official(),
    decisions_of.Next(),
)


@pytest.mark.slow
def test_another_version_is_not_proven_if_its_bots_differ(played: Path) -> None:
    """A record of another version passes only if the bots of this version press its keys."""
    folder = played / "published"
    game = games_of(read(folder))[-1]
    assert game.plan is not None
    arena = load(game.plan.arena, game.plan.arena_settings)
    kept = EntryFolder(folder / "entries")
    entries = [kept.load(one[-1]) for one in game.files]
    record = Record.read([folder / "records" / game.played.record])
    header = replace(record.header, versions={**record.header.versions, "lacoc": "0.0.1"})
    record.headers = [header]

    def check_with(bot: str) -> InputCheck:
        sides = [
            Side(team, replace(entry, bot=bot or entry.bot), "")
            for team, entry in zip(game.played.teams, entries, strict=True)
        ]
        return check_inputs(record, arena, sides, game.late_ticks, programs=False)

    assert check_with("") == ((), ())
    found = check_with("nobody")
    assert (found.wrong, {one.code for one in found.unchecked}) == ((), {"unchecked.bot"})
    found = check_with("straight" if entries[0].bot != "straight" else "planner")
    assert (found.wrong, found.unchecked[0].code) == ((), "unchecked.version")
    record.inputs[60] = [SilentSeat(0)]
    found = check_with("")
    assert (found.wrong, found.unchecked[0].code) == ((), "unchecked.inputs")


@pytest.mark.slow
def test_a_record_of_other_physics_is_not_proven(copied: Path) -> None:
    """A record of another MuJoCo is neither proven nor forged; a damaged one is a finding."""
    folder = copied.parent / "published"
    game = games_of(read(folder))[-1]
    path = folder / "records" / game.played.record
    record = Record.read([path])
    versions = {**record.header.versions, "mujoco": "3.0.0"}
    record.headers = [replace(record.header, versions=versions)]
    path.unlink()
    game_forger.written(record, path)
    game = replace(game, played=replace(game.played, record_hash=""))
    found = check_game(folder, game, proven=True, programs=True)
    why = found.unchecked[0].values["why"]
    assert isinstance(why, Phrase)
    assert (found.wrong, why.code) == ((), "replay.other-mujoco")
    path.write_bytes(path.read_bytes()[:1000])
    assert check_game(folder, game, proven=True).wrong


@pytest.mark.slow
@pytest.mark.long
def test_a_game_of_another_arithmetic_is_played_again(played: Path, tmp_path: Path) -> None:
    """The record of another arithmetic passes if the game ends here with the same result."""
    folder = played / "published"
    game = games_of(read(folder))[-1]
    assert game.plan is not None
    arena = load(game.plan.arena, game.plan.arena_settings)
    kept = EntryFolder(folder / "entries")
    entries = [kept.load(one[-1]) for one in game.files]
    sides = [Side(team, one, "") for team, one in zip(game.played.teams, entries, strict=True)]
    record = Record.read([folder / "records" / game.played.record])
    assert ends_alike(record, arena, sides, game.late_ticks, programs=True)
    idle = [side._replace(entry=replace(side.entry, program=IDLE, bot="idle")) for side in sides]
    assert not ends_alike(record, arena, idle, game.late_ticks, programs=True)
    other, found = forged(folder, tmp_path / "forged", ["another path"])
    assert not other
    assert (found.wrong, found.unchecked) == ((), ())


@pytest.mark.slow
def test_a_program_is_run_only_if_that_is_wanted(played: Path) -> None:
    """Without `programs` the keys of a team that brought a program are told as not checked."""
    folder = played / "published"
    found = [
        (one.unchecked, check_game(folder, game, proven=False, programs=True).unchecked)
        for game in games_of(read(folder))
        if (one := check_game(folder, game, proven=False)).unchecked
    ]
    assert found
    for without, with_programs in found:
        assert [one.values["why"].code for one in without] == ["unchecked.program"]  # type: ignore[union-attr]
        assert with_programs == ()


@pytest.mark.slow
def test_a_team_that_a_bot_steered_is_checked(tmp_path: Path) -> None:
    """A team without a bot is steered by one that the fact names; it must have pressed the keys."""
    file = small_contest.enter(
        tmp_path,
        small_contest.CONTEST + small_contest.FINAL.replace('after = "swiss"\n', ""),
        bots={"Ann": "straight"},
    )
    organiser.enter(file, "Bob", None, "", "")
    small_contest.play(file)
    folder = small_contest.publish(file)
    facts = [*read(folder)]
    game = games_of(facts)[-1]
    assert game.played.steer == "planner"
    assert check_game(folder, game, proven=True) == GameCheck(has_bots=True)
    assert "planner" in render(check(folder, lambda done, there: None, jobs=1).decisions[-1])
    for steer, code in (("", "unchecked.steer"), ("nobody", "unchecked.bot")):
        played = replace(game.played, steer=steer)
        found = check_game(folder, replace(game, played=played), proven=False)
        assert (found.wrong, found.unchecked[0].values["why"].code) == ((), code)  # type: ignore[union-attr]
    played = replace(game.played, steer="straight")
    assert check_game(folder, replace(game, played=played), proven=False).wrong


@pytest.mark.slow
def test_nobody_steers_a_team_with_a_bot(played: Path) -> None:
    """A fact that names a steering bot where both teams have entered bots is found."""
    folder = played / "published"
    game = games_of(read(folder))[-1]
    game = replace(game, played=replace(game.played, steer="planner"))
    (found,) = check_game(folder, game, proven=False, programs=True).wrong
    assert isinstance(what := found.values["what"], Phrase)
    assert what.code == "verify.of-steer"


def test_advice_that_no_court_gave_is_found(played: Path) -> None:
    """A fact that names reasons for a rematch which the record does not have is found."""
    folder = played / "published"
    game = games_of(read(folder))[-1]
    late = say("health.late-beat", late_ms=300.0, most_ms=200.0)
    game = replace(game, played=replace(game.played, advice=(late,)))
    (found,) = check_game(folder, game, proven=False, programs=True).wrong
    assert isinstance(what := found.values["what"], Phrase)
    assert what.code == "verify.of-advice"


def test_facts_that_are_nested_too_deep_are_refused(tmp_path: Path) -> None:
    """Facts that no parser can unfold are an error for people, and no traceback."""
    deep = "[" * 100_000 + "]" * 100_000
    fact = f'{{"fact":"planned","id":"a","number":1,"stage":"a","format":"x","limits":{deep}}}'
    options = fact.replace("limits", "arena_settings").replace(deep, f'{{"a":{deep}}}')
    for one in (fact, options):
        (tmp_path / "facts.json").write_text(f'{{"version":1,"facts":[{one}]}}')
        with pytest.raises(UserError):
            read(tmp_path)


@pytest.mark.parametrize("name", [".", "contest.toml", "nowhere"])
def test_a_path_without_a_published_contest_is_told_what_to_give(tmp_path: Path, name: str) -> None:
    """A contest file in place of a published folder is told what `verify` needs."""
    (tmp_path / "contest.toml").write_text('[contest]\nname = "LACOC"\n')
    with pytest.raises(UserError, match=r"no published contest .*lacoc contest publish"):
        read(tmp_path / name)


def _double(text: str) -> str:
    return text.replace('"outcome":', '"outcome":"void","outcome":', 1)


def _unknown(text: str) -> str:
    return text.replace('"outcome":', '"judge":"Kim","outcome":', 1)


@pytest.mark.slow
@pytest.mark.parametrize("change", [_double, _unknown])
@pytest.mark.parametrize("file", ["facts.json", "contest.json"])
def test_a_field_that_is_passed_over_is_found(
    copied: Path, file: str, change: Callable[[str], str]
) -> None:
    """A field that occurs twice, or is not known, is found in facts and sheet."""
    folder = copied.parent / "published"
    path = folder / file
    before = path.read_text("utf-8")
    assert change(before) != before
    path.write_text(change(before), "utf-8")
    codes = [one.code for one in check_published(folder, read(folder))]
    assert codes == [{"facts.json": "verify.more-in-facts"}.get(file, "verify.other-sheet")]


@pytest.mark.slow
def test_a_file_that_no_fact_names_is_found(copied: Path) -> None:
    """Further records, entries and files of entries are found."""
    folder = copied.parent / "published"
    entry = next((folder / "entries").iterdir())
    shutil.copytree(entry, folder / "entries" / ("0" * 32))
    (entry / "notes.txt").write_text("x")
    (folder / "records" / "other.mcap").write_bytes(b"")
    found = [*check_published(folder, read(folder))]
    assert {one.code for one in found} == {"verify.not-named"}
    assert {one.values["file"] for one in found} == {
        "records/other.mcap",
        f"entries/{'0' * 32}",
        f"entries/{entry.name}/notes.txt",
    }


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pipes by name")
@pytest.mark.parametrize("kind", every_third(["link", "zero", "pipe", "folder"]))
def test_a_hostile_folder_ends_the_check_at_once(copied: Path, kind: str) -> None:
    """What is no regular file in the folder is a finding: nothing waits, and nothing is read."""
    folder = copied.parent / "published"
    secret = copied.parent / "secret"
    facts = read(folder)
    entry = next(path for path in sorted((folder / "entries").iterdir()))
    record = next(path for path in sorted((folder / "records").iterdir()))
    for path in (entry / "robot.toml", record, folder / SHEET, folder / "games.csv"):
        path.rename(secret)
        if kind == "link":
            path.symlink_to(secret)
        elif kind == "zero":
            path.symlink_to("/dev/zero")
        elif kind == "pipe":
            os.mkfifo(path)
        else:
            path.mkdir()
        found = [*check_published(folder, facts)]
        for game in games_of(facts):
            found += check_game(folder, game, proven=False).wrong
        assert found, path
        path.rmdir() if kind == "folder" else path.unlink()
        secret.rename(path)
    (folder / "facts.json").rename(secret)
    if kind == "pipe":
        os.mkfifo(folder / "facts.json")
    else:
        (folder / "facts.json").symlink_to(secret if kind == "link" else "/dev/zero")
    with pytest.raises(UserError):
        read(folder)
    for name in ("entries", "records"):
        (folder / name).rename(folder / "away")
        (folder / name).symlink_to(folder / "away")
        assert "regular.no-folder" in {one.code for one in check_published_of(folder, facts)}
        (folder / name).unlink()
        (folder / "away").rename(folder / name)


def check_published_of(folder: Path, facts: tuple[AnyFact, ...]) -> list[Phrase]:
    """Check a published folder whose facts were read before."""
    (folder / "facts.json").unlink(missing_ok=True)
    (folder / "facts.json").write_bytes(league_facts.encode(facts))
    return [*check_published(folder, facts)]


@pytest.mark.slow
def test_a_folder_of_an_honest_contest_has_nothing_more(played: Path) -> None:
    """In the published folder of an honest contest everything is named and known."""
    folder = played / "published"
    assert [*check_published(folder, read(folder))] == []


def test_why_a_game_was_not_due_is_told() -> None:
    """The finding says what speaks against a game: a result, its number, its seats, or no match."""
    plan = new(Planned, stage="a", format="round-robin", arena="othello")
    begun = [new(Entered, team=one, files="f" * 32) for one in "AB"]
    begun += [plan, new(Closed), new(Drawn, stage="a", entries=("A", "B"))]
    what: dict[str, Any] = {"pairing": "a:a1.1", "game": 1, "teams": ("A", "B")}
    score: dict[str, Any] = {"scores": (1, 0), "outcome": "left"}
    given = new(Replaced, reason="no net", **what, **score)
    game = new(Played, **what, **score)

    def why(*facts: AnyFact) -> str | None:
        found = games_of(numbered(*begun, *facts))[-1].why_not
        return found and found.code

    assert why(game) is None
    assert why(given, game) == "due.has-result"
    assert why(replace(game, teams=("B", "A"))) == "due.other-seats"
    assert why(replace(game, game=2)) == "due.other-game"
    assert why(replace(game, pairing="b:a1.1")) == "due.no-pairing"
    assert why(new(Withdrawn, team="A"), game) == "due.not-open"
    called = new(Called, court="main", **what)
    assert why(called, given, game) is None
    assert why(replace(called, teams=("B", "A")), game) == "due.other-seats"


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
    shutil.copytree(Path(__file__).parents[2] / "arenas/lacoc_arenas/othello", evil)
    (evil / "__init__.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\n")
    facts = [
        replace(fact, arena=str(evil)) if isinstance(fact, Planned) else fact
        for fact in read(folder)
    ]
    (folder / "facts.json").write_bytes(league_facts.encode(facts))
    games = [check_game(folder, game, proven=True) for game in games_of(read(folder))]
    assert {one.code for game in games for one in game.unchecked} == {"verify.unchecked"}
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
    (wrong, *_) = check_game(tmp_path, game, proven=True).wrong
    assert render(wrong).startswith("Round robin, round 1 (A – B): ")
    assert render(wrong, "ja").startswith("総当たり戦")


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


def test_a_check_says_what_it_does(
    played: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Before the long part `verify` says how many games it plays again, and how many at a time."""
    told: list[tuple[int, int]] = []
    check(
        played / "published",
        lambda done, there: told.append((done, there)),
        sampled=1,
        jobs=1,
    )
    there = told[0][1]
    assert told == [(done, there) for done in range(there + 1)]
    monkeypatch.setattr(
        "lacoc_server.contest.verify.check.check",
        lambda folder, changed, **_: (
            changed(0, 16),
            ContestCheck((), (), (), (), 9, 20, 20, 0, 0, 0),
        )[1],
    )
    checking.verify(played / "published", jobs=2)
    assert "16 games are played again from their records, 2 at a time" in capsys.readouterr().err


def test_what_is_like_the_rest_is_listed_in_part(capsys: pytest.CaptureFixture[str]) -> None:
    """A long list ends with the number of those that are not shown."""
    unchecked = tuple(say("verify.more", count=one) for one in range(100, 120))
    checking._show(ContestCheck((), unchecked, (), (), 9, 20, 20, 0, 0, 0))
    told = capsys.readouterr().err
    assert "111 more" in told
    assert "112 more" not in told
    assert "8 more" in told
