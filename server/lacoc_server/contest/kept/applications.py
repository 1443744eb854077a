"""Applications: entries that were weighed in and wait for the organiser.

They are no facts, because anybody who has the event code can apply, and facts are never deleted.
What the organiser approves becomes a fact.
"""

import sqlite3
import time
from pathlib import Path
from typing import NamedTuple, Self

import msgspec

from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_shared.command import database
from lacoc_shared.command.database import Damaged
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

_APPLICATION, _VERSION = 0x4C434150, 1
"""Numbers in the database's header: "LCAP" in ASCII, and the version of `_TABLES`."""
_TABLES = (
    "CREATE TABLE applications (team TEXT PRIMARY KEY, at_ms INTEGER NOT NULL, entry BLOB NOT NULL)"
    " WITHOUT ROWID",
)


class Application(NamedTuple):
    """The newest entry of a team, which waits for the organiser."""

    team: str
    at_ms: int
    """When the files were handed in, in milliseconds since 1970, UTC."""
    entry: ContestEntry


class Applications:
    """The applications of a contest on the disk; used as a context manager.

    Args:
        path: the file; it is made if there is none.

    Raises:
        UserError: if it is damaged, a database of something else, or can't be opened.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._db = database.connect(path, _APPLICATION, _VERSION, _TABLES, alone=False)
        except Damaged as damage:
            raise self._damaged(str(damage)) from None
        self._known = {one.team: one for one in self._read()}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._db.close()

    @property
    def waiting(self) -> dict[str, Application]:
        """The newest application of each team, by team, the oldest first."""
        return dict(sorted(self._known.items(), key=lambda one: one[1].at_ms))

    @property
    def teams(self) -> tuple[str, ...]:
        """The names of the teams whose applications wait; any thread may ask."""
        return tuple(self._known)

    def put(self, team: str, entry: ContestEntry, at_ms: int | None = None) -> None:
        """Keep the files of a team in place of its earlier ones.

        Args:
            team: the team.
            entry: its files.
            at_ms: when they were handed in, in milliseconds since 1970, UTC; None: now.

        Raises:
            UserError: if they can't be written.
        """
        at_ms = time.time_ns() // 1_000_000 if at_ms is None else at_ms
        row = (team, at_ms, msgspec.msgpack.encode(entry))
        self._write("INSERT OR REPLACE INTO applications VALUES (?, ?, ?)", row)
        self._known[team] = Application(team, at_ms, entry)

    def drop(self, *teams: str) -> None:
        """Remove the applications of teams; teams without one are ignored.

        Raises:
            UserError: if the database can't be written.
        """
        self._write("DELETE FROM applications WHERE team = ?", *((team,) for team in teams))
        for team in teams:
            self._known.pop(team, None)

    def _write(self, statement: str, *rows: tuple[object, ...]) -> None:
        try:
            with self._db:
                self._db.executemany(statement, rows)
        except sqlite3.Error as error:
            raise self._problem(error) from None

    def _read(self) -> list[Application]:
        try:
            rows = self._db.execute("SELECT team, at_ms, entry FROM applications").fetchall()
            return [
                Application(team, at_ms, msgspec.msgpack.decode(entry, type=ContestEntry))
                for team, at_ms, entry in rows
            ]
        except sqlite3.Error as error:
            raise self._problem(error) from None
        except msgspec.MsgspecError as error:
            raise self._damaged(str(error)) from None

    def _problem(self, error: sqlite3.Error) -> UserError:
        found = database.problem(self._path, error)
        return found if isinstance(found, UserError) else self._damaged(str(found))

    def _damaged(self, why: str) -> UserError:
        return UserError(say("contest.facts-damaged", file=text_of(self._path), why=why))
