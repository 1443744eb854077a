"""The workshop's C header becomes a robot file (workshop 4-3)."""

import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_robots.commands import app as robot_app
from lacoc_robots.header.c_values import read_c
from lacoc_robots.header.importing import CFile, Imported, import_robot
from lacoc_robots.library import find_robot
from lacoc_robots.robot_file import read_robot
from lacoc_shared.words import Phrase

HEADER = """
#define ROBOT_BODY_W 0.1      // width of robot body
#define ROBOT_BODY_D 0.12   // length of robot body
#define ROBOT_BODY_H 0.05   // height of robot body
#define ROBOT_LEG_R 0.015   // length of robot leg0
#define ROBOT_LEG_L 0.04    // length of robot leg1 & leg2
#define ROBOT_NUM 19
#define RJOINT_NUM 18 //Total number of joints to make in the robot
dReal Start_Pos[3] = { 0.0, 0.0, ROBOT_LEG_L + ROBOT_LEG_R };
dReal Robot_Pos[ROBOT_NUM][3] = {
//the position of the main body
{ Start_Pos[0], Start_Pos[1], ROBOT_BODY_H * 0.5 + Start_Pos[2] },
};
dReal Robot_weight[ROBOT_NUM] = { 0.125,
  0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055,
  0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055};
dJointID Rjoint [RJOINT_NUM]; //Variable number for joint
dReal Joint_Angle [RJOINT_NUM] = { 0.25 * M_PI, 0.0, -0.25 * M_PI, -0.25 * M_PI, 0.0, 0.25 * M_PI,
  20 * M_PI / 180, 20 * M_PI / 180, 20 * M_PI / 180,
  20 * M_PI / 180, 20 * M_PI / 180, 20 * M_PI / 180};
dReal Joint_AngVel [RJOINT_NUM] = { 0.0};
void make_Robot() { dReal Start_Pos[3] = {9, 9, 9}; if (1) { int ROBOT_LEG_R = 3; } }
"""
MAIN = "double AngMin=1.2, // modify this parameter can change the speed\n  speed = 0;\n"


def imported(header: str = HEADER, main: str = MAIN) -> tuple[dict[str, Any], tuple[Phrase, ...]]:
    """Import the files; return the robot file as TOML reads it, and the notes."""
    made = import_robot([CFile("robot6legs.h", header), CFile("mainR.cpp", main)], "Hexapod")
    return tomllib.loads(made.toml), made.notes


def test_the_workshops_header_is_the_sample_robot() -> None:
    """The workshop's own header gives the sample robot in all that the header says."""
    made = import_robot([CFile("robot6legs.h", HEADER), CFile("mainR.cpp", MAIN)], "Hexapod")
    robot = read_robot(made.toml, "robot.toml")
    sample = read_robot(find_robot("hexapod")[1], "sample")
    assert robot.labels == sample.labels
    assert robot.mass_kg == pytest.approx(sample.mass_kg)
    assert robot.ang_min_rad_s == pytest.approx(sample.ang_min_rad_s)
    assert robot.start_posture == pytest.approx(sample.start_posture)
    zero = (0.0,) * robot.joints
    for one, other in zip(robot.capsules(zero), sample.capsules(zero), strict=True):
        assert (*one.start, *one.end) == pytest.approx((*other.start, *other.end))
    (places,) = made.notes
    assert places.code == "header.missing"
    assert places.values["name"] == "Rjoint_x, Rjoint_y, Rjoint_z"


@pytest.mark.parametrize(
    ("old", "new", "entry", "value"),
    [
        ("_W 0.1 ", "_W  (0.05 * 4)", ("body", "size_m", 0), 0.2),
        ("_W 0.1 ", "_W .2f", ("body", "size_m", 0), 0.2),
        ("_W 0.1 ", "_W 2e-1", ("body", "size_m", 0), 0.2),
        ("_W 0.1 ", "_W (ROBOT_BODY_D / 0.6)", ("body", "size_m", 0), 0.2),
        ("#define ROBOT_BODY_W 0.1", "#  define\tROBOT_BODY_W\t0.2", ("body", "size_m", 0), 0.2),
        ("#define ROBOT_BODY_W 0.1", "const double ROBOT_BODY_W=.2;", ("body", "size_m", 0), 0.2),
        ("_H 0.05 ", "_H 0.04 + \\\n 0.02", ("body", "size_m", 2), 0.06),
        ("0.125,", "/* the body */ (dReal)0.25,", ("body", "mass_kg"), 0.25),
        ("0.125,", "1 / 4.0,", ("body", "mass_kg"), 0.25),
        ("_LEG_L + ROBOT", "_LEG_L + 2*ROBOT", ("start", "height_m"), 0.07),
        ("{ 0.25 * M_PI,", "{ -M_PI_2,", ("start", "posture_deg", 0), -90),
        ("{ 0.25 * M_PI,", "{ 3.14159265358979 / 6,", ("start", "posture_deg", 0), 30),
        ("{ 0.25 * M_PI,", "{ atan(1.0),", ("start", "posture_deg", 0), 45),
        ("_LEG_R 0.015", "_LEG_R 0.02", ("link", "radius_m"), 0.02),
        ("_LEG_L 0.04 ", "_LEG_L 0.05 ", ("link", "lengths_m", 1), 0.08),
        ("AngMin=1.2", "AngMin = 2 * 0.6 + 0.3", ("drive", "ang_min_deg_s"), 150),
        (
            "double AngMin=1.2,",
            "static int a = 1, b;\nfloat AngMin=1.5F,",
            ("drive", "ang_min_deg_s"),
            150,
        ),
        (
            "double AngMin=1.2,",
            "// double AngMin=9;\ndouble AngMin=1.5,",
            ("drive", "ang_min_deg_s"),
            150,
        ),
    ],
)
def test_each_way_to_write_a_number_is_read(
    old: str, new: str, entry: tuple[str | int, ...], value: float
) -> None:
    """Comments, spaces, expressions and casts are read as a compiler reads them."""
    assert old in HEADER + MAIN
    found: Any = imported(HEADER.replace(old, new), MAIN.replace(old, new))[0]
    for part in entry:
        found = found[part]
    assert found == pytest.approx(value)


@pytest.mark.parametrize(
    "lines",
    [
        "#if 0\n#define ROBOT_BODY_W 0.2\n#endif",
        "#if 1\n#else\n#define ROBOT_BODY_W 0.2\n#endif",
        "#if 1\n#elif BIG\n#define ROBOT_BODY_W 0.2\n#endif",
        " # if (0) // old\n#ifdef BIG\n#define ROBOT_BODY_W 0.2\n#endif\n#else\n#endif",
        "#if 0\n#if 1\n#define ROBOT_BODY_W 0.2\n#endif\ndouble ROBOT_BODY_W = 0.2;\n#endif",
        "#ifdef BIG\n#elif 0\n#define ROBOT_BODY_W 0.2\n#endif",
        "#if BIG\n#define ROBOT_BODY_W 0.10\n#endif",
        "#else\n#endif\n#endif",
    ],
)
def test_what_a_compiler_leaves_out_is_not_read(lines: str) -> None:
    """Lines that `#if 0` leaves out do not count, and what stands there twice is not told."""
    assert imported(HEADER + lines) == imported()


@pytest.mark.parametrize(
    ("define", "value"), [("ROBOT_BODY_W 0.2", 0.2), ("ROBOT_BODY_W wide()", 0.1)]
)
def test_a_second_value_is_told(define: str, value: float) -> None:
    """It is not known whether `#ifdef BIG` holds: a note says which of two values counts."""
    first = HEADER.splitlines().index("#define ROBOT_BODY_W 0.1      // width of robot body") + 1
    last = len(HEADER.splitlines()) + 2
    found, notes = imported(f"{HEADER}#ifdef BIG\n#define {define}\n#endif\n")
    assert found["body"]["size_m"][0] == value
    (note,) = [one for one in notes if one.code == "header.again"]
    lines = {"line": last, "other": first} if value == 0.2 else {"line": first, "other": last}
    assert note.values == {"file": "robot6legs.h", "name": "ROBOT_BODY_W", **lines}


@pytest.mark.parametrize(
    ("old", "new", "note", "name"),
    [
        ("_W 0.1 ", "_W wide", "header.not-read", "ROBOT_BODY_W"),
        ("0.125,", "0.125, ...,", "header.not-read", "Robot_weight"),
        ("0.125,", "0.125, 1 2,", "header.not-read", "Robot_weight"),
        ("_LEG_L + ROBOT", "_LEG_L / 0 + ROBOT", "header.not-read", "Start_Pos"),
        ("_W 0.1 ", "_W 0", "header.no-side", "ROBOT_BODY_W"),
        ("_H 0.05 ", "_H (0.1 - 0.1)", "header.no-side", "ROBOT_BODY_H"),
        ("_D 0.12 ", "_D 1e999", "header.not-read", "ROBOT_BODY_D"),
        ("_D 0.12 ", "_D (int)(1e999)", "header.not-read", "ROBOT_BODY_D"),
        ("_D 0.12 ", "_D (int)(1e999 - 1e999)", "header.not-read", "ROBOT_BODY_D"),
        ("_D 0.12 ", f"_D {'9' * 400}", "header.not-read", "ROBOT_BODY_D"),
        ("_D 0.12 ", f"_D {'9' * 400} / 3", "header.not-read", "ROBOT_BODY_D"),
        ("_D 0.12 ", f"_D {'9' * 5000}", "header.not-read", "ROBOT_BODY_D"),
        ("0.125,", "1e999,", "header.not-read", "Robot_weight"),
        ("0.125,", "0.125, \x01,", "header.not-read", "Robot_weight"),
        ("AngMin=1.2", "AngMin=speed()", "header.not-read", "AngMin"),
        ("AngMin=1.2", "AngMin", "header.missing", "AngMin"),
        ("dReal Robot_weight", "dReal Robot_mass", "header.missing", "Robot_weight"),
        ("dReal Start_Pos[3]", "dReal Place[3]", "header.missing", "Start_Pos"),
        ("0.125,", "0.125, 0.1,", "header.entries", "Robot_weight"),
        ("_NUM 18", "_NUM 99999999999", "header.joints", "RJOINT_NUM"),
        ("_NUM 18", "_NUM 0", "header.joints", "RJOINT_NUM"),
    ],
)
def test_what_is_not_read_is_told(old: str, new: str, note: str, name: str) -> None:
    """The workshop's number stands where a value is missing or not read, and a note says so."""
    found, notes = imported(HEADER.replace(old, new), MAIN.replace(old, new))
    told = [one for one in notes if one.values.get("name") == name]
    assert [one.code for one in told] == [note]
    if note == "header.not-read":
        text = MAIN.replace(old, new) if name == "AngMin" else HEADER.replace(old, new)
        lines = [number for number, line in enumerate(text.splitlines(), 1) if name in line]
        assert told[0].values["line"] in (*lines, *(number + 1 for number in lines))
    assert found["drive"]["ang_min_deg_s"] == 120
    assert found["body"] == {"size_m": [0.1, 0.12, 0.05], "mass_kg": 0.125}


def with_legs(right: str, left: str) -> Imported:
    """Import the files with Rjoint_x, _y and _z; `right` and `left` are x of the legs."""
    x = ", ".join([right] * 3 + [left] * 3)
    y = "0.05, 0, -0.05, -0.05, 0, 0.05"
    z = ", ".join(["ROBOT_LEG_R + Start_Pos[2]"] * 6)
    places = f"dReal Rjoint_x[18]={{{x}}}, Rjoint_y[18]={{{y}}}, Rjoint_z[18]={{{z}}};"
    return import_robot([CFile("robot6legs.h", HEADER + places), CFile("m.cpp", MAIN)], "Wide")


def test_places_of_legs_are_in_shares_of_the_body() -> None:
    """Rjoint_x, _y and _z say where the legs are; a wider body carries them along."""
    made = with_legs("0.5*ROBOT_BODY_W + Start_Pos[0]", "-0.5*ROBOT_BODY_W")
    assert made.notes == ()
    robot = read_robot(made.toml, "robot.toml")
    assert robot.legs[0].position_m == pytest.approx((0.05, 0.05, -0.01))
    wide = read_robot(made.toml.replace("size_m = [0.1,", "size_m = [0.14,"), "robot.toml")
    assert wide.legs[0].position_m == pytest.approx((0.07, 0.05, -0.01))
    assert wide.legs[3].position_m.x == pytest.approx(-0.07)


def test_legs_may_stand_beside_the_body() -> None:
    """A leg outside the body's box has no shares of it: its place is in metres."""
    made = with_legs("0.5*ROBOT_BODY_W + ROBOT_LEG_R", "-0.5*ROBOT_BODY_W")
    legs = tomllib.loads(made.toml)["leg"]
    assert [one.get("position_m") for one in legs[2:4]] == [[0.065, -0.05, -0.01], None]
    robot = read_robot(made.toml, "robot.toml")
    assert robot.legs[3].position_m == pytest.approx((-0.05, -0.05, -0.01))


@given(st.text("#define dReal{}[]()=,;.0129+-*/ \n\"'abW_", max_size=200) | st.text(max_size=80))
def test_no_file_breaks_the_reader(text: str) -> None:
    """Any text is read to its end, and what is read are numbers and lists."""
    found = read_c("double x = 1;\n" + text)
    for value in found.values.values():
        assert isinstance(value, int | float | tuple)


@given(st.text(max_size=30))
def test_any_name_is_kept(name: str) -> None:
    """Whatever is in the robot's name, the robot file can be read."""
    assert tomllib.loads(import_robot([], name).toml)["name"] == name


def test_the_command_writes_the_file_and_keeps_an_older_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`lacoc robot import` writes robot.toml beside an older one, and says what was missing."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot6legs.h").write_bytes(HEADER.replace("my", "歩").encode("cp932"))
    (tmp_path / "robot.toml").write_text("old")
    robot_app(["import", "robot6legs.h"], standalone_mode=False)
    said = capsys.readouterr().err
    assert "AngMin is not there" in said
    assert "robot.toml written" in said
    assert (tmp_path / "robot.1.toml").read_text() == "old"
    assert math.isclose(read_robot((tmp_path / "robot.toml").read_bytes(), "r").mass_kg, 1.115)
