"""A table that the teacher has handed out."""

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.design.table import FileTable


class Handed(msgspec.Struct, frozen=True, kw_only=True):
    """A table that the teacher has handed out, to all students or to a group."""

    number: int
    """Number of the table among all that were handed out in this class, from 1."""
    title: str
    table: FileTable
    sequences: tuple[tuple[int, ...], ...] | None = None
    of: str = ""
    """Nickname of the student whose table it is; "": nobody's."""

    def message(self) -> bytes:
        """Return the message that offers this table to a page."""
        body = msgspec.structs.asdict(self)
        del body["of"]  # the title says what students shall know
        return wire.map_message(MessageKind.HANDED, body)
