"""Writes what a studio answers about sample robots, as msgpack: {name: [robot, trial]}.

The cases of design_trial.test.mjs read it.
"""

import sys

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.answers import answer
from lacoc_server.trial.course import Course
from lacoc_server.world.sensed import make_course
from lacoc_shared.codec import encode
from lacoc_shared.messages import PROTOCOL, SentFile
from lacoc_shared.studio import GaitFiles, RobotRequest, TrialRequest


def replies(name: str) -> list[bytes]:
    """Return a studio's answers about a robot: a description, and a trial of its sample gait."""
    courses: dict[str, Course] = {}

    def course_of(robot: RobotSpec) -> Course:
        if robot.name not in courses:
            courses[robot.name] = make_course(robot)
        return courses[robot.name]

    robot = SentFile(*find_robot(name))
    postures, locomotion = sample_gait_files(name)
    files = GaitFiles(robot=robot, postures=postures, locomotion=locomotion)
    asked = {
        "robot": RobotRequest(protocol=PROTOCOL, robot=robot),
        "trial": TrialRequest(protocol=PROTOCOL, files=files, seconds=3.0),
    }
    answers = [answer(what, encode(request), course_of) for what, request in asked.items()]
    assert all(one.right for one in answers)
    return [one.payload for one in answers]


sys.stdout.buffer.write(encode({name: replies(name) for name in ("hexapod", "quadruped")}))
