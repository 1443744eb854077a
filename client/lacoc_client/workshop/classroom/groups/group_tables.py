"""The tables of a class's groups, and how they are kept in the class file."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterable, Mapping
from contextlib import suppress

from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_client.workshop.tables.document import TableDocument
from lacoc_client.workshop.tables.draft import Draft
from lacoc_client.workshop.tables.kept_table import TABLE
from lacoc_client.workshop.tables.shared_table import SharedTable
from lacoc_shared.mistakes import UserError

OF_GROUP = "group\n"
"""In the class file a group's documents are kept under this prefix and the group's id. No student's
nickname begins with it."""


class GroupTables:
    """The tables of a class's groups, by the id of the group; used from the event loop only.

    Args:
        store: opens the class file.
    """

    def __init__(self, store: Callable[[], Awaitable[ClassStore]]) -> None:
        self._store = store
        self._tables: dict[str, SharedTable] = {}

    def __getitem__(self, id_: str) -> SharedTable:
        return self._tables[id_]

    async def begin(self, documents: Iterable[Document], gone: Mapping[str, Iterable[str]]) -> None:
        """Load the tables of groups from the class file.

        Delete from it what is left of ended groups.

        Args:
            documents: the documents of groups in the class file.
            gone: for each group its members who are no students of the class any more.
        """
        kept = {one.student: one for one in documents if one.name == TABLE}
        for id_, names in gone.items():
            one = kept.pop(OF_GROUP + id_, None)
            content, epoch = (one.content, one.version) if one else (b"", "")
            keep = self._keeps(id_)
            try:
                self._tables[id_] = SharedTable(id_, keep, content, epoch)
            except UserError:  # of another version of this program
                self._tables[id_] = SharedTable(id_, keep)
            for name in names:
                await self._tables[id_].forget(name)
        for owner in kept:
            await self._delete(owner)

    def add(self, id_: str, document: TableDocument) -> SharedTable:
        """Make the table of a new group."""
        table = SharedTable(id_, self._keeps(id_))
        table.replace(document)
        self._tables[id_] = table
        return table

    async def end(self, id_: str) -> None:
        """Delete the table of a group that ends."""
        del self._tables[id_]
        await self._delete(OF_GROUP + id_)

    def drafts(self) -> dict[str, Draft]:
        """Return the newest table of each group that has one, by the id of the group."""
        drafts = {id_: table.draft for id_, table in self._tables.items()}
        return {id_: draft for id_, draft in drafts.items() if draft is not None}

    async def _delete(self, owner: str) -> None:
        with suppress(UserError):  # `Keeper.trouble` says why
            store = await self._store()
            await asyncio.wrap_future(store.forget(owner))

    def _keeps(self, id_: str) -> Callable[[bytes, str], Awaitable[None]]:
        async def keep(content: bytes, epoch: str) -> None:
            if id_ not in self._tables:
                return  # it has ended
            with suppress(UserError):  # `Keeper.trouble` says why
                store = await self._store()
                document = Document(OF_GROUP + id_, TABLE, epoch, time.time(), content)
                await asyncio.wrap_future(store.write(document))

        return keep
