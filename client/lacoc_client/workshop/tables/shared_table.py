"""A table that several pages have open: passes edits on, keeps them, and says who is where."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.tables.document import TableDocument, document_of
from lacoc_client.workshop.tables.draft import Draft, draft_of
from lacoc_client.workshop.tables.entries import Entry, without_proposals
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

UPDATES_HZ, UPDATES_BURST = 100.0, 200
"""Updates of one table [1/s], however many pages send them."""
_COST_ENTRIES = 500
"""An update counts once more for each so many entries of the table: it costs more time."""
_REFUSED_COST = 10
"""An update that is refused counts so many times: the document is read again."""
_PEOPLE_S = 0.05
"""Pages are told at most so often where the others are [s]."""

_FORGET_AFTER = 20_000
"""After so many cells it is no longer remembered who typed into which."""


class TableUpdate(msgspec.Struct, frozen=True, kw_only=True):
    """What a page has done to a table."""

    table: str
    epoch: str
    update: bytes
    cells: tuple[str, ...] = ()
    """Names of the cells into which somebody typed."""
    seen: int = 0
    """Number of the newest update that the page had taken in."""
    begins: bool = False
    """Whether it has what the page has put into an empty table."""


class Person(msgspec.Struct, kw_only=True):
    """A page at the table."""

    id: int
    """Counts the pages of the table, from 1; a place that is free is taken again."""
    name: str
    """Nickname; "": whoever designs alone."""
    row: int = -1
    col: int = -1
    typing: str | None = None
    """What is being typed; None: nothing is."""


class SharedTable:
    """A table that several pages edit at once; used from the event loop only.

    Args:
        name: tells it from other tables; "": the table of a student or of a folder.
        keep: writes a state to the disk, with the name of the epoch. When it returns, the state is
            there, or the student is told elsewhere why not.
        state: a state of an earlier run, with its epoch.
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
        """The pages that have the table open."""
        self._keep = keep
        self._allowance = Allowance(UPDATES_HZ, UPDATES_BURST)
        self._writing: asyncio.Task[None] | None = None
        self._telling: asyncio.TimerHandle | None = None
        self._told_s = 0.0
        self._draft: Draft | None = None
        """The newest draft that was asked for, or could not be made later."""
        self._begin(TableDocument(state), epoch or new_token())
        self.is_touched = bool(state)
        """Whether anybody has changed anything; else the table is not kept."""
        # A page that comes back after a restart has seen smaller numbers.
        self._seq = self._written = int(time.time() * 1000)

    @property
    def draft(self) -> Draft | None:
        """The newest table whose cells all had angles; None: there was none."""
        return self._newest_draft() if self.is_touched else None

    def opened(self) -> dict[str, Any]:
        """Return what a page needs to begin."""
        return {
            "table": self.name,
            "epoch": self._epoch,
            "seq": self._seq,
            "state": self._document.state,
            "others": len(self.people),
        }

    def add(self, viewer: Viewer, name: str) -> None:
        """Take in a page that has the table open now."""
        taken = {person.id for person in self.people.values()}
        free = next(number for number in range(1, len(taken) + 2) if number not in taken)
        self.people[viewer] = Person(id=free, name=name)
        self._tell_people()

    def show(self, viewer: Viewer, name: str) -> None:
        """Take in a page that has had another table open."""
        viewer.send(self._message({"state": self._document.state}))
        self.add(viewer, name)

    def leave(self, viewer: Viewer) -> None:
        """Remove a page."""
        if self.people.pop(viewer, None) is not None:
            self._tell_people()

    def end(self) -> None:
        """Forget a table that nobody has changed: the last page of its student has gone."""
        if not self.is_touched:
            self._begin(TableDocument(), new_token())

    def move(self, viewer: Viewer, row: int, col: int, typing: str | None) -> None:
        """Tell the others where a page is, and what is being typed there."""
        person = self.people.get(viewer)
        if person is not None and (person.row, person.col, person.typing) != (row, col, typing):
            person.row, person.col, person.typing = row, col, typing
            self._tell_people()

    async def take(self, viewer: Viewer, told: TableUpdate) -> dict[str, Any]:
        """Merge an update of a page, and pass it on; when this returns, it is on the disk.

        Raises:
            UserError: if the page has another table or an older document, or if it would be no
                table any more. The page then takes what `opened` returns.
        """
        if viewer not in self.people or (told.table, told.epoch) != (self.name, self._epoch):
            raise UserError(say("tables.older"))
        if told.begins and self._document.entries:
            raise UserError(say("tables.older"))  # another page was quicker
        now_s = time.monotonic()
        cost = 1 + len(self._document.entries) // _COST_ENTRIES
        if self._allowance.left(now_s) < cost:
            raise UserError(say("gateway.too-much"))
        self._allowance.take(cost, now_s)
        before = self._document.entries
        try:
            changes = self._document.merge(told.update, lambda writer: self._is_of(writer, viewer))
        except UserError:
            self._allowance.take(_REFUSED_COST * cost, now_s)
            raise
        self._seq += 1
        seq = self._seq
        self.is_touched = self.is_touched or not told.begins or bool(told.cells)
        if changes:
            self._keep_draft(before)
            self._tell_others(viewer, {"update": told.update})
        self._find_clashes(viewer, told)
        if self._document.is_long:
            self.replace(self._document.fresh())
        if self.is_touched:
            await self._until_written(seq)
        return {"seq": seq}

    def replace(self, document: TableDocument) -> None:
        """Go on with another document; all pages take it, and add what they had not sent."""
        self._begin(document, new_token())
        self._seq += 1
        message = self._message({"state": self._document.state})
        for viewer in self.people:
            viewer.send(message)

    def fresh(self) -> TableDocument:
        """Return a document with the same table, for somebody else."""
        return self._document.fresh()

    async def forget(self, name: str) -> None:
        """Cut off the past of the table, and remove what somebody has proposed."""
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
        """Whose the numbers of pages are in this document."""
        self._typed: dict[str, tuple[int, Viewer]] = {}
        """For each cell the number of the last update with it, and whose it was."""

    def _is_of(self, writer: int, viewer: Viewer) -> bool:
        """Return whether a page may write under a number of a page.

        If two wrote under the same one, the edits of the second would count as here already.
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
        """Note that the table has changed.

        Before a change of more than numbers, the table as it was becomes the draft: it may be the
        last one that is whole.
        """
        after = self._document.entries
        changed = (name for name in {*before, *after} if before.get(name) is not after.get(name))
        if self._is_draft_old and not all(isinstance(after.get(name), float) for name in changed):
            self._draft = draft_of(before) or self._draft
        self._is_draft_old = True

    def _find_clashes(self, viewer: Viewer, told: TableUpdate) -> None:
        """Tell two pages that typed into the same cell without having seen each other's number."""
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
        """Tell all pages who is where: at once, or soon if they have just been told."""
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
