"""Keeps the floors for trials that a process has compiled; to compile one takes long."""

from functools import lru_cache

from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.answers import Answer, answer
from lacoc_server.trial.course import Course
from lacoc_server.world.sensed import make_course
from lacoc_server.world.world import SUBSTEPS


@lru_cache(maxsize=16)
def course_of(robot: RobotSpec, steps: int = SUBSTEPS) -> Course:
    """Return the compiled floor for a robot's trials; arguments as in `make_course`.

    The 16 floors that a process used last are kept; any other is compiled again.
    """
    return make_course(robot, steps)


def answered(what: str, payload: bytes) -> Answer:
    """Answer a request in this process; arguments as in `answers.answer`."""
    return answer(what, payload, course_of)
