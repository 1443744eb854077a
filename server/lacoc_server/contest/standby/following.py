"""Keeps a copy of the folder of another machine's office, and brings it up to date step by step.

A step asks what the office has, and copies what this folder lacks: first entries, secrets, records,
because facts can name them, then the facts themselves. These facts came with the office's answer,
so they are older than the copies of the records. So if copying stops at any moment, the copy has
the record of each of its results, at least up to the end of the match.
"""

import os
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple, Self

import msgspec

from lacoc_server.contest.kept import machine
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.copying import Taken, have, take
from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_server.contest.kept.folder import ContestFolder, hash_of
from lacoc_server.contest.kept.machine import Machine
from lacoc_server.contest.kept.plans import open_stage, plans
from lacoc_server.contest.kept.publish import entries_of
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import AnyFact, Played, generation
from lacoc_server.contest.standby.door import hashes, small_files, version_of, with_segments
from lacoc_server.contest.standby.messages import Got, Kind, PartAsk, RecordAsk, StepAsk, There
from lacoc_server.contest.standby.other import LacksIt, Other
from lacoc_shared import codec
from lacoc_shared.command.replacing import write
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import own_address
from lacoc_shared.record.files import packed_path
from lacoc_shared.words import Phrase, say

_STAY = ("contest", "secrets")
"""Files that are not removed here if the office lacks them: an editor may just be replacing one,
and without them this machine could not take over."""
_ENTRY_MAX_BYTES = 1 << 26
_TRIES = 5
"""How often a step is repeated at once if the office's files changed during it."""


class _Changed(Exception):
    """A file of the office changed while it was copied, so the copying must be repeated."""


class CopyingEnded(Exception):
    """This machine takes over as the office, so no more may be copied into its folder."""


class CopyState(NamedTuple):
    """How much of the office's folder the copy has."""

    at_ms: int
    """The last time at which the copy was equal to the office's folder, in milliseconds since 1970,
    UTC; 0: never yet."""
    facts: int
    records: int
    """How many records of results are here completely."""
    open: int
    """How many records are not complete here yet."""


class Follower:
    """Copies the office's folder of another machine into this machine's; used as a context manager.

    Args:
        where: the contest in this machine's folder.
        other: asks the office whose folder is copied.
        tell: called with problems that the organiser must know.

    Raises:
        UserError: if a file in this machine's folder can't be read.
    """

    def __init__(self, where: ContestFolder, other: Other, tell: Callable[[Phrase], None]) -> None:
        assert where.contest.standby is not None, "the contest file names a second machine"
        port = where.contest.standby.office.rpartition(":")[2]
        self._address = f"tcp/{own_address()}:{port}"
        self._where = where
        self._other = other
        self._tell = tell
        self._store = FactStore(where.facts)
        self._applications = Applications(where.applications)
        self._facts = self._store.facts()
        self._generation = generation(self._facts)
        self._open: set[str] = {
            *with_segments(where.records),
            *_missing(where.records, self._facts),
        }
        """Ids of the matches whose records are not complete here yet."""
        self._wrong_contest: str | None = None
        """Hash of the office's contest file if it can't be used here; it is not fetched again."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._store.__exit__()
        self._applications.__exit__()

    def step(self) -> CopyState:
        """Copy all that has changed at the office; return how much the copy has now.

        Raises:
            NotThere: if the office does not answer. What was copied before stays; call this again.
            CopyingEnded: if this machine takes over as the office.
            UserError: if the office has another token than this machine, or other facts than those
                copied so far, or if something can't be read or written.
        """
        for _ in range(_TRIES):
            with suppress(_Changed):
                return self._step()
        raise UserError(say("standby.changes"))

    def _step(self) -> CopyState:
        self._ask_ended()
        at_ms = time.time_ns() // 1_000_000
        there = self._ask_step()
        self._mark()
        facts = _following(self._facts, there.facts)
        self._copy_entries(entries_of(facts))
        self._copy_files(there)
        self._copy_records(there, facts)
        if facts:
            self._store.copy(facts, there.facts)
            self._facts = (*self._facts, *facts)
            self._generation = generation(self._facts)
        self._copy_applications(there)
        found = self._ask_ended()
        if not there.has_more:
            found = msgspec.structs.replace(found, copied_ms=at_ms)
            machine.save(self._where.machine, found)
        names = {fact.record for fact in self._facts if isinstance(fact, Played) and fact.record}
        whole = sum(name.removesuffix(".mcap") not in self._open for name in names)
        return CopyState(found.copied_ms, len(self._facts), whole, len(self._open))

    def _mark(self) -> None:
        """Note in this folder that it is a copy; this is done before anything is copied into it."""
        found = self._ask_ended()
        if (found.role, found.office) != ("copy", self._other.address):
            machine.save(self._where.machine, Machine(role="copy", office=self._other.address))

    def _ask_ended(self) -> Machine:
        found = machine.read(self._where.machine)
        if found.ends:
            raise CopyingEnded
        return found

    def _ask_step(self) -> There:
        last = self._store.bodies(max(0, len(self._facts) - 1), 0)
        step = StepAsk(
            generation=self._generation,
            address=self._address,
            facts=len(self._facts),
            last=hash_of(last[0].encode()) if last else "",
            applications=version_of(self._applications.waiting),
        )
        try:
            return self._other.ask(step, There)
        except LacksIt as error:
            raise UserError(error.why) from None

    def _copy_entries(self, wanted: Collection[str]) -> None:
        for one in sorted(wanted):
            if not (self._where.entries.path / one).exists():
                entry = codec.decode(self._fetch("entry", one), ContestEntry, _ENTRY_MAX_BYTES)
                if entry.hash != one:
                    raise UserError(say("contest.entry-changed", folder=one))
                self._where.entries.save(entry)

    def _copy_files(self, there: There) -> None:
        paths = small_files(self._where)
        here = hashes(paths)
        for name, path in paths.items():
            wanted = there.files.get(name, "")
            if wanted in (here.get(name, ""), self._wrong_contest):
                continue
            if not wanted:
                if name not in _STAY:
                    path.unlink(missing_ok=True)
                continue
            data = self._fetch("file", name)
            if hash_of(data) != wanted:
                raise _Changed
            if name == "contest" and not self._can_use(data):
                self._wrong_contest = wanted
                continue
            with _for_its_owner(path):
                write(path, data)
            if name == "contest":
                self._where = ContestFolder(self._where.file)

    def _can_use(self, data: bytes) -> bool:
        """Return whether a contest file can be used on this machine; if not, tell why."""
        path = self._where.file
        try:
            found = contests.loads(data, path)
            plans(found, path)
            open_stage(found, path)
        except UserError as error:
            self._tell(say("standby.bad-contest", why=error.phrase))
            return False
        return True

    def _copy_records(self, there: There, facts: Sequence[AnyFact]) -> None:
        records = self._where.records
        self._open.update(there.records, _missing(records, facts))
        for match_id in sorted(self._open):
            while True:
                self._ask_ended()
                asked = RecordAsk(
                    generation=self._generation, match_id=match_id, have=have(records, match_id)
                )
                try:
                    part = self._other.ask(asked, Got).part
                except LacksIt:  # it is packed just now
                    raise _Changed from None
                taken = take(records, match_id, part)
                if taken is Taken.WHOLE:
                    self._open.discard(match_id)
                if taken is not Taken.MORE:
                    break

    def _copy_applications(self, there: There) -> None:
        if there.waiting is None:
            return
        here = self._applications.waiting
        if gone := here.keys() - there.waiting.keys():
            self._applications.drop(*gone)
        for team, at_ms in there.waiting.items():
            if team in here and here[team].at_ms == at_ms:
                continue
            data = self._fetch("application", team)
            handed_ms, entry = codec.decode(data, tuple[int, ContestEntry], _ENTRY_MAX_BYTES)
            self._applications.put(team, entry, handed_ms)

    def _fetch(self, kind: Kind, name: str) -> bytes:
        data = b""
        while True:
            self._ask_ended()
            asked = PartAsk(generation=self._generation, kind=kind, name=name, offset=len(data))
            try:
                part = self._other.ask(asked, Got).part
            except LacksIt:
                raise _Changed from None
            data += part.data
            if part.is_whole:
                return data


def _following(known: Sequence[AnyFact], bodies: Sequence[str]) -> tuple[AnyFact, ...]:
    """Decode the stored texts of facts, which must follow the known facts.

    Raises:
        UserError: if a text is no fact, or a number does not follow the one before.
    """
    try:
        facts = tuple(msgspec.json.decode(body, type=AnyFact) for body in bodies)
    except msgspec.MsgspecError as error:
        raise UserError(say("league.wrong-facts", error=str(error))) from None
    first = known[-1].number + 1 if known else 1
    if [fact.number for fact in facts] != [*range(first, first + len(facts))]:
        raise UserError(say("standby.other-facts"))
    return facts


def _missing(records: Path, facts: Sequence[AnyFact]) -> Iterator[str]:
    """Yield the ids of the matches that have a result, but no complete record in this folder."""
    for fact in facts:
        if isinstance(fact, Played) and fact.record:
            match_id = fact.record.removesuffix(".mcap")
            if not packed_path(records, match_id).exists():
                yield match_id


@contextmanager
def _for_its_owner(path: Path) -> Iterator[None]:
    """In the block, create new files so that only their owner can read them.

    Raises:
        UserError: if the file at `path` can't be written in the block.
    """
    before = os.umask(0o077)
    try:
        yield
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(path), why=why)) from None
    finally:
        os.umask(before)
