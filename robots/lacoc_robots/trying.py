"""Trying a robot where MuJoCo is installed: a contestant's machine may have none."""

from collections.abc import Collection

from lacoc_robots.robot import RobotSpec
from lacoc_shared.gait.tables import Gait, Level
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase, say


def tried(
    robot: RobotSpec, gait: Gait, levels: Collection[Level], file: str, notes: list[Phrase]
) -> list[Mistake]:
    """Try whether a robot stands, as `trial.try_standing` does; a note says where it can't."""
    try:
        from lacoc_robots.trial import try_standing
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise
        notes.append(say("robot.not-tried"))
        return []
    return try_standing(robot, gait, levels, file)
