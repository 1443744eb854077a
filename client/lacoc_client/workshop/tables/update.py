"""Reads an update of a shared table, as Yjs writes it, before the library may read it.

Yjs has updates for texts, lists and nested documents too. A table needs only few kinds, and the
library checks the others too little: deeply nested lists end the process, and an update whose
predecessor is missing deletes cells. So only the kinds that a table needs are let through.
"""

from collections.abc import Mapping
from typing import NamedTuple

ROOT = "table"
"""Name of the map in which a table's entries are."""

_CLOCK_MOST = 1 << 31
"""Most edits of one page; the library counts them in 32 bits."""
_CLIENT_MOST = 1 << 53
_ORIGIN, _RIGHT_ORIGIN, _NAMED = 0x80, 0x40, 0x20
_GC, _DELETED, _ANY, _SKIP = 0, 1, 8, 10
_LENGTHS = {127: 0, 126: 0, 124: 4, 123: 8, 122: 8, 121: 0, 120: 0}
"""How many bytes follow the type byte of a value, for types of a fixed length."""
_INTEGER, _TEXT = 125, 119


class Unfit(ValueError):
    """An update that no page with a table could have written."""


class ItemSpan(NamedTuple):
    """Edits of one page, counted from 0: from `start` up to, but not including, `end`."""

    client: int
    """The page number, which the page has drawn at random (Yjs's client id)."""
    start: int
    end: int


class Update(NamedTuple):
    """The edits in an update, and those that must be in it or in the document already."""

    edits: tuple[ItemSpan, ...]
    needs: tuple[ItemSpan, ...]
    """Edits that the update refers to, such as those that it deletes."""

    def fits(self, known: Mapping[int, int]) -> bool:
        """Return whether the whole update can be merged into a document that has these edits.

        Args:
            known: number of edits of each page in the document.
        """
        ends = dict(known)
        for client, start, end in sorted(self.edits):
            if start > ends.get(client, 0):
                return False
            ends[client] = max(end, ends.get(client, 0))
        return all(end <= ends.get(client, 0) for client, _, end in self.needs)

    @property
    def writers(self) -> set[int]:
        """The numbers of the pages whose edits are in the update."""
        return {client for client, _, _ in self.edits}


def read_update(data: bytes) -> Update:
    """Read an update.

    Raises:
        Unfit: if no page with a table could have written it.
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
    """Read from a state vector how many edits of each page a document has."""
    reader = _Reader(state_vector)
    return {reader.number(): reader.number() for _ in range(reader.number())}


class _Reader:
    def __init__(self, data: bytes) -> None:
        self._data = data
        self.at = 0

    def number(self) -> int:
        """Read a number whose bytes have seven bits of it each.

        The eighth bit of a byte says whether another byte follows.
        """
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
        """Read an edit or a gap; return for how many edits it stands, and False for a gap.

        Args:
            needs: to this list the edits are added to which this edit refers.
        """
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
