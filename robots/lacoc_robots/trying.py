"""Tries a robot in physics if MuJoCo is installed; it may be missing on a contestant's machine."""

from collections.abc import Collection

from lacoc_robots.robot import RobotSpec
from lacoc_shared.command import installing
from lacoc_shared.gait.tables import Gait, Level
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase, say


def not_tried() -> Phrase:
    """Make the note that the robot was not tried in physics, because MuJoCo is missing."""
    return say("robot.not-tried", install=installing.command("server"))


def tried(
    robot: RobotSpec, gait: Gait, levels: Collection[Level], file: str, notes: list[Phrase]
) -> list[Mistake]:
    """Try whether a robot stands (`stand_test.try_standing`); if MuJoCo is missing, add a note."""
    try:
        from lacoc_robots.stand_test import try_standing
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise
        notes.append(not_tried())
        return []
    return try_standing(robot, gait, levels, file)
