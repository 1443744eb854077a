"""A drive that moves commanded angles to given angles, not to the postures of a gait."""

from lacoc_server.match.drive import Drive, DriveState
from lacoc_server.match.entry import Entry
from lacoc_shared.gait.motion import toward
from lacoc_shared.gait.tables import Posture
from lacoc_shared.seat import BEAT_US


class Steered(Drive):
    """Moves commanded angles toward `target`, at the robot's own speed; keys have no effect."""

    def __init__(self, entry: Entry) -> None:
        robot = entry.robot
        start, speed = robot.start_posture, robot.ang_min_rad_s
        super().__init__(entry.gait, start, speed, robot.advance, robot.hold_us, repeat=True)
        self.target: Posture = start
        """(joints,) angles to reach [rad], by joint id."""
        self._most_rad = speed * BEAT_US / 1_000_000

    def tick(self, state: DriveState) -> DriveState:
        """Return the state after one tick of 20 ms."""
        return DriveState(state.level, 0, 0, 0, toward(state.angles, self.target, self._most_rad))
