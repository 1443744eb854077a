"""Tests of a match's log and answers to inputs, phrase by phrase (docs/protocol.md, Event)."""

from typing import Any

import msgspec
import pytest
from stage import (
    FORWARD,
    LEFT,
    QUICK,
    RIGHT,
    Script,
    ScriptedPhysics,
    Stage,
    X,
    decide,
    join,
    key,
    setup,
)

from lacoc_server.match.match import Match
from lacoc_server.match.physics import Fault
from lacoc_shared import __version__
from lacoc_shared import decisions as d
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import Advice, HeardSeat, Input, LeaveSeat, ReadySeat, SilentSeat
from lacoc_shared.messages import PROTOCOL, DecisionReply, Done, Event, Frame, Refusal, SeatFrame
from lacoc_shared.record.schema import Result
from lacoc_shared.seat import NOBODY, No, Phase
from lacoc_shared.words import Phrase, faults, render, say

P = Phase
FLIP = {2: {LEFT: (-0.15, -0.15)}, 3: {LEFT: (0.15, -0.15)}}
"""The left robot goes from the middle of its own disc c2r2 to the right seat's disc c3r2."""
Said = tuple[str, int, Phrase, dict[str, Any]]
"""An event as (kind, seat, said, data)."""


def said(events: tuple[Event, ...]) -> list[Said]:
    assert not [fault for event in events for fault in faults(event.said)]
    return [(event.kind, event.seat, event.said, event.data) for event in events]


def phase(before: str, then: str, **data: str) -> Said:
    said = Phrase(f"event.{then.lower()}")
    return "phase", NOBODY, said, {"before": before, "after": then, **data}


def word(name: str, did: Phrase, reason: str = "", **arguments: Any) -> Said:
    arguments = {"type": name, **arguments}
    data = {"decision": name, "by": "Kubota", "reason": reason, "arguments": arguments}
    said = say("event.decided", by="Kubota", did=did, reason=reason or None)
    return "decision", NOBODY, said, data


def joined(team: str, seat: str, robot: str) -> Phrase:
    return say("event.joined", team=team, seat=seat, robot=robot)


BROKE = say("fault.contacts")


HEXAPODS, WITH_A_QUADRUPED = "3d16d9075b90decf", "280170d9694dcef7"
"""Model hashes that the scripted physics gives to these pairs of robots."""
STORY: tuple[tuple[tuple[Input, ...], list[Said]], ...] = (
    (
        (join(LEFT), join(RIGHT, robot="quadruped")),
        [
            phase("CREATED", "LOBBY"),
            ("join", LEFT, joined("Ants", "left", "Hexapod"), {}),
            ("join", RIGHT, joined("Bees", "right", "Quadruped"), {}),
        ],
    ),
    (
        (ReadySeat(LEFT, True), ReadySeat(RIGHT, True)),
        [
            ("ready", LEFT, say("event.team-ready", team="Ants"), {"ready": True}),
            ("ready", RIGHT, say("event.team-ready", team="Bees"), {"ready": True}),
            phase("LOBBY", "READY", model=WITH_A_QUADRUPED),
        ],
    ),
    (
        (ReadySeat(LEFT, False),),
        [
            ("ready", LEFT, say("event.team-not-ready", team="Ants"), {"ready": False}),
            phase("READY", "LOBBY"),
        ],
    ),
    (
        (LeaveSeat(RIGHT),),
        [("leave", RIGHT, say("event.left-seat", team="Bees", seat="right"), {})],
    ),
    (
        (join(RIGHT), decide(d.Ready("right"), ""), ReadySeat(LEFT, True)),
        [
            ("join", RIGHT, joined("Bees", "right", "Hexapod"), {}),
            ("ready", LEFT, say("event.team-ready", team="Ants"), {"ready": True}),
            word("ready", say("decision.ready", team="Bees"), seat="right"),
            ("ready", RIGHT, say("event.team-ready", team="Bees"), {"ready": True}),
            phase("LOBBY", "READY", model=HEXAPODS),
        ],
    ),
    (
        (decide(d.Start(), ""),),
        [word("start", say("decision.start", seconds=0.04)), phase("READY", "COUNTDOWN")],
    ),
    ((), []),
    ((), [phase("COUNTDOWN", "PLAYING")]),
    ((), []),
    (
        (),
        [
            (
                "flip",
                LEFT,
                say("event.flip", team="Ants", marker="c3r2", also=[]),
                {"marker": "c3r2", "also": (), "points": 1},
            )
        ],
    ),
    ((SilentSeat(LEFT),), [("silent", LEFT, say("event.silent", team="Ants"), {})]),
    (
        (HeardSeat(LEFT),),
        [
            ("heard", LEFT, say("event.heard", team="Ants"), {}),
            ("fault", RIGHT, say("event.fault", why=BROKE), {}),
            phase("PLAYING", "HALTED"),
        ],
    ),
    (
        (decide(d.Resume(), ""),),
        [word("resume", say("decision.resume", seconds=0.04)), phase("HALTED", "COUNTDOWN")],
    ),
    ((), []),
    ((), [phase("COUNTDOWN", "PLAYING")]),
    ((key(RIGHT, X),), [("restart", RIGHT, say("event.restarted", team="Bees"), {})]),
    ((LeaveSeat(RIGHT),), [("leave", RIGHT, say("event.left-match", team="Bees"), {})]),
    ((join(RIGHT),), [("join", RIGHT, say("event.back", team="Bees"), {})]),
    (
        (decide(d.Restart("left"), "stuck"),),
        [word("restart", say("decision.restart", team="Ants"), "stuck", seat="left")],
    ),
    (
        (decide(d.Freeze("left", 2.5), "late"),),
        [
            word(
                "freeze",
                say("decision.freeze", team="Ants", seconds=2.5),
                "late",
                seat="left",
                seconds=2.5,
            )
        ],
    ),
    (
        (decide(d.Unfreeze("left"), ""),),
        [word("unfreeze", say("decision.unfreeze", team="Ants"), seat="left")],
    ),
    (
        (decide(d.Clock(-1.5), "a pause"),),
        [word("clock", say("decision.clock-less", seconds=1.5), "a pause", gives_s=-1.5)],
    ),
    ((decide(d.Halt(), ""),), [word("halt", say("decision.halt")), phase("PLAYING", "HALTED")]),
    (
        (decide(d.Adjust("right", 2), "fair"),),
        [
            word(
                "adjust",
                say(
                    "decision.adjust",
                    points=2,
                    team="Bees",
                    score=say("score.two", left="Ants", points=19, conceded=19, right="Bees"),
                ),
                "fair",
                seat="right",
                points=2,
            )
        ],
    ),
    (
        (decide(d.Set("c0r0", "neutral"), "torn"),),
        [
            word(
                "set",
                say(
                    "decision.set-so",
                    marker="c0r0",
                    state="neutral",
                    score=say("score.two", left="Ants", points=18, conceded=19, right="Bees"),
                ),
                "torn",
                marker="c0r0",
                state="neutral",
            )
        ],
    ),
    (
        (decide(d.Declare("right"), "agreed"),),
        [
            word("declare", say("decision.declare", team="Bees"), "agreed", winner="right"),
            (
                "phase",
                NOBODY,
                say("event.finished", why=say("over.ended")),
                {"before": "HALTED", "after": "FINISHED"},
            ),
            (
                "result",
                NOBODY,
                say("event.wins", team="Bees", scores=(18, 19)),
                {"winner": "right", "scores": (18, 19)},
            ),
        ],
    ),
    (
        (decide(d.Declare("draw"), "agreed"),),
        [word("declare", say("decision.declare-draw"), "agreed", winner="draw")],
    ),
    (
        (decide(d.Official(), ""),),
        [word("official", say("decision.official-draw")), phase("FINISHED", "OFFICIAL")],
    ),
    ((decide(d.Next(), ""),), [word("next", say("decision.next"))]),
)


def test_the_log_of_a_match() -> None:
    """A whole match logs each event with its kind, seat, phrase and data."""
    script = Script(poses=dict(FLIP), faults={5: Fault(RIGHT, BROKE)})
    stage = Stage(overrides={"match": {"countdown_s": 0.04}}, script=script)
    for inputs, expected in STORY:
        events = stage.beat(*inputs).events
        assert said(events) == expected
        assert {event.beat for event in events} <= {stage.frame.beat}
        if stage.phase is P.COUNTDOWN and not stage.match.ticks:
            stage.physics.begin()
            stage.let_move()
    assert [event.number for event in stage.events] == list(range(1, len(stage.events) + 1))
    assert {event.match for event in stage.events} == {1}
    flip = next(event for event in stage.events if event.kind == "flip")
    assert (flip.clock_ticks, flip.beat) == (3, 9)


def test_what_a_fault_in_ready_leaves_in_the_log() -> None:
    """A fault of physics in READY is logged, and the match goes back to LOBBY."""
    stage = Stage(script=Script(faults={3: Fault(NOBODY, BROKE)})).to_ready()
    stage.until(P.LOBBY)
    told = [event for beat in stage.beats[2:] for event in beat.events]
    assert said(tuple(told)) == [
        ("fault", NOBODY, say("event.fault", why=BROKE), {}),
        phase("READY", "LOBBY"),
    ]


def test_what_the_court_measured_in_the_log() -> None:
    """The log says why a rematch is advised, and later that it is no longer advised."""
    stage = Stage(overrides=QUICK).to(P.PLAYING)
    assert stage.match.advice == ()
    reasons = (say("health.late-beat", late_ms=80, most_ms=60), "a text of an old record")
    beat = stage.beat(Advice(reasons))
    assert beat.outcomes == (Done(),)
    advised = say("event.advised", reasons=reasons)
    assert said(beat.events) == [("advice", NOBODY, advised, {})]
    assert stage.match.advice == reasons
    again = said(stage.beat(Advice(())).events)
    assert again == [("advice", NOBODY, say("event.not-advised"), {})]


def test_what_an_abort_and_a_draw_leave_in_the_log() -> None:
    """Equal scores are logged as a draw (workshop 5-1 rule 7); an abort makes the match VOID."""
    stage = Stage(overrides=QUICK).to(P.FINISHED)
    assert said(stage.beats[-1].events)[-1] == (
        "result",
        NOBODY,
        say("event.draw", scores=(18, 18)),
        {"winner": "draw", "scores": (18, 18)},
    )
    beat = stage.beat(decide(d.Abort(), "rain"))
    assert said(beat.events) == [
        word("abort", say("decision.abort"), "rain"),
        phase("FINISHED", "VOID"),
    ]


def test_what_a_take_back_leaves_in_the_log() -> None:
    """A take-back logs the decision with the vanished events, then the events that are new."""
    script = Script(poses={5: {LEFT: (-0.8, -0.8)}, 6: {LEFT: (0.0, 0.0)}, 7: {LEFT: (-0.8, -0.8)}})
    stage = Stage("flag-strike", QUICK, script=script).to_playing()
    stage.run(8)
    stage.decide(d.Halt())
    (number,) = stage.numbers("capture")
    beat = stage.beat(decide(d.TakeBack(number), "a mistake"))
    changes = (
        say("change.vanishes", kind="capture", marker="corner0"),
        say("change.appears", kind="capture", marker="corner0"),
    )
    struck = say("struck.event", kind="capture", marker="corner0", team="Ants")
    score = say("score.two", left="Ants", points=5, conceded=0, right="Bees")
    did = say("decision.took-back", what=struck, score=score)
    name, nobody, told, data = word("take-back", did, "a mistake", event=number, dry_run=False)
    capture = say("event.capture", team="Ants", marker="corner0", points=5)
    assert said(beat.events) == [
        (name, nobody, told, {**data, "vanished": [number], "scores": (5, 0)}),
        (
            "capture",
            LEFT,
            say("event.judged-again", event=capture),
            {"marker": "corner0", "also": (), "points": 5},
        ),
    ]
    (reply,) = beat.outcomes
    assert reply == DecisionReply(
        beat=beat.frame.beat,
        event=number + 3,  # after the halt and its phase
        said=did,
        scores=(5, 0),
        changes=changes,
    )


def test_a_sheet_of_a_robot_that_does_not_walk() -> None:
    """In practice a robot may have no LocoTra-data file; the sheet then has no keys of level B."""
    whole = join(LEFT)
    stage = Stage("practice")
    stage.beat(msgspec.structs.replace(whole, locomotion=None))
    (seat,) = stage.match.sheet().seats
    assert seat.team == "Ants"
    assert (seat.keys[1], seat.postures) == ((), ())


@pytest.mark.parametrize(
    ("at", "item", "answer"),
    [
        (P.LOBBY, join(LEFT), Done()),
        (P.LOBBY, ReadySeat(LEFT, True), Done()),
        (P.LOBBY, LeaveSeat(LEFT), Done()),
        (P.PLAYING, join(LEFT), Done()),
        (
            P.PLAYING,
            join(LEFT, robot="quadruped"),
            Done(say("note.files-next-match")),
        ),
        (P.PLAYING, ReadySeat(LEFT, True), Refusal(say("refused.match-on", phase="playing"))),
        (P.PLAYING, LeaveSeat(LEFT), Done(say("note.seat-stays"))),
        (P.PLAYING, SilentSeat(LEFT), Done()),
        (P.PLAYING, HeardSeat(LEFT), Done()),
        (P.PLAYING, key(LEFT, FORWARD), Done()),
        (P.HALTED, key(LEFT, FORWARD), Refusal(say("key.not-playing"))),
    ],
)
def test_answers(at: Phase, item: Input, answer: Done | Refusal) -> None:
    """Each input is answered with Done, perhaps with a note, or with a refusal that says why."""
    assert Stage(overrides=QUICK).to(at).send(item) == answer


def test_answers_about_empty_seats() -> None:
    """An empty seat can't be made ready, and nobody can join it while a match is on.

    After the match a team can join it for the next one. A join with a wrong file is refused.
    """
    stage = Stage(overrides=QUICK)
    nobody = Refusal(say("refused.nobody-joined", seat="right"))
    assert stage.send(ReadySeat(RIGHT, True)) == nobody
    wrong = stage.send(join(RIGHT, robot_file=b"name = 3"))
    assert isinstance(wrong, Refusal)
    assert (wrong.why.code, len(wrong.mistakes) > 1) == ("refused.mistakes", True)
    assert not wrong.again, "the same files never become right"
    assert stage.match.seats[RIGHT].team == "right"
    on = Stage(overrides=QUICK).to(P.PLAYING)
    on.match.seats[RIGHT].join = None
    why = say("refused.match-on-join", phase="playing")
    assert on.send(join(RIGHT)) == Refusal(why, again=True)
    stage.decide(d.Abort())
    assert stage.send(join(RIGHT)) == Done(say("note.next-match"))


def test_a_robot_is_weighed_by_the_contest_and_the_arena() -> None:
    """A robot is refused if it breaks a limit of the contest or has no keys of any open level."""
    light = msgspec.structs.replace(setup("othello"), limits={"mass_max_kg": 0.4})
    stage = Stage()
    stage.match = Match(light, lambda arena, entries: ScriptedPhysics(arena, entries, Script()))
    heavy = stage.send(join(LEFT))
    assert isinstance(heavy, Refusal)
    assert any("0.4" in render(mistake.expected) for mistake in heavy.mistakes), heavy.mistakes
    cannot_walk = Stage().send(msgspec.structs.replace(join(LEFT), locomotion=None))
    assert isinstance(cannot_walk, Refusal)


def test_a_result_says_all() -> None:
    """The result has teams, scores, winner, reason, clock, and the digest that proves it.

    A beat has the result only if it changed the result.
    """
    stage = Stage(overrides=QUICK, script=Script(poses=dict(FLIP))).to(P.PLAYING)
    assert stage.match.result().computed == ""
    stage.decide(d.Clock(-3600.0))
    expected = Result(
        match_id="m",
        court="main",
        match=1,
        arena="othello",
        teams=("Ants", "Bees"),
        scores=(19, 17),
        computed="left",
        official="",
        reason=say("over.time"),
        clock_s=3600.06,
        beats=len(stage.beats),
        digest=stage.physics.digest.hex(),
        model=HEXAPODS,
    )
    assert stage.beats[-1].result == expected
    assert stage.beat().result is None, "only in a beat that changed it"


def test_a_frame_says_all() -> None:
    """A frame has all fields that docs/protocol.md names; a client needs no earlier frame."""
    stage = Stage(overrides=QUICK)
    first = stage.beat()
    assert first.sheet_changed
    assert first.frame.seats == (SeatFrame(0, 18, 0, 0, 0, 0, 0, 0, 0, 0),) * 2
    stage.to(P.PLAYING)
    stage.beat(key(LEFT, FORWARD, seq=3), key(RIGHT, X, seq=7))
    pressed = stage.frame.beat
    stage.beat(SilentSeat(LEFT), key(RIGHT, FORWARD, seq=9), decide(d.Adjust("left", 4)))
    joined_ready, silent, lock_ticks, level = 1 + 2, 4, 250, 1
    assert stage.frame == Frame(
        match=1,
        beat=len(stage.beats) - 1,
        phase=4,
        countdown_beats=0,
        clock_ticks=stage.match.ticks,
        seats=(
            SeatFrame(joined_ready + silent, 22, level, 0, 0, 0, 3, pressed, 0, No.NONE),
            SeatFrame(joined_ready, 18, level, 0, 0, lock_ticks - 2, 7, pressed, 9, No.RESTARTED),
        ),
        markers=bytes([0b10_01_01_01, 0b01_01_10_10, 0b10_10_10_01] * 3),
        poses=stage.physics.poses(),
        scene=stage.physics.scene_hash,
        digest=stage.physics.digest,
    )


def test_a_sheet_says_what_frames_leave_out() -> None:
    """The sheet has what frames leave out, such as teams, robots, keys and settings."""
    stage = Stage("flag-strike", QUICK)
    empty = stage.beat(join(LEFT))
    assert empty.sheet_changed
    assert not stage.beat().sheet_changed
    sheet = stage.match.sheet()
    assert (sheet.protocol, sheet.version) == (PROTOCOL, __version__)
    assert (sheet.court, sheet.match, sheet.match_id) == ("main", 1, "m")
    assert sheet.arena == "flag-strike"
    assert (sheet.title, sheet.duration_s, sheet.levels) == ("Flag-Strike", 180.0, (1,))
    assert sheet.settings == stage.match.arena.settings
    assert sheet.markers == stage.match.game.markers
    assert sheet.scene == stage.physics.scene_hash
    taken, free = sheet.seats
    entry = stage.match.seats[LEFT].entry
    assert entry is not None
    assert (taken.id, taken.team, taken.robot) == ("left", "Ants", "Hexapod")
    assert taken.legs == entry.robot.labels
    assert taken.keys == (entry.gait.keys(Level.POSTURE), entry.gait.keys(Level.LOCOMOTION))
    assert entry.gait.locomotion is not None
    assert taken.postures == tuple(map(len, entry.gait.locomotion.sequences))
    assert (free.id, free.team, free.robot, free.legs) == ("right", "", "", ())
    seats = stage.match.arena.seats
    assert [(s.colour, s.pattern) for s in (taken, free)] == [(s.colour, s.pattern) for s in seats]
