"""The list of courts that run on the office's machine because their own machine was lost.

To give a court back to its own machine, an organiser removes its line while the court has no match.
"""

from pathlib import Path

from lacoc_shared.command.replacing import write
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def stand_ins(path: Path) -> list[str]:
    """Return the names of the courts that run on the office's machine in place of their own.

    Args:
        path: the list; a name stands on each line.

    Raises:
        UserError: if the list can't be read.
    """
    try:
        return path.read_text(encoding="utf-8").split()
    except FileNotFoundError:
        return []
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise UserError(say("command.cannot-read", path=str(path), why=why)) from None


def stand_in(path: Path, court: str) -> None:
    """Add a court to the list of courts that run on the office's machine in place of their own.

    Raises:
        UserError: if the list can't be read or written.
    """
    names = dict.fromkeys([*stand_ins(path), court])
    try:
        write(path, "".join(f"{name}\n" for name in names).encode())
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(path), why=why)) from None
