"""The file of a contest's facts: they are appended, and none is ever changed."""

import re
import sqlite3
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Self

import msgspec

from lacoc_server.contest.kept import machine
from lacoc_server.contest.league.facts import AnyFact, TakenOver, generation, new
from lacoc_shared.command import database
from lacoc_shared.command.database import Damaged
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

_APPLICATION, _VERSION = 0x4C434654, 1
"""Numbers in the database's header that mark a file of facts: "LCFT" in ASCII, and the version of
`_TABLES`."""
_TOO_LONG = re.compile(r"length <= (\d+) - at `\$\.(\w+)`")
"""How msgspec tells of a text that is too long: the most characters, and the field."""
_INSERT = "INSERT INTO facts VALUES (?, ?, ?)"
_TABLES = (
    "CREATE TABLE facts (number INTEGER PRIMARY KEY, at_ms INTEGER NOT NULL, body TEXT NOT NULL)",
    "CREATE TRIGGER unchanged BEFORE UPDATE ON facts BEGIN SELECT RAISE(ABORT, 'facts stay'); END",
    "CREATE TRIGGER kept BEFORE DELETE ON facts BEGIN SELECT RAISE(ABORT, 'facts stay'); END",
)


class FactStore:
    """The facts of a contest on the disk; several programs can use one file.

    Used as a context manager. When `append` returns, all its facts are on the disk; if it raises an
    error, none of them is.

    Args:
        path: the file; it is made if there is none.
        by: who of the staff decides what is appended; "": the organiser, or the office itself.

    Raises:
        UserError: if it is damaged, a database of something else, or can't be opened.
    """

    def __init__(self, path: Path, by: str = "") -> None:
        self._path = path
        self._by = by
        try:
            self._db = database.connect(path, _APPLICATION, _VERSION, _TABLES, alone=False)
        except Damaged as damage:
            raise UserError(
                say("contest.facts-damaged", file=text_of(path), why=str(damage))
            ) from None
        self._known: list[AnyFact] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._db.close()

    @contextmanager
    def decided_by(self, name: str) -> Iterator[None]:
        """In the block, note in all appended facts that this member of staff decided them."""
        before, self._by = self._by, name
        try:
            yield
        finally:
            self._by = before

    def append(self, *facts: AnyFact) -> None:
        """Append facts; the store gives each its number, id, time and who decided it.

        Raises:
            UserError: if the file can't be written; nothing is appended then.
        """
        self.decide(lambda _: facts)

    def decide(self, decision: Callable[[tuple[AnyFact, ...]], Iterable[AnyFact]]) -> None:
        """Append facts that `decision` makes from all facts.

        No other program can append any meanwhile.

        Args:
            decision: is given all facts, and returns those to append. If it raises an exception,
                nothing is appended.

        Raises:
            UserError: if a fact can't be kept as it is, the file can't be read or written, or the
                contest's office is not on this machine; nothing is appended then.
        """
        self._decide(decision, machine.check_office)

    def take_over(self) -> None:
        """Append the fact that the office goes on at this machine, which has a copy of its facts.

        Raises:
            UserError: if the file can't be read or written; nothing is appended then.
        """
        self._decide(lambda _: [new(TakenOver)], lambda _: None)

    def _decide(
        self,
        decision: Callable[[tuple[AnyFact, ...]], Iterable[AnyFact]],
        check: Callable[[machine.Machine], None],
    ) -> None:
        now_ms = time.time_ns() // 1_000_000
        try:
            with self._db:
                self._db.execute("BEGIN IMMEDIATE")
                check(machine.read(machine.path_of(self._path)))
                known = self.facts()
                last, moves = known[-1].number if known else 0, generation(known)
                for number, fact in enumerate(decision(known), last + 1):
                    moves += isinstance(fact, TakenOver)
                    placed = msgspec.structs.replace(
                        fact, id=_id(number, moves), number=number, at_ms=now_ms, by=self._by
                    )
                    self._db.execute(_INSERT, (number, now_ms, _body(placed)))
        except sqlite3.Error as error:
            raise self._problem(error) from None

    def bodies(self, after: int, most_bytes: int) -> list[str]:
        """Read the stored text of facts, in their order.

        The first of them is read whatever its length.

        Args:
            after: number of the fact after which to begin.
            most_bytes: how many characters all texts may have together; a single fact may be
                longer.

        Raises:
            UserError: if the file can't be read.
        """
        found: list[str] = []
        try:
            select = "SELECT body FROM facts WHERE number > ? ORDER BY number"
            for (body,) in self._db.execute(select, (after,)):
                most_bytes -= len(body)
                if found and most_bytes < 0:
                    break
                found.append(body)
        except sqlite3.Error as error:
            raise self._problem(error) from None
        return found

    def copy(self, facts: Sequence[AnyFact], bodies: Sequence[str]) -> None:
        """Store facts copied from another machine, with the same text as in its file.

        Args:
            facts: the facts, which follow those that this file has.
            bodies: the stored text of each of these facts on the other machine.

        Raises:
            UserError: if the file can't be written; nothing is stored then.
        """
        rows = [(one.number, one.at_ms, body) for one, body in zip(facts, bodies, strict=True)]
        try:
            with self._db:
                self._db.executemany(_INSERT, rows)
        except sqlite3.Error as error:
            raise self._problem(error) from None

    def facts(self) -> tuple[AnyFact, ...]:
        """Read all facts in their order, also those that other programs have appended.

        Raises:
            UserError: if the file can't be read, or a fact in it is not one of this version.
        """
        last = self._known[-1].number if self._known else 0
        try:
            rows = self._db.execute(
                "SELECT body FROM facts WHERE number > ? ORDER BY number", (last,)
            ).fetchall()
            self._known += [msgspec.json.decode(body, type=AnyFact) for (body,) in rows]
        except sqlite3.Error as error:
            raise self._problem(error) from None
        except msgspec.MsgspecError as error:
            raise UserError(say("league.wrong-facts", error=str(error))) from None
        return tuple(self._known)

    def _problem(self, error: sqlite3.Error) -> UserError:
        found = database.problem(self._path, error)
        if isinstance(found, UserError):
            return found
        return UserError(say("contest.facts-damaged", file=text_of(self._path), why=str(found)))


def _body(fact: AnyFact) -> str:
    """Write a fact as it is stored.

    Raises:
        UserError: if it could not be read again, for example because a text is too long.
    """
    body = msgspec.json.encode(fact)
    try:
        msgspec.json.decode(body, type=AnyFact)
    except msgspec.ValidationError as error:
        if found := _TOO_LONG.search(str(error)):
            most, field = found.groups()
            raise UserError(say("league.too-long", field=field, most=int(most))) from None
        raise UserError(say("league.wrong-fact", error=str(error))) from None
    return body.decode()


def _id(number: int, moves: int) -> str:
    """Return an id for a fact.

    A machine that takes over as the office never gives an id that exists.

    Args:
        number: the fact's place among all facts.
        moves: how often the office has gone to another machine.
    """
    return f"f{number}.{moves}" if moves else f"f{number}"
