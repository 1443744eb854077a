"""The file that keeps students' evidence and tables; it is opened when it is first needed."""

import asyncio
from pathlib import Path

from lacoc_client.workshop.phases.store import ClassStore
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase


class Keeper:
    """Keeps open the file of evidence and tables; used from the event loop only.

    If the file can't be opened, nothing is kept on the disk, and `trouble` says why.

    Args:
        path: the file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._store: ClassStore | None = None
        self._refused: Phrase | None = None
        self._opening: asyncio.Task[None] | None = None

    @property
    def trouble(self) -> Phrase | None:
        """Why evidence can't be kept, or what happened to its file; None: all is well."""
        return self._refused if self._store is None else self._store.trouble

    async def opened(self) -> ClassStore | None:
        """Open the file if it is not open yet, and return it; None if it can't be opened."""
        if self._store is None and self._refused is None:
            if self._opening is None:
                self._opening = asyncio.get_running_loop().create_task(self._open())
            # If the page that asked first goes, its request is cancelled. The opening must go
            # on, or the file would be open without being known here.
            await asyncio.shield(self._opening)
        return self._store

    async def close(self) -> None:
        """Close the file of evidence and tables."""
        if self._opening is not None and not self._opening.done():
            await asyncio.wait({self._opening})
        if self._store is not None:
            await asyncio.to_thread(self._store.close)

    async def _open(self) -> None:
        try:
            self._store = await asyncio.to_thread(ClassStore, self.path)
        except UserError as error:
            self._refused = error.phrase
