"""A table that the teacher handed out."""

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.design.table import FileTable


class Handed(msgspec.Struct, frozen=True, kw_only=True):
    """A table that the teacher handed out, to all or to a group."""

    number: int
    """Counts the tables of the class, from 1."""
    title: str
    table: FileTable
    sequences: tuple[tuple[int, ...], ...] | None = None

    def message(self) -> bytes:
        """Return the message that offers it to a page."""
        return wire.map_message(MessageKind.HANDED, msgspec.structs.asdict(self))
