"""The records of a contest, in the order in which its sheet has them."""

from pathlib import Path

import msgspec

from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

SHEET = "contest.json"
_FOLDERS = ("records", "recordings", ".")
"""Where records are: in a published folder, and beside a contest file."""


class _Game(msgspec.Struct):
    record: str = ""
    outcome: str = ""


class _Match(msgspec.Struct):
    games: list[_Game] = []


class _Stage(msgspec.Struct):
    matches: list[_Match] = []


class _Sheet(msgspec.Struct):
    """The part of a contest's sheet that names records."""

    stages: list[_Stage] = []


def records(folder: Path) -> list[Path]:
    """Return the records of a contest's games, except void ones, as paths in the sheet's order.

    Args:
        folder: a published folder, or the folder of a contest file; it has `contest.json`.

    Raises:
        UserError: if it has no sheet, no game was played yet, or a record is missing.
    """
    path = folder / SHEET
    try:
        sheet = msgspec.json.decode(path.read_bytes(), type=_Sheet)
    except FileNotFoundError:
        raise UserError(say("film.no-contest", folder=str(folder), sheet=SHEET)) from None
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("film.cannot-read", file=str(path), why=why)) from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        told = printable(str(error), 120)
        raise UserError(say("film.bad-sheet", file=str(path), error=told)) from None
    games = [game for stage in sheet.stages for match in stage.matches for game in match.games]
    names = [game.record for game in games if game.record and game.outcome != "void"]
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
