"""The file of a record's odds, beside the record."""

import os
from pathlib import Path

import msgspec

from lacoc_server.simulate.forks.chances import FORMAT, Odds
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def read_odds(path: Path) -> Odds | None:
    """Read the odds of a record; None if there are none that this version can use."""
    try:
        found = msgspec.json.decode(path.read_bytes(), type=Odds)
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return None  # they are computed again
    return found if found.format == FORMAT else None


def write_odds(path: Path, odds: Odds) -> None:
    """Write the odds of a record; whoever reads meanwhile gets the old file or the new one, whole.

    Raises:
        UserError: if it can't be written.
    """
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(msgspec.json.encode(odds))
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(path), why=why)) from None
