"""What a learned policy sees of a frame: numbers with units, from its own seat's side.

A robot in the right seat sees the field turned by 180 degrees, and its own robot first. So one
policy can play both seats. If the field is not the same after this turn, nothing is turned.

Environments and exported bots use the same functions. So a policy sees the same numbers, bit for
bit, while it learns and while it plays (docs/environments.md).
"""

from collections.abc import Sequence
from struct import Struct
from typing import Any

import numpy as np
import numpy.typing as npt

from lacoc_shared.codec import unpack_states
from lacoc_shared.gait.tables import JOINTS_PER_LEG
from lacoc_shared.messages import Frame, MarkerInfo, Sheet
from lacoc_shared.seat import BEATS_PER_S

Numbers = npt.NDArray[np.float32]

BODY = ("x_m", "y_m", "z_m", "forward_x", "forward_y", "up")
"""Names of the numbers of a robot's body: position of its middle, x and y of its forward
direction, and how upright it is (1 upright, -1 on its back)."""
SEAT = ("points", "key", "posture", "locked_s")
"""Names of the numbers of a seat: its points, the digit of its present key, the index of the
posture that its robot moves to, and for how long keys are still refused."""
CLOCK = ("left_s", "played_s")
"""Names of the numbers of the clock: time left to play (0 without a limit), and time played."""

_POSE = 7
"""How many numbers a robot has in `Frame.poses` before its joint angles: position and
quaternion."""
_FLOAT = np.dtype("<f4")


class Senses:
    """Reads the frames of one match as numbers.

    The numbers are, in this order: for each robot, its own first, `BODY` and the angle of each
    joint [rad] by joint id; for each seat, its own first, `SEAT`; then `CLOCK`; then for each
    marker 1 if the own seat has it, -1 if another seat has it, 0 if it is neutral and 0.5 if it is
    a flag that fell for nobody.

    Args:
        sheet: the sheet of the match, with all robots.
    """

    def __init__(self, sheet: Sheet) -> None:
        self._sheet = sheet
        self._seats = len(sheet.seats)
        self._duration_ticks = round(sheet.duration_s * BEATS_PER_S)
        self._markers = len(sheet.markers)
        self._joints = [JOINTS_PER_LEG * len(seat.legs) for seat in sheet.seats]
        turned = partners(sheet.markers) if self._seats == 2 else None
        self._turned = turned
        self.names = tuple(self._names(sheet))
        """Name of each number; in the names the seats are "own" and "other"."""
        self.size = len(self.names)
        angles = [f"{_FLOAT.itemsize * joints}s" for joints in self._joints]
        self._unpack = Struct("<" + "".join(f"{_POSE}f{size}" for size in angles)).unpack
        seats = range(self._seats)
        self._orders = [(seat, *(s for s in seats if s != seat)) for seat in seats]
        rest = f"{self._seats * len(SEAT) + len(CLOCK)}f{_FLOAT.itemsize * self._markers}s"
        self._packs = [
            Struct(
                "<" + "".join(f"{len(BODY)}f{angles[robot]}" for robot in order) + rest
            ).pack_into
            for order in self._orders
        ]
        self._packed: bytes | None = None
        self._boards: list[bytes] = []
        self._frame: Frame | None = None
        self._parts: tuple[Any, ...] = ()

    def __reduce__(self) -> tuple[Any, ...]:
        return Senses, (self._sheet,)  # what packs numbers can't be copied

    def see(self, frame: Frame, seat: int) -> Numbers:
        """Return what a seat sees of a frame: an array of `size` numbers.

        The frame must be of phase READY or later.
        """
        if frame is not self._frame:
            self._frame, self._parts = frame, self._read(frame)
        bodies, commands, clock = self._parts
        turns = seat == 1 and self._turned is not None
        values: list[Any] = []
        for robot in self._orders[seat]:
            values += bodies[robot][turns]
        for robot in self._orders[seat]:
            values += commands[robot]
        numbers = np.empty(self.size, _FLOAT)
        self._packs[seat](numbers.data, 0, *values, *clock, self._boards[seat])
        return numbers

    def _read(self, frame: Frame) -> tuple[Any, ...]:
        """Read the numbers of a frame: each seat's body and present key, and the clock."""
        if frame.markers != self._packed:
            self._packed, self._boards = frame.markers, self._read_board(frame.markers)
        poses = self._unpack(frame.poses)
        played = frame.clock_ticks
        left = max(0, self._duration_ticks - played) if self._duration_ticks else 0
        size = _POSE + 1
        return (
            [_body(*poses[size * seat : size * (seat + 1)]) for seat in range(self._seats)],
            [
                (seat.score, seat.key, seat.posture, seat.locked_ticks / BEATS_PER_S)
                for seat in frame.seats
            ],
            (left / BEATS_PER_S, played / BEATS_PER_S),
        )

    def _read_board(self, packed: bytes) -> list[bytes]:
        states = unpack_states(packed, self._markers)
        boards = []
        for seat in range(self._seats):
            order: Sequence[int] = range(self._markers)
            if seat == 1 and self._turned is not None:
                order = self._turned
            values = [_value(states[marker], seat) for marker in order]
            boards.append(np.array(values, _FLOAT).tobytes())
        return boards

    def _names(self, sheet: Sheet) -> list[str]:
        whose = ("own", *("other" for _ in range(self._seats - 1)))
        names = []
        for owner, joints in zip(whose, self._joints, strict=True):
            names += [f"{owner} {name}" for name in BODY]
            names += [f"{owner} angle {joint} [rad]" for joint in range(joints)]
        names += [f"{owner} {name}" for owner in whose for name in SEAT]
        return [*names, *CLOCK, *(marker.name for marker in sheet.markers)]


def partners(markers: Sequence[MarkerInfo]) -> tuple[int, ...] | None:
    """Return each marker's partner: the marker whose place it takes when the field is turned.

    The turn is by 180 degrees. Partners have the same kind and the same points. The result is None
    if a marker has no partner: then the field is not symmetric.
    """
    places = {_place(m, 1): index for index, m in enumerate(markers)}
    found = [places.get(_place(m, -1)) for m in markers]
    return None if None in found else tuple(index for index in found if index is not None)


def _place(marker: MarkerInfo, sign: int) -> tuple[object, ...]:
    x, y = (round(sign * value_m * 1e6) for value_m in (marker.x_m, marker.y_m))
    return x, y, marker.kind, marker.points


def _value(state: int, seat: int) -> float:
    """Return a marker's state as a seat sees it.

    1: the seat has it; -1: another seat has it; 0: neutral; 0.5: a flag that fell for nobody.
    """
    if state == seat + 1:
        return 1.0
    return (0.0, -1.0, -1.0, 0.5)[state]


def _body(
    x: float, y: float, z: float, qw: float, qx: float, qy: float, qz: float, angles: bytes
) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return the numbers of a robot twice: as it is, and with the field turned by 180 degrees."""
    ahead_x, ahead_y = 2 * (qx * qy - qw * qz), 1 - 2 * (qx * qx + qz * qz)
    up = 1 - 2 * (qx * qx + qy * qy)
    return (x, y, z, ahead_x, ahead_y, up, angles), (-x, -y, z, -ahead_x, -ahead_y, up, angles)
