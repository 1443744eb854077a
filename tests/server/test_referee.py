"""Tests of the referee's decisions: when each is legal, why not, and what it does (rules 4.1).

In the workshop's text, decisions are in 5-1 rule 8 and 5-2 rule 9.
"""

import math

import pytest
from stage import (
    FORWARD,
    LEFT,
    QUICK,
    RIGHT,
    STAND,
    Script,
    Stage,
    X,
    decide,
    join,
    key,
    seen,
)

from lacoc_shared import decisions as d
from lacoc_shared.codec import decode, encode
from lacoc_shared.inputs import THE_COURT, ReadySeat
from lacoc_shared.messages import DecisionReply, Done, Refusal
from lacoc_shared.seat import Phase, SeatFlag
from lacoc_shared.words import Phrase, faults, render, say

P = Phase
PHASES = list(P)[1:]

LEGAL: dict[str, tuple[d.Decision, set[Phase]]] = {
    "ready": (d.Ready("left"), {P.LOBBY}),
    "start": (d.Start(), {P.READY}),
    "halt": (d.Halt(), {P.COUNTDOWN, P.PLAYING}),
    "resume": (d.Resume(), {P.HALTED}),
    "restart": (d.Restart("left"), {P.PLAYING, P.HALTED}),
    "freeze": (d.Freeze("left", 5.0), {P.PLAYING, P.HALTED}),
    "unfreeze": (d.Unfreeze("left"), {P.PLAYING, P.HALTED}),
    "adjust": (d.Adjust("left", 3), {P.PLAYING, P.HALTED, P.FINISHED}),
    "set": (d.Set("c0r0", "right"), {P.PLAYING, P.HALTED, P.FINISHED}),
    "take-back": (d.TakeBack(1), {P.HALTED, P.FINISHED}),
    "clock": (d.Clock(5.0), {P.PLAYING, P.HALTED, P.FINISHED}),
    "abort": (d.Abort(), {P.LOBBY, P.READY, P.COUNTDOWN, P.PLAYING, P.HALTED, P.FINISHED}),
    "declare": (d.Declare("left"), {P.HALTED, P.FINISHED}),
    "official": (d.Official(), {P.FINISHED}),
    "next": (d.Next(), {P.OFFICIAL, P.VOID}),
}


def stage_in(phase: Phase, script: Script | None = None) -> Stage:
    return Stage(overrides=QUICK if phase is not P.COUNTDOWN else None, script=script).to(phase)


def refused(stage: Stage, decision: d.Decision, reason: str = "agreed") -> Phrase:
    """Check that a decision is refused and changes neither log nor game; return the reason."""
    before = stage.match.history.state
    outcome = stage.decide(decision, reason)
    assert isinstance(outcome, Refusal), outcome
    assert not any(event.kind == "decision" for event in stage.beats[-1].events)
    assert stage.match.history.state is before
    assert not faults(outcome.why)
    assert outcome.why.code == "refused.decision"
    why = outcome.why.values["why"]
    assert isinstance(why, Phrase)
    return why


def done(stage: Stage, decision: d.Decision) -> DecisionReply:
    outcome = stage.decide(decision)
    assert isinstance(outcome, DecisionReply), outcome
    return outcome


def test_every_decision_is_in_the_table() -> None:
    """This file's table has every decision of the protocol."""
    assert list(LEGAL) == list(d.DECISIONS)


@pytest.mark.parametrize("phase", PHASES, ids=lambda phase: phase.name)
def test_what_is_legal_is_published(phase: Phase) -> None:
    """In each phase the match lists which decisions are legal, and why the others are not."""
    published = stage_in(phase).match.legality()
    assert list(published) == list(LEGAL)
    for name, (_, phases) in LEGAL.items():
        if phase in phases:
            assert published[name] is None
        else:
            why = published[name]
            assert why is not None
            assert (why.code, why.values["phase"]) == ("why.phase", phase.word)
            assert why.values["phases"] == tuple(one.word for one in sorted(phases))
            assert not faults(why)


@pytest.mark.parametrize("name", LEGAL)
@pytest.mark.parametrize("phase", PHASES, ids=lambda phase: phase.name)
def test_only_a_legal_decision_is_made(phase: Phase, name: str) -> None:
    """A legal decision is made; an illegal one is refused with the reason and changes nothing."""
    decision, phases = LEGAL[name]
    stage, twin = stage_in(phase), stage_in(phase)
    if phase in phases:
        if name not in ("take-back", "unfreeze"):
            done(stage, decision)
        return
    why = stage.match.legality()[name]
    assert stage.decide(decision) == Refusal(say("refused.decision", decision=name, why=why))
    twin.beat()
    for _ in range(3):
        assert seen(stage) == seen(twin)
        stage.beat()
        twin.beat()
    assert encode(stage.events) == encode(twin.events)


def test_why_a_match_cannot_start_names_all_that_is_missing() -> None:
    """The reason why a match can't start lists everything that is missing."""
    stage = Stage()
    stage.beat(join(LEFT))
    legality = stage.match.legality()
    not_ready = say("why.not-ready", seat="left", team="Ants")
    nobody = say("why.nobody-in-seat", seat="right")
    missing = [not_ready, nobody]
    assert legality["start"] == say("why.phase", phase="lobby", phases=["ready"], missing=missing)
    phases = ["countdown", "playing"]
    assert legality["halt"] == say("why.phase", phase="lobby", phases=phases, missing=[])


@pytest.mark.parametrize("name", sorted(LEGAL))
def test_some_decisions_need_a_reason(name: str) -> None:
    """A decision that needs a reason is refused if the reason is blank; others need none."""
    decision, phases = LEGAL[name]
    if name in ("take-back", "unfreeze"):
        return
    for blank in ("", "  \n"):
        outcome = stage_in(min(phases)).decide(decision, reason=blank)
        if name in d.NEED_A_REASON:
            why = say("why.needs-reason")
            assert outcome == Refusal(say("refused.decision", decision=name, why=why))
        else:
            assert isinstance(outcome, DecisionReply)


BAD_ARGUMENTS: list[tuple[d.Decision, Phase, str]] = [
    (d.Ready("solo"), P.LOBBY, "why.no-seat"),
    (d.Restart("Left"), P.HALTED, "why.no-seat"),
    (d.Freeze("middle", 1.0), P.PLAYING, "why.no-seat"),
    (d.Freeze("left", 0.0), P.PLAYING, "why.bad-freeze"),
    (d.Freeze("left", -1.0), P.PLAYING, "why.bad-freeze"),
    (d.Freeze("left", 600.1), P.PLAYING, "why.bad-freeze"),
    (d.Freeze("left", math.nan), P.PLAYING, "why.bad-freeze"),
    (d.Freeze("left", math.inf), P.PLAYING, "why.bad-freeze"),
    (d.Unfreeze("left"), P.PLAYING, "why.not-frozen"),
    (d.Unfreeze("top"), P.HALTED, "why.no-seat"),
    (d.Adjust("left", 0), P.PLAYING, "why.bad-points"),
    (d.Adjust("left", 1001), P.PLAYING, "why.bad-points"),
    (d.Adjust("left", -1001), P.FINISHED, "why.bad-points"),
    (d.Adjust("none", 1), P.HALTED, "why.no-seat"),
    (d.Set("c9r9", "left"), P.HALTED, "why.no-marker"),
    (d.Set("c0r0", "blue"), P.HALTED, "why.no-state"),
    (d.Set("c0r0", "down"), P.HALTED, "why.disc-state"),
    (d.Clock(0.0), P.PLAYING, "why.bad-clock"),
    (d.Clock(math.nan), P.PLAYING, "why.bad-clock"),
    (d.Clock(3601.0), P.PLAYING, "why.bad-clock"),
    (d.Declare("Ants"), P.FINISHED, "why.can-not-win"),
    (d.TakeBack(0), P.HALTED, "why.can-not-take-back"),
    (d.TakeBack(1), P.HALTED, "why.can-not-take-back"),
    (d.TakeBack(-5), P.FINISHED, "why.can-not-take-back"),
    (d.TakeBack(10**9), P.FINISHED, "why.can-not-take-back"),
]


@pytest.mark.parametrize(("decision", "phase", "code"), BAD_ARGUMENTS)
def test_wrong_arguments(decision: d.Decision, phase: Phase, code: str) -> None:
    """A decision with a wrong argument is refused, the reply says why, and nothing changes."""
    stage, twin = stage_in(phase), stage_in(phase)
    assert refused(stage, decision).code == code
    twin.beat()
    assert seen(stage) == seen(twin)


def test_a_decision_is_an_event_with_beat_referee_and_reason() -> None:
    """Rules 4.1: the log has a decision's beat, referee and reason; the reply has the scores."""
    stage = stage_in(P.PLAYING)
    beat = stage.beat(decide(d.Adjust("right", -2), "pushed the table", by="Takeda"))
    (reply,) = beat.outcomes
    event = next(event for event in beat.events if event.kind == "decision")
    assert isinstance(reply, DecisionReply)
    assert (
        (reply.beat, reply.event) == (event.beat, event.number) == (stage.frame.beat, event.number)
    )
    assert reply.scores == (18, 16)
    assert (
        render(event.said)
        == "Referee Takeda: -2 points for Bees: Ants 18 : 16 Bees. Reason: pushed the table"
    )
    assert event.data["by"] == "Takeda"
    assert event.data["reason"] == "pushed the table"
    assert event.data["decision"] == "adjust"
    assert event.data["arguments"] == {"type": "adjust", "seat": "right", "points": -2}


# What each decision does.


def test_the_court_is_no_referee() -> None:
    """The log names the court, not a referee, for a decision of the court itself."""
    stage = Stage().to(Phase.PLAYING)
    stage.send(decide(d.Halt(), say("reason.court-restarted"), THE_COURT))
    (event,) = [event for event in stage.beats[-1].events if event.kind == "decision"]
    assert render(event.said) == "The court: halted. Reason: the court was started again"
    assert render(event.said, "ja").startswith("コート：")


def test_ready_for_a_seat() -> None:
    """`ready`: the referee says ready for a contestant; an empty seat can't be made ready."""
    stage = Stage()
    stage.beat(join(LEFT), join(RIGHT))
    assert "nobody" not in render(stage.match.legality()["start"] or "")
    done(stage, d.Ready("left"))
    assert stage.frame.seats[LEFT].flags & SeatFlag.READY
    done(stage, d.Ready("right"))
    assert stage.phase is P.READY
    empty = Stage()
    empty.beat()
    assert refused(empty, d.Ready("left")) == say("why.nobody-joined")
    empty.beat(join(RIGHT))
    assert refused(empty, d.Ready("left")) == say("why.nobody-in-seat", seat="left")


@pytest.mark.parametrize("phase", [P.PLAYING, P.HALTED])
def test_restart(phase: Phase) -> None:
    """`restart` puts the robot back at its start, standing, and its keys work at once."""
    stage = Stage(overrides=QUICK, script=Script(poses={1: {LEFT: (0.1, 0.5)}})).to(P.PLAYING)
    stage.beat(key(LEFT, FORWARD))
    if phase is P.HALTED:
        done(stage, d.Halt())
    done(stage, d.Restart("left"))
    assert stage.physics._places[LEFT] == stage.match.game.starts[LEFT][0][:2]
    assert stage.frame.seats[LEFT].key == STAND
    if phase is P.HALTED:
        done(stage, d.Resume())
        stage.until(P.PLAYING)
    assert stage.match.history.state.last[LEFT] == 12
    assert stage.send(key(LEFT, FORWARD, seq=2)) == Done()


def test_freeze_and_its_end() -> None:
    """`freeze` makes the robot stand and refuses its keys, for some seconds of the clock."""
    stage = stage_in(P.PLAYING)
    stage.beat(key(LEFT, FORWARD))
    done(stage, d.Freeze("left", 1.0))
    seat = stage.frame.seats[LEFT]
    assert (seat.key, seat.locked_ticks) == (STAND, 49)
    assert seat.flags == SeatFlag.JOINED | SeatFlag.READY | SeatFlag.FROZEN
    assert stage.send(key(LEFT, FORWARD, seq=2)) == Refusal(say("key.frozen"))
    assert stage.send(key(LEFT, X, seq=3)) == Refusal(say("key.frozen"))
    assert stage.send(key(RIGHT, FORWARD)) == Done()
    done(stage, d.Halt())
    stage.run(60)
    done(stage, d.Resume())
    stage.until(P.PLAYING)
    left = stage.frame.seats[LEFT].locked_ticks
    assert left == 45
    stage.run(left - 1)
    assert stage.frame.seats[LEFT].flags & SeatFlag.FROZEN
    stage.run(1)
    assert not stage.frame.seats[LEFT].flags & SeatFlag.FROZEN
    assert stage.send(key(LEFT, FORWARD, seq=4)) == Done()


def test_unfreeze() -> None:
    """`unfreeze` ends a freeze, and keys work again."""
    stage = stage_in(P.PLAYING)
    done(stage, d.Freeze("right", 600.0))
    stage.run(5)
    done(stage, d.Unfreeze("right"))
    assert not stage.frame.seats[RIGHT].flags & SeatFlag.FROZEN
    assert stage.send(key(RIGHT, FORWARD)) == Done()


def test_unfreeze_after_the_end_of_a_freeze() -> None:
    """`unfreeze` is refused after a freeze has ended, but can end a freeze set before play."""
    stage = stage_in(P.PLAYING)
    done(stage, d.Freeze("left", 0.04))
    assert stage.frame.seats[LEFT].locked_ticks == 1
    stage.beat()
    assert refused(stage, d.Unfreeze("left")) == say("why.not-frozen", team="Ants")
    early = stage_in(P.COUNTDOWN)
    done(early, d.Halt())
    done(early, d.Freeze("left", 1.0))
    done(early, d.Unfreeze("left"))
    assert not early.frame.seats[LEFT].flags & SeatFlag.FROZEN


@pytest.mark.parametrize(
    "decision",
    [
        d.Adjust("left", 1000),
        d.Adjust("left", -1000),
        d.Clock(3600.0),
        d.Clock(-3600.0),
        d.Clock(0.02),
        d.Freeze("left", 600.0),
        d.Freeze("left", 0.02),
    ],
)
def test_the_limits_themselves_are_allowed(decision: d.Decision) -> None:
    """The largest and smallest numbers that are allowed for a decision are accepted."""
    done(stage_in(P.HALTED), decision)


def test_adjust() -> None:
    """`adjust` adds points to a score, which is shown and decides the winner."""
    stage = stage_in(P.HALTED)
    assert done(stage, d.Adjust("left", 5)).scores == (23, 18)
    assert done(stage, d.Adjust("right", -1)).scores == (23, 17)
    assert stage.scores == (23, 17)
    assert stage.match.winner() == "left"


@pytest.mark.parametrize(
    ("arena", "marker", "state", "scores"),
    [
        ("othello", "c0r0", "right", (17, 19)),
        ("othello", "c5r5", "neutral", (18, 17)),
        ("flag-strike", "corner2", "left", (5, 0)),
        ("flag-strike", "flag18", "right", (0, 5)),
        ("flag-strike", "flag18", "down", (0, 0)),
    ],
)
def test_set(arena: str, marker: str, state: str, scores: tuple[int, ...]) -> None:
    """`set` changes a disc, a corner or a flag, and the scores with it."""
    stage = Stage(arena, QUICK).to(P.HALTED)
    assert done(stage, d.Set(marker, state)).scores == scores == stage.scores
    assert stage.board.get(marker, "neutral") == state


def test_set_in_a_game_without_a_board() -> None:
    """In a game without markers and without an end, `set` and `clock` are not legal."""
    stage = Stage("practice", {"match": {"start": "referee"}})
    assert stage.to_ready().match.phase is P.READY
    stage.decide(d.Start())
    assert stage.match.legality()["set"] == say("why.no-board")
    assert stage.match.legality()["clock"] == say("why.no-end")


def test_clock_moves_the_end() -> None:
    """`clock` with a positive number lengthens the match, and with a negative one shortens it."""
    stage = stage_in(P.PLAYING)
    was = stage.frame.clock_ticks
    done(stage, d.Clock(10.0))
    assert stage.frame.clock_ticks == was + 1 - 500
    done(stage, d.Clock(-100.0))
    assert stage.frame.clock_ticks == was + 2 - 500 + 5000
    stage.until(P.FINISHED)
    assert stage.match.ticks == 9000 + 500 - 5000
    assert stage.frame.clock_ticks == 9000


def test_clock_in_old_records() -> None:
    """In old records `clock` and its event have `seconds`; if positive, they shorten the match."""
    old: d.Decision = decode(encode({"type": "clock", "seconds": 10.0}), d.Decision)
    stage = stage_in(P.PLAYING)
    was = stage.frame.clock_ticks
    assert done(stage, old).said == say("decision.clock-less", seconds=10.0)
    assert stage.frame.clock_ticks == was + 1 + 500
    (event,) = (event for event in stage.events if event.data.get("decision") == "clock")
    assert event.data["arguments"] == {"type": "clock", "seconds": 10.0}


def test_clock_past_the_end() -> None:
    """If `clock` leaves no time, play ends at once, or a halted match ends after it is resumed."""
    stage = stage_in(P.HALTED)
    ticks = stage.match.ticks
    done(stage, d.Clock(-3600.0))
    assert stage.phase is P.HALTED
    done(stage, d.Resume())
    stage.until(P.FINISHED, at_most=5)
    assert (stage.match.ticks, stage.match.ended) == (ticks, say("over.time"))
    stage = stage_in(P.PLAYING)
    ticks = stage.match.ticks
    done(stage, d.Clock(-3600.0))
    assert (stage.phase, stage.match.ticks) == (P.FINISHED, ticks)


def test_time_taken_by_mistake_is_given_back() -> None:
    """If `clock` ended play by a slip, giving the time back lets it go on; so does a longer match.

    That is possible until the result is official, but not if the game or the referee ended play.
    """
    stage = stage_in(P.PLAYING)
    ticks = stage.match.ticks
    done(stage, d.Clock(-3600.0))
    assert stage.phase is P.FINISHED
    assert refused(stage, d.Clock(-1.0)).code == "why.no-time-left"
    done(stage, d.Clock(60.0))
    assert stage.phase is P.FINISHED  # still no time is left
    done(stage, d.Clock(3540.0))
    assert stage.phase is P.HALTED
    assert stage.match.result().computed == ""
    done(stage, d.Resume())
    stage.until(P.FINISHED)
    assert stage.match.ticks == 9000 > ticks
    assert stage.frame.clock_ticks == 9000
    done(stage, d.Declare("left"))
    assert refused(stage, d.Clock(60.0)).code == "why.not-over-by-time"


def test_a_new_winner_is_an_event() -> None:
    """Each decision that changes the computed winner adds one event with the new result."""
    stage = stage_in(P.FINISHED)

    def told() -> list[tuple[str, tuple[int, ...]]]:
        results = [e for beat in stage.beats for e in beat.events if e.kind == "result"]
        return [(event.data["winner"], event.data["scores"]) for event in results]

    before = told()
    assert len(before) == 1
    left, right = stage.match.scores()
    done(stage, d.Adjust("right", 30))
    number = stage.match.next_number - 2
    done(stage, d.Adjust("left", 30))
    done(stage, d.TakeBack(number))
    done(stage, d.Declare("draw"))
    done(stage, d.Official())
    assert told()[1:] == [
        ("right", (left, right + 30)),
        (before[0][0], (left + 30, right + 30)),
        ("left", (left + 30, right)),
    ]


def test_abort_is_void() -> None:
    """`abort` makes a match void; if the match had ended, its computed result is kept."""
    stage = stage_in(P.PLAYING)
    done(stage, d.Abort())
    result = stage.beats[-1].result
    assert result is not None
    assert (result.official, result.reason) == ("void", say("over.aborted"))
    finished = stage_in(P.FINISHED)
    done(finished, d.Adjust("left", 1))
    done(finished, d.Abort())
    result = finished.beats[-1].result
    assert result is not None
    assert (result.official, result.computed, result.reason) == ("void", "left", say("over.time"))


@pytest.mark.parametrize("phase", [P.HALTED, P.FINISHED])
@pytest.mark.parametrize("winner", ["left", "right", "draw"])
def test_declare_keeps_both_results(phase: Phase, winner: str) -> None:
    """Rules 4.1: after `declare`, the computed result and the official one are both kept."""
    stage = stage_in(phase)
    done(stage, d.Adjust("right", 4))
    done(stage, d.Declare(winner))
    assert stage.phase is P.FINISHED
    assert stage.match.ended == say("over.time") if phase is P.FINISHED else say("over.ended")
    done(stage, d.Official())
    result = stage.beats[-1].result
    assert result is not None
    assert (result.computed, result.official, result.scores) == ("right", winner, (18, 22))


def test_official_without_declare_is_what_was_computed() -> None:
    """`official` without `declare` makes the computed result official."""
    stage = stage_in(P.FINISHED)
    reply = done(stage, d.Official())
    assert reply.said == say("decision.official-draw")
    assert stage.phase is P.OFFICIAL


@pytest.mark.parametrize("phase", [P.OFFICIAL, P.VOID])
def test_next(phase: Phase) -> None:
    """`next` asks the court for a new match; the match itself does not change."""
    stage = stage_in(phase)
    assert not stage.match.next_wanted
    done(stage, d.Next())
    assert stage.match.next_wanted
    assert stage.phase is phase


def test_a_halt_in_the_countdown() -> None:
    """A countdown can be halted, and the next countdown begins from 3 s again."""
    stage = stage_in(P.COUNTDOWN)
    stage.run(100)
    done(stage, d.Halt())
    assert stage.frame.countdown_beats == 0
    done(stage, d.Resume())
    assert stage.frame.countdown_beats == 150
    assert stage.match.ticks == 0


def test_two_decisions_of_one_beat_are_taken_in_the_order_they_came() -> None:
    """Decisions of one beat are taken one after another, so a second `halt` is refused."""
    stage = stage_in(P.PLAYING)
    beat = stage.beat(decide(d.Halt()), decide(d.Halt()), decide(d.Adjust("left", 1)))
    assert [type(outcome) for outcome in beat.outcomes] == [DecisionReply, Refusal, DecisionReply]
    numbers = [event.number for event in stage.events]
    assert numbers == list(range(1, len(numbers) + 1))


def test_ready_can_be_taken_back_after_the_referee_gave_it() -> None:
    """A team can take ready back, even if the referee said it for the team."""
    stage = Stage()
    stage.beat(join(LEFT), join(RIGHT))
    done(stage, d.Ready("left"))
    stage.beat(ReadySeat(RIGHT, True))
    stage.beat(ReadySeat(LEFT, False))
    assert stage.phase is P.LOBBY


@pytest.mark.parametrize("decision", [d.Freeze("left", 0.004), d.Clock(-0.009)])
def test_less_than_a_tick_is_no_decision(decision: d.Decision) -> None:
    """A freeze or a change of the clock that rounds to 0 ticks is refused."""
    assert refused(stage_in(P.HALTED), decision).code == "why.less-than-tick"


def test_a_decision_stands_in_the_log_before_what_follows() -> None:
    """In the log a decision comes first, then the phase and the result that follow from it."""
    stage = stage_in(P.HALTED)
    stage.decide(d.Declare("left"))
    assert [event.kind for event in stage.beats[-1].events] == ["decision", "phase", "result"]
