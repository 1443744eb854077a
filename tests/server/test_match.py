"""Tests of seats in play: [x], silence, refused keys, the order of inputs, frames (rules 3, 4)."""

import math
import random
import struct
from itertools import pairwise

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stage import (
    FORWARD,
    LEFT,
    QUICK,
    RIGHT,
    STAND,
    TURN_LEFT,
    A,
    B,
    Script,
    Stage,
    X,
    decide,
    join,
    key,
)

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.inputs import HeardSeat, Input, KeySeat, LeaveSeat, SilentSeat
from lacoc_shared.messages import Done, Frame, Refusal
from lacoc_shared.seat import WHY_NO, No, Phase, SeatFlag
from lacoc_shared.words import say

P = Phase
LOCK_TICKS = 250
"""5 s of the clock, for which keys are refused after [x] (rules 3)."""
BOTH_LEVELS = {"match": {"levels": ["A", "B"], "countdown_s": 0.02}}


def at(frame: Frame, seat: int) -> tuple[float, ...]:
    """Return a hexapod's x, y, z, quaternion and joint angles from a frame."""
    return struct.unpack_from("<25f", frame.poses, seat * 100)


def playing(
    arena: str = "othello", script: Script | None = None, ticks: int = 1, **more: object
) -> Stage:
    stage = Stage(arena, more or QUICK, script=script).to_playing()
    stage.run(ticks)
    return stage


# [x]


def test_x_puts_the_robot_back_as_it_started() -> None:
    """Rules 3: [x] puts the robot back at its start place, in its start posture and at rest."""
    stage = Stage.real(overrides=QUICK).to(P.PLAYING)
    fresh = at(stage.beats[1].frame, LEFT)  # its first tick in READY
    stage.beat(key(LEFT, FORWARD))
    stage.run(150)
    walked = at(stage.frame, LEFT)
    assert math.dist(walked[:2], fresh[:2]) > 0.05
    stage.beat(key(LEFT, X, seq=2))
    assert at(stage.frame, LEFT) == pytest.approx(fresh, abs=2e-6)
    seat = stage.frame.seats[LEFT]
    assert (seat.level, seat.key, seat.posture) == (B, STAND, 0)
    assert stage.match.seats[LEFT].state.angles == stage.match.seats[LEFT].entry.robot.start_posture
    said = next(event.said for event in stage.events if event.kind == "restart")
    assert said == say("event.restarted", team="Ants")
    stage.run(50)
    assert math.dist(at(stage.frame, LEFT)[:2], fresh[:2]) < 0.01


def test_x_keeps_the_level() -> None:
    """[x] keeps the level of the seat, even if the command names the other level."""
    stage = playing(**BOTH_LEVELS)
    for seat, level in ((LEFT, B), (RIGHT, A)):
        stage.beat(key(seat, 3, level=level))
        stage.beat(key(seat, X, seq=2, level=1 - level))
    assert [(s.level, s.key) for s in stage.frame.seats] == [(B, 0), (A, 0)]


def test_x_locks_for_5_s_of_clock() -> None:
    """Rules 3: after [x], digits and [x] are refused for 5 s of the clock."""
    stage = playing(ticks=3)
    stage.beat(key(LEFT, X, seq=1))
    assert stage.frame.seats[LEFT].locked_ticks == LOCK_TICKS - 1
    assert stage.send(key(LEFT, FORWARD, seq=2)) == Refusal(say("key.restarted"))
    assert stage.send(key(LEFT, X, seq=3)) == Refusal(say("key.restarted"))
    assert stage.send(key(RIGHT, FORWARD, seq=1)) == Done()
    stage.decide(d.Halt())
    stage.run(300)  # the clock stands still
    stage.decide(d.Resume())
    stage.until(P.PLAYING)
    while stage.frame.seats[LEFT].locked_ticks:
        assert stage.send(key(LEFT, FORWARD, seq=4)) == Refusal(say("key.restarted"))
    assert stage.match.ticks == 3 + LOCK_TICKS
    assert stage.send(key(LEFT, FORWARD, seq=5)) == Done()


def test_the_lock_is_a_setting() -> None:
    """The lock of 5 s after [x] is a setting; in the arena practice it is 0."""
    stage = playing(match={"restart_freeze_s": 0.1, "countdown_s": 0.02})
    stage.beat(key(LEFT, X))
    stage.run(4)
    assert stage.send(key(LEFT, FORWARD, seq=2)) == Done()
    practice = Stage("practice").to_playing(join(0))
    practice.run(2)
    inputs = [key(0, FORWARD, seq=3), key(0, X, seq=2)]
    assert practice.beat(*inputs).outcomes == (Done(), Done())
    assert practice.frame.seats[0].key == FORWARD
    assert practice.frame.seats[0].applied_seq == 3


def test_x_comes_before_the_digit_of_its_tick() -> None:
    """Rules 3: in one tick [x] takes effect before a digit, so the digit is refused."""
    stage = playing(ticks=2)
    beat = stage.beat(key(LEFT, FORWARD, seq=2), key(LEFT, X, seq=1))
    assert beat.outcomes == (Refusal(say("key.restarted")), Done())
    seat = stage.frame.seats[LEFT]
    assert (seat.key, seat.applied_seq, seat.refused_seq) == (STAND, 1, 2)


def test_x_works_for_a_robot_on_its_back() -> None:
    """Rules 3: [x] also works when the robot lies on its back."""
    stage = Stage.real(overrides=QUICK).to(P.PLAYING)
    world = stage.match.physics
    robot = world.robots[LEFT]
    world.data.qpos[robot.root_qpos + 2] = 0.2
    world.data.qpos[robot.root_qpos + 3 : robot.root_qpos + 7] = 0.0, 1.0, 0.0, 0.0
    stage.run(50)
    _, qx, qy, _ = at(stage.frame, LEFT)[3:7]
    assert 1 - 2 * (qx * qx + qy * qy) < -0.9
    assert stage.send(key(LEFT, X)) == Done()
    stage.run(25)
    assert at(stage.frame, LEFT)[3:7] == pytest.approx(
        at(stage.beats[1].frame, LEFT)[3:7], abs=0.01
    )


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
@pytest.mark.parametrize("taken", [0, 1, 2])
def test_the_first_free_start_place_is_used(arena: str, taken: int) -> None:
    """Rules 3: [x] takes the first start place that is far enough from the other robot."""
    starts = arenas.load(arena).game.starts[LEFT]
    # The other robot stands so that the first `taken` places are too near, and no others.
    near = {
        ("othello", 0): (0.5, 0.5),
        ("othello", 1): (starts[0].x_m - 0.1, starts[0].y_m - 0.06),
        ("othello", 2): (starts[0].x_m, 0.0),
        ("flag-strike", 0): (0.5, 0.5),
        ("flag-strike", 1): (starts[0].x_m + 0.2, 0.0),
        ("flag-strike", 2): (starts[0].x_m, 0.2),
    }[arena, taken]
    free = [place for place in starts if math.dist(place[:2], near) >= 0.35]
    stage = playing(arena, Script(poses={1: {RIGHT: near, LEFT: (0.0, 0.9)}}), ticks=2)
    stage.beat(key(LEFT, X))
    assert at(stage.frame, LEFT)[:2] == pytest.approx(free[0][:2])
    assert taken == 0 or free[0] != starts[0]


def test_a_wide_robot_needs_more_room() -> None:
    """[x] skips a start place whose distance to the other robot is below the sum of both radii."""
    radii = {}
    for robot in ("hexapod", "long-legs"):
        stage = Stage("flag-strike", QUICK)
        stage.to_playing(join(LEFT, robot=robot), join(RIGHT, robot=robot))
        radii[robot] = sum(s.entry.robot.radius_m for s in stage.match.seats if s.entry)
    assert radii["hexapod"] < radii["long-legs"]
    between = (0.35 + radii["long-legs"]) / 2
    assert between > max(0.35, radii["hexapod"])
    for robot, place in (("hexapod", (-0.6, 0.0)), ("long-legs", (-0.6, 0.4))):
        other = (-0.6 + between, -0.1)
        stage = Stage("flag-strike", QUICK, script=Script(poses={1: {RIGHT: other}}))
        stage.to_playing(join(LEFT, robot=robot), join(RIGHT, robot=robot))
        stage.run(2)
        stage.beat(key(LEFT, X))
        assert struct.unpack_from("<2f", stage.frame.poses) == pytest.approx(place), robot


def test_both_restart_at_once() -> None:
    """If both seats press [x] in one tick, each gets its first place, whichever key comes first."""
    for order in ((LEFT, RIGHT), (RIGHT, LEFT)):
        swapped = {LEFT: (0.6, 0.0), RIGHT: (-0.6, 0.0)}
        stage = playing("flag-strike", Script(poses={1: swapped}), ticks=2)
        stage.beat(*(key(seat, X) for seat in order))
        assert at(stage.frame, LEFT)[:2] == pytest.approx((-0.6, 0.0))
        assert at(stage.frame, RIGHT)[:2] == pytest.approx((0.6, 0.0))


@pytest.mark.parametrize(("other_y_m", "roomiest_y_m"), [(-0.05, 0.1), (0.15, 0.0)])
def test_if_no_place_is_free_the_farthest_is_used(other_y_m: float, roomiest_y_m: float) -> None:
    """If no start place is free, [x] takes the one that is farthest from the other robot."""
    one = {"game": {"starts": [[-0.6, 0.0], [-0.6, 0.1]]}, "match": {"countdown_s": 0.02}}
    script = Script(poses={1: {RIGHT: (-0.6, other_y_m)}})
    stage = Stage("flag-strike", one, script=script).to_playing()
    stage.run(2)
    stage.beat(key(LEFT, X))
    assert at(stage.frame, LEFT)[:2] == pytest.approx((-0.6, roomiest_y_m))


def test_being_put_back_claims_nothing() -> None:
    """Rules 5: the disc on which [x] puts a robot becomes its last disc, and nothing flips."""
    own = (-0.75, -0.15)
    script = Script(poses={1: {LEFT: (-0.15, -0.15)}, 2: {LEFT: own}})
    stage = playing(script=script, ticks=3)
    stage.beat(key(LEFT, X))
    assert stage.match.history.state.last[LEFT] == 12
    assert stage.numbers("flip") == []


def test_being_put_back_is_no_walk() -> None:
    """Rules 5: a robot that [x] puts on a disc of the other colour flips nothing."""
    script = Script(poses={1: {LEFT: (-0.45, -0.15)}})
    stage = playing(script=script, ticks=3)
    stage.beat(decide(d.Set("c0r2", "right")))
    stage.beat(key(LEFT, X))
    assert stage.match.history.state.last[LEFT] == 12
    assert (stage.board["c0r2"], stage.numbers("flip")) == ("right", [])


def _postures(stage: Stage, ticks: int) -> list[int]:
    """Press forward for the left seat; return the index of the seat's posture in each tick."""
    stage.beat(key(LEFT, FORWARD))
    stage.run(ticks)
    return [beat.frame.seats[LEFT].posture for beat in stage.beats[-ticks - 1 :]]


@pytest.mark.parametrize("repeat", [True, False])
def test_the_arena_says_whether_sequences_repeat(repeat: bool) -> None:
    """The arena's setting `repeat` says whether a sequence repeats or runs once."""
    walked = _postures(playing(match={"repeat": repeat, "countdown_s": 0.02}), 600)
    assert (max(walked) > 0, 0 in walked[-300:]) == (True, repeat)


def test_the_robot_file_says_how_a_sequence_goes_on() -> None:
    """Rules 3: with advance = "time" in the robot file, each posture lasts hold_s."""
    _, data = find_robot("hexapod")
    by_time = data.replace(b'advance = "reached"', b'advance = "time"')
    by_time = by_time.replace(b"hold_s = 0.0", b"hold_s = 0.1")
    assert by_time != data
    stage = Stage(overrides=QUICK).to_playing(join(LEFT, robot_file=by_time), join(RIGHT))
    stage.run(2)
    length = stage.match.sheet().seats[LEFT].postures[FORWARD]
    assert _postures(stage, 99) == [tick // 5 % length for tick in range(100)]


# Silence, and refused keys.


def test_a_silent_seat_stands_until_a_new_command() -> None:
    """Rules 3: the robot of a silent seat stands until the seat sends a new command."""
    stage = playing(ticks=1)
    stage.beat(key(LEFT, FORWARD, seq=5))
    stage.run(30)
    stage.beat(SilentSeat(LEFT))
    seat = stage.frame.seats[LEFT]
    assert (seat.key, seat.level, bool(seat.flags & SeatFlag.SILENT)) == (STAND, B, True)
    assert not stage.frame.seats[RIGHT].flags & SeatFlag.SILENT
    stage.beat(HeardSeat(LEFT))
    seat = stage.frame.seats[LEFT]
    assert (seat.key, seat.flags & SeatFlag.SILENT) == (STAND, 0)
    stage.beat(key(LEFT, TURN_LEFT, seq=6))
    assert stage.frame.seats[LEFT].key == TURN_LEFT


def test_a_team_that_leaves_in_play_keeps_its_seat() -> None:
    """A team that leaves during play can come back to its seat; meanwhile its robot stands."""
    stage = playing(ticks=1)
    stage.beat(key(LEFT, FORWARD))
    stage.beat(LeaveSeat(LEFT))
    assert stage.frame.seats[LEFT].key == STAND
    stage.beat(join(LEFT), HeardSeat(LEFT), key(LEFT, FORWARD, seq=2))
    assert stage.frame.seats[LEFT].key == FORWARD


@pytest.mark.parametrize(
    ("item", "why"),
    [
        (key(LEFT, FORWARD, level=A), No.LEVEL_CLOSED),
        (key(LEFT, FORWARD, level=9), No.LEVEL_CLOSED),
        (key(LEFT, 4), No.NO_SUCH_KEY),
        (key(LEFT, 9), No.NO_SUCH_KEY),
        (key(LEFT, -1), No.NO_SUCH_KEY),
        (key(LEFT, 11), No.NO_SUCH_KEY),
    ],
)
def test_refused_keys(item: KeySeat, why: No) -> None:
    """A key of a closed level, or one that the gait lacks, is refused and changes nothing."""
    stage, twin = playing(ticks=3), playing(ticks=3)
    for both in (stage, twin):
        both.beat(key(LEFT, TURN_LEFT, seq=1))
    assert stage.send(KeySeat(LEFT, 2, item.level, item.key)) == Refusal(WHY_NO[why])
    twin.beat()
    seat, was = stage.frame.seats[LEFT], twin.frame.seats[LEFT]
    assert (seat.refused_seq, seat.refused_why) == (2, why)
    assert (seat.key, seat.posture, seat.applied_seq) == (was.key, was.posture, was.applied_seq)
    assert stage.frame.poses == twin.frame.poses


def test_each_level_has_its_own_keys() -> None:
    """Rules 3: the keys of level A come from Loco-data, and those of level B from LocoTra-data."""
    stage = playing(**BOTH_LEVELS)
    entry = stage.match.seats[LEFT].entry
    assert entry is not None
    for seq, digit in enumerate(range(10), start=1):
        for level in (A, B):
            there = digit in entry.gait.keys(level)
            stage.beat(key(LEFT, digit, seq=2 * seq + level, level=level))
            seat = stage.frame.seats[LEFT]
            assert ((seat.level, seat.key) == (level, digit)) is there
    assert entry.gait.keys(A) != entry.gait.keys(B)


def test_frames_tell_which_command_was_applied_when() -> None:
    """A frame has each seat's newest applied command and the beat in which it took effect."""
    stage = playing(ticks=3)
    beat = stage.beat(key(LEFT, FORWARD, seq=41))
    stage.run(5)
    seat = stage.frame.seats[LEFT]
    assert (seat.applied_seq, seat.applied_beat) == (41, beat.frame.beat)


# The order of inputs in a beat.

seats = st.sampled_from([LEFT, RIGHT])


def _beat_of_inputs() -> st.SearchStrategy[list[Input]]:
    """Draw the inputs of one beat: [x], a digit and a silence of each seat, and a freeze."""

    def of(seat: int) -> st.SearchStrategy[list[Input]]:
        return st.tuples(
            st.lists(st.just(key(seat, X, seq=8)), max_size=1),
            st.lists(st.integers(0, 4).map(lambda n: key(seat, n, seq=9)), max_size=1),
            st.lists(st.just(SilentSeat(seat)), max_size=1),
        ).map(lambda parts: [item for part in parts for item in part])

    frozen = st.lists(st.just(decide(d.Freeze("left", 1.0))), max_size=1)
    return st.tuples(of(LEFT), of(RIGHT), frozen).map(lambda parts: [i for p in parts for i in p])


@pytest.mark.slow
@given(_beat_of_inputs(), st.randoms(use_true_random=False))
def test_the_order_of_arrival_favours_no_seat(inputs: list[Input], mix: random.Random) -> None:
    """Rules 4: frames do not depend on the order in which a beat's inputs arrived."""
    shuffled = list(inputs)
    mix.shuffle(shuffled)
    one, other = playing(ticks=2), playing(ticks=2)
    one.beat(*inputs)
    other.beat(*shuffled)
    for _ in range(3):
        assert encode(one.frame) == encode(other.frame)
        one.beat()
        other.beat()


def test_the_order_of_a_beat_is_that_of_its_kinds() -> None:
    """A beat takes requests first, then silences, decisions, [x] and digits."""
    stage = playing(ticks=2)
    freeze = decide(d.Freeze("right", 1.0))
    inputs = (key(RIGHT, FORWARD), key(LEFT, X), freeze, SilentSeat(RIGHT), join(RIGHT))
    beat = stage.beat(*inputs)
    told = [(event.kind, event.seat) for event in beat.events]
    assert told == [("join", RIGHT), ("silent", RIGHT), ("decision", -1), ("restart", LEFT)]
    assert beat.outcomes[0] == Refusal(say("key.frozen"))
    for later, earlier in pairwise(inputs):
        one, other = playing(ticks=2), playing(ticks=2)
        one.beat(later, earlier)
        other.beat(earlier, later)
        assert encode(one.events) == encode(other.events)


def test_decisions_come_before_keys() -> None:
    """If a key arrives in the beat of a halt, the key is refused."""
    stage = playing(ticks=2)
    beat = stage.beat(key(LEFT, FORWARD), decide(d.Halt()))
    assert isinstance(beat.outcomes[0], Refusal)
    assert stage.phase is P.HALTED


def test_a_key_takes_effect_in_its_tick() -> None:
    """A key moves the robot's joints in the tick in which it is taken."""
    stage = playing(ticks=2)
    before = at(stage.frame, LEFT)[7:]
    stage.beat(key(LEFT, FORWARD))
    moved = [abs(b - a) for a, b in zip(before, at(stage.frame, LEFT)[7:], strict=True)]
    assert max(moved) == pytest.approx(math.radians(2.4), abs=1e-6)


# Frames.


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_a_frame_has_at_most_320_bytes(arena: str) -> None:
    """A frame of two hexapods has at most 320 bytes in every phase (docs/protocol.md, Frame)."""
    sizes = {}
    for phase in list(P)[1:]:
        stage = Stage.real(arena, QUICK if phase is not P.COUNTDOWN else None)
        stage.match.beats = 10_000_000  # two days
        stage.match.setup = msgspec.structs.replace(stage.match.setup, match=100_000)
        stage.to(phase)
        seq = 2**31
        stage.beat(key(LEFT, X, seq=seq), key(RIGHT, X, seq=seq))
        stage.beat(key(LEFT, 1, seq=seq), key(RIGHT, 1, seq=seq))
        sizes[phase.name] = len(encode(stage.frame))
    assert max(sizes.values()) <= 320, sizes


def test_scores_and_board_are_in_every_frame() -> None:
    """Rules 5: after a flip, a frame has the new board and the new scores (numbers of discs)."""
    script = Script(poses={1: {LEFT: (-0.15, -0.15)}, 3: {LEFT: (0.15, -0.15)}})
    stage = playing(script=script, ticks=3)
    assert stage.scores == (19, 17)
    assert stage.board["c3r2"] == "left"


def test_a_touch_is_recorded_only_where_there_is_one() -> None:
    """A beat records a touch only if a robot touches a marker or is put on a start place."""
    script = Script(touches={3: {RIGHT: (4, 9)}})
    stage = playing("flag-strike", script, ticks=4)
    stage.beat(key(LEFT, X))
    stage.run(3)  # one [x] gives one touch
    noted = {b.frame.clock_ticks: b.touch for b in stage.beats if b.touch}
    assert noted[3].touched == ((), (4, 9))
    assert noted[5].placed == ((-0.6, 0.0, 0.0), None)
    assert set(noted) == {3, 5}
    assert stage.scores[RIGHT] > 0
