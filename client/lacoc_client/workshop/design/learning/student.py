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
        """The student's pages."""

    @property
    def rules(self) -> StudentRules:
        """What the teacher allows."""
        return self._rules()

    def tell(self) -> None:
        """Tell all pages how far the student is."""
        self.send(self.phases_message())

    def send(self, message: bytes) -> None:
        """Send a message to all pages."""
        for viewer in self.viewers:
            viewer.send(message)

    def send_away(self, forgotten: bool = False) -> None:
        """Refuse further requests from all pages, and tell the pages why.

        Two pages at work would lose each other's changes: only the newest one works.

        Args:
            forgotten: whether the student was deleted; else another page was opened.
        """
        self.send(wire.map_message(MessageKind.ELSEWHERE, {"forgotten": forgotten}))
        for viewer in self.viewers:
            viewer.can_act = False
        self.viewers.clear()

    def phases_message(self) -> bytes:
        """Return the message that says how far the student is."""
        return wire.map_message(
            MessageKind.PHASES, msgspec.structs.asdict(self.diary.phases(self.rules))
        )
