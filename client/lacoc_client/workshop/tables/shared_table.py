"""A table that several pages have open: it merges, sends and keeps their edits."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.tables.document import UPDATE_BYTES, TableDocument, document_of
from lacoc_client.workshop.tables.draft import Draft, draft_of
from lacoc_client.workshop.tables.entries import Entry, without_proposals
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

UPDATES_HZ, UPDATES_BURST = 100.0, 200
"""How many updates of one table all pages together may send: a second on average, and at once."""
_COST_ENTRIES = 500
"""An update of a large table takes longer: it counts once more for each so many entries of the
table."""
_REFUSED_COST = 10
"""An update that is refused counts so many times, because the document must be read again."""
_PEOPLE_S = 0.05
"""Least time between two messages that tell pages at which cells the other pages are [s]."""

_FORGET_AFTER = 20_000
"""The memory of who typed into which cell is cleared when it has more cells than this."""


class TableUpdate(msgspec.Struct, frozen=True, kw_only=True):
    """A page's change of a table."""

    table: str
    epoch: str
    update: bytes
    cells: tuple[str, ...] = ()
    """Names of the cells into which somebody typed."""
    seen: int = 0
    """Number of the newest update of the table that the page had received."""
    begins: bool = False
    """Whether the change contains the first content that the page has put into an empty table."""


class Person(msgspec.Struct, kw_only=True):
    """A page that has the table open, as the other pages see it."""

    id: int
    """Number of the page among those of the table, from 1; numbers of pages that have gone are used
    again."""
    name: str
    """Nickname; "": a person who designs alone."""
    row: int = -1
    col: int = -1
    typing: str | None = None
    """The text that is being typed; None: nothing is being typed."""


class SharedTable:
    """A table that several pages edit at once; used from the event loop only.

    Args:
        name: id of the table, different from those of other tables; "": the table of a student or
            of a folder.
        keep: writes a state to the disk, with the name of the epoch. When it returns, the state is
            on the disk, or the student is told in another way why it is not.
        state: the state that an earlier run kept, with its epoch.
    """

    def __init__(
        self,
        name: str,
        keep: Callable[[bytes, str], Awaitable[None]],
        state: bytes = b"",
        epoch: str = "",
    ) -> None:
        self.name = name
        self.people: dict[Viewer, Person] = {}
        """The pages that have the table open, with what the others see of them."""
        self._keep = keep
        self._allowance = Allowance(UPDATES_HZ, UPDATES_BURST)
        self._writing: asyncio.Task[None] | None = None
        self._telling: asyncio.TimerHandle | None = None
        self._told_s = 0.0
        self._draft: Draft | None = None
        """The last complete table that was computed. It is computed when somebody asks for it, and
        before each change after which the table may be incomplete."""
        self._begin(TableDocument(state), epoch or new_token())
        self.is_touched = bool(state)
        """Whether anybody has ever changed the table; if not, it is not kept."""
        # A page that comes back after a restart has seen smaller numbers.
        self._seq = self._written = int(time.time() * 1000)

    @property
    def draft(self) -> Draft | None:
        """The newest table without a bad cell.

        None: nobody ever changed the table, or since the program started it always had a bad cell.
        """
        return self._newest_draft() if self.is_touched else None

    def equals(self, other: "SharedTable") -> bool:
        """Return whether another table has the same entries."""
        return self._document.entries == other._document.entries

    def opened(self) -> dict[str, Any]:
        """Return everything that a page needs to show and edit this table."""
        return {
            "table": self.name,
            "epoch": self._epoch,
            "seq": self._seq,
            "state": self._document.state,
            "others": len(self.people),
        }

    def add(self, viewer: Viewer, name: str) -> None:
        """Add a page that has opened the table."""
        taken = {person.id for person in self.people.values()}
        free = next(number for number in range(1, len(taken) + 2) if number not in taken)
        self.people[viewer] = Person(id=free, name=name)
        self._tell_people()

    def show(self, viewer: Viewer, name: str) -> None:
        """Add a page that had another table open, and send it this table."""
        viewer.send(self._message({"state": self._document.state}))
        self.add(viewer, name)

    def leave(self, viewer: Viewer) -> None:
        """Remove a page that has closed the table."""
        if self.people.pop(viewer, None) is not None:
            self._tell_people()

    def end(self) -> None:
        """Make the table empty again if nobody has changed it; all its pages have been closed."""
        if not self.is_touched:
            self._begin(TableDocument(), new_token())

    def move(self, viewer: Viewer, row: int, col: int, typing: str | None) -> None:
        """Tell the other pages at which cell a page is, and what is being typed there."""
        person = self.people.get(viewer)
        if person is not None and (person.row, person.col, person.typing) != (row, col, typing):
            person.row, person.col, person.typing = row, col, typing
            self._tell_people()

    async def take(self, viewer: Viewer, told: TableUpdate) -> dict[str, Any]:
        """Merge an update of a page, and send it to the other pages.

        When this returns, the state is on the disk, or the student is told why not. A table that
        pages have only begun, without a typed cell, is not kept.

        Raises:
            UserError: if the update is for another table or an older document, if the document
                would not be a table any more, or if too many updates come. The page then opens the
                table again with what `opened` returns.
        """
        if viewer not in self.people or (told.table, told.epoch) != (self.name, self._epoch):
            raise UserError(say("tables.older"))
        if told.begins and self._document.entries:
            raise UserError(say("tables.older"))  # another page was quicker
        if len(told.update) > UPDATE_BYTES:
            raise UserError(say("tables.too-large"))
        now_s = time.monotonic()
        cost = 1 + len(self._document.entries) // _COST_ENTRIES
        if not self._allowance.take_all(cost, now_s):
            raise UserError(say("gateway.too-much"))
        before = self._document.entries
        try:
            is_new = self._document.merge(told.update, lambda writer: self._is_of(writer, viewer))
        except UserError:
            self._allowance.take(_REFUSED_COST * cost, now_s)
            raise
        self._seq += 1
        seq = self._seq
        self.is_touched = self.is_touched or not told.begins or bool(told.cells)
        if is_new:
            self._keep_draft(before)
            self._tell_others(viewer, {"update": told.update})
        self._find_clashes(viewer, told)
        if self._document.is_long:
            self.replace(self._document.fresh())
        if self.is_touched:
            await self._until_written(seq)
        return {"seq": seq}

    def replace(self, document: TableDocument) -> None:
        """Replace the whole document of the table.

        All pages open the new document, and add to it the edits that they had not sent.
        """
        self._begin(document, new_token())
        self._seq += 1
        message = self._message({"state": self._document.state})
        for viewer in self.people:
            viewer.send(message)

    def fresh(self) -> TableDocument:
        """Return a document for another shared table: the same table, without earlier edits."""
        return self._document.fresh()

    def has_proposals(self, name: str) -> bool:
        """Return whether the table has proposals of this student."""
        entries = self._document.entries
        return without_proposals(entries, name) != entries

    async def forget(self, name: str) -> None:
        """Remove the table's earlier edits, and the proposals of one student."""
        self.replace(document_of(without_proposals(self._document.entries, name)))
        await self.keep_now()

    async def keep_now(self) -> None:
        """Write the table to the disk."""
        self.is_touched = True
        self._seq += 1
        await self._until_written(self._seq)

    def _begin(self, document: TableDocument, epoch: str) -> None:
        self._document = document
        self._epoch = epoch
        self._draft = draft_of(document.entries) or self._draft
        self._is_draft_old = False
        self._writers: dict[int, Viewer] = {}
        """For each page number (Yjs's client id) of this document, the page that has it."""
        self._typed: dict[str, tuple[int, Viewer]] = {}
        """For each cell the number of the last update in which it was typed, and the page."""

    def _is_of(self, writer: int, viewer: Viewer) -> bool:
        """Return whether a page may send edits under a page number (Yjs's client id).

        If two pages wrote under the same number, the document would take the second page's edits
        for edits that it has already.
        """
        owner = self._writers.setdefault(writer, viewer)
        if owner is not viewer and owner not in self.people:  # it has connected again
            owner = self._writers[writer] = viewer
        return owner is viewer

    def _newest_draft(self) -> Draft | None:
        if self._is_draft_old:
            self._is_draft_old = False
            self._draft = draft_of(self._document.entries) or self._draft
        return self._draft

    def _keep_draft(self, before: Mapping[str, Entry]) -> None:
        """Note that the table has changed, so that `draft` must be computed again.

        A change of anything else than numbers may make a table incomplete. Then the table as it was
        before the change becomes the draft.
        """
        after = self._document.entries
        changed = (name for name in {*before, *after} if before.get(name) is not after.get(name))
        if self._is_draft_old and not all(isinstance(after.get(name), float) for name in changed):
            self._draft = draft_of(before) or self._draft
        self._is_draft_old = True

    def _find_clashes(self, viewer: Viewer, told: TableUpdate) -> None:
        """Tell two pages if both typed into one cell before they received each other's text."""
        clashes: dict[Viewer, list[str]] = {}
        for cell in told.cells:
            seq, other = self._typed.get(cell, (0, viewer))
            if seq > told.seen and other is not viewer and other in self.people:
                clashes.setdefault(other, []).append(cell)
            self._typed[cell] = (self._seq, viewer)
        if len(self._typed) > _FORGET_AFTER:
            self._typed.clear()
        for other, cells in clashes.items():
            for one, partner in ((viewer, other), (other, viewer)):
                clash = {"cells": cells, "by": self.people[partner].id}
                one.send(self._message({"clash": clash}))

    def _tell_others(self, viewer: Viewer, body: dict[str, Any]) -> None:
        message = self._message(body)
        for other in self.people:
            if other is not viewer:
                other.send(message)

    def _message(self, body: dict[str, Any]) -> bytes:
        head = {"table": self.name, "epoch": self._epoch, "seq": self._seq}
        return wire.map_message(MessageKind.TABLE, {**head, **body})

    def _tell_people(self) -> None:
        """Tell all pages who is at which cell: at once, or a moment later if it was just told."""
        if not self.people or self._telling is not None:
            return
        loop = asyncio.get_running_loop()
        wait_s = max(0.0, self._told_s + _PEOPLE_S - loop.time())
        if wait_s:
            self._telling = loop.call_later(wait_s, self._tell_people_now)
        else:
            self._tell_people_now()

    def _tell_people_now(self) -> None:
        self._telling = None
        self._told_s = asyncio.get_running_loop().time()
        people = [msgspec.structs.asdict(person) for person in self.people.values()]
        for viewer, person in self.people.items():
            body = {"me": person.id, "people": people}
            viewer.send(wire.map_message(MessageKind.PEOPLE, body))

    async def _until_written(self, seq: int) -> None:
        """Wait until an update is on the disk; updates that come meanwhile share the next write."""
        while self._written < seq:
            if self._writing is None:
                self._writing = asyncio.get_running_loop().create_task(self._write())
            # A page that goes must not end the write that others wait for.
            await asyncio.shield(self._writing)

    async def _write(self) -> None:
        seq = self._seq
        try:
            await self._keep(self._document.state, self._epoch)
        finally:
            self._written = seq
            self._writing = None
