"""Computes from the table alone, without physics, where a sequence of postures puts the feet."""

from collections.abc import Sequence
from dataclasses import dataclass

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.feet import mean_phase
from lacoc_shared.gait.tables import Posture


@dataclass(frozen=True)
class Steps:
    """The places of each leg's foot in the postures of a sequence, in the body frame."""

    ahead_m: list[list[float]]
    """For each leg and posture, the foot's y: how far it is in front of the body's origin."""
    lift_m: list[list[float]]
    """For each leg and posture, how high the foot is above the lowest foot of this posture."""

    @property
    def highest_m(self) -> list[float]:
        """For each leg, its largest lift in all postures."""
        return [max(lift) for lift in self.lift_m]

    @property
    def swing_m2(self) -> list[float]:
        """For each leg, its motion forward times its lift, summed over the sequence.

        A negative value means that the leg swings backward while it is lifted.
        """
        return [
            sum(
                (ahead[index] - ahead[index - 1]) * (lift[index] + lift[index - 1]) / 2
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
    tips = [[leg[3] for leg in robot.points(posture)] for posture in sequence]
    lowest_m = [min(tip.z for tip in feet) for feet in tips]
    legs = range(len(robot.legs))
    return Steps(
        [[feet[leg].y for feet in tips] for leg in legs],
        [[feet[leg].z - low for feet, low in zip(tips, lowest_m, strict=True)] for leg in legs],
    )
