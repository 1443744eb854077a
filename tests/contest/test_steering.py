"""Tests of a day that is steered from the office: who may, what it says, and that it is proven."""

import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from msgspec.structs import replace
from office_room import CODE, KEY, NOW_MS, Room, said, sample

from lacoc_server.contest.acts import deciding, organiser, steering
from lacoc_server.contest.kept.plans import note_plans
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Drawn,
    Entered,
    FilesChanged,
    Moved,
    NoShow,
    Played,
    Substituted,
    Undrawn,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.sheet import sheet
from lacoc_server.contest.league.timetable.calling import LOST_MS
from lacoc_server.contest.live.court_link import CourtResult
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.verify.history import check_history
from lacoc_server.contest.verify.published import check_published
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.messages.desk import (
    PUBLISHED,
    Announce,
    AnyRequest,
    Apply,
    Approve,
    CloseEntries,
    Draw,
    Effect,
    Move,
    PauseContest,
    Publish,
    ResumeContest,
    Rule,
    Said,
    Shift,
    Staff,
    Substitute,
    TakeOut,
    TokenList,
    Tokens,
    Undraw,
    Unshift,
)
from lacoc_shared.messages.office import call_is_over
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

_KNOCKOUT = """
[stage.finals]
format = "single-knockout"
after = "cup"
teams = 2
break_s = 600
final_court = "south"
"""
_BY_HAND = '[stage.finals]\nformat = "single-knockout"\ndraw = "organiser"\n'


@pytest.fixture
def room(tmp_path_factory: pytest.TempPathFactory) -> Room:
    """Give a contest of four teams, whose first stage is drawn."""
    room = Room(tmp_path_factory.mktemp("cup"), _KNOCKOUT)
    room.enter("Ants", "Bees", "Crabs", "Dogs")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    return room


def code_of(answer: object) -> str:
    """Return the code of what was done."""
    assert isinstance(answer, Said), answer
    return answer.said[0].code


def effect_of(answer: object) -> list[str]:
    assert isinstance(answer, Effect), answer
    return [line.code for line in answer.lines]


def wrongs(facts: tuple[AnyFact, ...]) -> list[str]:
    """Return the codes of what can't come from an honest contest."""
    return [one.code for one in check_history(facts, compute(facts, FORMATS))]


def set_clocks(patch: pytest.MonkeyPatch, passed_s: float, set_by_s: float = 0) -> None:
    """Let time pass for the office; its machine's clock may also be set."""
    wall_ns = time.time_ns() + round((passed_s + set_by_s) * 1e9)
    now_s = time.monotonic() + passed_s
    clocks = SimpleNamespace(time_ns=lambda: wall_ns, monotonic=lambda: now_s)
    patch.setattr("lacoc_server.contest.live.office.time", clocks)


def test_the_timetable_has_every_match(room: Room) -> None:
    """Also the final of a stage that is not drawn: with its court, and after its break."""
    slots = {slot.pairing: slot for slot in room.view.slots}
    assert len(slots) == 6 + 1
    final = slots["finals:w1.1"]
    assert (final.court, final.teams) == ("south", ("", ""))
    assert final.who is not None
    assert [who.code for who in final.who] == ["who.seed"] * 2
    last = max(slot.at_ms for slot in slots.values() if slot is not final)
    assert final.at_ms >= last + 600_000
    later = {one.pairing: one for one in sheet("", compute(room.facts, FORMATS)).later}
    assert later["finals:w1.1"].fixture.code == "fixture.final"


@pytest.mark.parametrize("typed", ["Café  Ants", "Cafe\u0301 Ants", " Café\u3000Ants "])
def test_a_team_is_known_as_it_is_typed_at_its_entry(tmp_path: Path, typed: str) -> None:
    """Spaces and the way of writing an accent do not matter, whatever is decided about a team."""
    room = Room(tmp_path)
    room.enter(typed, "Bees")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    room.enter("Crabs", reason="late")
    contest, team = compute(room.facts, FORMATS), "Café Ants"
    no_show = deciding.WantedDecision("no-show", "cup:a1.1", 1, typed, None, "ill")
    assert deciding.decision(contest, no_show) == new(
        NoShow, pairing="cup:a1.1", team=team, opponent="Bees", reason="ill"
    )
    wanted = new(Substituted, team=team, substitute="Crabs", reason="ill")
    assert steering.substituting(contest, typed, "Crabs", "ill") == wanted
    assert [*deciding.teams_named(contest, [f"Bees,{typed}"])] == ["Bees", team]
    assert [*organiser.tokens(room.file, typed)] == [team]
    left = organiser.take_out(room.file, typed, "ill", disqualified=False)
    assert left == say("contest.left", team=team)
    assert [one.name for one in compute(room.facts, FORMATS).teams if one.gone] == [team]


def test_a_match_that_is_not_drawn_is_moved(room: Room) -> None:
    """The final goes to the other court, and stays there; who moves nothing is told why."""
    move = Move(secret=KEY, pairing="finals:w1.1", court="north", not_before_ms=NOW_MS + 9_000_000)
    assert code_of(room.ask(move)) == "desk.moved"
    (final,) = (slot for slot in room.view.slots if slot.pairing == "finals:w1.1")
    assert (final.court, final.at_ms) == ("north", NOW_MS + 9_000_000)
    assert said(room.ask(Move(secret=KEY, pairing="finals:w9.1"))) == "decide.no-match"
    assert said(room.ask(Move(secret=KEY, pairing="finals:w1.1", court="x"))) == "desk.no-court"


def test_a_match_that_the_draw_does_not_have_was_moved_in_vain(tmp_path: Path) -> None:
    """With fewer teams than before the moved match is not there; the contest stays honest."""
    room = Room(tmp_path)
    room.enter("Ants", "Bees", "Crabs", "Dogs")
    assert code_of(room.ask(Move(secret=KEY, pairing="cup:a3.2", court="north"))) == "desk.moved"
    room.ask(TakeOut(secret=KEY, team="Dogs", reason="ill", really=True))
    room.ask(TakeOut(secret=KEY, team="Crabs", reason="ill", really=True))
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    assert [len(view.matches) for view in compute(room.facts, FORMATS).stages] == [1]
    assert wrongs(room.facts) == []


@pytest.mark.parametrize("kind", ["void", "no-show"])
def test_a_match_that_was_decided_without_a_game_is_opened_again(room: Room, kind: Any) -> None:
    """A wrong decision is not final; a result is told to open the match first."""
    contest = compute(room.facts, FORMATS)
    match = contest.stages[0].matches[0]
    team = (match.teams[0] or "") if kind == "no-show" else ""
    rule = Rule(secret=KEY, kind=kind, pairing=match.pairing.id, team=team, reason="x", really=True)
    assert effect_of(room.ask(rule))
    assert compute(room.facts, FORMATS).stages[0].matches[0].decided
    result = replace(rule, kind="result", game=1, scores=(3, 1), team="")
    assert said(room.ask(result)) == "decide.not-played"
    again = replace(rule, kind="replay", game=1, team="")
    assert effect_of(room.ask(again))
    match = compute(room.facts, FORMATS).stages[0].matches[0]
    assert (match.state, match.next_game) == ("open", 1)
    assert wrongs(room.facts) == []


def call_first(room: Room) -> Called:
    """Call the first match of the contest to court north."""
    match = compute(room.facts, FORMATS).stages[0].matches[0]
    assert match.next_seats is not None
    game = {"pairing": match.pairing.id, "game": 1}
    room.store.append(league_facts.new(Called, teams=match.next_seats, court="north", **game))
    call = room.facts[-1]
    assert isinstance(call, Called)
    return call


def test_a_refused_game_is_tried_again_with_other_files(room: Room) -> None:
    """The office holds a game back until a team of it has other files."""
    call = call_first(room)
    office = Office(room.store, room.where.entries, room.secrets.team, {}, {})
    refused = SimpleNamespace(take=lambda: Refusal(say("refused.no-office-token")))
    office._asked[call.id] = cast(Any, refused)
    office.step()
    assert [*office.held] == [(call.pairing, 1)]
    office.step()
    assert office.held, "nothing has changed"
    room.store.append(
        league_facts.new(FilesChanged, team=call.teams[0], files="f", reason="a wrong leg")
    )
    office.step()
    assert office.held == {}


def test_a_game_whose_call_is_over_at_its_court_is_called_again(room: Room) -> None:
    """The facts may be an older copy: then the court has played the call, and closed its match."""
    call = call_first(room).id
    office = Office(room.store, room.where.entries, room.secrets.team, {}, {})
    refused = SimpleNamespace(take=lambda: Refusal(call_is_over(call)))
    office._asked[call] = cast(Any, refused)
    office.step()
    assert office.contest.running == ()
    assert office.held == {}


def test_the_end_of_a_game_that_was_moved_in_play_is_waited_for(room: Room) -> None:
    """Its court says that the match is over before the office knows its result."""
    called = call_first(room)
    call = called.id
    asked = SimpleNamespace(take=lambda: None)
    link = SimpleNamespace(
        poll=lambda: None,
        is_there=True,
        call=call,
        phase=Phase.PLAYING,
        missing=(),
        result=None,
        tell=lambda _: asked,
        assign=lambda *_, **__: asked,
    )
    links = {"north": cast(Any, link)}
    office = Office(room.store, room.where.entries, room.secrets.team, links, {"north": "tcp/n"})
    room.store.append(league_facts.new(Moved, pairing=called.pairing, court="south"))
    for link.is_there, link.call, link.phase in (
        (True, call, Phase.PLAYING),
        (False, None, None),
        (True, None, None),
        (True, call, Phase.OFFICIAL),
    ):
        office.step()
        assert [one.id for one in office.contest.running] == [call]
    link.result = CourtResult(call, "m", called.teams, (20, 16), "left")
    office.step()
    played = [fact for fact in room.facts if isinstance(fact, Played)]
    assert [(one.pairing, one.scores) for one in played] == [(called.pairing, (20, 16))]


def test_a_court_that_can_not_be_understood_loses_its_game(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is heard, but nobody knows what it has, so nobody ever would hear a result."""
    call_first(room)
    asked = SimpleNamespace(take=lambda: None)
    link = SimpleNamespace(poll=lambda: None, is_there=True, call=None, phase=None, missing=())
    link.result, link.tell = None, lambda _: asked
    links = {"north": cast(Any, link)}
    office = Office(room.store, room.where.entries, room.secrets.team, links, {"north": "tcp/n"})
    office.step()
    assert len(office.contest.running) == 1
    set_clocks(monkeypatch, passed_s=LOST_MS / 1000 + 1)
    office.step()
    assert office.contest.running == ()


def test_a_game_in_vain_ends_though_the_clock_was_set_back(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The office asks a court once a second, whatever the clock of its machine says."""
    called = call_first(room)
    call = called.id
    asked = SimpleNamespace(take=Done)
    sent: list[str] = []
    link = SimpleNamespace(poll=lambda: None, is_there=True, call="", missing=(), result=None)
    link.phase, link.tell = Phase.CREATED, lambda _: asked
    link.assign = link.withdraw = lambda call, *_, **__: sent.append(call) or asked
    links = {"north": cast(Any, link)}
    office = Office(room.store, room.where.entries, room.secrets.team, links, {"north": "tcp/n"})
    office.step()
    assert sent == [call]
    link.call, link.phase = call, Phase.PLAYING
    set_clocks(monkeypatch, passed_s=2, set_by_s=-600)
    left = league_facts.new(Withdrawn, team=called.teams[0], reason="a broken leg")
    room.store.append(left)
    office.step()
    assert call in sent[1:]
    assert office.known.seen["north"].heard_ms <= office.known.pace.now_ms


def test_a_team_whose_game_was_void_has_played(room: Room) -> None:
    """No substitute is offered for it, because the draw would not give the place away."""
    match = compute(room.facts, FORMATS).stages[0].matches[0]
    assert match.next_seats is not None
    team = match.next_seats[0]
    assert steering.places(compute(room.facts, FORMATS), team)
    about = {"pairing": match.pairing.id, "game": 1, "teams": match.next_seats, "scores": (0, 0)}
    room.store.append(league_facts.new(Played, outcome="void", record="r.mcap", **about))
    assert steering.places(compute(room.facts, FORMATS), team) == []


def test_the_day_is_paused_shifted_and_goes_on(room: Room) -> None:
    """Each is a fact; what can't be is told."""
    assert said(room.ask(ResumeContest(secret=KEY))) == "day.not-paused"
    assert code_of(room.ask(PauseContest(secret=KEY, reason="a cable"))) == "day.paused"
    assert (room.view.day.paused, room.view.day.reason) == (True, "a cable")
    assert said(room.ask(PauseContest(secret=KEY))) == "day.paused-already"
    assert said(room.ask(PauseContest(secret=KEY, until_ms=1))) == "day.in-the-past"
    assert code_of(room.ask(ResumeContest(secret=KEY))) == "day.goes-on"
    before = [slot.at_ms for slot in room.view.slots]
    assert code_of(room.ask(Shift(secret=KEY, by_ms=900_000))) == "day.shifted"
    assert min(slot.at_ms for slot in room.view.slots) >= min(before)
    assert wrongs(room.facts) == []


def test_a_shift_is_taken_back_once(room: Room) -> None:
    """The page shows the newest shift while it matters; who asks twice takes one back."""
    room.ask(Move(secret=KEY, pairing="finals:w1.1", not_before_ms=NOW_MS + 9_000_000))
    for minutes in (1, 15):
        assert code_of(room.ask(Shift(secret=KEY, by_ms=minutes * 60_000))) == "day.shifted"
    shift = room.view.shift
    assert shift is not None
    assert shift.by_ms == 900_000
    back = Unshift(secret=KEY, shift=shift.shift)
    assert code_of(room.ask(back)) == "day.unshifted"
    assert said(room.ask(back)) == "day.not-shifted"
    assert room.view.shift is not None
    assert room.view.shift.by_ms == 60_000
    assert wrongs(room.facts) == []


@pytest.mark.parametrize(
    ("how", "code"), [("", "decide.draws"), ('draw = "organiser"', "decide.waits-for-draw")]
)
def test_a_decision_that_ends_a_stage_says_what_is_drawn_then(
    tmp_path_factory: pytest.TempPathFactory, how: str, code: str
) -> None:
    """Before a no-show ends the last match, it is told who is in the next stage, and when."""
    room = Room(tmp_path_factory.mktemp("cup"), _KNOCKOUT + how)
    room.enter("Ants", "Bees")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    rule = Rule(secret=KEY, kind="no-show", pairing="cup:a1.1", team="Ants", reason="?")
    seen = room.ask(rule)
    assert isinstance(seen, Effect)
    lines = {line.code: line.values for line in seen.lines}
    assert [*lines][-2:] == ["decide.ends", code]
    assert lines[code]["teams"] == ("Bees", "Ants")


def test_a_line_is_told_to_all(room: Room) -> None:
    """It is in the sheet that all pages read."""
    assert code_of(room.ask(Announce(secret=KEY, text=" Lunch\n until 1 "))) == "day.announced"
    shown = sheet("", compute(room.facts, FORMATS)).announced
    assert shown is not None
    assert shown.text == room.view.announced == "Lunch until 1"
    assert code_of(room.ask(Announce(secret=KEY, text=" "))) == "day.announced-nothing"
    assert room.view.announced == ""


def test_a_substitute_comes_for_a_team_that_is_ill(room: Room) -> None:
    """A late team enters with a reason, takes a place, and the history is that of an honest one."""
    apply = Apply(secret=CODE, team="Eels", files=sample(), contact="eel@x", club="North")
    room.ask(apply)
    (row,) = (row for row in room.view.teams if row.team == "Eels")
    assert (row.contact, row.club) == ("eel@x", "North")
    room.ask(Approve(secret=KEY, teams=("Eels",), reason="a reserve"))
    assert [fact.club for fact in room.facts if isinstance(fact, Entered)][-1] == "North"

    assert [row.team for row in room.view.teams if row.reserve] == ["Eels"]
    assert {row.team for row in room.view.teams if row.substitute} == {
        "Ants",
        "Bees",
        "Crabs",
        "Dogs",
    }
    ill = {"team": "Bees", "substitute": "Eels"}
    assert said(room.ask(Substitute(secret=KEY, **ill, reason=" "))) == "decide.needs-reason"
    lines = effect_of(room.ask(Substitute(secret=KEY, **ill, reason="ill")))
    assert "decide.leaves" in lines
    assert not any(isinstance(fact, Substituted) for fact in room.facts)
    room.ask(Substitute(secret=KEY, **ill, reason="ill", really=True))
    (view,) = compute(room.facts, FORMATS).stages
    assert view.stage.entries == ("Ants", "Eels", "Crabs", "Dogs")
    assert said(room.ask(Substitute(secret=KEY, team="Ants", substitute="Eels", reason="x"))) == (
        "day.no-place"
    )
    assert wrongs(room.facts) == []
    decided = sheet("", compute(room.facts, FORMATS)).decided
    assert [one.what.code for one in decided] == ["decided.substituted", "decided.entered-late"]
    shown = {team.name: team for team in sheet("", compute(room.facts, FORMATS)).teams}
    assert (shown["Bees"].withdrawn, shown["Bees"].substitute) == (True, "Eels")
    assert shown["Eels"].substitute == ""
    assert {row.team: row.replaced_by for row in room.view.teams if row.replaced_by} == {
        "Bees": "Eels"
    }


def test_a_draw_is_taken_back_and_made_again(room: Room) -> None:
    """Until somebody plays; the stage is drawn again with a team that came late."""
    undrawable = room.view.undrawable
    assert undrawable is not None
    assert undrawable.stage == "cup"
    assert said(room.ask(Undraw(secret=KEY, stage="finals", reason="x"))) == "league.not-drawn"
    (first, *_) = compute(room.facts, FORMATS).stages[0].matches
    assert first.next_seats is not None
    call = {"pairing": first.pairing.id, "game": 1, "teams": first.next_seats, "court": "main"}
    room.store.append(league_facts.new(Called, **call))
    assert room.view.undrawable is not None, "a game that is only called holds nobody up"
    room.store.append(
        steering.moving(
            compute(room.facts, FORMATS), (), first.pairing.id, not_before_ms=NOW_MS * 2
        )
    )
    lines = effect_of(room.ask(Undraw(secret=KEY, stage="cup", reason="a late team")))
    assert [*lines] == ["decide.gone", "decide.taken-back", "decide.waits-for-draw"]
    room.ask(Undraw(secret=KEY, stage="cup", reason="a late team", really=True))
    assert compute(room.facts, FORMATS).running == ()
    assert wrongs(room.facts) == []
    assert room.view.undrawable is None
    office = Office(room.store, room.where.entries, room.secrets.team, {}, {})
    note_plans(room.store, room.where.plans)  # as a restart of the office does
    office.step()
    assert office.contest.stages == (), "it waits for the organiser"
    room.enter("Eels", reason="a late train")
    to_draw = room.view.to_draw
    assert to_draw is not None
    room.ask(Draw(secret=KEY, stage="cup", entries=to_draw.entries))
    note_plans(room.store, room.where.plans)
    assert room.view.to_draw is None
    (view,) = compute(room.facts, FORMATS).stages
    assert view.stage.entries == ("Ants", "Bees", "Crabs", "Dogs", "Eels")
    assert compute(room.facts, FORMATS).moves == (), "what was moved was of the other draw"
    assert wrongs(room.facts) == []
    match = view.matches[0]
    assert match.next_seats is not None
    room.store.append(
        league_facts.new(
            Played,
            pairing=match.pairing.id,
            game=1,
            teams=match.next_seats,
            scores=(1, 0),
            outcome="left",
        )
    )
    assert room.view.undrawable is None
    assert said(room.ask(Undraw(secret=KEY, stage="cup", reason="x"))) == "day.draw-stays"


@pytest.mark.parametrize(
    ("given", "order", "decided"),
    [
        ({}, ["Ants", "Bees", "Crabs"], []),
        ({"how": "lot", "lot": "4 2"}, None, ["decided.drawn-by-lot"]),
        (
            {"how": "hand", "reason": "last year", "entries": ("Crabs", "Ants", "Bees")},
            ["Crabs", "Ants", "Bees"],
            ["decided.drawn-by-hand"],
        ),
    ],
)
def test_a_stage_is_drawn_as_the_organiser_wants(
    tmp_path_factory: pytest.TempPathFactory,
    given: dict[str, object],
    order: list[str] | None,
    decided: list[str],
) -> None:
    """By the ranking, by lot or by hand; each draw is checked, and others are told."""
    room = Room(tmp_path_factory.mktemp("cup"), stages=_BY_HAND)
    room.enter("Ants", "Bees", "Crabs")
    room.ask(CloseEntries(secret=KEY))
    to_draw = room.view.to_draw
    assert to_draw is not None
    request = {"stage": "finals", "entries": to_draw.entries} | given
    assert isinstance(room.ask(Draw(secret=KEY, **request)), Said)
    drawn = next(fact for fact in room.facts if isinstance(fact, Drawn))
    assert sorted(drawn.entries) == ["Ants", "Bees", "Crabs"]
    assert order is None or [*drawn.entries] == order
    found = sheet("", compute(room.facts, FORMATS)).decided
    assert [one.what.code for one in found] == decided
    assert wrongs(room.facts) == []


@pytest.mark.parametrize(
    ("kind", "change", "code"),
    [
        (Drawn, {"how": "lot"}, "verify.other-draw"),
        (Drawn, {"how": "lot", "lot": "7"}, "verify.other-draw"),
        (Drawn, {"how": "hand"}, "verify.other-draw"),
        (Drawn, {"entries": ("Bees", "Ants", "Crabs", "Dogs")}, "verify.other-draw"),
        (Drawn, {"how": "hand", "reason": "x", "entries": ("Ants", "Bees")}, "verify.other-draw"),
        (Entered, {"reason": ""}, "verify.entered-late"),
        (Substituted, {"substitute": "Gnus"}, "verify.unused"),
        (Substituted, {"team": "Gnus"}, "verify.unused"),
        (Undrawn, {"stage": "finals"}, "verify.unused"),
    ],
)
def test_forged_facts_of_a_day_are_found(
    room: Room, kind: type[AnyFact], change: dict[str, object], code: str
) -> None:
    """A changed fact of each kind is no honest history."""
    room.ask(Undraw(secret=KEY, stage="cup", reason="a late team", really=True))
    room.enter("Eels", reason="a late train")
    room.draw()
    room.enter("Fish", reason="a reserve")
    ill = Substitute(secret=KEY, team="Bees", substitute="Fish", reason="ill", really=True)
    assert isinstance(room.ask(ill), Effect)
    facts = list(room.facts)
    assert wrongs(tuple(facts)) == []
    at = max(number for number, fact in enumerate(facts) if isinstance(fact, kind))
    facts[at] = replace(facts[at], **change)
    assert code in wrongs(tuple(facts))


def test_the_staff_decide_under_their_names(room: Room) -> None:
    """Each has a link; facts say who decided; only the organiser gives links, and takes them."""
    assert code_of(room.ask(Staff(secret=KEY, name="Aiko"))) == "desk.staff-added"
    tokens = cast("TokenList", room.ask(Tokens(secret=KEY)))
    token = tokens.staff["Aiko"]
    assert isinstance(room.ask(PauseContest(secret=token, reason="a cable")), Said)
    assert [fact.by for fact in room.facts][-1] == "Aiko"
    assert isinstance(room.ask(ResumeContest(secret=KEY)), Said)
    assert [fact.by for fact in room.facts][-1] == ""
    assert cast("TokenList", room.ask(Tokens(secret=token))).staff == {}
    assert said(room.ask(Staff(secret=token, name="Ben"))) == "desk.not-organiser"
    room.ask(Staff(secret=KEY, name="Aiko", remove=True))
    assert said(room.ask(PauseContest(secret=token))) == "desk.not-organiser"
    assert room.view.staff == ()


@pytest.mark.parametrize(
    "asked",
    [
        PauseContest(),
        ResumeContest(),
        Shift(by_ms=60_000),
        Unshift(shift="f1"),
        Announce(text="x"),
        Publish(),
        Staff(name="x"),
    ],
)
def test_only_the_staff_may(room: Room, asked: AnyRequest) -> None:
    """Neither the event code nor a team's token steers the day."""
    before = room.facts
    for secret in ("", CODE, room.secrets.team("Ants")):
        assert said(room.ask(replace(asked, secret=secret))) == "desk.not-organiser"
    assert room.facts == before


def test_the_office_publishes_nothing_that_the_contest_holds_back(tmp_path: Path) -> None:
    """Everybody can read the published folder, so it waits until the records may be seen."""
    held = '[contest]\nreplays = "after-contest"\n'
    room = Room(tmp_path, stages=held + '[stage.cup]\nformat = "round-robin"\n')
    room.enter("Ants", "Bees")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    assert said(room.ask(Publish(secret=KEY))) == "desk.holds-back"
    assert not room.where.published.exists()
    room.ask(TakeOut(secret=KEY, team="Bees", reason="ill", really=True))
    assert compute(room.facts, FORMATS).over
    assert code_of(room.ask(Publish(secret=KEY))) == "desk.published"


def test_the_office_publishes(room: Room) -> None:
    """The published folder stands beside the contest file, and can be checked."""
    assert room.view.published == ""
    done = room.ask(Publish(secret=KEY))
    assert code_of(done) == "desk.published"
    assert cast("Said", done).said[0].values["folder"] == str(room.where.published)
    assert (room.view.published, room.view.folder) == (PUBLISHED, str(room.where.published))
    assert [one.code for one in check_published(room.where.published, room.facts)] == []
