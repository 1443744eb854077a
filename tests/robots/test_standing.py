"""The stand test at the weigh-in: a robot must be able to stand (rules 1)."""

import json
import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lacoc_robots.commands import app as robot_app
from lacoc_robots.gait_commands import app as gait_app
from lacoc_robots.library import find_robot, installed_robots, robot_folder, sample_gait_files
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_robots.stand_test import stand, try_standing
from lacoc_robots.standing import Stood, mistakes_of, standing_postures
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture, PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.words import faults, render

A, B = Level.POSTURE, Level.LOCOMOTION
STILL = Stood(moved_m=0.01, tilt_rad=0.1, joint_rad_s=0.001, centre_m_s=0.0001)


def sample_gait(name: str) -> Gait:
    tables = [read_gait(file.data, file.name) for file in sample_gait_files(name) if file]
    return Gait(
        next(table for table in tables if isinstance(table, PostureTable)),
        next(table for table in tables if isinstance(table, LocomotionTable)),
    )


@pytest.mark.parametrize("name", installed_robots())
def test_every_sample_stands(name: str) -> None:
    """Every sample robot stands with key 0 of both levels and moves less than 0.1 mm."""
    robot = read_robot(find_robot(name)[1], name)
    gait = sample_gait(name)
    assert try_standing(robot, gait, (A, B), name) == []
    (posture,) = standing_postures(gait, (A, B), robot.start_posture)
    assert stand(robot, posture).moved_m < 1e-4


def swept(robot: RobotSpec) -> Posture:
    """Return the start posture with all legs swung back by 90 degrees, to row the robot away."""
    legs = len(robot.legs)
    return tuple(
        angle - math.radians(90) * (joint < legs) for joint, angle in enumerate(robot.start_posture)
    )


def test_a_robot_that_rows_itself_away_is_told_how_far(hexapod: RobotSpec) -> None:
    """The mistake of a robot that rows itself away names the level, the distance and the limit."""
    gait = Gait(PostureTable({0: hexapod.start_posture}), LocomotionTable(((swept(hexapod),),)))
    assert try_standing(hexapod, gait, (A,), "robot.toml") == []
    mistakes = try_standing(hexapod, gait, (A, B), "robot.toml")
    assert mistakes == try_standing(hexapod, gait, (B,), "robot.toml")
    (mistake,) = mistakes
    moved_m = stand(hexapod, swept(hexapod)).moved_m
    assert moved_m > 0.05
    assert mistake.field == "start.posture_deg"
    assert render(mistake.found) == (
        f"a robot that moves {moved_m:.3f} m from its start within 2 s "
        "(standing with key 0 of level B)"
    )
    assert render(mistake.expected).startswith("at most 0.045 m")


def test_a_robot_that_stands_on_one_side_leans(hexapod: RobotSpec) -> None:
    """A robot that lifts its left legs and pushes with its right ones is refused as leaning."""
    first = dict.fromkeys((6, 7, 8), math.radians(-50)) | dict.fromkeys((9, 10, 11), 1.4)
    posture = tuple(first.get(joint, angle) for joint, angle in enumerate(hexapod.start_posture))
    stood = stand(hexapod, posture)
    found = [render(mistake.found) for mistake in mistakes_of(stood, "robot.toml", (B,))]
    assert stood.tilt_rad > math.radians(30)
    assert any("leans" in one for one in found)


def test_a_robot_that_is_still_on_its_way_is_not_at_rest(hexapod_text: str) -> None:
    """A slow robot that is still moving to key 0 after two seconds is refused as not at rest."""
    robot = read_robot(
        hexapod_text.replace("ang_min_deg_s = 120", "ang_min_deg_s = 10"), "robot.toml"
    )
    higher = tuple(angle - math.radians(25) * (6 <= joint < 12)
                   for joint, angle in enumerate(robot.start_posture))  # fmt: skip
    stood = stand(robot, higher)
    assert stood.joint_rad_s == pytest.approx(math.radians(10), rel=0.2)
    (mistake,) = mistakes_of(stood, "robot.toml", (B,))
    speed_deg_s = math.degrees(stood.joint_rad_s)
    words = f"a robot that still moves after 2 s: a joint at {speed_deg_s:.1f} degrees/s"
    assert words in render(mistake.found)


def test_a_robot_that_is_about_to_buckle_is_not_at_rest() -> None:
    """A robot that sinks at 1.8 mm/s after two seconds is refused, because it would fall later."""
    slow = Stood(moved_m=0.015, tilt_rad=0.18, joint_rad_s=0.0087, centre_m_s=0.0018)
    (mistake,) = mistakes_of(slow, "robot.toml", (B,))
    assert "a joint at 0.5 degrees/s, the middle of the body at 1.8 mm/s" in render(mistake.found)


@pytest.mark.parametrize(
    ("stood", "words"),
    [
        (STILL, []),
        (Stood(0.045, math.radians(30), math.radians(0.2), 0.0002), []),
        (Stood(0.0451, 0.0, 0.0, 0.0), ["moves 0.045 m"]),
        (Stood(0.0, math.radians(31), 0.0, 0.0), ["leans 31 degrees"]),
        (Stood(0.0, 0.0, math.radians(4), 0.0), ["a joint at 4.0 degrees/s"]),
        (Stood(0.0, 0.0, 0.0, 0.0003), ["the middle of the body at 0.3 mm/s"]),
        (Stood(0.0, 0.0, 0.0, 0.0, fault=True), ["physics can't simulate"]),
        (Stood(0.3, 1.0, 9.0, 1.0), ["moves 0.300 m", "leans 57", "a joint at 515.7"]),
    ],
)
def test_what_is_told(stood: Stood, words: list[str]) -> None:
    """A mistake names each value beyond its bound; a value on its bound gives no mistake."""
    mistakes = mistakes_of(stood, "robot.toml", (A, B))
    assert len(mistakes) == len(words)
    for mistake, word in zip(mistakes, words, strict=True):
        assert word in render(mistake.found)
        assert "key 0 of level A and B" in render(mistake.found)
        assert faults(mistake.phrase) == []


def test_the_posture_of_key_0() -> None:
    """A robot stands in a level's first posture of key 0, or without key 0 in its start posture."""
    first, other, start = (0.1,) * 12, (0.2,) * 12, (0.3,) * 12
    gait = Gait(PostureTable({0: first, 1: other}), LocomotionTable(((first, other), (other,))))
    assert standing_postures(gait, (B, A), start) == {first: [A, B]}
    without = Gait(PostureTable({1: other}), LocomotionTable(((other,),)))
    assert standing_postures(without, (A, B), start) == {start: [A], other: [B]}


@pytest.fixture
def leaper(tmp_path: Path, hexapod_text: str) -> Path:
    """Give a folder with the hexapod, changed so that its legs start far from key 0 of its gait."""
    text = hexapod_text.replace(
        "45,  0, -45, -45,  0, 45,  # root", "100, 100, 100, 100, 100, 100,  # root"
    )
    assert text != hexapod_text
    (tmp_path / "robot.toml").write_text(text)
    for name in ("Loco-data.txt", "LocoTra-data.txt"):
        (tmp_path / name).write_bytes((robot_folder("hexapod") / name).read_bytes())
    return tmp_path


def test_commands_say_the_same(leaper: Path) -> None:
    """`robot check` and `gait check --robot` report the same mistake about standing."""
    run = CliRunner().invoke
    robot_file, gait_file = leaper / "robot.toml", leaper / "LocoTra-data.txt"
    robot = read_robot(robot_file.read_bytes(), "robot.toml")
    (expected,) = try_standing(robot, sample_gait("hexapod"), (B,), "robot.toml")

    checked = run(gait_app, ["check", str(gait_file), "--robot", str(robot_file), "--json"])
    assert checked.exit_code == 2
    (mistake,) = json.loads(checked.stdout)["mistakes"]
    assert mistake["found"] == render(expected.found)

    refused = run(robot_app, ["check", str(robot_file)])
    assert refused.exit_code != 0
    (mistake_of_both,) = refused.exception.mistakes  # type: ignore[union-attr]
    both = render(expected.found).replace("level B", "level A and B")
    assert render(mistake_of_both.found) == both


def test_a_gait_is_checked_for_a_robot(leaper: Path) -> None:
    """`gait check --robot` uses the number of legs of that robot, and refuses the option --legs."""
    gait_file = str(leaper / "Loco-data.txt")
    run = CliRunner().invoke
    assert run(gait_app, ["check", gait_file, "--robot", "hexapod"]).exit_code == 0
    other = run(gait_app, ["check", gait_file, "--robot", "octopod", "--json"])
    assert "this robot has 8 legs" in other.stdout
    both = run(gait_app, ["check", gait_file, "--robot", "hexapod", "--legs", "6"])
    assert "Leave out --legs" in str(both.exception)
