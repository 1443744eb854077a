"""Finds the records of a contest, in the order of the contest's sheet."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from lacoc_client.web.gateway import contest_sheet
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

_FOLDERS = ("records", "recordings", ".")
"""Folders in which records may be: in a published folder, and beside a contest file."""


class ContestGame(NamedTuple):
    """A game of a contest, of which a reel shows something."""

    record: Path
    scores: tuple[int, ...]
    """The points that count, by seat."""


def games(contest: Path) -> list[ContestGame]:
    """Return a contest's games with their records, except void ones, in the sheet's order.

    Args:
        contest: a contest file; or a published folder or that of a contest file, with
            `contest.json`.

    Raises:
        UserError: if the contest file can't be read, there is no sheet, no game was played yet, or
            a record is missing.
    """
    if contest.is_dir():
        folder, path = contest, contest / contest_sheet.NAME
        places = [folder / name for name in _FOLDERS]
    else:
        folder, path = contest.parent, contests.sheet_path(contest)
        places = [contests.load(contest).recordings]
    try:
        sheet = contest_sheet.read(path)
    except FileNotFoundError:
        raise UserError(say("film.no-contest", folder=str(folder), sheet=path.name)) from None
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("film.cannot-read", file=str(path), why=why)) from None
    except ValueError as error:
        told = printable(str(error), 120)
        raise UserError(say("film.bad-sheet", file=str(path), error=told)) from None
    played = [game for game in sheet.games if game.record and game.outcome != "void"]
    if not played:
        raise UserError(say("film.no-games", folder=str(folder)))
    return [ContestGame(_found(places, game.record), game.scores) for game in played]


def _found(places: Sequence[Path], name: str) -> Path:
    # The sheet may come from anywhere: a record's name leads to no other folder.
    own = Path(name).name
    for place in places:
        path = place / own
        if path.is_file():
            return path
    folders = [str(place) for place in places]
    raise UserError(say("film.no-record", folders=folders, name=printable(own, 120)))
