"""Keeps the messages of a court, and finds out which have not arrived. No I/O, no clock.

A spectator and a gateway each have a `CourtView`. They give it the messages that arrive, and
request from the court those that it lacks.
"""

from collections.abc import Callable
from typing import Generic, TypeVar

import msgspec

from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.messages import PROTOCOL, Event
from lacoc_shared.network.event_log import EventLog

T = TypeVar("T")

MAX_BYTES = 1 << 20
"""Longest message of a court [bytes]."""


class _SheetHead(msgspec.Struct):
    protocol: int
    scene: bytes = b""
    match_id: str = ""


class Told(msgspec.Struct):
    """The fields of `Health` that say what a court has sent."""

    match: int
    beat: int
    events: int = 0
    sheet: bytes = b""


class CourtView(Generic[T]):
    """The newest sheet, scene and list of events that a court has sent.

    All bytes come from the network: if they can't be decoded, `take_...` raises `BadMessage` and
    changes nothing.

    Args:
        keep: takes an event and its bytes; returns what is kept in `log`.
    """

    def __init__(self, keep: Callable[[Event, bytes], T]) -> None:
        self._keep = keep
        self.log: EventLog[T] = EventLog()
        """The events of the match."""
        self.sheet: bytes | None = None
        """The newest sheet in this version of the protocol."""
        self.scene: bytes | None = None
        """The newest scene. It belonged to the newest frame when it arrived."""
        self.match_id = ""
        """Id of the match; its record has this name."""
        self.other_version: int | None = None
        """The court's version of the protocol if it differs from this program's. 0: it differs, but
        the sheet can't be read; None: it is the same."""
        self._sheet_hash = self._scene_hash = b""
        self._frame_scene = self._sheet_scene = b""
        """Hash of the newest frame's scene, and of the sheet's."""
        self._told = Told(0, 0)
        self._doubt = False

    @property
    def lacks_events(self) -> bool:
        """Whether the court has sent an event that did not arrive here."""
        return self.log.differs(self._told.match, self._told.beat, self._told.events)

    @property
    def lacks_scene(self) -> bool:
        """Whether the scene that arrived last is another one than the newest frame's."""
        return self._frame_scene != self._scene_hash

    @property
    def lacks_sheet(self) -> bool:
        """Whether the sheet that arrived last is not, or perhaps not, the court's newest one."""
        return self._doubt or self.has_older_sheet or not self.fits

    @property
    def has_older_sheet(self) -> bool:
        """Whether the court's health names another sheet than the one that arrived last."""
        return self._told.sheet not in (b"", self._sheet_hash)

    @property
    def fits(self) -> bool:
        """Whether the sheet that arrived last belongs to the newest frame."""
        return self._frame_scene == self._sheet_scene

    def doubt(self) -> None:
        """Note that a message can't be decoded, so that `lacks_sheet` becomes true.

        The sheet then shows whether the court has another version of the protocol.
        """
        self._doubt = True

    def refuse_sheet(self) -> None:
        """Note that the court's sheet itself can't be decoded."""
        self.other_version = 0

    def see_frame(self, scene: bytes) -> None:
        """Note which scene belongs to the newest frame.

        Args:
            scene: hash of the scene.
        """
        self._frame_scene = scene

    def see_health(self, told: Told) -> None:
        """Note which messages the court has sent, as its health says.

        Args:
            told: the fields of the court's health.
        """
        self._told = told

    def add_event(self, event: Event, payload: bytes) -> bool:
        """Add an event that came; return whether it is new."""
        return self.log.add(event, self._keep(event, payload))

    def take_log(self, payload: bytes) -> list[Event]:
        """Replace all events by the list that the court has sent; return the new ones in order."""
        events = decode(payload, tuple[Event, ...], MAX_BYTES)
        return self.log.restore([(event, self._keep(event, encode(event))) for event in events])

    def take_sheet(self, payload: bytes) -> bool:
        """Keep a sheet that came; return whether it is new and in this version of the protocol."""
        found = decode(payload, _SheetHead, MAX_BYTES)
        self._doubt = False
        self._sheet_scene, self.match_id = found.scene, found.match_id
        self._sheet_hash = message_hash(payload)
        self.other_version = None if found.protocol == PROTOCOL else found.protocol
        if self.other_version is not None or payload == self.sheet:
            return False
        self.sheet = payload
        return True

    def take_scene(self, payload: bytes) -> bool:
        """Keep a scene that came, if it belongs to the newest frame; return whether it is new."""
        found = message_hash(payload)
        if found != self._frame_scene or found == self._scene_hash:
            return False
        self._scene_hash, self.scene = found, payload
        return True
