"""Tests of trials: a robot walks with the court's own physics and drive, and is measured."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from every_third import every_third
from faulty_tables import FAULTS, tell
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_walks import ROBOTS, entry_of, match_digests

from lacoc_robots.library import find_robot
from lacoc_robots.reading import load_gait
from lacoc_server.match.entry import weigh_in
from lacoc_server.trial.bars import foot_bars
from lacoc_server.trial.course import CYCLES, NO_CYCLE_S, SETTLE_TICKS, Course
from lacoc_server.trial.feet import feet_down, phases
from lacoc_server.trial.figures import measure
from lacoc_server.trial.keys import forward_key, parse_keys
from lacoc_server.trial.reasons.explain import explain
from lacoc_server.trial.support import hull, margin_m
from lacoc_server.trial.walk import Press, Span, Walk
from lacoc_server.world.sensed import make_course
from lacoc_shared.command import cli
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable
from lacoc_shared.gait.text import write_gait
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render

SAMPLE = Path(__file__).parents[2] / "robots/lacoc_robots/samples/hexapod/Loco-data.txt"


@pytest.fixture(scope="module")
def courses() -> dict[str, Course]:
    """Map each sample robot's name to its course: a floor for the robot's trials."""
    return {name: make_course(entry_of(name).robot) for name in ROBOTS}


@pytest.fixture(scope="module")
def sample(courses: dict[str, Course]) -> Walk:
    """Give a trial of the workshop's robot with key 2 (forward) of its sample gait."""
    gait = load_gait(SAMPLE, entry_of("hexapod").robot)
    return courses["hexapod"].walk(gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, 2)])


@st.composite
def tables(draw: st.DrawFn, robot: str) -> Gait:
    """Draw a gait of one to four keys: angles in whole degrees, within 60 of the start posture."""
    start = entry_of(robot).robot.start_posture
    ranges = entry_of(robot).robot.ranges_rad
    turn = st.integers(-60, 60)
    posture = st.lists(turn, min_size=len(start), max_size=len(start)).map(
        lambda turns: tuple(
            min(max(math.radians(round(math.degrees(angle)) + by), low), high)
            for angle, by, (low, high) in zip(start, turns, ranges, strict=True)
        )
    )
    sequence = st.lists(posture, min_size=1, max_size=4).map(tuple)
    return Gait(None, LocomotionTable(tuple(draw(st.lists(sequence, min_size=1, max_size=4)))))


@pytest.mark.slow
@pytest.mark.parametrize("robot", every_third(ROBOTS))
@settings(max_examples=5)  # benchmarks/trials.py tries a thousand
@given(data=st.data())
def test_a_trial_is_what_a_court_would_do(
    courses: dict[str, Course], robot: str, data: st.DataObject
) -> None:
    """After every tick, a trial with sensors has the same state hash as a match without them."""
    gait = data.draw(tables(robot))
    assert gait.locomotion is not None
    # A match reads its gait from a file, which has whole degrees; the trial gets the same angles.
    sent = SentFile("LocoTra-data.txt", write_gait(gait.locomotion, entry_of(robot).robot.labels))
    gait = weigh_in(SentFile(*find_robot(robot)), None, sent).gait
    keys = data.draw(st.lists(st.integers(0, len(gait.keys(Level.LOCOMOTION)) - 1), min_size=1))
    gap = data.draw(st.integers(1, 40))
    presses = [
        Press(SETTLE_TICKS + gap * index, Level.LOCOMOTION, key)
        for index, key in enumerate(keys[:4])
    ]
    walk = courses[robot].walk(gait, presses, 1.0)
    assert len(walk.digests) == presses[-1].tick + 50 or walk.fault is not None
    ticks = len(walk.digests)
    assert list(walk.digests) == match_digests(robot, sent, presses, ticks)


def test_a_trial_can_be_repeated(courses: dict[str, Course], sample: Walk) -> None:
    """A trial gives the same states again, even after another trial on the same floor."""
    gait = load_gait(SAMPLE, entry_of("hexapod").robot)
    courses["hexapod"].walk(gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, 1)], 1.0)
    again = courses["hexapod"].walk(gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, 2)])
    assert again.digests == sample.digests


def test_a_long_sequence_is_measured_in_whole_cycles(courses: dict[str, Course]) -> None:
    """A long sequence is measured for a whole cycle, even if the cycle takes more than 3 s."""
    start = entry_of("hexapod").robot.start_posture
    sway = tuple(angle + 0.3 for angle in start[:6]) + start[6:]
    gait = Gait(None, LocomotionTable((((start, sway) * 10),)))
    walk = courses["hexapod"].walk(gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, 0)], cycles=1)
    assert walk.span.cycles == 1
    assert walk.span.seconds > NO_CYCLE_S / 2


def test_a_trial_that_ends_at_once_has_figures(sample: Walk) -> None:
    """If physics stops in the first tick, a trial still has figures, and no error is raised."""
    nothing = {
        name: value[:0] for name, value in vars(sample).items() if isinstance(value, np.ndarray)
    }
    found = measure(replace(sample, **nothing, span=Span(0, 0, 0), starts=(), digests=()))
    assert (found.cycles, found.speed_mm_s, found.margin_mm) == (0, 0.0, None)


def test_the_figures_of_the_sample(sample: Walk) -> None:
    """The workshop's gait is stable and straight; its feet slide nearly as fast as it walks."""
    found = measure(sample)
    assert found.cycles == CYCLES
    assert found.speed_mm_s == pytest.approx(60, abs=2)
    assert abs(found.drift_deg_s) < 0.01
    assert found.stable_share == 1
    assert found.few_feet_share == 0
    assert found.margin_mm == pytest.approx(23, abs=2)
    assert found.slip_ratio == pytest.approx(0.93, abs=0.03)
    assert max(found.changes_hz) <= 4
    assert found.belly_share == 0
    assert found.upright > 0.99
    assert found.cost_of_transport is not None
    assert 2 < found.cost_of_transport < 3
    # A tripod: each leg moves half a cycle after its neighbours.
    assert found.phase[0] is not None
    for leg, phase in enumerate(found.phase):
        assert phase == pytest.approx((found.phase[0] + leg % 2 / 2) % 1, abs=0.05)


def test_feet_that_are_down_are_low(sample: Walk) -> None:
    """In over 95 % of cases, feet that count as down are below 1 mm, and other feet are not."""
    part = slice(sample.span.first, sample.span.end)
    down = sample.down[part]
    assert ((sample.tip_m[part] < 0.001) == down).mean() > 0.95


def test_contact_has_two_bounds() -> None:
    """A foot counts as down from a load of 2 % of the weight, until its load is below 1 %."""
    load_n = np.array([[0.015], [0.03], [0.015], [0.005], [0.015]])
    assert feet_down(load_n, 1.0)[:, 0].tolist() == [False, True, True, False, False]


def test_phases_are_means_on_a_circle() -> None:
    """The mean of touchdowns just before and after the start of a cycle is the cycle's start."""
    down = np.zeros((40, 1), bool)
    down[[9, 10, 21, 22]] = True
    (found,) = phases(down, 0, [(0, 10), (20, 30)])
    assert found is not None
    assert math.cos(2 * math.pi * found) == pytest.approx(1)
    assert phases(np.ones((40, 1), bool), 0, [(1, 10)]) == [None]


@given(
    st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=3, max_size=8),
    st.tuples(st.integers(-9, 9), st.integers(-9, 9)),
)
def test_margin(feet: list[tuple[int, int]], centre: tuple[int, int]) -> None:
    """The margin is the distance to the nearest edge of the feet's hull, and positive inside it."""
    corners = hull(feet)
    found = margin_m(feet, centre)
    assert found is not None
    edges = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    ways = np.linspace(0, 1, 2001)[:, None]
    points = [np.array(a) + ways * (np.array(b) - np.array(a)) for a, b in edges]
    nearest = min(np.hypot(*(line - centre).T).min() for line in points)
    assert abs(found) == pytest.approx(nearest, abs=0.02)
    # A point is inside if the corners are seen from it all around.
    angles = sorted(math.atan2(y - centre[1], x - centre[0]) for x, y in corners)
    gaps = [b - a for a, b in zip(angles, [*angles[1:], angles[0] + 2 * math.pi], strict=True)]
    if abs(found) > 1e-9 and len(corners) > 2:
        assert (found > 0) == (max(gaps) < math.pi)


def test_margin_of_few_feet() -> None:
    """One or two feet enclose no area, so the margin is negative; without feet there is none."""
    assert margin_m([], (0, 0)) is None
    assert margin_m([(3, 4)], (0, 0)) == -5
    assert margin_m([(-1, 2), (1, 2)], (0, 0)) == -2
    assert margin_m([(1, 0), (1, 0), (2, 0)], (0, 0)) == -1


def test_the_key_for_forward_is_tried_also_if_it_does_nothing() -> None:
    """Without a key that a person named, key 2 is tried, or else key 0, even with zeros only."""
    start = entry_of("hexapod").robot.start_posture
    zeros, turns = ((0.0,) * 18,) * 4, (start, (0.1,) * 18)
    nothing = Gait(None, LocomotionTable(((start,), turns, zeros)))
    assert forward_key(nothing) == (Level.LOCOMOTION, 2)
    assert forward_key(Gait(None, LocomotionTable(((start,), turns)))) == (Level.LOCOMOTION, 0)


def test_keys_as_people_type_them() -> None:
    """Keys are read with levels and times; without a letter the level is B, or A if only A fits."""
    gait = load_gait(SAMPLE, entry_of("hexapod").robot)
    assert forward_key(gait) == (Level.LOCOMOTION, 2)
    assert parse_keys("1:3, A4:0.5,2", gait, 25) == [
        Press(25, Level.LOCOMOTION, 1),
        Press(175, Level.POSTURE, 4),
        Press(200, Level.LOCOMOTION, 2),
    ]
    assert parse_keys("8", gait, 0) == [Press(0, Level.POSTURE, 8)]
    for wrong in ("", "11", "2:3", "1,2", "x", "1:..,2", "1:999,2", "B9", "1:-1,2", "１"):
        with pytest.raises(UserError):
            parse_keys(wrong, gait, 0)


@pytest.mark.parametrize("seed", range(len(FAULTS)), ids=FAULTS)
def test_the_first_sentence_names_the_fault(seed: int) -> None:
    """If a gait has one fault, the first sentence names it and its leg; else it names no fault."""
    told = tell(seed)
    assert told.named, told


def test_a_walk_that_fell_is_explained(courses: dict[str, Course]) -> None:
    """A robot's fall is explained even if no cycle of its key was completed."""
    robot = entry_of("quadruped").robot
    start, legs = robot.start_posture, len(robot.legs)
    fallen = tuple(
        math.radians(80) if joint in (legs, legs + 1) else angle
        for joint, angle in enumerate(start)
    )
    gait = Gait(None, LocomotionTable(((start,), (fallen,))))
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, 1)
    walk = courses["quadruped"].walk(gait, [press])
    figures = measure(walk)
    assert figures.cycles == 0
    assert figures.margin_mm is not None
    explained = explain(robot, walk, figures, press, (fallen,))
    assert explained[0].said.code in ("explain.belly", "explain.tipped", "explain.limit")


def test_a_robot_that_goes_backward_is_not_said_to_go_forward(sample: Walk) -> None:
    """If a robot goes backward, its explanation does not say that it walks forward."""
    robot, gait = entry_of("hexapod").robot, entry_of("hexapod").gait
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, 2)
    sequence = gait.sequence(Level.LOCOMOTION, 2)
    assert sequence is not None

    def codes(speed_mm_s: float) -> list[str]:
        figures = replace(measure(sample), speed_mm_s=speed_mm_s)
        return [one.said.code for one in explain(robot, sample, figures, press, sequence)]

    assert "explain.walks" in codes(60.0)
    assert "explain.walks" not in codes(-60.0)


def test_hardly_moving_has_the_figure_of_the_panel(sample: Walk) -> None:
    """A robot that hardly moves is told with its forward speed, sign and decimal included."""
    robot, gait = entry_of("hexapod").robot, entry_of("hexapod").gait
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, 2)
    sequence = gait.sequence(Level.LOCOMOTION, 2)
    assert sequence is not None
    figures = replace(measure(sample), speed_mm_s=-3.3, lateral_mm_s=2.4)
    said = [render(one.said) for one in explain(robot, sample, figures, press, sequence)]
    assert "The robot hardly moves: -3.3 mm/s forward." in said


def test_foot_bars() -> None:
    """In a foot's bar, a full block means "mostly down"; the last row marks the cycles."""
    down = np.array([[True, False]] * 4 + [[False, True]] * 4)
    rows = foot_bars(["R,F", "L"], down, [0, 4], 0, 4)
    assert rows == ["R,F ██··", "  L ··██", "    │ │"]
    assert foot_bars(["R,F"], down[:0, :1], [], 0, 4) == []


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    """`lacoc trial` prints figures, even for less than a cycle; it refuses another robot's gait."""

    def run(*words: str) -> int:
        try:
            return cli.main(["trial", str(SAMPLE), *words])
        except SystemExit as ended:
            return int(ended.code or 0)

    assert run("--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["speed_mm_s"] == pytest.approx(60, abs=2)
    assert len(found["duty"]) == len(found["phase"]) == 6
    assert run("--keys", "1:1, 2", "--seconds", "2") == 0
    said = capsys.readouterr()
    assert "speed forward" in said.out
    # Without a whole cycle nothing is explained.
    assert "The feet slide over the floor at" not in said.out
    assert "repeated too few times" in said.err
    assert run("--robot", "quadruped") == 2


def test_the_command_prints_the_readers_notes(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """What is perhaps not intended in the file is told before the figures."""
    file = tmp_path / "Loco-data.txt"
    file.write_text(SAMPLE.read_text().replace("Position\tR,F", "Position\tL,F"))
    with pytest.raises(SystemExit, match="0"):
        cli.main(["trial", str(file), "--seconds", "0.1", "--json"])
    assert "the legend says L,F, but joint 0 is a joint of leg R,F" in capsys.readouterr().err
