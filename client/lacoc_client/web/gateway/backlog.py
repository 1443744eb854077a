"""Keeps the messages that a page needs first: the newest of each kind, and all events."""

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import decode

_BEFORE_EVENTS = (
    MessageKind.WELCOME,
    MessageKind.NOTICE,
    MessageKind.PROGRAMME,
    MessageKind.LINK,
    MessageKind.SHEET,
    MessageKind.SCENE,
)
_AFTER_EVENTS = (MessageKind.HEALTH, MessageKind.FRAME)
_OF_ALL_COURTS = (MessageKind.WELCOME, MessageKind.NOTICE, MessageKind.PROGRAMME)


class _LinkHead(msgspec.Struct):
    """The fields of a link message that say which earlier messages are still valid."""

    connected: bool
    log: int


class _ProgrammeHead(msgspec.Struct):
    """The field of a programme message that says which court the next messages are about."""

    court: str


class Backlog:
    """Keeps those messages about a court that a page needs when it begins to watch."""

    def __init__(self) -> None:
        self._newest: dict[MessageKind, bytes] = {}
        self._events: dict[bytes, None] = {}
        self._log = 0
        self._court = ""

    def take(self, framed: bytes) -> None:
        """Note a message that was sent to the pages that watch."""
        kind, payload = wire.opened(framed)
        if kind is MessageKind.EVENT:
            self._events[framed] = None
            return
        self._newest[kind] = framed
        if kind is MessageKind.LINK:
            link = decode(payload, _LinkHead)
            if link.log != self._log:
                self._log = link.log
                self._events.clear()
            if not link.connected:  # an old frame must not look like a new one
                self._newest.pop(MessageKind.FRAME, None)
        elif kind is MessageKind.PROGRAMME:
            court = decode(payload, _ProgrammeHead).court
            if court != self._court:  # all that is known of it follows
                self._court = court
                self._events.clear()
                self._newest = {k: v for k, v in self._newest.items() if k in _OF_ALL_COURTS}

    def all(self) -> list[bytes]:
        """Return the kept messages in the order in which a new page needs them."""
        kept = self._newest
        before = [kept[kind] for kind in _BEFORE_EVENTS if kind in kept]
        after = [kept[kind] for kind in _AFTER_EVENTS if kind in kept]
        return [*before, *self._events, *after]
