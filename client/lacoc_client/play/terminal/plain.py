"""Frames and events as plain values with names, for programs that read LACOC's JSON."""

from typing import Any

import msgspec
import numpy as np

from lacoc_shared.codec import unpack_states
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import (
    MARKER_STATES,
    ROOT_FLOATS,
    DecisionReply,
    Event,
    Frame,
    Outlook,
    SeatFrame,
    Sheet,
    SheetSeat,
)
from lacoc_shared.record.export.kinematics import (
    euler_zyx,
    joints_per_seat,
    split_poses,
)
from lacoc_shared.seat import BEAT_S, Phase, SeatFlag
from lacoc_shared.words import render


def frame_dict(frame: Frame, sheet: Sheet) -> dict[str, Any]:
    """Turn a frame into plain values.

    Args:
        frame: the frame.
        sheet: the sheet that belongs to it.

    Returns:
        Its values by name; lengths in metres, times in seconds, angles in degrees. `poses` is empty
        while there are no robots, and if the sheet belongs to another scene. `markers` is empty if
        the frame has too few.
    """
    used_s = frame.clock_ticks * BEAT_S
    return {
        "match": frame.match,
        "beat": frame.beat,
        "phase": Phase(frame.phase).name,
        "countdown_s": round(frame.countdown_beats * BEAT_S, 2),
        "clock_s": round(used_s, 2),
        "left_s": round(sheet.duration_s - used_s, 2) if sheet.duration_s else None,
        "seats": [_seat(info, seat) for info, seat in zip(sheet.seats, frame.seats, strict=False)],
        "markers": marker_states(frame, sheet),
        "poses": poses(frame, sheet),
        "digest": frame.digest.hex(),
    }


def event_dict(event: Event, sheet: Sheet) -> dict[str, Any]:
    """Turn an event into plain values: code, values, text, the seat's name, clock in seconds."""
    plain: dict[str, Any] = msgspec.to_builtins(event) | {"text": render(event.said)}
    del plain["clock_ticks"]
    plain["clock_s"] = round(event.clock_ticks * BEAT_S, 2)
    plain["seat"] = sheet.seats[event.seat].id if 0 <= event.seat < len(sheet.seats) else None
    return plain


def reply_dict(reply: DecisionReply) -> dict[str, Any]:
    """Turn the reply to a decision into plain values; `text` is its sentence."""
    plain: dict[str, Any] = msgspec.to_builtins(reply)
    return plain | {"text": render(reply.said)}


def outlook_dict(outlook: Outlook, sheet: Sheet) -> dict[str, Any]:
    """Turn an outlook into plain values, and each of its events as `event_dict` does."""
    plain: dict[str, Any] = msgspec.to_builtins(outlook)
    del plain["clock_ticks"]
    return plain | {
        "clock_s": round(outlook.clock_ticks * BEAT_S, 2),
        "phase": Phase(outlook.phase).name,
        "events": [event_dict(event, sheet) for event in outlook.events],
    }


def marker_states(frame: Frame, sheet: Sheet) -> dict[str, str]:
    """Return the state of each marker, by the marker's name; empty if the frame has too few."""
    if 4 * len(frame.markers) < len(sheet.markers):
        return {}
    states = unpack_states(frame.markers, len(sheet.markers))
    return {
        marker.name: MARKER_STATES[state]
        for marker, state in zip(sheet.markers, states, strict=True)
    }


def poses(frame: Frame, sheet: Sheet) -> dict[str, dict[str, float]]:
    """Return each robot's position in the world's frame [m] and the heading of its body's +y.

    The heading is measured counter-clockwise from the world's +x [deg].
    """
    if not frame.poses or frame.scene != sheet.scene:
        return {}
    found = {}
    for seat, pose in zip(
        sheet.seats, split_poses(frame.poses, joints_per_seat(sheet)), strict=True
    ):
        yaw_deg = float(np.degrees(euler_zyx(pose[3:ROOT_FLOATS])[2]))
        heading_deg = (yaw_deg + 90 + 180) % 360 - 180  # yaw is 0 where +y points along +y
        values = {"x_m": pose[0], "y_m": pose[1], "z_m": pose[2], "heading_deg": heading_deg}
        found[seat.id] = {name: round(float(value), 4) for name, value in values.items()}
    return found


def _seat(info: SheetSeat, seat: SeatFrame) -> dict[str, Any]:
    flags = SeatFlag(seat.flags)
    return {
        "id": info.id,
        "team": info.team or None,
        "score": seat.score,
        "level": "AB"[Level(seat.level)],
        "key": seat.key,
        "posture": seat.posture,
        "locked_s": round(seat.locked_ticks * BEAT_S, 2),
        **{str(flag.name).lower(): flag in flags for flag in SeatFlag},
    }
