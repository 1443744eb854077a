"""Reads an update of a shared table, as Yjs writes it, before the library gets it.

Yjs has updates for texts, lists and nested documents too. A table needs few of them, and the
library believes the rest: a list in a list in a list ends the process, and an update whose
predecessor is missing takes cells away. So only what a table needs is let through.
"""

from collections.abc import Mapping
from typing import NamedTuple

ROOT = "table"
"""Name of the map in which a table's entries are."""

_CLOCK_MOST = 1 << 31
"""End of the edits of one page; the library counts them in 32 bits."""
_CLIENT_MOST = 1 << 53
_ORIGIN, _RIGHT_ORIGIN, _NAMED = 0x80, 0x40, 0x20
_GC, _DELETED, _ANY, _SKIP = 0, 1, 8, 10
_LENGTHS = {127: 0, 126: 0, 124: 4, 123: 8, 122: 8, 121: 0, 120: 0}
"""How many bytes follow the sign of a value, for signs of a fixed length."""
_INTEGER, _TEXT = 125, 119


class Unfit(ValueError):
    """An update that no page of a table writes."""


class ItemSpan(NamedTuple):
    """Edits of one page, counted from 0 on: those from `start` up to, but without, `end`."""

    client: int
    """The number that the page has drawn for itself."""
    start: int
    end: int


class Update(NamedTuple):
    """What an update brings, and what it is made for."""

    edits: tuple[ItemSpan, ...]
    needs: tuple[ItemSpan, ...]
    """Edits that it names, such as those that it deletes."""

    def fits(self, known: Mapping[int, int]) -> bool:
        """Return whether a document that has these edits can take the whole update in.

        Args:
            known: number of edits of each page.
        """
        ends = dict(known)
        for client, start, end in sorted(self.edits):
            if start > ends.get(client, 0):
                return False
            ends[client] = max(end, ends.get(client, 0))
        return all(end <= ends.get(client, 0) for client, _, end in self.needs)

    @property
    def writers(self) -> set[int]:
        """The numbers of the pages whose edits it brings."""
        return {client for client, _, _ in self.edits}


def read_update(data: bytes) -> Update:
    """Read an update.

    Raises:
        Unfit: if no page of a table writes such an update.
    """
    try:
        reader = _Reader(data)
        found = reader.update()
    except (IndexError, UnicodeDecodeError) as error:
        raise Unfit(str(error)) from None
    if reader.at != len(data):
        raise Unfit("more than an update")
    return found


def read_known(state_vector: bytes) -> dict[int, int]:
    """Read how many edits of each page a document has."""
    reader = _Reader(state_vector)
    return {reader.number(): reader.number() for _ in range(reader.number())}


class _Reader:
    def __init__(self, data: bytes) -> None:
        self._data = data
        self.at = 0

    def number(self) -> int:
        """Read seven bits of each byte; the eighth says that another one follows."""
        value = shift = 0
        while True:
            byte = self._data[self.at]
            self.at += 1
            value |= (byte & 127) << shift
            if byte < 128:
                return value
            shift += 7
            if shift > 63:
                raise Unfit("a number without an end")

    def update(self) -> Update:
        edits: list[ItemSpan] = []
        needs: list[ItemSpan] = []
        for _ in range(self.number()):
            count, client, clock = self.number(), self.number(), self.number()
            for _ in range(count):
                length, is_edit = self._edit(needs)
                span = _span(client, clock, length)
                clock = span.end
                if is_edit:
                    edits.append(span)
        for _ in range(self.number()):
            client = self.number()
            needs += [_span(client, self.number(), self.number()) for _ in range(self.number())]
        return Update(tuple(edits), tuple(needs))

    def _edit(self, needs: list[ItemSpan]) -> tuple[int, bool]:
        """Read an edit; return how many it counts as, and whether it is there."""
        info = self._data[self.at]
        self.at += 1
        kind = info & 31
        if kind in (_GC, _SKIP):
            return self.number(), kind == _GC
        origins = bool(info & _ORIGIN) + bool(info & _RIGHT_ORIGIN)
        needs += [_span(self.number(), self.number(), 1) for _ in range(origins)]
        if not origins:
            if self.number() != 1 or self._text() != ROOT or not info & _NAMED:
                raise Unfit("an edit outside the map")
            self._text()
        if kind not in (_DELETED, _ANY):
            raise Unfit("no value of a table")
        length = self.number()
        if kind == _ANY:
            for _ in range(length):
                self._value()
        return length, True

    def _text(self) -> str:
        length = self.number()
        text = self._data[self.at : self.at + length]
        self._pass(length)
        return text.decode()

    def _value(self) -> None:
        sign = self._data[self.at]
        self.at += 1
        if sign == _INTEGER:
            while self._data[self.at] > 127:
                self.at += 1
            self.at += 1
        elif sign == _TEXT:
            self._text()
        elif sign in _LENGTHS:
            self._pass(_LENGTHS[sign])
        else:
            raise Unfit("a value with values in it")

    def _pass(self, count: int) -> None:
        self.at += count
        if self.at > len(self._data):
            raise Unfit("cut off")


def _span(client: int, start: int, length: int) -> ItemSpan:
    if client >= _CLIENT_MOST or length < 1 or start + length >= _CLOCK_MOST:
        raise Unfit("a number too large")
    return ItemSpan(client, start, start + length)
