"""Errors of SQLite are told as what they are, so that a user does the right thing."""

import sqlite3
from pathlib import Path

import pytest

from lacoc_shared.command import database
from lacoc_shared.mistakes import UserError

TABLES = ("CREATE TABLE notes (text TEXT)",)


def test_a_refused_write_is_not_told_as_a_full_disk(tmp_path: Path) -> None:
    """If SQLite may not write, the user is told to look at the file, not to make room."""
    path = tmp_path / "notes.db"
    db = database.connect(path, 7, 1, TABLES, alone=False)
    db.execute("PRAGMA query_only = ON")

    with pytest.raises(sqlite3.Error) as raised:
        db.execute("INSERT INTO notes VALUES ('Ada')")
    db.close()

    told = database.problem(path, raised.value)
    assert isinstance(told, UserError)
    assert told.phrase.code == "database.failed"
    assert str(path) in str(told)


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (sqlite3.SQLITE_FULL, "database.no-room"),
        (sqlite3.SQLITE_IOERR_WRITE, "database.no-room"),
        (sqlite3.SQLITE_IOERR_READ, "database.failed"),
        (sqlite3.SQLITE_IOERR, "database.failed"),
        (sqlite3.SQLITE_READONLY, "database.failed"),
        (sqlite3.SQLITE_BUSY, "database.in-use"),
    ],
)
def test_only_a_full_disk_is_told_to_be_full(code: int, told: str) -> None:
    """Advice to make room is given where a full disk can be the cause, and nowhere else."""
    error = sqlite3.OperationalError("no reason")
    error.sqlite_errorcode = code
    found = database.problem(Path("x.facts"), error)
    assert isinstance(found, UserError)
    assert found.phrase.code == told
