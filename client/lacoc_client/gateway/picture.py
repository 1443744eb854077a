"""The newest state of a court, as the bytes that its pages get."""

import msgspec

from lacoc_client.court_view import MAX_BYTES, CourtView, Told
from lacoc_client.gateway import wire
from lacoc_client.gateway.wire import Kind
from lacoc_shared.codec import decode, message_hash
from lacoc_shared.messages import Event


class _Frame(msgspec.Struct, array_like=True):
    """The fields of a `Frame` up to its scene; only pages read the others."""

    match: int
    beat: int
    phase: int
    countdown_beats: int
    clock_ticks: int
    seats: msgspec.Raw
    markers: msgspec.Raw
    poses: msgspec.Raw
    scene: bytes


class CourtPicture:
    """A court as a page that comes now sees it.

    Each `take_...` returns the bytes for pages, or None if there is nothing new for them. It
    raises `BadMessage` if the court's bytes can't be decoded; then the picture does not change.
    """

    def __init__(self) -> None:
        self.view: CourtView[bytes] = CourtView(lambda _, data: wire.message(Kind.EVENT, data))
        """What the court has sent, and what part of it is missing here."""
        self.phase = 0
        """Phase in the newest frame."""
        self.frame: bytes | None = None
        """The newest frame."""
        self._health: bytes | None = None

    @property
    def log(self) -> tuple[bytes, ...]:
        """All events."""
        return tuple(self.view.log)

    def all_but_frame(self) -> tuple[bytes, ...]:
        """Return what a page needs before it can show a frame."""
        view = self.view
        sheet = [] if view.sheet is None else [wire.message(Kind.SHEET, view.sheet)]
        scene = [] if view.scene is None else [_scene(view.scene)]
        health = [] if self._health is None else [self._health]
        return (*sheet, *scene, *view.log, *health)

    def take_frame(self, payload: bytes) -> bytes:
        """Take a frame in."""
        frame = decode(payload, _Frame, MAX_BYTES)
        self.view.see_frame(frame.scene)
        self.phase = frame.phase
        self.frame = framed = wire.message(Kind.FRAME, payload)
        return framed

    def take_event(self, payload: bytes) -> bytes | None:
        """Take an event in."""
        is_new = self.view.add_event(decode(payload, Event, MAX_BYTES), payload)
        return wire.message(Kind.EVENT, payload) if is_new else None

    def take_scene(self, payload: bytes) -> bytes | None:
        """Take a scene in; it goes to pages if it belongs to the newest frame."""
        return _scene(payload) if self.view.take_scene(payload) else None

    def take_sheet(self, payload: bytes) -> bytes | None:
        """Take a sheet in; it goes to pages if it has this version of the protocol."""
        return wire.message(Kind.SHEET, payload) if self.view.take_sheet(payload) else None

    def take_health(self, payload: bytes) -> bytes | None:
        """Take health in; it goes to pages if the court has this version of the protocol."""
        self.view.see_health(decode(payload, Told, MAX_BYTES))
        if self.view.other_version is not None:
            return None
        self._health = framed = wire.message(Kind.HEALTH, payload)
        return framed


def _scene(payload: bytes) -> bytes:
    return wire.message(Kind.SCENE, message_hash(payload) + payload)
