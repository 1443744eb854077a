"""Pos-data.txt: how one robot moved in a match, tick by tick, as a table for a spreadsheet."""

import numpy as np

from lacoc_shared.messages import ROOT_FLOATS, Frame
from lacoc_shared.record.export.kinematics import Array, euler_zyx, split_poses
from lacoc_shared.seat import BEAT_S, Phase

_PHYSICS = (Phase.READY, Phase.PLAYING)


class PosData:
    """Collects the poses of one seat's robot at each tick, from a record or live.

    Args:
        seat: index of the seat.
        joints: number of joints of each seat's robot, as in the frames.
    """

    def __init__(self, seat: int, joints: tuple[int, ...]) -> None:
        self.joints = joints
        self._seat = seat
        self._rows: list[tuple[int, int, Array]] = []  # beat, tick, pose
        self._last: Frame | None = None
        self._tick = 0

    def add(self, frame: Frame) -> None:
        """Add a frame; it becomes a row of the table if physics ran in its beat.

        A frame older than the last one is ignored.

        Raises:
            ValueError: if the frame's robots have other numbers of joints.
        """
        last = self._last
        if last is not None and frame.beat <= last.beat:
            return
        self._last = frame
        if not _physics_ran(frame, last):
            return
        pose = split_poses(frame.poses, self.joints)[self._seat]
        if self._rows and last is not None:
            # Frames may be lost in transit, but while physics runs every beat is a tick.
            self._tick += frame.beat - last.beat if last.phase in _PHYSICS else 1
        self._rows.append((frame.beat, self._tick, pose))

    def times_s(self) -> dict[int, float]:
        """Return the time of each row, by the beat of its frame."""
        return {beat: tick * BEAT_S for beat, tick, _ in self._rows}

    def text(self) -> str:
        """Return the file as a text: tab-separated, a header row, then a row for each tick."""
        names = [f"j{joint}_deg" for joint in range(self.joints[self._seat])]
        header = ["time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg", *names]
        lines = ["\t".join(header)]
        for _, tick, pose in self._rows:
            angles = [*euler_zyx(pose[3:ROOT_FLOATS]), *pose[ROOT_FLOATS:]]
            values = [tick * BEAT_S, *pose[:3], *np.degrees(angles)]
            lines.append("\t".join(f"{value:z.6f}" for value in values))
        return "\n".join(lines) + "\n"


def _physics_ran(frame: Frame, last: Frame | None) -> bool:
    if frame.phase in _PHYSICS:
        return True
    # Physics runs in the tick that ends a match too (rules 4: tick 9000 is the last one).
    return (
        frame.phase == Phase.FINISHED
        and last is not None
        and last.phase == Phase.PLAYING
        and frame.clock_ticks > last.clock_ticks
    )
