"""The document of a shared table: it merges updates of pages, and checks that it stays a table.

Pages merge in the same way, with Yjs. An update after which the document would not be a table is
undone before another page sees it. An update whose earlier edits did not come is refused.
"""

from collections.abc import Callable, Mapping
from typing import Any

from pycrdt import Doc, Map

from lacoc_client.workshop.tables.entries import ENTRIES_MOST, Entry, is_entry
from lacoc_client.workshop.tables.update import ROOT, Unfit, read_known, read_update
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

UPDATE_BYTES = 256 << 10
"""Longest update of a page [bytes]; one can have a whole table of `ENTRIES_MOST`."""
STATE_BYTES = 512 << 10
"""Longest state of a document [bytes]; an update that makes it longer is refused."""
COMPACT_BYTES = 48 << 10
"""A document that has grown by more than this [bytes] is replaced by one without earlier edits. The
growth counts from the size of the table, without earlier edits, when the document was made."""


class TableDocument:
    """The merged edits of all pages of one table. Pure: no clock, network or disk.

    Args:
        state: a state to begin with; b"": an empty table.

    Raises:
        UserError: if the state is not that of a table.
    """

    def __init__(self, state: bytes = b"") -> None:
        self.state = b""
        """The whole document in the form with which a page can merge its edits."""
        self._entries: dict[str, Entry] = {}
        self._changes: set[str] = set()
        self._load(b"")
        if state:
            self.merge(state)
        # A state that is read again may have a past.
        self._compact_bytes = len(_state_of(self._entries)) + COMPACT_BYTES

    @property
    def entries(self) -> Mapping[str, Entry]:
        """All entries of the table by name, in a mapping that later merges do not change."""
        return self._entries

    def merge(self, update: bytes, may_write: Callable[[int], bool] = lambda _: True) -> bool:
        """Merge an update that a page sent; return whether it brought an edit that was not here.

        Such an edit may change no entry, as when two pages write into one cell. The other pages
        need it all the same: without it they can't merge the page's later edits.

        Args:
            update: the update, as Yjs writes it.
            may_write: returns whether the page may bring edits under a page number (Yjs's client
                id).

        Raises:
            UserError: if the update can't be read, would make something else than a table, needs
                edits that are not here, or writes under another page's number; then nothing has
                changed.
        """
        known = read_known(self._document.get_state())
        try:
            read = read_update(update)
        except Unfit:
            raise UserError(say("tables.unreadable")) from None
        if not read.fits(known) or not all(map(may_write, read.writers)):
            raise UserError(say("tables.older"))
        before, entries = self.state, self._entries
        self._entries = dict(entries)
        self._changes.clear()
        try:
            self._document.apply_update(update)
            self.state = bytes(self._document.get_update())
            self._check()
        except (UserError, ValueError, TypeError) as error:
            self._restore(before, entries)
            if isinstance(error, UserError):
                raise
            raise UserError(say("tables.unreadable")) from None
        except BaseException as error:
            self._restore(before, entries)
            if type(error).__name__ == "PanicException":  # the library is written in Rust
                raise UserError(say("tables.unreadable")) from None
            raise
        return self.state != before

    @property
    def is_long(self) -> bool:
        """Whether the state is so long that a document without earlier edits should be used."""
        return len(self.state) > self._compact_bytes

    def fresh(self) -> "TableDocument":
        """Return a document with the same entries of the table and without earlier edits.

        Edits that a page has made in this document can't be merged into the new one.
        """
        return document_of(self._entries)

    def _check(self) -> None:
        """Read the entries that were changed from the document, and check them.

        Raises:
            UserError: if the document is no table, or too large.
        """
        if len(self.state) > STATE_BYTES:
            raise UserError(say("tables.too-large"))
        if list(self._document.keys()) != [ROOT]:
            raise UserError(say("tables.unreadable"))
        for name in self._changes:
            # What the event itself says is wrong where updates came in another order.
            value = self._map.get(name)
            if value is None:
                self._entries.pop(name, None)
                continue
            if not is_entry(name, value):
                raise UserError(say("tables.unreadable"))
            self._entries[name] = value
        if len(self._entries) > ENTRIES_MOST:
            raise UserError(say("tables.too-large"))

    def _restore(self, state: bytes, entries: dict[str, Entry]) -> None:
        self._load(state)
        self._entries = entries
        self._changes.clear()

    def _load(self, state: bytes) -> None:
        self._document: Doc[Any] = Doc()
        self._map: Map[Any] = self._document.get(ROOT, type=Map)
        if state:
            self._document.apply_update(state)
        self.state = state
        self._watching = self._map.observe(self._changed)

    def _changed(self, event: Any) -> None:
        self._changes.update(event.keys)


def document_of(entries: Mapping[str, Entry]) -> TableDocument:
    """Make the document of a table that has these entries and no earlier edits."""
    return TableDocument(_state_of(entries))


def _state_of(entries: Mapping[str, Entry]) -> bytes:
    document: Doc[Any] = Doc()
    root: Map[Any] = document.get(ROOT, type=Map)
    with document.transaction():
        for name, value in entries.items():
            root[name] = value
    return bytes(document.get_update())
