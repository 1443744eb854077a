"""The newest messages of a court, kept as the bytes that are sent to the pages that watch it."""

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import BadMessage, decode, message_hash
from lacoc_shared.messages import Event
from lacoc_shared.network.court_view import MAX_BYTES, CourtView, Told
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase


class _Score(msgspec.Struct, array_like=True):
    """The fields of a `SeatFrame` (a seat in a frame) up to its score."""

    flags: int
    score: int


class SeatPart(msgspec.Struct):
    """The fields of a `SheetSeat` that say who plays."""

    team: str = ""


class SheetPart(msgspec.Struct):
    """The fields of a `Sheet` that say what is played."""

    match: int
    title: str
    duration_s: float
    seats: tuple[SeatPart, ...]
    call: str = ""
    fixture: Phrase | None = None


class FramePart(msgspec.Struct):
    """Phase, clock and scores of a match, read from the court's newest frame."""

    match: int
    phase: Phase
    clock_ticks: int
    scores: tuple[int, ...]


class _FrameHead(msgspec.Struct, array_like=True):
    """The fields of a `Frame` up to its scene; the gateway does not read the fields behind it."""

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
    """The newest messages of a court: all that a page needs when it begins to watch.

    Each `take_...` notes a message of the court. It returns the bytes to send to pages, or None if
    they need not be sent. It raises `BadMessage` if the message can't be decoded; then nothing
    changes.
    """

    def __init__(self) -> None:
        self.view: CourtView[bytes] = CourtView(
            lambda _, data: wire.message(MessageKind.EVENT, data)
        )
        """The messages of the court, and which of them did not arrive here."""
        self.phase = 0
        """Phase in the newest frame."""
        self.frame: bytes | None = None
        """The newest frame."""
        self._newest: _FrameHead | None = None
        self._sheet: tuple[bytes, SheetPart] | None = None
        """The newest sheet that `played` has read: its bytes and its parts."""
        self._health: bytes | None = None

    @property
    def log(self) -> tuple[bytes, ...]:
        """All events of the match, as bytes for pages."""
        return tuple(self.view.log)

    def all_but_frame(self) -> tuple[bytes, ...]:
        """Return the messages that a page needs before it can show a frame of the match."""
        view = self.view
        sheet = [] if view.sheet is None else [wire.message(MessageKind.SHEET, view.sheet)]
        scene = [] if view.scene is None else [_scene(view.scene)]
        health = [] if self._health is None else [self._health]
        return (*sheet, *scene, *view.log, *health)

    def stands(self) -> FramePart | None:
        """Return phase, clock and scores of the match; None without a readable frame."""
        frame = self._newest
        if frame is None:
            return None
        try:
            seats = decode(bytes(frame.seats), tuple[_Score, ...], MAX_BYTES)
            phase = Phase(frame.phase)
        except (BadMessage, ValueError):
            return None
        scores = tuple(seat.score for seat in seats)
        return FramePart(frame.match, phase, frame.clock_ticks, scores)

    def played(self) -> SheetPart | None:
        """Return who plays, and which match it is, from the match's sheet.

        None if no readable sheet of the newest frame's match has come yet.
        """
        sheet, frame = self.view.sheet, self._newest
        if sheet is None or frame is None:
            return None
        if self._sheet is None or self._sheet[0] is not sheet:
            try:
                self._sheet = sheet, decode(sheet, SheetPart, MAX_BYTES)
            except BadMessage:
                return None
        played = self._sheet[1]
        return played if played.match == frame.match else None  # else a newer one is on its way

    def take_frame(self, payload: bytes) -> bytes:
        """Note a frame of the court; return the bytes to send to pages."""
        frame = decode(payload, _FrameHead, MAX_BYTES)
        self.view.see_frame(frame.scene)
        self.phase = frame.phase
        self._newest = frame
        self.frame = framed = wire.message(MessageKind.FRAME, payload)
        return framed

    def take_event(self, payload: bytes) -> bytes | None:
        """Note an event of the match; return the bytes to send to pages, or None if not new."""
        is_new = self.view.add_event(decode(payload, Event, MAX_BYTES), payload)
        return wire.message(MessageKind.EVENT, payload) if is_new else None

    def take_scene(self, payload: bytes) -> bytes | None:
        """Note a scene that the court has sent.

        Returns:
            The bytes for pages; None if the scene is not new, or not the newest frame's scene.
        """
        return _scene(payload) if self.view.take_scene(payload) else None

    def take_sheet(self, payload: bytes) -> bytes | None:
        """Note a sheet that the court has sent.

        Returns:
            The bytes for pages; None if the sheet is not new, or has another protocol version.
        """
        return wire.message(MessageKind.SHEET, payload) if self.view.take_sheet(payload) else None

    def take_health(self, payload: bytes) -> bytes | None:
        """Note a health message that the court has sent.

        Returns:
            The bytes for pages; None if the court has another version of the protocol.
        """
        self.view.see_health(decode(payload, Told, MAX_BYTES))
        if self.view.other_version is not None:
            return None
        self._health = framed = wire.message(MessageKind.HEALTH, payload)
        return framed


def _scene(payload: bytes) -> bytes:
    return wire.message(MessageKind.SCENE, message_hash(payload) + payload)
