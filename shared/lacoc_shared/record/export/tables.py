"""Exports tables and JSON from a record; `foxglove` exports the 3D view."""

import msgspec

from lacoc_shared import codec
from lacoc_shared.command.csv_text import csv_text
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export.kinematics import joints_per_seat
from lacoc_shared.record.export.pos_data import PosData
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import render, say


def pos_data(record: Record, seat: str) -> bytes:
    """Make the table Pos-data.txt: how the robot of a seat moved, tick by tick.

    If a team joins during the match with a robot that has another number of joints, all earlier
    rows are dropped.

    Raises:
        UserError: if there is no such seat, or no frame has poses of robots.
    """
    data = _path(record, seat_index(record, seat))
    if data is None:
        raise UserError(say("export.no-path", match=record.header.match_id))
    return data.text().encode()


def events_csv(record: Record) -> bytes:
    """Make a table of all events with one header row; the texts are in the process's language.

    `pos_data_s` is the `time_s` of the row of Pos-data of the same beat; "" if there is none.
    """
    path = _path(record, 0)  # physics runs for all robots at once
    times_s = path.times_s() if path else {}
    rows: list[tuple[object, ...]] = [
        ("number", "beat", "clock_s", "pos_data_s", "kind", "seat", "team", "code", "text")
    ]
    for event in record.events:
        sheet = record.sheet_at(event.beat)
        seat = sheet.seats[event.seat] if sheet is not None and event.seat >= 0 else None
        rows.append(
            (
                event.number,
                event.beat,
                f"{event.clock_ticks / BEATS_PER_S:.2f}",
                f"{times_s[event.beat]:.2f}" if event.beat in times_s else "",
                event.kind,
                seat.id if seat else "",
                seat.team if seat else "",
                event.said.code,
                render(event.said),
            )
        )
    return csv_text(rows)


def result_json(record: Record) -> bytes:
    """Return the result of a match as JSON.

    It has the entries of `Result` and two more: `played_s` is `clock_s` plus the time that the
    referee gave; `health` says how well the match ran, and is null if no court measured it.

    Raises:
        UserError: if the match has no result.
    """
    if record.result is None:
        match = record.header.match_id
        if record.lost:
            raise UserError(say("export.result-lost", match=match))
        raise UserError(say("export.no-result", match=match))
    found = msgspec.structs.asdict(record.result) | {
        "played_s": record.result.clock_s + record.given_s,
        "health": record.health,
    }
    return msgspec.json.format(msgspec.json.encode(found), indent=2) + b"\n"


def seat_index(record: Record, seat: str) -> int:
    """Return the index of a seat among the seats of a match.

    Raises:
        UserError: if the match has no such seat; the message lists the seats it has.
    """
    seats = seat_ids(record)
    if seat not in seats:
        raise UserError(say("export.no-seat", seat=seat, seats=seats))
    return seats.index(seat)


def seat_ids(record: Record) -> list[str]:
    """Return the ids of a match's seats, in the arena's order."""
    return [seat.id for seat in record.sheets[-1][1].seats] if record.sheets else []


def _path(record: Record, seat: int) -> PosData | None:
    """Return the path of a seat's robot since no robot had another number of joints.

    None: no frame has poses of robots.
    """
    data: PosData | None = None
    for beat, encoded in record.frames:
        frame = codec.decode(encoded, Frame)
        sheet = record.sheet_at(beat)
        if sheet is None or not frame.poses:
            continue
        joints = joints_per_seat(sheet)
        if data is None or data.joints != joints:  # a team came back with another robot
            data = PosData(seat, joints)
        data.add(frame)
    return data
