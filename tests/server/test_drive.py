"""Tests of the drive: commanded angles tick by tick, compared with tables (rules 3)."""

import math
import struct
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.match.drive import Drive, DriveState
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture, PostureTable

A, B = Level.POSTURE, Level.LOCOMOTION
ANG_MIN = math.radians(120)
STEP_DEG = 2.4
"""The largest move of a commanded angle in a tick of 20 ms, at 120 degrees/s (rules 1)."""


def posture(*degrees: float) -> Posture:
    return tuple(math.radians(angle) for angle in degrees)


def drive(
    *keys: tuple[float, ...],
    advance: str = "reached",
    hold_s: float = 0.0,
    repeat: bool = True,
    start: float = 0.0,
    postures: dict[int, float] | None = None,
) -> Drive:
    """Return a drive of one joint with sequences for level B and postures for level A [degrees]."""
    table = LocomotionTable(tuple(tuple(posture(angle) for angle in key) for key in keys))
    return Drive(
        Gait(
            PostureTable({k: posture(v) for k, v in postures.items()}) if postures else None,
            table if keys else None,
        ),
        posture(start),
        ANG_MIN,
        "time" if advance == "time" else "reached",
        round(hold_s * 1e6),
        repeat,
    )


def ticks(it: Drive, state: DriveState, count: int) -> list[DriveState]:
    states = []
    for _ in range(count):
        state = it.tick(state)
        states.append(state)
    return states


def targets(it: Drive, state: DriveState, count: int) -> list[int]:
    """Return the index of the target posture in each of the next ticks."""
    return [state.posture for state in ticks(it, state, count)]


@pytest.mark.parametrize(
    ("degrees", "needed"), [(45, 19), (-45, 19), (24, 10), (2.4, 1), (2.5, 2), (0.1, 1), (150, 63)]
)
def test_a_move_takes_whole_ticks(degrees: float, needed: int) -> None:
    """Rules 3: an angle moves by at most 2.4 degrees in a tick, so 45 degrees take 19 ticks."""
    it = drive((0.0,), (degrees,))
    states = ticks(it, it.press(it.begin(B), B, 1), needed)
    assert states[-1].angles == posture(degrees)
    assert all(state.angles != posture(degrees) for state in states[:-1])


def test_no_remainder_is_carried() -> None:
    """When a posture is reached within a tick, the next one begins only in the next tick."""
    it = drive((0.0,), (3.0, 6.0))
    angles = [s.angles[0] for s in ticks(it, it.press(it.begin(B), B, 1), 4)]
    assert angles == pytest.approx([math.radians(a) for a in (2.4, 3.0, 5.4, 6.0)])


def test_all_joints_move_at_once_and_wait_for_the_last() -> None:
    """Rules 3: the next posture begins when the commanded angles of all joints have arrived."""
    it = Drive(
        Gait(None, LocomotionTable(((posture(0, 0),), (posture(2.4, -7.2), posture(0, 0))))),
        posture(0, 0),
        ANG_MIN,
        "reached",
        0,
        True,
    )
    states = ticks(it, it.press(it.begin(B), B, 1), 4)
    assert [s.posture for s in states] == [0, 0, 0, 1]
    assert states[0].angles == pytest.approx(posture(2.4, -2.4))
    assert states[2].angles == posture(2.4, -7.2)
    assert states[3].angles == pytest.approx(posture(0, -4.8))


@pytest.mark.parametrize(
    ("hold_s", "expected"),
    [
        (0.0, [0, 0, 1, 1, 0, 0]),
        (0.02, [0, 0, 0, 1, 1, 1, 0]),
        (0.05, [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0]),  # ceil(2.5) = 3 further ticks
        (0.06, [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0]),
    ],
)
def test_reached(hold_s: float, expected: list[int]) -> None:
    """With "reached", the next posture begins 1 + ceil(hold_s / 0.02) ticks after the arrival."""
    it = drive((0.0,), (4.8, 0.0), hold_s=hold_s)
    assert targets(it, it.press(it.begin(B), B, 1), len(expected)) == expected


def test_at_most_one_posture_a_tick() -> None:
    """Rules 3: the target changes at most once a tick, even if all postures are equal."""
    it = drive((0.0,), (0.0, 0.0, 0.0))
    assert targets(it, it.press(it.begin(B), B, 1), 7) == [0, 1, 2, 0, 1, 2, 0]


@pytest.mark.parametrize("hold_s", [0.02, 0.05, 0.09, 0.2, 0.33])
def test_time(hold_s: float) -> None:
    """With "time", posture n (from 0) begins n * hold_s after the key, rounded up to a tick."""
    it = drive((0.0,), (45.0, -45.0, 30.0), advance="time", hold_s=hold_s)
    expected = [k * 20_000 // round(hold_s * 1e6) % 3 for k in range(400)]
    assert targets(it, it.press(it.begin(B), B, 1), 400) == expected


def test_time_does_not_wait_for_arrival() -> None:
    """With "time", the next posture begins even if the joint has not arrived."""
    it = drive((0.0,), (45.0, -45.0), advance="time", hold_s=0.2)
    degrees = [math.degrees(s.angles[0]) for s in ticks(it, it.press(it.begin(B), B, 1), 40)]
    assert max(degrees) == pytest.approx(24.0)
    assert min(degrees) == pytest.approx(0.0)


@pytest.mark.parametrize(("advance", "hold_s"), [("reached", 0.0), ("time", 0.04)])
def test_without_repeat_the_last_posture_holds(advance: str, hold_s: float) -> None:
    """Without `repeat` a sequence runs once and holds its end; the same digit starts it again."""
    it = drive((0.0,), (2.4, 4.8), advance=advance, hold_s=hold_s, repeat=False)
    states = ticks(it, it.press(it.begin(B), B, 1), 300)
    assert [s.posture for s in states][-200:] == [1] * 200
    assert states[-1].angles == posture(4.8)
    again = it.tick(it.press(states[-1], B, 1))
    assert (again.posture, again.angles) == (0, pytest.approx(posture(2.4)))


@pytest.mark.parametrize(("advance", "hold_s"), [("reached", 0.0), ("time", 0.1)])
def test_with_repeat_the_same_command_changes_nothing(advance: str, hold_s: float) -> None:
    """Rules 3: pressing the same key again changes nothing while its sequence repeats."""
    it = drive((0.0,), (24.0, -24.0), advance=advance, hold_s=hold_s)
    state = pressed = it.press(it.begin(B), B, 1)
    for _ in range(60):
        state, pressed = it.tick(state), it.tick(it.press(pressed, B, 1))
        assert pressed == state


def test_the_other_level_is_another_command() -> None:
    """The same digit at the other level is a new command and starts its own sequence."""
    it = drive((0.0,), (4.8, 0.0), postures={0: 0.0, 1: 12.0})
    state = ticks(it, it.press(it.begin(B), B, 1), 3)[-1]
    assert state.posture == 1
    state = it.press(state, A, 1)
    assert (state.level, state.digit, state.posture) == (A, 1, 0)
    assert ticks(it, state, 4)[-1].angles == posture(12.0)
    back = it.tick(it.press(state, B, 1))
    assert (back.level, back.digit, back.posture) == (B, 1, 0)


@pytest.mark.parametrize("advance", ["reached", "time"])
def test_a_key_starts_at_its_first_posture_at_once(advance: str) -> None:
    """A new digit's sequence begins with its first posture, in the tick of the key."""
    it = drive((0.0,), (24.0, 0.0), (-24.0, 0.0), advance=advance, hold_s=0.1)
    state = ticks(it, it.press(it.begin(B), B, 1), 17)[-1]
    angle = state.angles[0]
    state = it.tick(it.press(state, B, 2))
    assert state.posture == 0
    assert state.angles[0] == pytest.approx(angle - math.radians(STEP_DEG))


def test_level_a_holds_its_posture() -> None:
    """Rules 3: at level A, every joint moves to its angle in the key's posture and stays there."""
    it = drive(postures={0: 0.0, 5: 45.0})
    states = ticks(it, it.press(it.begin(A), A, 5), 100)
    assert [s.angles == posture(45.0) for s in states] == [False] * 18 + [True] * 82
    assert {s.posture for s in states} == {0}


@pytest.mark.parametrize("level", [A, B])
def test_key_0_is_the_start_posture_where_the_file_lacks_it(level: Level) -> None:
    """If a gait has no key 0, pressing 0 moves the robot to its start posture."""
    it = drive(postures={3: 24.0}, start=12.0)
    state = ticks(it, it.press(it.begin(A), A, 3), 10)[-1]
    assert state.angles == posture(24.0)
    assert ticks(it, it.press(state, level, 0), 5)[-1].angles == posture(12.0)
    assert not it.has(level, 0)


def test_begin_is_the_start_posture_with_key_0() -> None:
    """A drive begins with key 0 and with commanded angles equal to the start posture."""
    it = drive((24.0,), (45.0,), start=12.0)
    state = it.begin(B)
    assert (state.level, state.digit, state.angles) == (B, 0, posture(12.0))
    assert ticks(it, state, 5)[-1].angles == posture(24.0)


@pytest.mark.parametrize("advance", ["reached", "time"])
def test_who_is_told_to_stand_takes_one_posture(advance: str) -> None:
    """Rules 3: a robot that stands holds the first posture of key 0, even if key 0 has several."""
    it = drive((24.0, -24.0), (45.0, 0.0), advance=advance, hold_s=0.04)
    walking = it.tick(it.press(it.begin(B), B, 1))
    for state in (it.begin(B), it.stand(walking), it.stand(it.press(walking, B, 0))):
        states = ticks(it, state, 60)
        assert {(s.level, s.digit, s.posture) for s in states} == {(B, 0, 0)}
        assert states[-1].angles == posture(24.0)
    assert it.stand(states[-1]) is states[-1]


@pytest.mark.parametrize("repeat", [True, False])
def test_key_0_of_who_stands_begins_its_sequence(repeat: bool) -> None:
    """Rules 3: if key 0 is pressed while a robot stands, the whole sequence of key 0 begins."""
    it = drive((24.0, -24.0, 0.0), (0.0,), advance="time", hold_s=0.04, repeat=repeat)
    pressed = it.press(it.tick(it.begin(B)), B, 0)
    assert targets(it, pressed, 6) == [0, 0, 1, 1, 2, 2]
    assert (it.press(pressed, B, 0) is pressed) is repeat


def test_which_keys_do_something() -> None:
    """A key does something only if the table of its level has it."""
    it = drive((0.0,), (45.0,), postures={0: 0.0, 9: 45.0})
    assert [digit for digit in range(-1, 12) if it.has(A, digit)] == [0, 9]
    assert [digit for digit in range(-1, 12) if it.has(B, digit)] == [0, 1]


angles = st.floats(-150, 150).map(lambda angle: round(angle, 3))
postures = st.tuples(angles, angles)
presses = st.lists(
    st.tuples(st.integers(1, 40), st.sampled_from([A, B]), st.integers(0, 2)), max_size=6
)


@st.composite
def drives(draw: st.DrawFn) -> Drive:
    by_time = draw(st.booleans())
    keys = st.lists(st.lists(postures, min_size=1, max_size=4), min_size=3, max_size=3)
    return Drive(
        Gait(
            PostureTable({digit: posture(*draw(postures)) for digit in range(3)}),
            LocomotionTable(tuple(tuple(posture(*p) for p in key) for key in draw(keys))),
        ),
        posture(*draw(postures)),
        math.radians(draw(st.floats(1, 240))),
        "time" if by_time else "reached",
        draw(st.integers(20_000 if by_time else 0, 300_000)),
        draw(st.booleans()),
    )


def path(it: Drive, script: list[tuple[int, Level, int]]) -> list[DriveState]:
    states = [it.begin(B)]
    for wait, level, digit in script:
        states += ticks(it, states[-1], wait)
        states.append(it.press(states[-1], level, digit))
    return states + ticks(it, states[-1], 40)


@given(drives(), presses)
def test_never_faster_than_ang_min_and_the_same_again(
    it: Drive, script: list[tuple[int, Level, int]]
) -> None:
    """No angle moves faster than AngMin; the same keys give the same angles again."""
    states = path(it, script)
    step = it._step_rad * (1 + 1e-8)
    for before, now in pairwise(states):
        moves = [abs(b - a) for a, b in zip(before.angles, now.angles, strict=True)]
        assert max(moves) <= step
    assert path(it, script) == states


@given(drives(), presses, st.integers(0, 2))
def test_angles_end_exactly_at_the_target(
    it: Drive, script: list[tuple[int, Level, int]], digit: int
) -> None:
    """The commanded angles reach a posture exactly, without a rounding error."""
    state = it.press(path(it, script)[-1], A, digit)
    needed = math.ceil(math.radians(300) / it._step_rad) + 1
    held = ticks(it, state, needed)[-1]
    assert held.angles == it._gait.sequence(A, digit)[0]  # type: ignore[index]


@given(drives(), presses)
def test_a_kept_tick_is_the_tick(it: Drive, script: list[tuple[int, Level, int]]) -> None:
    """A result that the drive has kept has the bits of a new one."""
    for state in path(it, script):
        kept, new = it.tick(state), it._tick(state)
        assert kept == new
        assert struct.pack("2d", *kept.angles) == struct.pack("2d", *new.angles)
