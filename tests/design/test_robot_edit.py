"""Tests of changing one number in a robot file's text."""

import copy
import re
import tomllib
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.workshop.design.saving.robot_edit import LegEntry, RobotEntry, edit_robot
from lacoc_robots.library import find_robot
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_server.studio.facts import bounds, facts
from lacoc_shared.mistakes import FileRefused, UserError

ENTRIES: tuple[RobotEntry, ...] = get_args(RobotEntry)
SAMPLES = [
    find_robot(name)[1].decode() for name in ("hexapod", "long-legs", "quadruped", "octopod")
]
OWN_LINK = SAMPLES[0].replace(
    "\naccent = true", "\nlengths_m = [\n  0.015,\n  0.05, # short\n  0.07,\n]\naccent = true", 1
)
NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(\.\d+)?([eE][+-]?\d+)?(?![\w.])")


def numbers(value: Any) -> list[float]:
    """Return all numbers of a parsed file, in the order in which they stand in it."""
    if isinstance(value, dict):
        return [one for part in value.values() for one in numbers(part)]
    if isinstance(value, list):
        return [one for part in value for one in numbers(part)]
    return [value] if isinstance(value, int | float) and not isinstance(value, bool) else []


@given(
    st.sampled_from([*SAMPLES, OWN_LINK]),
    st.sampled_from(ENTRIES),
    st.floats(-1000, 1000, allow_nan=False) | st.integers(-200, 200),
    st.sampled_from(["\n", "\r\n"]),
)
def test_one_number_changes_and_the_rest_stays(
    text: str, entry: RobotEntry, value: float, newline: str
) -> None:
    """An edit changes only numbers, all to the new value; the same edit again changes nothing."""
    text = text.replace("\n", newline)
    edited = edit_robot(text, entry, value)
    assert NUMBER.sub("#", edited) == NUMBER.sub("#", text)
    before, after = numbers(tomllib.loads(text)), numbers(tomllib.loads(edited))
    changed = [new for old, new in zip(before, after, strict=True) if old != new]
    assert set(changed) <= {value}
    assert edit_robot(edited, entry, value) == edited


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("text", [SAMPLES[0], OWN_LINK])
def test_the_robot_has_the_number_under_the_name_of_the_fact(text: str, entry: RobotEntry) -> None:
    """After an edit of an entry, the robot's fact with the entry's name has the new value."""
    old = facts(read_robot(text, "robot.toml"))[entry]
    value = (old[0] if isinstance(old, tuple) else old) * (1.02 if entry == "root_link_m" else 0.98)
    if entry in ("armature", "hold_s"):  # they stand at their lowest
        value = 0.01
    robot = read_robot(edit_robot(text, entry, value), "robot.toml")
    new = facts(robot)[entry]
    assert new == pytest.approx((value, value) if isinstance(old, tuple) else value, abs=1e-6)
    assert entry == "start_height_m" or entry in bounds(robot, Limits())


@pytest.mark.parametrize("advance", ["reached", "time"])
def test_the_shortest_hold_that_is_shown_is_the_shortest_allowed(advance: str) -> None:
    """A robot whose postures go on by time must hold each for a beat; another one may hold none."""
    text = SAMPLES[0].replace('advance = "reached"', f'advance = "{advance}"')

    def read(hold_s: float) -> RobotSpec:
        return read_robot(edit_robot(text, "hold_s", hold_s), "a.toml")

    low, _ = bounds(read(1.0), Limits())["hold_s"]
    assert low is not None
    assert read(low).hold_us == round(low * 1e6)
    with pytest.raises(FileRefused):
        read(low - 0.001)


@given(
    st.sampled_from(SAMPLES),
    st.sampled_from(get_args(LegEntry)),
    st.integers(0, 3),
    st.floats(-0.05, 0.05),
    st.booleans(),
)
def test_one_leg_is_moved_and_the_others_stay(
    text: str, entry: LegEntry, leg: int, value: float, is_on_body: bool
) -> None:
    """A number of a leg changes in that leg alone, also where it is a share of the body."""
    if is_on_body:
        text = re.sub(r"position_m = .*", "on_body = [0.5, 0.25, -0.4]  # shares", text)
    edited = edit_robot(text, entry, value, leg)
    assert NUMBER.sub("#", edited) == NUMBER.sub("#", text)
    wanted = tomllib.loads(text)
    if entry == "leg_outward_deg":
        wanted["leg"][leg]["outward_deg"] = value
    else:
        at = ("leg_x_m", "leg_y_m", "leg_z_m").index(entry)
        half_m = wanted["body"]["size_m"][at] / 2
        name = "on_body" if is_on_body else "position_m"
        wanted["leg"][leg][name][at] = pytest.approx(
            value / half_m if is_on_body else value, abs=1e-8
        )
    assert tomllib.loads(edited) == wanted


def test_a_leg_that_is_not_there_is_refused() -> None:
    """A number of the ninth leg has no place in a robot with six."""
    with pytest.raises(UserError):
        edit_robot(SAMPLES[0], "leg_x_m", 0.01, 8)


@pytest.mark.parametrize(
    "text",
    [
        "[body]\nmass_kg = 1\n[[leg]]\nlabel = 'A' # end",
        "servo.kv = 1 # dotted\n[body]\nmass_kg = 1\n",
        "servo = { kv = 1 } # inline\n",
        "",
    ],
)
def test_an_entry_that_was_left_out_is_added(text: str) -> None:
    """An entry that the file lacks is added to the right table; other entries and remarks stay."""
    edited = edit_robot(text, "kp", 30.5)
    wanted = copy.deepcopy(tomllib.loads(text))
    wanted.setdefault("servo", {})["kp"] = 30.5
    assert tomllib.loads(edited) == wanted
    assert all(remark in edited for remark in re.findall("#.*", text))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("[body", 1.0),
        ("body = 3", 1.0),
        ("[body]\nsize_m = [1]", 1.0),
        ("[body]\nsize_m = 3", 1.0),
        ("[body]", 1.0),
        ("[[body]]\nsize_m = [1, 2, 3]", 1.0),
        ("a" * 40_000, 1.0),
        (SAMPLES[0], float("nan")),
        (SAMPLES[0], float("inf")),
    ],
)
def test_a_text_without_a_place_for_the_number_is_refused(text: str, value: float) -> None:
    """A broken file, a wrong kind of entry, NaN and infinity are refused."""
    with pytest.raises(UserError):
        edit_robot(text, "body_length_m", value)
