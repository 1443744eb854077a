"""The key expressions of a court (docs/protocol.md)."""

import re
from dataclasses import dataclass

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

EVERY_COURT = "lacoc/*/live/court"
"""Key expression for the announcements of all courts that can be reached (Zenoh's liveliness)."""
DESK = "lacoc/office/desk"
"""Key expression of the requests of pages to an office's desk, which has a Zenoh session of its
own."""
COMMAND_MAX_BYTES = 1024
"""Largest command that is read [bytes]; also the largest ready, leave, try or where request."""
ENTER = "enter"
"""Stands in the place of a decision's name when a referee only shows the token."""
DECISION_MAX_BYTES = 4096
"""Largest decision of a referee that is read [bytes]."""
EVENTS_LISTED = 2000
"""How many events of a match a court lists, and a client keeps, at most: the newest ones. There is
a limit because a reply has a greatest size, and a practice may last for days."""
JOIN_MAX_BYTES = 65_536
"""Largest join, with all its files, that is read [bytes]."""

ASSIGN_MAX_BYTES = 196_608
"""Largest assignment of the office that is read [bytes]; it has the files of two teams, and
more."""

COPY_PART_BYTES = 131_072
"""Largest part of a record that a court sends to the office at once [bytes]."""

_NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,31}")


def check_name(name: str) -> None:
    """Check that a name is allowed for a court or studio.

    Raises:
        UserError: if it is not 1 to 32 of a-z, 0-9 and hyphens, or begins with a hyphen.
    """
    if not _NAME.fullmatch(name):
        raise UserError(say("address.court-name", name=name))


@dataclass(frozen=True)
class KeySpace:
    """The key expressions of one court.

    Raises:
        UserError: if the court's name is not allowed (`check_name`).
    """

    court: str

    def __post_init__(self) -> None:
        check_name(self.court)

    @property
    def root(self) -> str:
        """Prefix of all key expressions of the court."""
        return f"lacoc/{self.court}"

    @property
    def frame(self) -> str:
        """Key expression of frames: the court sends 50 a second, and only the newest matters."""
        return f"{self.root}/frame"

    @property
    def event(self) -> str:
        """Key expression of events; a query to it returns the newest `EVENTS_LISTED` of the match.

        Events are numbered, so that a client sees if one was lost, and asks for it.
        """
        return f"{self.root}/event"

    @property
    def sheet(self) -> str:
        """Key expression of the sheet: the court sends each new one, and answers queries for it."""
        return f"{self.root}/sheet"

    @property
    def scene(self) -> str:
        """Key expression of queries for the scene; frames have the hash of the newest scene."""
        return f"{self.root}/scene"

    @property
    def health(self) -> str:
        """Key expression of health, of which only the newest matters.

        The court sends it twice a second, and at once when `gains` changes.
        """
        return f"{self.root}/health"

    @property
    def alive(self) -> str:
        """Key expression that is announced while the court is connected (Zenoh's liveliness)."""
        return f"{self.root}/live/court"

    def command(self, seat: str) -> str:
        """Return the key expression of a seat's commands (controller to court)."""
        return f"{self.root}/seat/{seat}/key"

    def request(self, seat: str, what: str) -> str:
        """Return the key expression on which a seat sends the court requests of one kind.

        Args:
            seat: the seat.
            what: join, ready, leave or try.
        """
        return f"{self.root}/seat/{seat}/{what}"

    @property
    def enter(self) -> str:
        """Key expression on which a client asks whether its token is a referee's."""
        return f"{self.root}/referee/{ENTER}"

    def decision(self, name: str) -> str:
        """Return the key expression of a decision, which gets a reply; `*` means all decisions."""
        return f"{self.root}/referee/{name}"

    @property
    def outlook(self) -> str:
        """Key expression on which a referee asks what would happen if play went on."""
        return f"{self.root}/outlook"

    @property
    def where(self) -> str:
        """Key expression on which a team asks where it plays, at a court with an office."""
        return f"{self.root}/where"

    def office(self, what: str) -> str:
        """Return the key expression on which the office sends a court requests of one kind.

        Args:
            what: assign, withdraw, tell, copy or retire; `*` means all of them.
        """
        return f"{self.root}/office/{what}"
