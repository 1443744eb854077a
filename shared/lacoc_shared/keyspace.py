"""The key expressions of a court (docs/protocol.md)."""

import re
from dataclasses import dataclass

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

EVERY_COURT = "lacoc/*/live/court"
"""Liveliness: the announcements of all courts that can be reached."""
COMMAND_MAX_BYTES = 1024
"""A longer command, ready or leave is not read."""
ENTER = "enter"
"""In the place of a decision's name: the token is only shown."""
DECISION_MAX_BYTES = 4096
"""A longer decision of a referee is not read."""
EVENTS_LISTED = 2000
"""A court lists, and a client keeps, at most so many events of a match, the newest: a reply has its
limit, and a practice may go on for days."""
JOIN_MAX_BYTES = 65_536
"""A longer join, with all its files, is not read."""

_NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,31}")


@dataclass(frozen=True)
class Keys:
    """The key expressions of one court.

    Raises:
        UserError: if the court's name is not made of a-z, 0-9 and hyphens.
    """

    court: str

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.court):
            raise UserError(say("address.court-name", name=self.court))

    @property
    def root(self) -> str:
        """Everything of the court lies below this."""
        return f"lacoc/{self.court}"

    @property
    def frame(self) -> str:
        """Court to all, 50 Hz, the newest wins."""
        return f"{self.root}/frame"

    @property
    def event(self) -> str:
        """Court to all, numbered, must arrive; by query all of the match."""
        return f"{self.root}/event"

    @property
    def sheet(self) -> str:
        """Court to all on change, and by query."""
        return f"{self.root}/sheet"

    @property
    def scene(self) -> str:
        """By query; a frame's scene hash tells that it changed."""
        return f"{self.root}/scene"

    @property
    def health(self) -> str:
        """Court to all, 2 Hz, the newest wins."""
        return f"{self.root}/health"

    @property
    def alive(self) -> str:
        """Liveliness: announced while the court is connected."""
        return f"{self.root}/live/court"

    def command(self, seat: str) -> str:
        """Controller to court: the seat's commands."""
        return f"{self.root}/seat/{seat}/key"

    def request(self, seat: str, what: str) -> str:
        """Controller to court, with a reply: `what` is join, ready or leave."""
        return f"{self.root}/seat/{seat}/{what}"

    @property
    def enter(self) -> str:
        """Referee to court, with a reply: is this a referee's token?"""
        return f"{self.root}/referee/{ENTER}"

    def decision(self, name: str) -> str:
        """Referee to court, with a reply; `*` for all decisions."""
        return f"{self.root}/referee/{name}"
