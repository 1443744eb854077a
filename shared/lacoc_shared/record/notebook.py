"""Reads a record as numpy arrays, with units in their names, for notebooks and one's own programs.

    from lacoc_shared.record import notebook

    match = notebook.read("recordings/20260501-100000-main-001.mcap")
    left = match.robots[0]
    print(left.team, match.score[-1], left.position_m[match.playing])

docs/notebook.md describes every array. The arrays of an object have one entry for each frame, key
or event, in the order of time; only arrays about markers have one entry for each marker. `columns`
returns the arrays by name, as a table for pandas or a spreadsheet.
"""

import dataclasses
import math
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lacoc_shared import codec
from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import ROOT_FLOATS, Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export.kinematics import euler_zyx, joints_per_seat, split_poses
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEAT_S, Phase
from lacoc_shared.words import render, say

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]
Flags = NDArray[np.bool_]
Texts = NDArray[np.str_]


@dataclass(frozen=True, repr=False)  # that of a dataclass prints whole arrays
class RobotArrays:
    """The robot of a seat in each frame, as arrays; NaN in frames without robots on the field."""

    seat: str
    team: str
    """The team that held the seat last."""
    position_m: Floats
    """Centre of the body in the world: x, y, z; (frames, 3)."""
    quaternion: Floats
    """Orientation, body to world: w, x, y, z; (frames, 4)."""
    roll_pitch_yaw_rad: Floats
    """The same orientation as Euler angles ZYX (rules 2); (frames, 3)."""
    joints_rad: Floats
    """Joint angles by joint id; (frames, joints). If the team changed its robot, the columns are
    those of the robot with the most joints."""

    def __repr__(self) -> str:
        frames, joints = self.joints_rad.shape
        return f"RobotArrays(seat={self.seat!r}, team={self.team!r}, {frames=}, {joints=})"


@dataclass(frozen=True, repr=False)
class KeyArrays:
    """The keys that were pressed on all seats, as arrays; also those that the match refused."""

    beat: Numbers
    """Beat in which the match took the key."""
    time_s: Floats
    seat: Numbers
    """Index of the seat in `MatchArrays.robots`."""
    level: Numbers
    """Level of the key; 0: level A, 1: level B."""
    key: Numbers
    """Digit of the key; 10 is [x]."""
    held_ms: Floats
    """Time for which the court delayed the key, to make the links equal."""
    late_ms: Floats
    """Time between the end of the common delay and the key's effect; 0: in time."""

    def __repr__(self) -> str:
        return f"KeyArrays({len(self.beat)} keys)"


@dataclass(frozen=True, repr=False)
class EventArrays:
    """The events of a match as arrays."""

    number: Numbers
    beat: Numbers
    time_s: Floats
    clock_s: Floats
    kind: Texts
    """Kind of the event: phase, flip, capture, strike, decision and others (docs/protocol.md)."""
    seat: Numbers
    """Index of the seat that the event is about; -1: none."""
    text: Texts
    """The event as a sentence in the language of the process."""

    def __repr__(self) -> str:
        return f"EventArrays({len(self.beat)} events)"


@dataclass(frozen=True, repr=False)
class MatchArrays:
    """A match as arrays. Arrays without a note have one entry for each frame."""

    match_id: str
    arena: str
    beat: Numbers
    """Beat of each frame. The court records fewer frames while nothing moves, before and after
    play."""
    time_s: Floats
    """Time since beat 0 of the match."""
    clock_s: Floats
    """Time that was used on the clock of play."""
    phase: Texts
    """Name of the phase, such as "PLAYING"."""
    playing: Flags
    """True in the phase PLAYING: `match.time_s[match.playing]`."""
    score: Numbers
    """Points of each seat; (frames, seats)."""
    markers: NDArray[np.uint8]
    """State of each marker: 0 neutral, 1 left, 2 right, 3 down; (frames, markers)."""
    marker_names: Texts
    """Name of each marker; (markers,)."""
    marker_position_m: Floats
    """Position of each marker in the world: x, y; (markers, 2)."""
    robots: tuple[RobotArrays, ...]
    """The robots, one for each seat."""
    keys: KeyArrays
    events: EventArrays
    winner: str
    """Id of the official winner's seat; if there is none, of the winner by the rules. Also "draw",
    "void", or "" if there is no winner yet."""
    cut: str
    """Where the record ends too early, and why; "": the record is complete."""

    def __repr__(self) -> str:
        match_id, arena, winner = self.match_id, self.arena, self.winner
        frames, teams = len(self.beat), [robot.team for robot in self.robots]
        return f"MatchArrays({match_id=}, {arena=}, {frames=}, {teams=}, {winner=})"


def read(path: str | Path | Iterable[str | Path]) -> MatchArrays:
    """Read the record of a match as arrays.

    Args:
        path: the .mcap file of a match or one of its segments, as a text or a Path; or several
            segments, in order.

    Raises:
        UserError: if it is no record, holds no frame, or its messages contradict each other.
    """
    paths = Path(path) if isinstance(path, str | Path) else [Path(one) for one in path]
    record = Record.read(paths)
    if not record.frames or not record.sheets:
        raise UserError(say("notebook.no-frames", match=record.header.match_id[:80]))
    try:
        return _match(record)
    except (ValueError, ArithmeticError, LookupError, TypeError, struct.error) as error:
        match = record.header.match_id[:80]
        raise UserError(say("replay.damaged-copy", match=match, error=str(error)[:80])) from None


def columns(table: KeyArrays | EventArrays) -> dict[str, NDArray[Any]]:
    """Return the columns of a table by name: `pandas.DataFrame(columns(match.events))`."""
    return {field.name: getattr(table, field.name) for field in dataclasses.fields(table)}


def _match(record: Record) -> MatchArrays:
    frames = [codec.decode(encoded, Frame) for _, encoded in record.frames]
    beats = np.array([beat for beat, _ in record.frames], dtype=np.int64)
    sheet = record.sheets[-1][1]
    seats = len(sheet.seats)
    count = len(sheet.markers)
    result = record.result
    return MatchArrays(
        match_id=record.header.match_id,
        arena=record.header.setup.arena,
        beat=beats,
        time_s=_times(beats),
        clock_s=_times(np.array([frame.clock_ticks for frame in frames], dtype=np.int64)),
        phase=np.array([Phase(frame.phase).name for frame in frames]),
        playing=np.array([frame.phase == Phase.PLAYING for frame in frames]),
        score=np.array(
            [[seat.score for seat in frame.seats] for frame in frames], dtype=np.int64
        ).reshape(len(frames), seats),
        markers=np.array(
            [codec.unpack_states(frame.markers, count) for frame in frames], dtype=np.uint8
        ).reshape(len(frames), count),
        marker_names=np.array([marker.name for marker in sheet.markers], dtype=np.str_),
        marker_position_m=np.array(
            [(marker.x_m, marker.y_m) for marker in sheet.markers], dtype=np.float64
        ).reshape(count, 2),
        robots=_robots(record, frames, sheet),
        keys=_keys(record),
        events=_events(record),
        winner=(result.official or result.computed) if result is not None else "",
        cut=render(record.cut) if record.cut else "",
    )


def _robots(record: Record, frames: list[Frame], last: Sheet) -> tuple[RobotArrays, ...]:
    joints_of = {beat: joints_per_seat(sheet) for beat, sheet in record.sheets}
    most = [max(column) for column in zip(*joints_of.values(), strict=True)]
    poses = [np.full((len(frames), ROOT_FLOATS + joints), math.nan) for joints in most]
    starts = np.array(list(joints_of))
    for row, (beat, _) in enumerate(record.frames):
        valid = int(np.searchsorted(starts, beat, side="right")) - 1
        if valid < 0 or not frames[row].poses:
            continue
        joints = joints_of[int(starts[valid])]
        for seat, pose in enumerate(split_poses(frames[row].poses, joints)):
            poses[seat][row, : len(pose)] = pose
    return tuple(
        RobotArrays(
            seat=seat.id,
            team=seat.team,
            position_m=pose[:, :3],
            quaternion=pose[:, 3:ROOT_FLOATS],
            roll_pitch_yaw_rad=euler_zyx(pose[:, 3:ROOT_FLOATS]),
            joints_rad=pose[:, ROOT_FLOATS:],
        )
        for seat, pose in zip(last.seats, poses, strict=True)
    )


def _keys(record: Record) -> KeyArrays:
    found = [
        (beat, item.seat, item.level, item.key, item.held, item.late)
        for beat, inputs in record.inputs.items()
        for item in inputs
        if isinstance(item, KeySeat)
    ]
    beat, seat, level, key, held, late = np.array(found, dtype=np.int64).reshape(-1, 6).T
    return KeyArrays(beat, _times(beat), seat, level, key, 1000 * _times(held), 1000 * _times(late))


def _events(record: Record) -> EventArrays:
    events = record.events
    beat = np.array([event.beat for event in events], dtype=np.int64)
    return EventArrays(
        number=np.array([event.number for event in events], dtype=np.int64),
        beat=beat,
        time_s=_times(beat),
        clock_s=_times(np.array([event.clock_ticks for event in events], dtype=np.int64)),
        kind=np.array([event.kind for event in events], dtype=np.str_),
        seat=np.array([event.seat for event in events], dtype=np.int64),
        text=np.array([render(event.said) for event in events], dtype=np.str_),
    )


def _times(beats: Numbers) -> Floats:
    return np.asarray(beats * BEAT_S, dtype=np.float64)
