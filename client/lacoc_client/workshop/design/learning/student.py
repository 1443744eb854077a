"""A student at work: what was done, and the pages on which it is seen."""

from collections.abc import Callable

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.rules import StudentRules


class Student:
    """A student, alone or in a class; used from the event loop only.

    Args:
        name: nickname in the class; "": whoever designs alone.
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

    @property
    def rules(self) -> StudentRules:
        """What the teacher allows."""
        return self._rules()

    def tell(self) -> None:
        """Tell all pages how far the student is."""
        self.send(self.phases_message())

    def send(self, message: bytes) -> None:
        """Send a message to all pages."""
        for viewer in (*self.viewers, *self.lessons):
            viewer.send(message)

    def greet(self, viewer: Viewer, lesson: bool) -> None:
        """Take in a page that was let in; a page of /design stops the others.

        Args:
            viewer: the page.
            lesson: whether it is a page of the lesson of one leg.
        """
        if lesson:
            self.lessons[viewer] = None
            return
        self.send_away()
        self.viewers[viewer] = None

    def leave(self, viewer: Viewer) -> None:
        """Remove a page that has gone."""
        self.viewers.pop(viewer, None)
        self.lessons.pop(viewer, None)

    def send_away(self, forgotten: bool = False) -> None:
        """Refuse further requests from all pages of /design, and tell the pages why.

        Two pages at work would lose each other's changes: only the newest one works.

        Args:
            forgotten: whether the student was deleted, so that pages of the lesson end too; else
                another page was opened.
        """
        message = wire.map_message(MessageKind.ELSEWHERE, {"forgotten": forgotten})
        for pages in (self.viewers, self.lessons) if forgotten else (self.viewers,):
            for viewer in pages:
                viewer.send(message)
                viewer.can_act = False
            pages.clear()

    def phases_message(self) -> bytes:
        """Return the message that says how far the student is."""
        return wire.map_message(
            MessageKind.PHASES, msgspec.structs.asdict(self.diary.phases(self.rules))
        )
