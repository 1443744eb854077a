"""A student at work: the student's evidence, tables and open pages."""

import asyncio
from collections.abc import Callable
from contextlib import suppress

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.rules import StudentRules
from lacoc_client.workshop.tables.draft import Draft
from lacoc_client.workshop.tables.kept_table import TABLE, kept_table
from lacoc_client.workshop.tables.shared_table import SharedTable
from lacoc_shared.mistakes import UserError


class Student:
    """A student, alone or in a class; used from the event loop only.

    Args:
        name: nickname in the class; "": a person who designs alone.
        diary: keeps what the student does.
        rules: returns what the teacher allows.
    """

    def __init__(self, name: str, diary: Diary, rules: Callable[[], StudentRules]) -> None:
        self.name = name
        self.diary = diary
        self._rules = rules
        self.viewers: dict[Viewer, None] = {}
        """The student's pages of /design."""
        self.lessons: dict[Viewer, None] = {}
        """The student's pages of the lesson of one leg, which change no table."""
        self.own = SharedTable("", self._keep)
        """The student's own table; in a group the student works on another one."""
        self.table = self.own
        """The table on which the student works."""
        self.reading = asyncio.Lock()
        """Held while a file of the student is read or written."""

    @property
    def rules(self) -> StudentRules:
        """What the teacher allows this student."""
        return self._rules()

    @property
    def draft(self) -> Draft | None:
        """The newest table without a bad cell.

        None: nobody ever changed the table, or since the program started it always had a bad cell.
        """
        return self.table.draft

    def open_kept(self) -> None:
        """Load the student's own table from the diary, if it has one that can be read."""
        kept = kept_table(self.diary.documents)
        if kept is not None:
            with suppress(UserError):  # of another version of this program
                self.own = SharedTable("", self._keep, kept.content, kept.version)
        self.table = self.own

    def sit_at(self, table: SharedTable) -> None:
        """Let the student work on another table; all the student's pages of /design show it."""
        if table is self.table:
            return
        for viewer in self.viewers:
            self.table.leave(viewer)
        self.table = table
        for viewer in self.viewers:
            table.show(viewer, self.name)

    def tell(self) -> None:
        """Tell all the student's pages how far the student is in the phases."""
        self.send(self.phases_message())

    def send(self, message: bytes) -> None:
        """Send a message to all the student's pages."""
        for viewer in (*self.viewers, *self.lessons):
            viewer.send(message)

    def greet(self, viewer: Viewer, lesson: bool) -> None:
        """Add a page of the student that was let in; a page of /design has the table open.

        Args:
            viewer: the page.
            lesson: whether it is a page of the lesson of one leg.
        """
        if lesson:
            self.lessons[viewer] = None
            return
        self.viewers[viewer] = None
        self.table.add(viewer, self.name)

    def leave(self, viewer: Viewer) -> None:
        """Remove a page of this student, because the page was closed."""
        self.viewers.pop(viewer, None)
        self.lessons.pop(viewer, None)
        self.table.leave(viewer)
        if not self.viewers:
            self.own.end()

    def send_away(self) -> None:
        """Tell the student's pages that the student was deleted; refuse their later requests."""
        message = wire.map_message(MessageKind.FORGOTTEN, {})
        for pages in (self.viewers, self.lessons):
            for viewer in (*pages,):
                viewer.send(message)
                viewer.can_act = False
                self.leave(viewer)

    async def _keep(self, state: bytes, epoch: str) -> None:
        await self.diary.write(TABLE, state, epoch)

    def phases_message(self) -> bytes:
        """Return the message that says how far the student is in the phases."""
        return wire.map_message(
            MessageKind.PHASES, msgspec.structs.asdict(self.diary.phases(self.rules))
        )
