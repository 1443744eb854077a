"""Finds the records of a contest, in the order of the contest's sheet."""

from pathlib import Path

from lacoc_client.web.gateway import contest_sheet
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

_FOLDERS = ("records", "recordings", ".")
"""Folders in which records may be: in a published folder, and beside a contest file."""


def records(folder: Path) -> list[Path]:
    """Return the records of a contest's games, except void ones, as paths in the sheet's order.

    Args:
        folder: a published folder, or the folder of a contest file; it has `contest.json`.

    Raises:
        UserError: if it has no sheet, no game was played yet, or a record is missing.
    """
    path = folder / contest_sheet.NAME
    try:
        sheet = contest_sheet.read(path)
    except FileNotFoundError:
        raise UserError(
            say("film.no-contest", folder=str(folder), sheet=contest_sheet.NAME)
        ) from None
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("film.cannot-read", file=str(path), why=why)) from None
    except ValueError as error:
        told = printable(str(error), 120)
        raise UserError(say("film.bad-sheet", file=str(path), error=told)) from None
    names = [game.record for game in sheet.games if game.record and game.outcome != "void"]
    if not names:
        raise UserError(say("film.no-games", folder=str(folder)))
    return [_found(folder, name) for name in names]


def _found(folder: Path, name: str) -> Path:
    # The sheet may come from anywhere: a record's name leads to no other folder.
    own = Path(name).name
    for place in _FOLDERS:
        path = folder / place / own
        if path.is_file():
            return path
    raise UserError(say("film.no-record", folder=str(folder), name=printable(own, 120)))
