"""To stand means to stay: what a robot is told to do before play, and what it must not do then.

Pure: a trial in physics (`trial`) or a match says where the robot went.
"""

import math
from collections.abc import Collection, Sequence

import msgspec

from lacoc_shared.gait.tables import Gait, Level, Posture
from lacoc_shared.mistakes import Mistake

TRIAL_S = 2.0
"""A robot is tried for so long."""
FARTHEST_M = 0.05
"""Where a robot's centre may be while it stands, seen from its start."""
MOST_TILT_RAD = math.radians(30.0)
"""A robot that leans more is not upright."""
REST_RAD_S = math.radians(3.0)
"""At rest no joint turns faster."""
REST_M_S = 0.002
"""At rest the centre moves no faster."""


class Stood(msgspec.Struct, frozen=True):
    """What a robot did in the time of a trial."""

    moved_m: float
    """Largest distance of the body's centre from its start, seen from above."""
    tilt_rad: float
    """Largest angle between the body's up and the world's."""
    joint_rad_s: float
    """Speed of the fastest joint at the end."""
    centre_m_s: float
    """Speed of the body's centre at the end."""
    fault: bool = False
    """Physics stopped."""


def standing_posture(gait: Gait, level: Level, start: Posture) -> Posture:
    """The posture of a robot that is told to stand at a level (decision 15).

    Args:
        gait: its files.
        level: of the command.
        start: its start posture, where it stays if the gait has no key 0 at this level.
    """
    return (gait.sequence(level, 0) or (start,))[0]


def standing_postures(
    gait: Gait, levels: Collection[Level], start: Posture
) -> dict[Posture, list[Level]]:
    """The different postures in which a robot may be told to stand, with their levels."""
    postures: dict[Posture, list[Level]] = {}
    for level in sorted(levels):
        postures.setdefault(standing_posture(gait, level, start), []).append(level)
    return postures


def mistakes_of(stood: Stood, file: str, levels: Sequence[Level]) -> list[Mistake]:
    """Say what kept a robot from standing.

    Args:
        stood: what happened.
        file: name of the robot file.
        levels: at whose key 0 it stood.

    Returns:
        One mistake for each thing that was wrong; none for a robot that stays where it is.
    """
    key = " and ".join(f"level {'AB'[level]}" for level in levels)
    where = f"to stand with key 0 of {key}"
    book = []

    def note(found: str, expected: str) -> None:
        book.append(Mistake(file=file, field=where, found=found, expected=expected))

    if stood.fault:
        note("a robot that physics can't follow", "heavier links, or a servo that is less stiff")
    if stood.moved_m > FARTHEST_M:
        note(
            f"a robot that goes {stood.moved_m:.3f} m from its start within {TRIAL_S:g} s",
            f"at most {FARTHEST_M:g} m: make posture_deg under [start] nearer to key 0, "
            "and let every foot be on the floor",
        )
    if stood.tilt_rad > MOST_TILT_RAD:
        note(
            f"a robot that leans {math.degrees(stood.tilt_rad):.0f} degrees",
            f"at most {math.degrees(MOST_TILT_RAD):.0f} degrees: let the feet stand around "
            "the body's middle",
        )
    if stood.joint_rad_s > REST_RAD_S or stood.centre_m_s > REST_M_S:
        note(
            f"a robot that still moves after {TRIAL_S:g} s: a joint at "
            f"{math.degrees(stood.joint_rad_s):.0f} degrees/s, its middle at "
            f"{1000 * stood.centre_m_s:.0f} mm/s",
            f"rest, at most {math.degrees(REST_RAD_S):.0f} degrees/s and "
            f"{1000 * REST_M_S:.0f} mm/s: make posture_deg nearer to key 0, or kv larger",
        )
    return book
