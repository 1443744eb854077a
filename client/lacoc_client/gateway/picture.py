"""What a court said last, as the bytes that its pages get."""

import msgspec

from lacoc_client.event_log import EventLog
from lacoc_client.gateway import wire
from lacoc_client.gateway.wire import Kind
from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.messages import PROTOCOL, Event

_MAX_BYTES = 1 << 20


class _Frame(msgspec.Struct, array_like=True):
    """What the gateway needs to know of a frame; the rest goes on unread."""

    match: int
    beat: int
    phase: int
    countdown_beats: int
    clock_ticks: int
    seats: msgspec.Raw
    markers: msgspec.Raw
    poses: msgspec.Raw
    scene: bytes


class _Sheet(msgspec.Struct):
    protocol: int
    scene: bytes
    match_id: str = ""


class _Health(msgspec.Struct):
    match: int
    beat: int
    events: int = 0
    sheet: bytes = b""


class CourtPicture:
    """A court as a page that comes now is shown it; knows what of it is missing.

    What it takes in is what came from the court. It raises `BadMessage` if that makes no sense,
    and is then as it was.
    """

    def __init__(self) -> None:
        self.other_version = ""
        """What the court speaks, if it is not this version of the protocol: "version 7"."""
        self.match_id = ""
        """The match that is on, as its record is named."""
        self.frame: bytes | None = None
        """The newest."""
        self._log: EventLog[bytes] = EventLog()
        self._sheet: bytes | None = None
        self._scene: bytes | None = None
        self._health: bytes | None = None
        self._sheet_hash = self._scene_hash = b""
        """Of what is here."""
        self._frame_scene = self._sheet_scene = b""
        """The scene that belongs to the frame and to the sheet, by its hash."""
        self._told = _Health(0, 0)
        """What the court said last of all that it sent."""
        self._doubt = False

    @property
    def log(self) -> tuple[bytes, ...]:
        """All events."""
        return tuple(self._log)

    @property
    def log_number(self) -> int:
        """Another number: the log began anew."""
        return self._log.number

    def all_but_frame(self) -> tuple[bytes, ...]:
        """What a page needs before a frame means something to it."""
        all_of_it = (self._sheet, self._scene, *self._log, self._health)
        return tuple(framed for framed in all_of_it if framed is not None)

    @property
    def lacks_events(self) -> bool:
        """Whether an event was sent that is not here."""
        return self._log.differs(self._told.match, self._told.beat, self._told.events)

    @property
    def lacks_scene(self) -> bool:
        """Whether the frame is one of another scene."""
        return self._frame_scene != self._scene_hash

    @property
    def lacks_sheet(self) -> bool:
        """Whether the court has another sheet, or may have."""
        other = self._told.sheet not in (b"", self._sheet_hash)
        return self._doubt or other or self._frame_scene != self._sheet_scene

    @property
    def lacks(self) -> bool:
        """Whether anything is to be asked for."""
        return self.lacks_events or self.lacks_scene or self.lacks_sheet

    def doubt(self) -> None:
        """Something made no sense: is this still a court of this version? Its sheet says."""
        self._doubt = True

    def take_frame(self, payload: bytes) -> bytes:
        """Take a frame in, and return it as pages get it."""
        self._frame_scene = decode(payload, _Frame, _MAX_BYTES).scene
        self.frame = framed = wire.message(Kind.FRAME, payload)
        return framed

    def take_event(self, payload: bytes) -> bytes | None:
        """Take an event in, and return it as pages get it; None if it is known."""
        event = decode(payload, Event, _MAX_BYTES)
        framed = wire.message(Kind.EVENT, payload)
        return framed if self._log.add(event, framed) else None

    def take_log(self, payload: bytes) -> None:
        """Take all events as the court lists them."""
        events = decode(payload, tuple[Event, ...], _MAX_BYTES)
        self._log.restore([(event, wire.message(Kind.EVENT, encode(event))) for event in events])

    def take_scene(self, payload: bytes) -> bytes | None:
        """Take a scene in, and return it as pages get it; None if it is not the frame's."""
        found = message_hash(payload)
        if found != self._frame_scene or found == self._scene_hash:
            return None
        self._scene_hash = found
        self._scene = wire.message(Kind.SCENE, found + payload)
        return self._scene

    def take_sheet(self, payload: bytes) -> bytes | None:
        """Take a sheet in, and return it as pages get it; None if it is known.

        One of another version says so in `other_version`, and is for no page.
        """
        sheet = decode(payload, _Sheet, _MAX_BYTES)
        self._doubt = False
        self._sheet_scene, self.match_id = sheet.scene, sheet.match_id
        self._sheet_hash = message_hash(payload)
        self.other_version = "" if sheet.protocol == PROTOCOL else f"version {sheet.protocol}"
        framed = wire.message(Kind.SHEET, payload)
        if self.other_version or framed == self._sheet:
            return None
        self._sheet = framed
        return framed

    def take_health(self, payload: bytes) -> bytes | None:
        """Take health in, and return it as pages get it; None: it is of another version."""
        self._told = decode(payload, _Health, _MAX_BYTES)
        if self.other_version:
            return None
        self._health = framed = wire.message(Kind.HEALTH, payload)
        return framed
