"""The contacts and clubs of the teams, as each team gave them when it applied.

The organiser and the staff read them. A club becomes public when its team enters.
"""

from pathlib import Path

import msgspec

from lacoc_shared.command.replacing import write
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class Contact(msgspec.Struct, frozen=True, omit_defaults=True):
    """How to reach a team, and its club, as the team told when it applied."""

    reach: str = ""
    """An e-mail address or a telephone number, as the team wrote it."""
    club: str = ""
    """The team's school or club."""


class Contacts:
    """The contacts of the teams, in a file that only its owner can read.

    Args:
        path: the file; it is made with the first contact.

    Raises:
        UserError: if the file can't be read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._known: dict[str, Contact] = {}
        try:
            self._known = msgspec.json.decode(path.read_bytes(), type=dict[str, Contact])
        except FileNotFoundError:
            pass
        except (OSError, msgspec.MsgspecError) as error:
            raise UserError(say("command.cannot-read", path=str(path), why=str(error))) from None

    def of(self, team: str) -> Contact:
        """Return the contact of a team; an empty one if the team told nothing."""
        return self._known.get(team, Contact())

    def put(self, team: str, contact: Contact) -> None:
        """Keep the newest contact of a team; an empty one only removes the contact before.

        Raises:
            UserError: if the file can't be written.
        """
        known = {name: one for name, one in self._known.items() if name != team}
        if contact != Contact():
            known[team] = contact
        if known == self._known:
            return
        try:
            write(self._path, msgspec.json.encode(known), secret=True)
        except OSError as error:
            path, why = str(self._path), error.strerror or str(error)
            raise UserError(say("command.cannot-write", path=path, why=why)) from None
        self._known = known
