"""The numbers of a match as messages that viewers plot: clock, and score, keys and joints by seat.

The messages are protobuf with their own description in the file, because all viewers read that.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2
from google.protobuf.message import Message
from google.protobuf.timestamp_pb2 import Timestamp

from lacoc_shared.messages import ROOT_FLOATS, Frame, Sheet
from lacoc_shared.record.export.kinematics import euler_zyx, joints_per_seat, split_poses
from lacoc_shared.seat import BEAT_S

_FIELD = descriptor_pb2.FieldDescriptorProto
_NUMBER, _WHOLE, _TIME = _FIELD.TYPE_DOUBLE, _FIELD.TYPE_INT32, _FIELD.TYPE_MESSAGE

_FIELDS: Mapping[str, Mapping[str, int]] = {
    "Match": {"timestamp": _TIME, "phase": _WHOLE, "clock_s": _NUMBER, "left_s": _NUMBER},
    "Robot": {
        "timestamp": _TIME,
        "score": _WHOLE,
        "level": _WHOLE,
        "key": _WHOLE,
        "posture": _WHOLE,
        "locked_s": _NUMBER,
        "x_m": _NUMBER,
        "y_m": _NUMBER,
        "z_m": _NUMBER,
        "roll_deg": _NUMBER,
        "pitch_deg": _NUMBER,
        "yaw_deg": _NUMBER,
        "joint_deg": _NUMBER,
    },
}
"""Fields of each message: `left_s` is the time that is left (0 without a limit), `joint_deg` has an
angle for each joint id."""
_MANY = ("joint_deg",)


def _made() -> dict[str, type[Message]]:
    file = descriptor_pb2.FileDescriptorProto(
        name="lacoc.proto",
        package="lacoc",
        syntax="proto3",
        dependency=["google/protobuf/timestamp.proto"],
    )
    for name, fields in _FIELDS.items():
        message = file.message_type.add(name=name)
        for number, (field, kind) in enumerate(fields.items(), 1):
            label = _FIELD.LABEL_REPEATED if field in _MANY else _FIELD.LABEL_OPTIONAL
            added = message.field.add(name=field, number=number, type=kind, label=label)
            if kind == _TIME:
                added.type_name = ".google.protobuf.Timestamp"
    pool = descriptor_pool.DescriptorPool()
    pool.AddSerializedFile(timestamp_pb2.DESCRIPTOR.serialized_pb)
    pool.Add(file)
    return {
        name: message_factory.GetMessageClass(pool.FindMessageTypeByName(f"lacoc.{name}"))
        for name in _FIELDS
    }


_KINDS = _made()
MATCH, ROBOT = _KINDS["Match"], _KINDS["Robot"]
"""The classes of the two kinds of messages."""


def topics(seats: Sequence[str]) -> dict[str, type[Message]]:
    """Return the topics of a match with these seats, with the message class of each topic."""
    return {"/match": MATCH} | {f"/robot/{seat}": ROBOT for seat in seats}


def figures(frame: Frame, sheet: Sheet, time: Timestamp) -> Iterator[tuple[str, Message]]:
    """Yield the messages of a frame with their topics; robots only while they are on the field.

    Args:
        frame: the frame.
        sheet: the sheet that is valid for the frame.
        time: the time of the frame.
    """
    clock_s = frame.clock_ticks * BEAT_S
    left_s = max(0.0, sheet.duration_s - clock_s) if sheet.duration_s else 0.0
    yield "/match", _message(MATCH, time, phase=int(frame.phase), clock_s=clock_s, left_s=left_s)
    if not frame.poses:
        return
    poses = split_poses(frame.poses, joints_per_seat(sheet))
    for seat, shown, pose in zip(sheet.seats, frame.seats, poses, strict=True):
        x_m, y_m, z_m = pose[:3].tolist()
        roll, pitch, yaw = np.degrees(euler_zyx(pose[3:ROOT_FLOATS])).tolist()
        yield (
            f"/robot/{seat.id}",
            _message(
                ROBOT,
                time,
                score=shown.score,
                level=shown.level,
                key=shown.key,
                posture=shown.posture,
                locked_s=shown.locked_ticks * BEAT_S,
                x_m=x_m,
                y_m=y_m,
                z_m=z_m,
                roll_deg=roll,
                pitch_deg=pitch,
                yaw_deg=yaw,
                joint_deg=np.degrees(pose[ROOT_FLOATS:]).tolist(),
            ),
        )


def _message(kind: type[Message], time: Timestamp, **values: Any) -> Message:
    message = kind(**values)
    message.timestamp.ParseFromString(time.SerializeToString())
    return message
