"""The code with which teams apply. The organiser can change it."""

from pathlib import Path

from lacoc_shared.command.replacing import write
from lacoc_shared.contest.codes import new_code
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class EventCode:
    """The event code. Once the organiser has changed it, a file has the newest one.

    Args:
        path: the file for a changed code.
        first: the code until it is changed.

    Raises:
        UserError: if the file can't be read.
    """

    def __init__(self, path: Path, first: str) -> None:
        self._path = path
        try:
            self.value = path.read_text().strip()
            """The code with which teams apply now."""
        except FileNotFoundError:
            self.value = first
        except (OSError, UnicodeDecodeError) as error:
            raise UserError(say("command.cannot-read", path=str(path), why=str(error))) from None

    def change(self) -> None:
        """Replace the code by a new one, chosen by chance, and write it to the file.

        Raises:
            UserError: if the file can't be written.
        """
        code = new_code()
        try:
            write(self._path, code.encode(), lasting=True)
        except OSError as error:
            why = error.strerror or str(error)
            raise UserError(say("command.cannot-write", path=str(self._path), why=why)) from None
        self.value = code
