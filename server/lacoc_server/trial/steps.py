"""Computes from the table alone, without physics, where a sequence of postures puts the feet."""

from collections.abc import Sequence
from dataclasses import dataclass

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.feet import mean_phase
from lacoc_server.trial.support import margin_m
from lacoc_shared.gait.tables import JOINTS_PER_LEG, Posture

LIFT_M = 0.004
"""A foot that is less than this above the lowest foot counts as standing on the floor [m]."""
_TOUCHES_M = 0.001
"""A shank less than this above the body's underside counts as touching the floor [m]."""
_LEANS_M = 0.025
"""A foot that is more than this above the lowest foot carries nothing, because the body would have
to lean too far [m]."""
_OUTSIDE_M = 0.03
"""A body falls if its middle is farther than this outside the polygon of the feet that reach the
floor [m]."""


@dataclass(frozen=True)
class Steps:
    """The places of each leg's foot in the postures of a sequence, in the body frame."""

    ahead_m: list[list[float]]
    """For each leg and posture, the foot's y: how far it is in front of the body's origin."""
    lift_m: list[list[float]]
    """For each leg and posture, how high the foot is above the lowest foot of this posture."""
    reaches: list[list[bool]]
    """For each leg and posture, whether its thick shank comes as low as the body. If not, the body
    lies on the floor before this foot touches it."""
    stands: list[bool]
    """For each posture, whether at least half of the feet reach the floor together, and the middle
    of the body is about above them."""

    @property
    def carries(self) -> list[list[bool]]:
        """For each posture and leg, whether the foot is about as low as the lowest one."""
        return [[lift < LIFT_M for lift in feet] for feet in zip(*self.lift_m, strict=True)]

    @property
    def highest_m(self) -> list[float]:
        """For each leg, its largest lift in all postures."""
        return [max(lift) for lift in self.lift_m]

    @property
    def swing_m2(self) -> list[float]:
        """For each leg, its motion forward times its lift, summed over the sequence.

        A negative value means that the leg swings backward while it is lifted. Motion between
        postures in which the robot does not stand is not counted, because no foot pushes then.
        """
        return [
            sum(
                (ahead[index] - ahead[index - 1])
                * (lift[index] + lift[index - 1])
                * (self.stands[index] + self.stands[index - 1])
                / 4
                for index in range(len(ahead))
            )
            for ahead, lift in zip(self.ahead_m, self.lift_m, strict=True)
        ]

    @property
    def phase(self) -> list[float]:
        """For each leg, the mean time in the sequence at which it is lifted, from 0 to 1."""
        return [
            mean_phase([index / len(lift) for index in range(len(lift))], lift)
            for lift in self.lift_m
        ]

    def swings_to(self, leg: int) -> int:
        """Return the index of the posture to which a leg swings forward most."""
        ahead = self.ahead_m[leg]
        return max(range(len(ahead)), key=lambda index: ahead[index] - ahead[index - 1])


def steps_of(robot: RobotSpec, sequence: Sequence[Posture]) -> Steps:
    """Compute where a sequence puts the feet."""
    points = [robot.points(posture) for posture in sequence]
    tips = [[leg[3] for leg in placed] for placed in points]
    lowest_m = [min(tip.z for tip in feet) for feet in tips]
    legs = range(len(robot.legs))
    under_m = -robot.size_m[2] / 2
    reaches = [
        [
            min(shank.start.z, shank.end.z) - shank.radius_m < under_m + _TOUCHES_M
            for shank in (spec.capsule(JOINTS_PER_LEG - 1, placed[leg]) for placed in points)
        ]
        for leg, spec in enumerate(robot.legs)
    ]
    return Steps(
        [[feet[leg].y for feet in tips] for leg in legs],
        [[feet[leg].z - low for feet, low in zip(tips, lowest_m, strict=True)] for leg in legs],
        reaches,
        [
            _stands(
                [
                    (feet[leg].x, feet[leg].y)
                    for leg in legs
                    if reaches[leg][index] and feet[leg].z - low < _LEANS_M
                ],
                len(legs),
            )
            for index, (feet, low) in enumerate(zip(tips, lowest_m, strict=True))
        ],
    )


def _stands(feet: Sequence[tuple[float, float]], legs: int) -> bool:
    if len(feet) < legs // 2:
        return False
    margin = margin_m(feet, (0.0, 0.0))
    return margin is not None and margin > -_OUTSIDE_M
