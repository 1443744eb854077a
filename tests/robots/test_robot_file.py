import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_robots.library import find_robot
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import LARGEST_FILE, read_robot
from lacoc_shared.mistakes import FileRefused, Mistake, UserError

HEXAPOD = find_robot("hexapod")[1].decode()


def mistakes_of(text: str | bytes, limits: Limits | None = None) -> list[Mistake]:
    with pytest.raises(FileRefused) as refused:
        read_robot(text, "mine.toml", limits)
    assert all(mistake.file == "mine.toml" for mistake in refused.value.mistakes)
    return [mistake.in_words() for mistake in refused.value.mistakes]


def changed(old: str, new: str, count: int = 1) -> str:
    """Return the hexapod's file with a piece of text replaced."""
    assert old in HEXAPOD
    return HEXAPOD.replace(old, new, count)


def test_workshop_robot(hexapod: RobotSpec) -> None:
    """The workshop's robot has six legs of three joints, 1.115 kg, and joints of 120 degrees/s."""
    assert hexapod.labels == ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")
    assert hexapod.joints == 18
    assert hexapod.size_m == (0.10, 0.12, 0.05)
    assert hexapod.mass_kg == pytest.approx(1.115)
    assert math.degrees(hexapod.ang_min_rad_s) == pytest.approx(1.2 / 0.010)
    assert hexapod.ranges_rad == ((math.radians(-150), math.radians(150)),) * 18
    assert all(leg.lengths_m == (0.015, 0.070, 0.070) for leg in hexapod.legs)
    assert [leg.accent for leg in hexapod.legs] == [True, False, False, False, False, True]


def test_a_robot_of_exactly_3_kg() -> None:
    """Masses that add up to exactly 3 kg are allowed, in spite of rounding in binary (rules 1)."""
    text = changed("mass_kg = 0.125", "mass_kg = 0.048")
    heavy = text.replace("[0.055, 0.055, 0.055]", "[0.164, 0.164, 0.164]")
    assert read_robot(heavy.encode(), "mine.toml").mass_kg == pytest.approx(3)
    with pytest.raises(FileRefused, match="mass_kg"):
        read_robot(heavy.replace("0.048", "0.049").encode(), "mine.toml")


def test_start(hexapod: RobotSpec) -> None:
    """The body's underside starts 0.055 m above the floor (workshop 4-3: LEG_L + LEG_R)."""
    assert hexapod.start_height_m == pytest.approx(0.04 + 0.015)
    assert hexapod.start_z_m == pytest.approx(0.055 + 0.025)
    assert hexapod.advance == "reached"
    assert hexapod.hold_us == 0


def test_hold_is_whole_microseconds() -> None:
    """With `advance = "time"`, hold_s is kept as whole microseconds."""
    text = changed('advance = "reached"', 'advance = "time"').replace(
        "hold_s = 0.0 ", "hold_s = 0.2 "
    )
    robot = read_robot(text, "mine.toml")
    assert (robot.advance, robot.hold_us) == ("time", 200_000)


def test_what_may_be_left_out() -> None:
    """A robot file that leaves out drive, servo and surface gets the workshop's values."""
    lines = re.sub(r"(?ms)^\[drive\].*?(?=^# All legs)", "", HEXAPOD)
    assert "[servo]" not in lines
    assert read_robot(lines, "mine.toml") == read_robot(HEXAPOD, "mine.toml")


@pytest.mark.parametrize(
    ("old", "new", "field", "found"),
    [
        pytest.param('name = "Hexapod"', "name = 6", "name", "6", id="wrong type"),
        pytest.param('name = "Hexapod"', 'name = ""', "name", '""', id="empty name"),
        pytest.param('name = "Hexapod"', "", "name", "nothing", id="missing name"),
        pytest.param("mass_kg = 0.125", "", "body.mass_kg", "nothing", id="missing entry"),
        pytest.param("[start]", "[strat]", "strat", "unknown", id="unknown table"),
        pytest.param("kp = 20.0", "kp = 20.0\nki = 1", "servo.ki", "unknown", id="unknown entry"),
        pytest.param("[servo]", "[[servo]]", "servo", "{", id="list for a table"),
        pytest.param("mass_kg = 0.125", "mass_kg = nan", "body.mass_kg", "nan", id="NaN"),
        pytest.param("mass_kg = 0.125", "mass_kg = inf", "body.mass_kg", "inf", id="infinity"),
        pytest.param("mass_kg = 0.125", "mass_kg = true", "body.mass_kg", "true", id="boolean"),
        pytest.param("kp = 20.0", "kp = 1" + "0" * 400, "servo.kp", "digits", id="long number"),
        pytest.param("0.12, 0.05]", "0.12]", "body.size_m", "2 entries", id="short list"),
        pytest.param("[0.10, 0.12, 0.05]", "7", "body.size_m", "7", id="number for a list"),
        pytest.param("45,  0, -45", "45, -45", "start.posture_deg", "17", id="short posture"),
        pytest.param("45,  0, -45", "45, 151, -45", "start.posture_deg", "151", id="posture range"),
        pytest.param("ed\"   # next", 'y"  # next', "drive.advance", "reachy", id="advance"),
        pytest.param('"L,F"', '"R,F"', "leg 5, label", "second time", id="label twice"),
        pytest.param('"L,F"', '"left front"', "leg 5, label", "left", id="long label"),
        pytest.param('"L,F"', '"L\\tF"', "leg 5, label", "L", id="tab in a label"),
        pytest.param(
            "position_m = [0.05, 0.0,", "position_m = [0.05, -0.05,", "leg 2, position_m",
            "clockwise", id="order of legs",
        ),
        pytest.param("outward_deg = 0", "outward_deg = 90",
         "leg 0, outward_deg", "forward", id="forward"),
        pytest.param("accent = true\n\n[[leg]]", "accent = 1\n\n[[leg]]",
         "leg 0, accent", "1", id="accent"),
        pytest.param("height_m = 0.055", "height_m = 0.025", "start.height_m", "-0.0", id="floor"),
        pytest.param("height_m = 0.055", "height_m = 0.100", "start.height_m", "0.07", id="drop"),
        pytest.param("[-150, 150]", "[30, 30]", "link.range_deg", "30 to 30", id="empty range"),
        pytest.param("0.070, 0.070]", "0.070, 0.030]", "link.lengths_m", "2nd link", id="stub"),
        pytest.param("[0.015, 0.070", "[0.014, 0.070", "link.lengths_m",
         "Root link", id="root stub"),
    ],
)  # fmt: skip
def test_one_mistake(old: str, new: str, field: str, found: str) -> None:
    """A mistake names the entry that is wrong and what was found there."""
    places = {(m.field, found in m.found) for m in mistakes_of(changed(old, new))}
    assert (field, True) in places


@pytest.mark.parametrize(
    ("old", "inside", "outside", "field"),
    [
        ("mass_kg = 0.125", "mass_kg = 1.0", "mass_kg = 1.001", "body.mass_kg"),
        ("[0.055, 0.055", "[0.005, 0.055", "[0.0049, 0.055", "link.masses_kg"),
        ("[0.055, 0.055, 0.055]", "[0.1, 0.1, 0.27]", "[0.1, 0.2, 0.2]",
         "mass_kg and masses_kg"),
        ("[0.055, 0.055, 0.055]", "[0.01, 0.01, 0.01]", "[0.009, 0.01, 0.01]",
         "mass_kg and masses_kg"),
        ("0.070, 0.070]", "0.070, 0.120]", "0.070, 0.121]", "link.lengths_m"),
        ("radius_m = 0.015", "radius_m = 0.005", "radius_m = 0.0049", "link.radius_m"),
        ("radius_m = 0.015", "radius_m = 0.015", "radius_m = 0.0301", "link.radius_m"),
        ("range_deg = [-150, 150]", "range_deg = [-150, 150]",
         "range_deg = [-151, 150]", "link.range_deg"),
        ("ang_min_deg_s = 120", "ang_min_deg_s = 240",
         "ang_min_deg_s = 241", "drive.ang_min_deg_s"),
        ("torque_n_m = 2.0", "torque_n_m = 2.0", "torque_n_m = 2.1", "servo.torque_n_m"),
        ("hold_s = 0.0", "hold_s = 5", "hold_s = 5.02", "drive.hold_s"),
        ('"reached"   #', '"time"\nhold_s = 0.02 #', '"time"\nhold_s = 0.01 #', "drive.hold_s"),
        ("armature = 0.002", "armature = 0.02", "armature = 0.001", "servo.armature"),
        ("friction = 1.0", "friction = 1.5", "friction = 1.6", "surface.friction"),
        ("kp = 20.0", "kp = 200", "kp = 201", "servo.kp"),
        ("kv = 0.5", "kv = 5", "kv = 5.1", "servo.kv"),
        ("damping = 0.02", "damping = 1", "damping = 1.1", "servo.damping"),
    ],
)  # fmt: skip
def test_limits(old: str, inside: str, outside: str, field: str) -> None:
    """A value on a limit is allowed, and one beyond the limit is refused (rules 1)."""
    text = HEXAPOD.replace("height_m = 0.055", "height_m = 0.12") if "0.120" in inside else HEXAPOD
    if "hold_s = 0.02" in inside:
        text = text.replace("hold_s = 0.0 ", "# hold_s = 0.0 ")
    assert old in text
    read_robot(text.replace(old, inside, 1), "mine.toml")
    assert field in {mistake.field for mistake in mistakes_of(text.replace(old, outside, 1))}


@pytest.mark.parametrize(("legs", "allowed"), [(2, False), (4, True), (5, False), (6, True)])
def test_number_of_legs(legs: int, allowed: bool) -> None:
    """A robot must have 4, 6 or 8 legs of 3 joints (rules 1)."""
    head, *blocks = HEXAPOD.split("[[leg]]\n")
    kept = blocks[: legs - legs // 2] + blocks[6 - legs // 2 :]
    posture = f"posture_deg = {[20.0 * (legs <= j < 2 * legs) for j in range(3 * legs)]}"
    head = re.sub(r"(?s)posture_deg = \[.*?\n\]", posture, head)
    text = head + "".join(f"[[leg]]\n{block}" for block in kept)
    if allowed:
        assert len(read_robot(text, "mine.toml").legs) == legs
    else:
        assert [m.field for m in mistakes_of(text)] == ["leg"]


def test_footprint_of_the_workshop_robot(hexapod: RobotSpec) -> None:
    """With every angle 0, the workshop's robot is 0.300 x 0.120 x 0.105 m, legs included."""
    low, high = hexapod.bounds((0.0,) * 18)
    extents_m = [b - a for a, b in zip(low, high, strict=True)]
    assert extents_m == pytest.approx([0.300, 0.120, 0.105])


@pytest.mark.parametrize(
    ("axis", "limit", "zero_m", "start_m"),
    [
        ("wide", "width_m", 0.300, 0.329),
        ("long", "length_m", 0.122, 0.263),
        ("high", "height_m", 0.105, 0.078),
    ],
)
def test_footprint(axis: str, limit: str, zero_m: float, start_m: float) -> None:
    """A robot as large as a contest's limit is allowed; if it is 1 mm larger, it is refused.

    This holds with every angle 0 and in the start posture.
    """
    text = HEXAPOD.replace("[0.05, 0.045,", "[0.05, 0.047,")
    larger_m = max(zero_m, start_m) + 0.001
    read_robot(text, "mine.toml", Limits(**{limit: larger_m}))
    found = [
        one.found for one in mistakes_of(text, Limits(**{limit: min(zero_m, start_m) - 0.001}))
    ]
    assert found == [
        f"a robot {zero_m:.3f} m {axis} with every angle 0",
        f"a robot {start_m:.3f} m {axis} in its start posture",
    ]
    (alone,) = mistakes_of(text, Limits(**{limit: larger_m - 0.002}))
    assert alone.found in found


def test_a_leg_of_its_own(hexapod: RobotSpec) -> None:
    """A leg may have its own links and ranges; all other legs take theirs from [link]."""
    own = "lengths_m = [0.02, 0.06, 0.07]\nmasses_kg = [0.1, 0.05, 0.05]\nrange_deg = [-90, 90]\n"
    text = HEXAPOD.replace('label = "R,C"\n', f'label = "R,C"\nradius_m = 0.014\n{own}')
    robot = read_robot(text, "mine.toml")
    leg = robot.legs[1]
    assert (leg.lengths_m, leg.radius_m) == ((0.02, 0.06, 0.07), 0.014)
    assert leg.masses_kg == (0.1, 0.05, 0.05)
    assert robot.ranges_rad[1] == robot.ranges_rad[7] == (-math.pi / 2, math.pi / 2)
    assert robot.legs[0] == hexapod.legs[0]


def test_all_mistakes_at_once() -> None:
    """A file is refused as a whole, and every mistake is listed once (rules 2)."""
    text = changed("mass_kg = 0.125", "mass_kg = nan\ncolour = 1")
    text = text.replace("radius_m = 0.015", "radius_m = -1").replace("0.12, 0.05]", '0.12, "x"]')
    text = text.replace('"L,B"', '"R,B"').replace("45,  0, -45", "45, nan, 200")
    named = [(m.field, m.joint, m.leg, m.column) for m in mistakes_of(text)]
    assert sorted(named, key=str) == sorted(
        [
            ("body.size_m", None, None, 3),
            ("body.mass_kg", None, None, None),
            ("body.colour", None, None, None),
            ("link.radius_m", None, None, None),
            ("leg 3, label", None, None, None),
            ("start.posture_deg", 1, "R,C", None),
            ("start.posture_deg", 2, "R,B", None),
        ],
        key=str,
    )


def test_entries_of_a_short_list_are_looked_at() -> None:
    """In a list that is too short, an entry that is not a number is still named."""
    fields = {(m.field, m.column) for m in mistakes_of(changed("[0.10, 0.12, 0.05]", "[0.1, nan]"))}
    assert fields == {("body.size_m", None), ("body.size_m", 2)}


def test_on_the_edge_of_a_range() -> None:
    """A posture at the ends of a range of whole degrees is allowed, in spite of rounding."""
    text = changed("[-150, 150]", "[-60, 60]").replace("-45, -45,  0, 45", "-60, -45,  0, 60")
    robot = read_robot(text, "mine.toml")
    assert robot.ranges_deg == ((-60.0, 60.0),) * 18


def test_no_mistake_of_a_mistake() -> None:
    """A number that can't be read gives one mistake, and no further ones that follow from it."""
    text = re.sub(r"(?s)posture_deg = \[.*?\n\]", f"posture_deg = {['nan'] * 18}", HEXAPOD)
    text = text.replace("height_m = 0.055", "height_m = 0.5").replace("'nan'", "nan", 17)
    assert {mistake.field for mistake in mistakes_of(text)} == {"start.posture_deg"}
    assert {m.field for m in mistakes_of(changed("radius_m = 0.015", "radius_m = nan"))} == {
        "link.radius_m"
    }


def test_broken_toml_names_the_line() -> None:
    """A file that is not TOML is refused with the line where reading stopped."""
    (mistake,) = mistakes_of("name = 'a'\n[body\n")
    assert mistake.row == 2


@pytest.mark.parametrize(
    ("data", "found"),
    [
        (b"name = '\xff'", "bytes that are not text"),
        (b"a = " + b"[" * 5000, "too deep"),
        (b"a = 1" + b"0" * 5000, "digits"),
        (b"name = [0x" + b"f" * 5000 + b"]", "digits"),
        (b"name = [{" + b"a." * 50 + b"a = 1}]", "too deep"),
        (b"a." * 15000 + b"a = 1", "dots"),
        (b"#" * (LARGEST_FILE + 1), f"{LARGEST_FILE + 1} bytes"),
        (b"", "nothing"),
    ],
    ids=[
        "not UTF-8",
        "deep",
        "long number",
        "long number in a list",
        "deep in a list",
        "dotted key",
        "long file",
        "empty",
    ],
)
def test_hostile_bytes(data: bytes, found: str) -> None:
    """Hostile bytes that are not a robot file are refused with a mistake."""
    assert any(found in mistake.found for mistake in mistakes_of(data))


def test_mistakes_are_safe_to_print() -> None:
    """A mistake never contains control characters that could reach a terminal."""
    for mistake in mistakes_of('"\\u001b[2J" = 1\nname = "\\u001b[31m"\n'):
        assert str(mistake).isprintable()


def test_byte_order_mark() -> None:
    """A robot file may begin with a byte order mark, as Windows' Notepad writes it."""
    data = HEXAPOD.replace("\n", "\r\n").encode("utf-8-sig")
    assert read_robot(data, "mine.toml") == read_robot(HEXAPOD, "mine.toml")


def never_raises_otherwise(data: str | bytes) -> None:
    try:
        robot = read_robot(data, "mine.toml")
    except FileRefused as refused:
        robot, mistakes = None, refused.mistakes
    else:
        mistakes = []
    assert (robot is None) == bool(mistakes)
    assert all(mistake.found and mistake.expected for mistake in mistakes)


@given(st.binary(max_size=300) | st.text(max_size=300))
def test_any_bytes(data: bytes | str) -> None:
    """Any bytes or text are read as a robot, or raise FileRefused."""
    never_raises_otherwise(data)


SCALARS = st.one_of(
    st.floats().map(repr),
    st.integers(-(10**30), 10**30).map(str),
    st.sampled_from(["true", '"x"', "[]", "[[]]", "{}", "1979-05-27", "12:00:00", "''", "nan"]),
)


@given(st.data())
def test_any_entry_replaced(data: st.DataObject) -> None:
    """A robot file with any values in place of its numbers is read, or raises FileRefused."""
    numbers = list(re.finditer(r"(?m)(?<=[=\[,] )\s*-?\d+(\.\d+)?", HEXAPOD))
    text = HEXAPOD
    for at in sorted(data.draw(st.sets(st.integers(0, len(numbers) - 1), max_size=4)))[::-1]:
        start, end = numbers[at].span()
        text = text[:start] + data.draw(SCALARS) + text[end:]
    never_raises_otherwise(text)


@given(st.data())
def test_any_lines_left_out(data: st.DataObject) -> None:
    """A robot file without some of its lines is read, or raises FileRefused."""
    lines = HEXAPOD.splitlines()
    out = data.draw(st.sets(st.integers(0, len(lines) - 1), max_size=8))
    never_raises_otherwise("\n".join(line for i, line in enumerate(lines) if i not in out))


def test_limits_from_a_contest_file() -> None:
    """Each limit is a setting of the contest; an unknown name or wrong value raises UserError."""
    assert Limits.of({"mass_max_kg": 5}).mass_max_kg == 5.0
    with pytest.raises(UserError, match=r"mass_max\b.*mass_max_kg"):
        Limits.of({"mass_max": 5})
    with pytest.raises(UserError, match="legs_max"):
        Limits.of({"legs_max": "many"})


def test_an_override_counts() -> None:
    """A contest may allow more or less than the default limits (rules 1)."""
    fast = changed("ang_min_deg_s = 120", "ang_min_deg_s = 300")
    read_robot(fast, "mine.toml", Limits.of({"ang_min_deg_s": 300}))
    (mistake,) = mistakes_of(HEXAPOD, Limits.of({"ang_min_deg_s": 100}))
    assert "from 1 to 100 degrees/s" in mistake.expected
