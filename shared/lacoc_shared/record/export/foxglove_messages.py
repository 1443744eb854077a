"""The messages that Foxglove and Lichtblick draw by themselves, as far as a match needs them.

Field names and meanings are those of https://docs.foxglove.dev/docs/sdk/schemas; a
message is JSON, and its schema is made from the struct. Lists that a match never fills
are there because the viewers expect them.
"""

from typing import Any

import msgspec


class Time(msgspec.Struct, frozen=True):
    """Since the Unix epoch; also a length of time."""

    sec: int = 0
    nsec: int = 0

    @classmethod
    def of_ns(cls, time_ns: int) -> "Time":
        """Split nanoseconds."""
        return cls(*divmod(time_ns, 1_000_000_000))


class Vector3(msgspec.Struct, frozen=True):
    """Metres."""

    x: float
    y: float
    z: float


class Quaternion(msgspec.Struct, frozen=True):
    """A turn; w comes last here."""

    x: float
    y: float
    z: float
    w: float


class Pose(msgspec.Struct, frozen=True):
    """Where a primitive's centre is, and its turn."""

    position: Vector3
    orientation: Quaternion


class Color(msgspec.Struct, frozen=True):
    """From 0 to 1."""

    r: float
    g: float
    b: float
    a: float


class FrameTransform(msgspec.Struct, frozen=True):
    """Pose of a child frame in its parent's."""

    timestamp: Time
    parent_frame_id: str
    child_frame_id: str
    translation: Vector3
    rotation: Quaternion


class FrameTransforms(msgspec.Struct, frozen=True):
    """Many at once."""

    transforms: tuple[FrameTransform, ...]


class CubePrimitive(msgspec.Struct, frozen=True):
    """A box; `size` is its edges."""

    pose: Pose
    size: Vector3
    color: Color


class SpherePrimitive(msgspec.Struct, frozen=True):
    """A sphere or ellipsoid; `size` is its diameters."""

    pose: Pose
    size: Vector3
    color: Color


class CylinderPrimitive(msgspec.Struct, frozen=True):
    """A cylinder along z; `size` is its diameters and its height."""

    pose: Pose
    size: Vector3
    bottom_scale: float
    top_scale: float
    color: Color


class Nothing(msgspec.Struct, frozen=True):
    """In the place of primitives that a match has none of."""


class SceneEntity(msgspec.Struct, frozen=True, kw_only=True):
    """Primitives that share a frame; replaces the entity of the same id."""

    timestamp: Time
    frame_id: str
    id: str
    lifetime: Time = Time()
    frame_locked: bool = True
    metadata: tuple[Nothing, ...] = ()
    arrows: tuple[Nothing, ...] = ()
    cubes: tuple[CubePrimitive, ...] = ()
    spheres: tuple[SpherePrimitive, ...] = ()
    cylinders: tuple[CylinderPrimitive, ...] = ()
    lines: tuple[Nothing, ...] = ()
    triangles: tuple[Nothing, ...] = ()
    texts: tuple[Nothing, ...] = ()
    models: tuple[Nothing, ...] = ()


ALL_ENTITIES = 1
"""Type of a deletion that clears its topic."""


class SceneEntityDeletion(msgspec.Struct, frozen=True):
    """Takes entities of the topic away."""

    timestamp: Time
    type: int = ALL_ENTITIES
    id: str = ""


class SceneUpdate(msgspec.Struct, frozen=True):
    """What changes in the 3D scene."""

    deletions: tuple[SceneEntityDeletion, ...]
    entities: tuple[SceneEntity, ...]


INFO, WARNING = 2, 3
"""Levels of a log message."""


class Log(msgspec.Struct, frozen=True):
    """A line of the log panel."""

    timestamp: Time
    level: int
    message: str
    name: str
    file: str = ""
    line: int = 0


def json_schema(message: type[msgspec.Struct]) -> bytes:
    """The JSON schema of a message, written out in one piece: the viewers follow no $ref."""
    return msgspec.json.encode(_schema(msgspec.inspect.type_info(message)))


def _schema(info: msgspec.inspect.Type) -> dict[str, Any]:
    match info:
        case msgspec.inspect.StructType():
            return {
                "title": f"foxglove.{info.cls.__name__}",
                "type": "object",
                "properties": {field.name: _schema(field.type) for field in info.fields},
            }
        case msgspec.inspect.VarTupleType():
            return {"type": "array", "items": _schema(info.item_type)}
        case msgspec.inspect.FloatType():
            return {"type": "number"}
        case msgspec.inspect.IntType():
            return {"type": "integer"}
        case msgspec.inspect.BoolType():
            return {"type": "boolean"}
        case msgspec.inspect.StrType():
            return {"type": "string"}
    raise TypeError(f"no JSON schema for {info}")
