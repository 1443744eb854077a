"""Tests of the phases of a match, and of how one leads to the next (rules 4)."""

import pytest
from stage import FORWARD, LEFT, RIGHT, B, Script, Stage, X, decide, join, key, seen

from lacoc_server.match.physics import Fault
from lacoc_server.match.state import TRANSITIONS
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.inputs import HeardSeat, Input, LeaveSeat, ReadySeat, SilentSeat
from lacoc_shared.messages import DecisionReply, Done, Event, Refusal
from lacoc_shared.seat import No, Phase, SeatFlag
from lacoc_shared.words import render, say

P = Phase
COUNTDOWN_BEATS = 150
"""3 s in beats of 20 ms (rules 4)."""


def steps(events: list[Event]) -> list[tuple[str, str]]:
    return [(e.data["before"], e.data["after"]) for e in events if e.kind == "phase"]


def test_the_table() -> None:
    """The table of transitions has exactly the pairs of phases that this test lists."""
    forward = [(a.name, b.name) for a in TRANSITIONS for b in sorted(TRANSITIONS[a])]
    assert forward == [
        ("CREATED", "LOBBY"),
        ("LOBBY", "READY"),
        ("LOBBY", "VOID"),
        ("READY", "LOBBY"),
        ("READY", "COUNTDOWN"),
        ("READY", "VOID"),
        ("COUNTDOWN", "PLAYING"),
        ("COUNTDOWN", "HALTED"),
        ("COUNTDOWN", "VOID"),
        ("PLAYING", "HALTED"),
        ("PLAYING", "FINISHED"),
        ("PLAYING", "VOID"),
        ("HALTED", "COUNTDOWN"),
        ("HALTED", "FINISHED"),
        ("HALTED", "VOID"),
        ("FINISHED", "HALTED"),
        ("FINISHED", "OFFICIAL"),
        ("FINISHED", "VOID"),
    ]


def test_every_transition_happens() -> None:
    """Each transition of the table can happen in a match."""
    walked = set()

    def walk(stage: Stage) -> None:
        walked.update(steps(stage.events))

    stage = Stage().to(P.READY)
    stage.beat(ReadySeat(LEFT, False))
    stage.beat(ReadySeat(LEFT, True))
    stage.decide(d.Start())
    stage.decide(d.Halt())
    stage.decide(d.Resume())
    stage.until(P.PLAYING)
    stage.decide(d.Halt())
    stage.decide(d.Declare("left"))
    stage.decide(d.Official())
    walk(stage)
    for phase in (P.LOBBY, P.READY, P.COUNTDOWN, P.PLAYING, P.HALTED, P.FINISHED):
        stage = Stage().to(phase)
        stage.decide(d.Abort())
        assert stage.phase is P.VOID
        walk(stage)
    stage = Stage("flag-strike", script=_all_corners()).to_playing()
    stage.until(P.FINISHED)
    stage.decide(d.TakeBack(stage.numbers("capture")[-1]))
    walk(stage)
    assert walked == {(a.name, b.name) for a in TRANSITIONS for b in TRANSITIONS[a]}


def _all_corners() -> Script:
    corners = ((-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8), (0.8, 0.8))
    return Script(poses={10 * n: {LEFT: at} for n, at in enumerate(corners, start=1)})


# Beginning: CREATED, LOBBY, READY.


def test_the_first_beat_is_lobby() -> None:
    """The first beat leads from CREATED to LOBBY, and beats are counted from 0."""
    stage = Stage()
    assert stage.phase is P.CREATED
    stage.run(3)
    assert [beat.frame.beat for beat in stage.beats] == [0, 1, 2]
    assert {beat.frame.phase for beat in stage.beats} == {P.LOBBY}


def test_ready_needs_every_seat_joined_and_ready() -> None:
    """A match goes from LOBBY to READY when every seat has joined and said ready."""
    stage = Stage()
    assert isinstance(stage.send(ReadySeat(LEFT, True)), Refusal)
    stage.beat(join(LEFT))
    stage.beat(ReadySeat(LEFT, True))
    assert stage.match.missing() == [say("why.nobody-in-seat", seat="right")]
    stage.beat(join(RIGHT))
    assert stage.match.missing() == [say("why.not-ready", seat="right", team="Bees")]
    assert stage.phase is P.LOBBY
    stage.beat(ReadySeat(RIGHT, True))
    assert stage.phase is P.READY
    assert stage.match.missing() == []
    assert stage.beats[-1].sheet_changed, "it names the scene with the robots"


@pytest.mark.parametrize("item", [LeaveSeat(LEFT), ReadySeat(LEFT, False)])
def test_back_to_lobby(item: LeaveSeat | ReadySeat) -> None:
    """If a team leaves or takes ready back, READY ends: the match is in LOBBY, without robots."""
    stage = Stage().to_ready()
    stage.beat(item)
    assert stage.phase is P.LOBBY
    assert (stage.frame.poses, stage.beats[-1].sheet_changed) == (b"", True)
    stage.beat(join(LEFT))
    stage.beat(ReadySeat(LEFT, True))
    assert stage.phase is P.READY


def test_a_seat_that_a_team_left_is_empty() -> None:
    """A team that leaves in LOBBY leaves an empty seat: no name, not ready, not silent."""
    stage = Stage().to(P.LOBBY)
    stage.beat(ReadySeat(LEFT, True), SilentSeat(LEFT))
    assert stage.frame.seats[LEFT].flags == SeatFlag.JOINED | SeatFlag.READY | SeatFlag.SILENT
    stage.beat(LeaveSeat(LEFT))
    assert stage.frame.seats[LEFT].flags == 0
    assert stage.match.sheet().seats[LEFT].team == ""
    assert stage.match.missing()[0] == say("why.nobody-in-seat", seat="left")


def test_joining_again_with_other_files_takes_ready_back() -> None:
    """A team that joins again with another robot has to say ready again."""
    stage = Stage().to_ready()
    stage.beat(join(LEFT))  # the same files
    assert stage.phase is P.READY
    stage.beat(join(LEFT, robot="quadruped"))
    assert stage.phase is P.LOBBY
    assert not stage.frame.seats[LEFT].flags & SeatFlag.READY
    assert stage.frame.seats[RIGHT].flags & SeatFlag.READY


@pytest.mark.parametrize("first", [(), (LeaveSeat(LEFT),)])
def test_a_new_robot_in_ready_is_built_even_if_ready_is_said_in_the_same_beat(
    first: tuple[LeaveSeat, ...],
) -> None:
    """If a team changes its robot and says ready in one beat, READY has the new robot."""
    stage = Stage().to_ready()
    before = stage.frame.scene
    stage.beat(*first, join(LEFT, robot="quadruped"), ReadySeat(LEFT, True))
    assert stage.phase is P.READY
    assert stage.frame.scene != before
    assert len(stage.frame.poses) == 4 * (7 + 12 + 7 + 18)


def test_files_with_mistakes_are_refused_and_the_seat_stays_as_it_was() -> None:
    """Rules 2: a join with mistakes in its files gets a list of them; the seat stays as it is."""
    stage, twin = Stage().to(P.LOBBY), Stage().to(P.LOBBY)
    bad = join(LEFT, robot_file=b"name = 3")
    outcome = stage.send(bad)
    assert isinstance(outcome, Refusal)
    assert len(outcome.mistakes) > 1
    twin.beat()
    assert seen(stage) == seen(twin)


def test_frames_before_ready_have_no_robots() -> None:
    """Frames before READY have no poses."""
    stage = Stage.real().to(P.LOBBY)
    assert stage.frame.poses == b""
    stage.beat(ReadySeat(LEFT, True), ReadySeat(RIGHT, True))
    assert len(stage.frame.poses) == 4 * 2 * (7 + 18)


# Countdown and play.


@pytest.mark.parametrize("again", [False, True])
def test_every_start_and_every_resume_has_a_countdown_of_150_beats(again: bool) -> None:
    """Rules 4: every start and every resume has a countdown of 3 s, counted in beats."""
    stage = Stage().to_ready()
    stage.decide(d.Start())
    if again:
        stage.until(P.PLAYING)
        stage.decide(d.Halt())
        stage.run(7)
        stage.decide(d.Resume())
    first = len(stage.beats) - 1
    stage.until(P.PLAYING)
    counted = [(b.frame.phase, b.frame.countdown_beats) for b in stage.beats[first:-1]]
    assert counted == [(P.COUNTDOWN, n) for n in range(COUNTDOWN_BEATS, 0, -1)]
    assert stage.frame.countdown_beats == 0
    assert stage.beats[-1].ticked


def test_a_countdown_also_where_the_seats_start_themselves() -> None:
    """A match without a referee (start = "ready") also has a countdown of 3 s."""
    stage = Stage(overrides={"match": {"start": "ready"}}).to_ready()
    stage.until(P.PLAYING)
    counted = [b.frame.countdown_beats for b in stage.beats if b.frame.phase is int(P.COUNTDOWN)]
    assert counted == list(range(COUNTDOWN_BEATS, 0, -1))


def test_physics_runs_in_ready_and_playing_only() -> None:
    """Physics runs in READY and PLAYING; in all other phases nothing moves."""
    stage = Stage()
    ran: dict[int, set[bool]] = {}
    still: dict[int, set[bytes]] = {}

    def note(count: int) -> None:
        for _ in range(count):
            stage.beat()
            ran.setdefault(stage.frame.phase, set()).add(stage.beats[-1].ticked)
            still.setdefault(stage.frame.phase, set()).add(stage.frame.digest + stage.frame.poses)

    note(3)
    stage.to_ready()
    note(5)
    stage.decide(d.Start())
    note(149)
    note(5)
    stage.decide(d.Halt())
    note(5)
    stage.decide(d.Declare("draw"))
    note(5)
    stage.decide(d.Official())
    note(5)
    frozen = (P.LOBBY, P.COUNTDOWN, P.HALTED, P.FINISHED, P.OFFICIAL)
    assert ran == {p: {p in (P.READY, P.PLAYING)} for p in (*frozen, P.READY, P.PLAYING)}
    assert all(len(still[phase]) == 1 for phase in frozen)
    assert len(still[P.PLAYING]) == len(still[P.READY]) == 5


def test_tick_9000_is_played_and_judged() -> None:
    """Rules 4, workshop 5-1 rule 2 and 5-2 rule 1: tick 9000, at 180 s, is the last one judged."""
    script = Script(poses={8999: {LEFT: (-0.15, -0.15)}, 9000: {LEFT: (0.15, -0.15)}})
    stage = Stage(script=script).to_playing()
    stage.until(P.FINISHED)
    assert (stage.match.ticks, stage.frame.clock_ticks) == (9000, 9000)
    assert stage.beats[-1].ticked
    flip = next(event for event in stage.events if event.kind == "flip")
    assert (flip.clock_ticks, flip.seat) == (9000, LEFT)
    assert stage.beats[-1].result is not None
    assert (stage.match.ended, stage.match.winner()) == (say("over.time"), "left")
    kinds = [event.kind for event in stage.beats[-1].events]
    assert kinds == ["flip", "phase", "result"]


def test_a_match_that_is_over_ends_at_once() -> None:
    """Rules 6, workshop 5-2 rule 4: the match ends in the tick that takes the fourth corner."""
    stage = Stage("flag-strike", script=_all_corners()).to_playing()
    stage.until(P.FINISHED)
    assert stage.frame.clock_ticks == 40
    assert stage.match.ended == say("over.all-corners", seat="left")


def test_all_corners_win_whatever_the_points_where_the_arena_says_so() -> None:
    """Rules 6: with `all_corners_win`, the robot with all corners wins, whatever its points are."""
    stage = Stage("flag-strike", {"game": {"all_corners_win": True}}, script=_all_corners())
    stage.to_playing()
    stage.until(P.FINISHED)
    stage.decide(d.Adjust("right", 30))
    assert (stage.scores, stage.match.winner()) == ((20, 30), "left")


def test_the_shortest_match_is_one_tick() -> None:
    """A match of 0.02 s ends after one tick."""
    stage = Stage(overrides={"match": {"duration_s": 0.02}}).to_playing()
    stage.until(P.FINISHED, at_most=5)
    assert (stage.match.ticks, stage.match.ended) == (1, say("over.time"))


def test_a_fault_halts_before_the_tick() -> None:
    """A fault of physics halts the match in its state before the faulty tick (docs/facts.md 3)."""
    script = Script(faults={4: Fault(RIGHT, say("fault.velocity"))})
    stage, twin = Stage(script=script).to_playing(), Stage().to_playing()
    stage.until(P.PLAYING)
    twin.until(P.PLAYING)
    stage.run(3)
    twin.run(2)
    assert stage.phase is P.HALTED
    assert not stage.beats[-1].ticked
    assert (stage.frame.poses, stage.frame.digest) == (twin.frame.poses, twin.frame.digest)
    fault = next(event for event in stage.events if event.kind == "fault")
    assert (fault.seat, fault.clock_ticks, fault.beat) == (RIGHT, 3, stage.frame.beat)
    stage.decide(d.Resume())
    stage.until(P.PLAYING)
    assert stage.frame.clock_ticks == 4


def test_a_fault_in_ready_goes_back_to_lobby() -> None:
    """After a fault in READY the match is in LOBBY, and both teams have to say ready again."""
    stage = Stage(script=Script(faults={5: Fault(LEFT, say("fault.contacts"))})).to_ready()
    stage.until(P.LOBBY, at_most=10)
    assert not any(seat.flags & SeatFlag.READY for seat in stage.frame.seats)


# Keys.


@pytest.mark.parametrize("phase", [p for p in P if p not in (P.CREATED, P.PLAYING)])
@pytest.mark.parametrize("digit", [FORWARD, X])
def test_keys_work_only_in_playing(phase: Phase, digit: int) -> None:
    """Rules 4: in every phase but PLAYING, keys are refused, and the answer says why."""
    stage, twin = Stage().to(phase), Stage().to(phase)
    outcome = stage.send(key(LEFT, digit, seq=7))
    twin.beat()
    assert outcome == Refusal(say("key.not-playing"))
    seat = stage.frame.seats[LEFT]
    assert (seat.refused_seq, seat.refused_why, seat.applied_seq) == (7, No.NOT_PLAYING, 0)
    was = twin.frame.seats[LEFT]
    assert (seat.level, seat.key, seat.score) == (was.level, was.key, was.score)
    assert (stage.frame.poses, stage.frame.digest) == (twin.frame.poses, twin.frame.digest)


def test_on_resume_each_drive_goes_on_where_it_stopped() -> None:
    """After a halt, a robot goes on with the same path as without the halt."""
    halted, straight = Stage().to(P.PLAYING), Stage().to(P.PLAYING)
    for stage in (halted, straight):
        stage.beat(key(LEFT, FORWARD))
        stage.run(29)
    halted.decide(d.Halt())
    halted.run(40)
    halted.decide(d.Resume())
    halted.until(P.PLAYING)
    straight.beat()
    for _ in range(50):
        assert halted.frame.poses == straight.frame.poses
        assert halted.frame.seats[LEFT].posture == straight.frame.seats[LEFT].posture
        halted.beat()
        straight.beat()


def test_seats_stay_as_they_are_in_play() -> None:
    """In play a team can't change its robot or take ready back, and it keeps a seat that it leaves.

    Another robot that it sends is for the next match.
    """
    stage = Stage().to(P.PLAYING)
    assert stage.send(join(LEFT)) == Done()
    changed = stage.send(join(LEFT, robot="quadruped"))
    assert isinstance(changed, Done)
    assert changed.said == say("note.files-next-match")
    assert stage.match.next_joins() == [join(LEFT, robot="quadruped"), join(RIGHT)]
    assert stage.match.sheet().seats[LEFT].robot == "Hexapod"
    assert isinstance(stage.send(ReadySeat(LEFT, False)), Refusal)
    left = stage.send(LeaveSeat(LEFT))
    assert isinstance(left, Done)
    assert stage.match.sheet().seats[LEFT].team == "Ants"


def test_a_team_that_joins_after_the_end_plays_in_the_next_match() -> None:
    """A team that joins after the end gets a seat in the next match, not in this one."""
    stage = Stage().to(P.LOBBY)
    stage.beat(LeaveSeat(RIGHT))
    stage.decide(d.Abort())
    answer = stage.send(join(RIGHT))
    assert isinstance(answer, Done)
    assert answer.said == say("note.next-match")
    assert stage.match.seats[RIGHT].join is None
    assert stage.match.next_joins() == [join(LEFT), join(RIGHT)]


@pytest.mark.parametrize("change", [LeaveSeat(RIGHT), ReadySeat(RIGHT, False)])
def test_start_is_refused_if_a_team_changes_its_mind_in_its_beat(change: Input) -> None:
    """If a team leaves or takes ready back in the beat of `start`, `start` is refused."""
    stage = Stage().to(P.READY)
    *_, started = stage.beat(change, decide(d.Start())).outcomes
    assert isinstance(started, Refusal)
    assert "right" in render(started.why)
    assert stage.phase is P.LOBBY
    stage.to_ready()
    *_, started = stage.beat(LeaveSeat(LEFT), LeaveSeat(RIGHT), decide(d.Start())).outcomes
    nobody = [say("why.nobody-in-seat", seat=seat) for seat in ("left", "right")]
    why = say("plain.sentences", sentences=nobody)
    assert started == Refusal(say("refused.decision", decision="start", why=why))


def test_practice_starts_by_itself_and_ends_when_everybody_has_left() -> None:
    """Rules 7, workshop 4-4: practice starts by itself, and ends when the contestant leaves."""
    stage = Stage("practice")
    stage.beat(join(LEFT), ReadySeat(LEFT, True))
    stage.run(1)
    assert stage.phase is P.PLAYING
    stage.run(10_000)
    assert stage.phase is P.PLAYING
    stage.beat(LeaveSeat(LEFT))
    assert stage.phase is P.FINISHED
    assert stage.match.ended == say("over.everybody-left")


READY = {"match": {"start": "ready", "countdown_s": 0.1, "unattended_s": 3.0}}
"""Settings of a match without a referee; it ends when nobody was heard for 3 s (150 beats)."""


@pytest.mark.parametrize("others", [[], [LeaveSeat(RIGHT)]])
def test_a_team_may_leave_in_the_countdown(others: list[LeaveSeat]) -> None:
    """Rules 7: a team may leave in the countdown; when all teams have left, the match ends."""
    stage = Stage(overrides=READY).to(P.READY)
    stage.beat()
    assert stage.phase is P.COUNTDOWN
    stage.beat(LeaveSeat(LEFT), *others)
    stage.run(10)
    assert stage.phase is (P.FINISHED if others else P.PLAYING)
    stage.beat(LeaveSeat(RIGHT))
    assert (stage.phase, stage.match.ended) == (P.FINISHED, say("over.everybody-left"))


@pytest.mark.parametrize("halted", [False, True])
def test_a_match_that_nobody_judges_ends_when_nobody_is_heard(halted: bool) -> None:
    """Rules 7: without a referee, a match ends when all seats are silent for `unattended_s`."""
    stage = Stage(overrides=READY).to_ready()
    stage.until(P.PLAYING)
    stage.beat(*([decide(d.Halt())] if halted else []))
    stage.beat(SilentSeat(LEFT))
    stage.run(200)
    stage.beat(SilentSeat(RIGHT))
    stage.run(148)
    stage.beat(HeardSeat(LEFT))  # without it, the match would end in this beat
    stage.beat(SilentSeat(LEFT))
    stage.run(148)
    assert stage.phase is (P.HALTED if halted else P.PLAYING)
    stage.beat()
    assert stage.phase is P.FINISHED
    assert stage.match.result().reason == say("over.nobody-heard", minutes=0.05)


def test_a_match_goes_on_if_a_team_comes_back() -> None:
    """A match without a referee goes on if a team comes back after all were silent."""
    stage = Stage(overrides=READY).to_ready()
    stage.until(P.PLAYING)
    stage.beat(LeaveSeat(LEFT), SilentSeat(RIGHT))
    stage.beat(join(LEFT), HeardSeat(LEFT))
    stage.run(300)
    assert stage.phase is P.PLAYING


@pytest.mark.parametrize(
    "match", [{"start": "referee"}, {"start": "ready", "unattended_s": 0.0, "duration_s": 0.0}]
)
def test_a_match_may_wait_for_ever(match: dict[str, object]) -> None:
    """A match with a referee, or with `unattended_s` = 0, does not end when all are silent."""
    stage = Stage(overrides={"match": {"unattended_s": 0.02, "countdown_s": 0.02, **match}})
    stage.to_playing()
    stage.beat(SilentSeat(LEFT), SilentSeat(RIGHT))
    stage.run(1000)
    assert stage.phase is P.PLAYING


def test_practice_ends_after_15_minutes_of_silence() -> None:
    """Rules 7: practice ends after 15 minutes of silence, and not after 14."""
    stage = Stage("practice").to_playing()
    stage.beat(SilentSeat(LEFT))
    for _ in range(14 * 60 * 50):
        stage.match.beat()
    assert stage.phase is P.PLAYING
    for _ in range(60 * 50):
        stage.match.beat()
    assert stage.match.ended == say("over.nobody-heard", minutes=15)


def test_a_match_with_a_referee_goes_on_though_everybody_has_left() -> None:
    """A match with a referee goes on even if both teams leave, and they keep their seats."""
    stage = Stage().to(P.PLAYING)
    stage.beat(LeaveSeat(LEFT), LeaveSeat(RIGHT))
    assert stage.phase is P.PLAYING
    flags = [seat.flags for seat in stage.frame.seats]
    assert flags == [SeatFlag.JOINED | SeatFlag.READY | SeatFlag.SILENT] * 2
    assert [seat.left for seat in stage.match.seats] == [True, True]
    stage.beat(join(LEFT))
    assert [seat.left for seat in stage.match.seats] == [False, True]


def test_an_illegal_decision_is_answered_and_changes_nothing_later() -> None:
    """An illegal decision is refused and does not change how the match goes on."""
    stage, twin = Stage().to(P.READY), Stage().to(P.READY)
    assert isinstance(stage.decide(d.Resume()), Refusal)
    twin.beat()
    for both in (stage, twin):
        assert isinstance(both.decide(d.Start()), DecisionReply)
        both.run(200)
    assert encode(stage.frame) == encode(twin.frame)
    assert encode(stage.events) == encode(twin.events)


def test_silence_and_hearing_are_only_told_once() -> None:
    """A silence that is reported twice is logged once, and so is the end of a silence."""
    stage = Stage().to(P.PLAYING)
    for item in (SilentSeat(LEFT), SilentSeat(LEFT), HeardSeat(LEFT), HeardSeat(LEFT)):
        stage.beat(item)
    assert [e.kind for e in stage.events if e.kind in ("silent", "heard")] == ["silent", "heard"]


def test_levels_begin_with_the_arenas_first() -> None:
    """Rules 3: a match begins with level B, and practice opens both levels."""
    stage = Stage().to(P.PLAYING)
    assert [seat.level for seat in stage.frame.seats] == [B, B]
    assert Stage("practice").match.rules.open_levels == (0, 1)
