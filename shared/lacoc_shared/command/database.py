"""Opens, recognises and checks SQLite files, in the same way for all parts that use them."""

import sqlite3
from collections.abc import Sequence
from pathlib import Path

from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

_NO_ROOM = (
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_IOERR_WRITE,
    sqlite3.SQLITE_IOERR_FSYNC,
    sqlite3.SQLITE_IOERR_SHMSIZE,
)
"""Error codes of SQLite that mean a full disk."""


class Damaged(Exception):
    """Raised when SQLite can't read a file as a database."""


def connect(
    path: Path, application: int, version: int, tables: Sequence[str], *, alone: bool
) -> sqlite3.Connection:
    """Open a database file; it is made if there is none.

    A committed transaction is on the disk, even if the power fails.

    Args:
        path: the file.
        application: number in the file's header that marks this kind of file.
        version: version of its tables.
        tables: SQL statements that make the tables of a new file.
        alone: whether to keep other programs from opening the file while it is open here.

    Raises:
        Damaged: if SQLite can't read the file as a database.
        UserError: if another program has locked the file, or the file is a database of something
            else or of another version, or it can't be opened.
    """
    try:
        db = sqlite3.connect(
            path, timeout=0 if alone else 10, isolation_level="IMMEDIATE", check_same_thread=False
        )
    except sqlite3.Error as error:
        raise problem(path, error, opening=True) from None
    try:
        _set_up(db, path, (application, version), tables, alone)
    except sqlite3.Error as error:
        db.close()
        raise problem(path, error, opening=True) from None
    except Exception:
        db.close()
        raise
    return db


def problem(path: Path, error: sqlite3.Error, opening: bool = False) -> Damaged | UserError:
    """Return the exception that a program raises in place of an error of SQLite.

    Args:
        path: the database file.
        error: the error.
        opening: whether the error came while the file was opened.
    """
    file, why = text_of(path.name), str(error)
    code = getattr(error, "sqlite_errorcode", 0)
    match code & 0xFF:
        case sqlite3.SQLITE_CORRUPT | sqlite3.SQLITE_NOTADB:
            return Damaged(why)
        case sqlite3.SQLITE_BUSY | sqlite3.SQLITE_LOCKED:
            return UserError(say("database.in-use", file=file))
        case _ if opening:
            return UserError(say("database.cannot-open", file=text_of(path), why=why))
        case sqlite3.SQLITE_FULL | sqlite3.SQLITE_IOERR if code in _NO_ROOM:
            return UserError(say("database.no-room", file=file, why=why))
        case _:
            return UserError(say("database.failed", file=text_of(path), why=why))


def _set_up(
    db: sqlite3.Connection, path: Path, kind: tuple[int, int], tables: Sequence[str], alone: bool
) -> None:
    if alone:
        db.execute("PRAGMA locking_mode = EXCLUSIVE")
    found = (_number(db, "application_id"), _number(db, "user_version"))
    if _number(db, "schema_version") and found != kind:
        raise UserError(say("database.newer", file=text_of(path)))
    db.execute("PRAGMA journal_mode = WAL")
    db.execute("PRAGMA secure_delete = ON")  # what is deleted can't be read in the file
    db.execute("PRAGMA synchronous = FULL")
    # One transaction makes all tables or none. A file without tables counts as a new one.
    with db:
        db.execute("BEGIN IMMEDIATE")  # with `alone`, the lock is held until the file is closed
        if not _number(db, "application_id"):
            for statement in tables:
                db.execute(statement)
            db.execute(f"PRAGMA application_id = {kind[0]}")
            db.execute(f"PRAGMA user_version = {kind[1]}")
    (whole,) = db.execute("PRAGMA quick_check(1)").fetchone()
    if whole != "ok":
        raise Damaged(whole)


def _number(db: sqlite3.Connection, name: str) -> int:
    (number,) = db.execute(f"PRAGMA {name}").fetchone()
    return int(number)
