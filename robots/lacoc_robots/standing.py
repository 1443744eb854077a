"""Standing: the posture of a robot before play, and the limits within which it must stay.

Pure: how far the robot moved is measured by a stand test in physics (`stand_test`) or by a match.
"""

import math
from collections.abc import Collection, Sequence

import msgspec

from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import too_large
from lacoc_shared.gait.tables import Gait, Level, Posture
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase, say

STAND_TEST_S = 2.0
"""Duration of a stand test [s]."""
FARTHEST_M = 0.05
"""In a match before play, the largest distance of a standing robot's centre from its start [m]."""
FARTHEST_IN_TEST_M = 0.045
"""In a stand test, the largest distance of the robot's centre from its start [m]. It is smaller
than in a match, because in a match a robot stands for longer, and at other places."""
MOST_TILT_RAD = math.radians(30.0)
"""A robot that leans more than this counts as not upright [rad]."""
REST_RAD_S = math.radians(0.2)
"""A standing robot's joints may move at most this fast [rad/s]. The limit is low, because a robot
whose servos are just too weak sinks by only a few degrees a second before it falls."""
REST_M_S = 0.0002
"""A standing robot's centre may move at most this fast [m/s]."""


class Stood(msgspec.Struct, frozen=True):
    """How far a robot moved and tilted during a stand test."""

    moved_m: float
    """Largest distance of the body's centre from its start, seen from above."""
    tilt_rad: float
    """Largest angle between the body's up and the world's up."""
    joint_rad_s: float
    """Speed of the fastest joint at the end of the test."""
    centre_m_s: float
    """Speed of the body's centre at the end of the test."""
    fault: bool = False
    """Whether the simulation became unstable and stopped."""


def standing_posture(gait: Gait, level: Level, start: Posture) -> Posture:
    """Return the posture of a robot that is told to stand at a level (rules 3).

    Args:
        gait: the robot's gait.
        level: level of the command.
        start: the robot's start posture, used if the gait has no key 0 at this level.
    """
    return (gait.sequence(level, 0) or (start,))[0]


def standing_postures(
    gait: Gait, levels: Collection[Level], start: Posture
) -> dict[Posture, list[Level]]:
    """Return the postures in which a robot may be told to stand, each with its levels."""
    postures: dict[Posture, list[Level]] = {}
    for level in sorted(levels):
        postures.setdefault(standing_posture(gait, level, start), []).append(level)
    return postures


def too_large_standing(
    robot: RobotSpec, gait: Gait, levels: Collection[Level], limits: Limits, file: str
) -> list[Mistake]:
    """List the sizes in which a robot that stands with key 0 is too large (rules 1).

    A robot that is too large could reach a marker while it stands.
    """
    return [
        Mistake(
            file=file,
            field="start.posture_deg",
            found=found,
            expected=expected,
        )
        for posture, where in standing_postures(gait, levels, robot.start_posture).items()
        if posture != robot.start_posture  # the robot file is checked for that one
        for found, expected in too_large(
            robot.bounds(posture),
            say("posture.key-0", levels=["AB"[level] for level in where]),
            limits,
        )
    ]


def mistakes_of(stood: Stood, file: str, levels: Sequence[Level]) -> list[Mistake]:
    """List what kept a robot from standing.

    Args:
        stood: what the robot did.
        file: name of the robot file.
        levels: levels whose key 0 gave the posture.

    Returns:
        One mistake for each limit that was broken; none for a robot that stays where it is.
    """
    book = []

    def note(found: Phrase, expected: Phrase) -> None:
        where = say("robot.stands", levels=["AB"[level] for level in levels], found=found)
        book.append(Mistake(file=file, field="start.posture_deg", found=where, expected=expected))

    if stood.fault:
        note(say("robot.unstable"), say("robot.stable"))
    if stood.moved_m > FARTHEST_IN_TEST_M:
        note(
            say("robot.strays", moved_m=stood.moved_m, within_s=STAND_TEST_S),
            say("robot.stays", farthest_m=FARTHEST_IN_TEST_M),
        )
    if stood.tilt_rad > MOST_TILT_RAD:
        note(
            say("robot.leans", tilt_deg=math.degrees(stood.tilt_rad)),
            say("robot.upright", most_deg=round(math.degrees(MOST_TILT_RAD), 6)),
        )
    if stood.joint_rad_s > REST_RAD_S or stood.centre_m_s > REST_M_S:
        note(
            say(
                "robot.moves",
                after_s=STAND_TEST_S,
                joint_deg_s=math.degrees(stood.joint_rad_s),
                centre_mm_s=1000 * stood.centre_m_s,
            ),
            say(
                "robot.rests",
                joint_deg_s=round(math.degrees(REST_RAD_S), 6),
                centre_mm_s=round(1000 * REST_M_S, 6),
            ),
        )
    return book
