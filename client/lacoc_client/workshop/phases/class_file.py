"""The SQLite file of a class: all evidence, and the newest documents of everybody."""

import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import NamedTuple

from lacoc_client.workshop.phases.evidence import Evidence, Voted, from_json, kind_of, to_json
from lacoc_shared.command import database
from lacoc_shared.command.database import Damaged
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

_APPLICATION, _VERSION = 0x4C41434F, 1
"""Numbers in the header of the SQLite file by which it is recognised as a class: "LACO" in ASCII,
and the version of `_TABLES`."""
_BESIDE = ("", "-wal", "-shm", "-journal")
"""Endings of the names of a database's files: of its own, and of those that SQLite makes beside
it."""
_TABLES = (
    """
    CREATE TABLE evidence (
        number INTEGER PRIMARY KEY AUTOINCREMENT,
        student TEXT NOT NULL, at_s REAL NOT NULL, kind TEXT NOT NULL, body TEXT NOT NULL
    )
    """,
    """
    CREATE INDEX evidence_of_student ON evidence (student, number)
    """,
    """
    CREATE TABLE tables (
        student TEXT NOT NULL, name TEXT NOT NULL,
        version TEXT NOT NULL, at_s REAL NOT NULL, content BLOB NOT NULL,
        PRIMARY KEY (student, name)
    ) WITHOUT ROWID
    """,
    """
    CREATE TABLE votes (
        poll TEXT NOT NULL, choice TEXT NOT NULL, votes INTEGER NOT NULL,
        PRIMARY KEY (poll, choice)
    ) WITHOUT ROWID
    """,
)


class Kept(NamedTuple):
    """A piece of evidence as it is in the class file."""

    number: int
    """Number of this evidence among all of the class, in the order of writing, from 1."""
    student: str
    at_s: float
    """Time when it happened, in seconds since 1970 (UTC)."""
    evidence: Evidence


class Document(NamedTuple):
    """The newest content of a document, such as a table; in SQL a row of `tables`."""

    student: str
    """The student or group (`group_tables.OF_GROUP`) whose document it is; "": the whole class, or
    a person who designs alone."""
    name: str
    """Name of the document, such as "table"."""
    version: str
    at_s: float
    content: bytes


class ClassFile:
    """The open file of a class; no other program can open it meanwhile. For one thread at a time.

    A method that writes returns when its data are on the disk.

    Args:
        path: the file; it is made if there is none.

    Raises:
        Damaged: if SQLite can't read the file as a database.
        UserError: if another program has the file open, if it is a database of something else, or
            if it can't be opened.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._db = database.connect(path, _APPLICATION, _VERSION, _TABLES, alone=True)

    def add(
        self, student: str, evidence: Evidence, at_s: float, documents: Iterable[Document] = ()
    ) -> int:
        """Write evidence to the class file, and documents with it; return the evidence's number.

        Raises:
            sqlite3.Error: if the file can't be written; `problem` says why.
        """
        with self._db:
            self._write_documents(documents)
            return self._add(student, evidence, at_s)

    def vote(self, student: str, poll: str, choice: str, at_s: float) -> bool:
        """Count a vote; the file keeps that the student voted, but not for which choice.

        Returns:
            Whether the vote counts: False if the student has voted in this poll before.
        """
        voted = Voted(poll=poll)
        before = "SELECT 1 FROM evidence WHERE student = ? AND kind = ? AND body = ?"
        with self._db:
            if self._db.execute(before, (student, *_row(voted))).fetchone():
                return False
            self._add(student, voted, at_s)
            self._db.execute(
                "INSERT INTO votes VALUES (?, ?, 1)"
                " ON CONFLICT (poll, choice) DO UPDATE SET votes = votes + 1",
                (poll, choice),
            )
        return True

    def votes(self, poll: str) -> dict[str, int]:
        """Return how many votes each choice of a poll has."""
        rows = self._db.execute("SELECT choice, votes FROM votes WHERE poll = ?", (poll,))
        return dict(rows.fetchall())

    def write_documents(self, documents: Iterable[Document]) -> None:
        """Write the newest content of documents; raise the same error as `add`."""
        with self._db:
            self._write_documents(documents)

    def evidence(self, student: str | None = None, after: int = 0) -> list[Kept]:
        """Read evidence in the order in which it was written; skip evidence that can't be decoded.

        Args:
            student: the student whose evidence is read; None: all students.
            after: only evidence with a larger number is read.
        """
        rows = self._db.execute(
            "SELECT number, student, at_s, body FROM evidence"
            " WHERE number > ?1 AND (?2 IS NULL OR student = ?2) ORDER BY number",
            (after, student),
        )
        return list(_readable(rows))

    def documents(self) -> list[Document]:
        """Read all documents of the class, such as tables and settings, in their newest version."""
        rows = self._db.execute("SELECT student, name, version, at_s, content FROM tables")
        return [Document(*row) for row in rows]

    def forget(self, student: str) -> None:
        """Delete everything that is kept of a student, except votes, because they have no names."""
        with self._db:
            self._db.execute("DELETE FROM evidence WHERE student = ?", (student,))
            self._db.execute("DELETE FROM tables WHERE student = ?", (student,))
        self._db.execute("PRAGMA wal_checkpoint(TRUNCATE)")  # the log still has it otherwise

    def close(self) -> None:
        """Close the class file."""
        self._db.close()

    def problem(self, error: sqlite3.Error) -> Damaged | UserError:
        """Turn an error of SQLite into the exception to raise, which has a sentence for people."""
        return database.problem(self._path, error)

    def _write_documents(self, documents: Iterable[Document]) -> None:
        self._db.executemany("INSERT OR REPLACE INTO tables VALUES (?, ?, ?, ?, ?)", documents)

    def _add(self, student: str, evidence: Evidence, at_s: float) -> int:
        added = self._db.execute(
            "INSERT INTO evidence (student, at_s, kind, body) VALUES (?, ?, ?, ?)",
            (student, at_s, *_row(evidence)),
        )
        return int(added.lastrowid or 0)


def set_aside(path: Path) -> Path:
    """Give a damaged file another name, so that a fresh one can be made.

    Returns:
        The new path, such as `class.damaged-1.sqlite`.

    Raises:
        UserError: if the file can't be renamed.
    """
    free = (path.with_name(f"{path.stem}.damaged-{number}{path.suffix}") for number in count(1))
    kept = next(name for name in free if not name.exists())
    try:
        for end in _BESIDE[1:]:  # the database itself last: after a failure it is found again
            beside = Path(f"{path}{end}")
            if beside.exists():
                beside.rename(f"{kept}{end}")
        path.rename(kept)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("database.cannot-open", file=text_of(path), why=why)) from None
    return kept


def forget(path: Path) -> list[Path]:
    """Delete the file of a class, its damaged files that were set aside, and SQLite's own files.

    Returns:
        The deleted files.

    Raises:
        UserError: if there is no such file, it is not a class, a program has it open, or a file
            can't be deleted.
    """
    if not path.exists():
        raise UserError(say("class.none", file=text_of(path)))
    with suppress(Damaged):  # a damaged file can be deleted too
        ClassFile(path).close()
    old = path.parent.glob(f"{_escaped(path.stem)}.damaged-*{_escaped(path.suffix)}")
    # The file itself is last: if another one can't be deleted now, the command can be used again.
    found = [Path(f"{one}{end}") for one in (*old, path) for end in reversed(_BESIDE)]
    found = [one for one in found if one.exists()]
    for one in found:
        try:
            one.unlink()
        except OSError as error:
            why = error.strerror or str(error)
            raise UserError(say("class.not-deleted", file=text_of(one), why=why)) from None
    return found


def _readable(rows: Iterable[tuple[int, str, float, str]]) -> Iterator[Kept]:
    for number, student, at_s, body in rows:
        with suppress(ValueError):  # somebody changed the file with another program
            yield Kept(number, student, at_s, from_json(body))


def _escaped(name: str) -> str:
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in name)


def _row(evidence: Evidence) -> tuple[str, str]:
    """Return the kind of evidence and the rest of it as JSON, for two columns of the file."""
    return kind_of(evidence), to_json(evidence).decode()
