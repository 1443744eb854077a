"""Exports a record as an MCAP file that Foxglove, Lichtblick and Rerun draw, 25 frames a second.

Topics: /tf (poses of the robots' parts); /scene (shapes; sent again when the scene changes); /board
(all markers as they look now; sent at each change); /events; and numbers to plot: /match (phase,
clock) and /robot/SEAT (score, keys, path, joint angles). Each message of /scene and /board is
complete, so a viewer may jump to any time. The messages are Foxglove's own schemas in protobuf,
because Rerun reads transforms in no other encoding.
"""

from collections.abc import Iterator, Sequence
from datetime import datetime
from io import BytesIO
from itertools import pairwise
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.CubePrimitive_pb2 import CubePrimitive
from foxglove_schemas_protobuf.CylinderPrimitive_pb2 import CylinderPrimitive
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneEntityDeletion_pb2 import SceneEntityDeletion
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.message import Message
from google.protobuf.timestamp_pb2 import Timestamp
from mcap.writer import Writer
from mcap_protobuf.schema import register_schema

from lacoc_shared import __version__, codec
from lacoc_shared.codec import unpack_states
from lacoc_shared.messages import Event, Frame, Scene, SceneGeom, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export.figures import figures, topics
from lacoc_shared.record.export.kinematics import (
    ForwardKinematics,
    joints_per_seat,
    multiply,
    rotate,
)
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import BEAT_NS
from lacoc_shared.words import render, say

_TOPICS: dict[str, type[Message]] = {
    "/tf": FrameTransforms,
    "/scene": SceneUpdate,
    "/board": SceneUpdate,
    "/events": Log,
}
_EVERY = 2
"""Step between exported frames: 2 means that every second frame is exported."""
_WORLD = "world"
_PLANE_M = 10.0
"""Edge of the square that is drawn for an infinite plane [m]."""
_THIN_M = 0.001


def foxglove(record: Record) -> bytes:
    """Return a record as an MCAP file for Foxglove and similar viewers.

    Raises:
        UserError: if the record has no scene.
    """
    if not record.scenes:
        raise UserError(say("export.no-scene", match=record.header.match_id))
    file = BytesIO()
    writer = Writer(file)
    writer.start(library=f"lacoc {__version__}")
    seats = [seat.id for seat in record.sheets[-1][1].seats] if record.sheets else []
    kinds = _TOPICS | topics(seats)
    schemas = {kind: register_schema(writer, kind) for kind in dict.fromkeys(kinds.values())}
    channels = {
        topic: writer.register_channel(topic, "protobuf", schemas[kind])
        for topic, kind in kinds.items()
    }
    started_ns = int(datetime.fromisoformat(record.header.started).timestamp()) * 10**9
    for beat, topic, message in _messages(record, started_ns):
        time_ns = started_ns + beat * BEAT_NS
        writer.add_message(channels[topic], time_ns, message.SerializeToString(), time_ns)
    writer.finish()
    return file.getvalue()


def _messages(record: Record, started_ns: int) -> Iterator[tuple[int, str, Message]]:
    """Yield all messages of the exported file, each with its beat and topic."""
    for event in record.events:
        time = _time(started_ns + event.beat * BEAT_NS)
        yield event.beat, "/events", _log(event, time)
    frames = [(beat, codec.decode(data, Frame)) for beat, data in record.frames]
    begins = [beat for beat, _ in record.scenes] + [record.last_beat + 1]
    for (_, scene), (begin, end) in zip(record.scenes, pairwise(begins), strict=True):
        shown = [(beat, frame) for beat, frame in frames if begin <= beat < end]
        sheet = record.sheet_at(shown[-1][0] if shown else begin)
        if sheet is None:
            continue
        for beat, frame in shown[::_EVERY]:
            time = _time(started_ns + beat * BEAT_NS)
            yield from ((beat, topic, message) for topic, message in figures(frame, sheet, time))
        picture = _ScenePicture(scene, sheet)
        yield begin, "/scene", picture.shapes(_time(started_ns + begin * BEAT_NS))
        moving = [item for item in shown[::_EVERY] if item[1].poses]
        for (beat, _), transforms in zip(
            moving, picture.transforms(moving, started_ns), strict=True
        ):
            yield beat, "/tf", transforms
        board = b""
        for beat, frame in shown:
            if frame.markers != board:
                board = frame.markers
                time = _time(started_ns + beat * BEAT_NS)
                yield beat, "/board", picture.board(board, time)


def _log(event: Event, time: Timestamp) -> Log:
    level = Log.WARNING if event.kind in ("fault", "rules") else Log.INFO
    return Log(timestamp=time, level=level, message=render(event.said, "en"), name=event.kind)


class _ScenePicture:
    """Draws the scene of a match in the colours of its teams, as messages for Foxglove."""

    def __init__(self, scene: Scene, sheet: Sheet) -> None:
        self._scene = scene
        self._sheet = sheet
        self._kinematics = ForwardKinematics(scene, joints_per_seat(sheet))
        self._rest = self._kinematics.poses(self._kinematics.rest)

    def transforms(
        self, frames: Sequence[tuple[int, Frame]], started_ns: int
    ) -> Iterator[FrameTransforms]:
        """Yield for each frame the poses of all moving bodies in the world."""
        if not frames:
            return
        numbers = np.array([np.frombuffer(frame.poses, "<f4") for _, frame in frames])
        pos_w, quat_w = (array.round(6).tolist() for array in self._kinematics.poses(numbers))
        names = {index: self._scene.bodies[index].name for index in self._kinematics.moving}
        for (beat, _), positions, quaternions in zip(frames, pos_w, quat_w, strict=True):
            time = _time(started_ns + beat * BEAT_NS)
            yield FrameTransforms(
                transforms=(
                    FrameTransform(
                        timestamp=time,
                        parent_frame_id=_WORLD,
                        child_frame_id=name,
                        translation=_vector(*positions[index]),
                        rotation=_quaternion(quaternions[index]),
                    )
                    for index, name in names.items()
                )
            )

    def shapes(self, time: Timestamp) -> SceneUpdate:
        """Return a message with all shapes of the scene except those of markers.

        They replace everything that was drawn before.
        """
        geoms: dict[int, list[SceneGeom]] = {}
        for geom in self._scene.geoms:
            if geom.marker < 0:
                geoms.setdefault(geom.body, []).append(geom)
        return SceneUpdate(
            deletions=(_everything(time),),
            entities=(
                self._entity(self._scene.bodies[body].name or f"body{body}", shapes, time)
                for body, shapes in geoms.items()
            ),
        )

    def board(self, packed: bytes, time: Timestamp) -> SceneUpdate:
        """Return a message with all markers as a frame has them; they replace those drawn before.

        Args:
            packed: the markers' states, as in `Frame.markers`.
            time: the time of the frame.
        """
        markers = self._sheet.markers
        states = unpack_states(packed, len(markers))
        geoms: list[list[SceneGeom]] = [[] for _ in markers]
        for geom in self._scene.geoms:
            if geom.marker >= 0 and geom.state in (-1, states[geom.marker]):
                geoms[geom.marker].append(geom)
        return SceneUpdate(
            deletions=(_everything(time),),
            entities=(
                self._entity(marker.name, shapes, time)
                for marker, shapes in zip(markers, geoms, strict=True)
                if shapes
            ),
        )

    def _entity(self, name: str, geoms: Sequence[SceneGeom], time: Timestamp) -> SceneEntity:
        """Make an entity for Foxglove: the shapes of one body, or shapes that never move."""
        moves = any(geom.body in self._kinematics.moving for geom in geoms)
        primitives: list[Any] = [
            primitive for geom in geoms for primitive in self._primitives(geom, moves)
        ]
        return SceneEntity(
            timestamp=time,
            frame_id=self._scene.bodies[geoms[0].body].name if moves else _WORLD,
            id=name,
            frame_locked=True,
            cubes=(p for p in primitives if isinstance(p, CubePrimitive)),
            spheres=(p for p in primitives if isinstance(p, SpherePrimitive)),
            cylinders=(p for p in primitives if isinstance(p, CylinderPrimitive)),
        )

    def _primitives(self, geom: SceneGeom, moves: bool) -> Iterator[Any]:
        """Yield the simple shapes of which a shape is drawn, such as a cylinder and two spheres.

        They are in the frame of the shape's body; if the shape never moves, in the world's frame.
        """
        pos, quat = np.array(geom.pos), np.array(geom.quat)
        if not moves:
            pos_w, quat_w = (array[geom.body] for array in self._rest)
            pos, quat = pos_w + rotate(quat_w, pos), multiply(quat_w, quat)

        def pose(z: float = 0.0) -> Pose:
            along = rotate(quat, np.array([0.0, 0.0, z]))
            return Pose(
                position=_vector(*(pos + along).tolist()), orientation=_quaternion(quat.tolist())
            )

        color = self._color(geom)
        a, b, c = (2 * half for half in geom.size)

        def ball(size: Vector3, z: float = 0.0) -> SpherePrimitive:
            return SpherePrimitive(pose=pose(z), size=size, color=color)

        match geom.type:
            case "plane":
                size = _vector(a or _PLANE_M, b or _PLANE_M, _THIN_M)
                yield CubePrimitive(pose=pose(-_THIN_M / 2), size=size, color=color)
            case "box":
                yield CubePrimitive(pose=pose(), size=_vector(a, b, c), color=color)
            case "sphere":
                yield ball(_vector(a, a, a))
            case "ellipsoid":
                yield ball(_vector(a, b, c))
            case "cylinder" | "capsule":
                yield CylinderPrimitive(
                    pose=pose(), size=_vector(a, a, b), bottom_scale=1.0, top_scale=1.0, color=color
                )
                for end in (-b / 2, b / 2) if geom.type == "capsule" else ():
                    yield ball(_vector(a, a, a), end)

    def _color(self, geom: SceneGeom) -> Color:
        r, g, b, a = geom.rgba
        if geom.seat >= 0:
            team = bytes.fromhex(self._sheet.seats[geom.seat].colour.removeprefix("#"))
            r, g, b = (part / 255 for part in team)
        return Color(r=r, g=g, b=b, a=a)


def _time(time_ns: int) -> Timestamp:
    seconds, nanos = divmod(time_ns, 10**9)
    return Timestamp(seconds=seconds, nanos=nanos)


def _everything(time: Timestamp) -> SceneEntityDeletion:
    """Make the message that deletes everything drawn on a topic before."""
    return SceneEntityDeletion(timestamp=time, type=SceneEntityDeletion.ALL)


def _vector(x: float, y: float, z: float) -> Vector3:
    return Vector3(x=x, y=y, z=z)


def _quaternion(quat: Sequence[float]) -> Quaternion:
    w, x, y, z = quat
    return Quaternion(x=x, y=y, z=z, w=w)
