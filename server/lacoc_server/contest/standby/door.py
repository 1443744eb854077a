"""Gives the machine that copies the office what it lacks: facts, entries, records, small files.

The messages between the two machines are encrypted.
"""

import hashlib
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Self

from lacoc_server.contest.kept.applications import Application, Applications
from lacoc_server.contest.kept.folder import ContestFolder, hash_of
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.standby.messages import (
    AnyAnswer,
    AnyAsk,
    Got,
    Lacks,
    OfficeThere,
    PartAsk,
    RecordAsk,
    StepAsk,
    There,
)
from lacoc_server.contest.standby.sealing import REQUEST, BadSeal, Sealing
from lacoc_server.contest.standby.tenure import Tenure
from lacoc_server.court.copying import next_part
from lacoc_shared import codec
from lacoc_shared.codec import encode
from lacoc_shared.keyspace import COPY_PART_BYTES
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.office import Copied
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path, segment_name
from lacoc_shared.record.matches import MatchName
from lacoc_shared.words import Phrase, say

_FACTS_BYTES = 1 << 18
"""Most characters that the facts in one answer may have together."""
ASK_MAX_BYTES = 65_536
"""Longest encrypted request that is read [bytes]."""
_SILENT_S = 10.0
"""The organiser is told if the second machine has not asked for this long [s]."""


class StandbyDoor:
    """Answers the machine that copies the office; any thread may use it.

    Used as a context manager.

    Args:
        where: the contest.
        tenure: this machine's time as the office; it ends if a later office asks.
        applications: the entries that wait.
        sealing: decrypts requests and encrypts answers.

    Raises:
        UserError: if the facts can't be read.
    """

    def __init__(
        self, where: ContestFolder, tenure: Tenure, applications: Applications, sealing: Sealing
    ) -> None:
        self._where = where
        self._tenure = tenure
        self._applications = applications
        self._sealing = sealing
        self._store = FactStore(where.facts)
        self._one = threading.Lock()
        self._asked_s: float | None = None
        """Monotonic time of the last request for a step [s]; None: there was none."""
        self._address = ""
        self._is_told = False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._store.__exit__()

    def judge(self, payload: bytes) -> bytes | Refusal:
        """Answer an encrypted request; refuse it if the sender's token is not this machine's."""
        if len(payload) > ASK_MAX_BYTES:
            return Refusal(say("standby.not-proven"))
        try:
            opened = self._sealing.open(payload, REQUEST)
            request: AnyAsk = codec.decode(opened, AnyAsk, ASK_MAX_BYTES)  # type: ignore[arg-type]
        except (BadSeal, codec.BadMessage):
            return Refusal(say("standby.not-proven"))
        return self._sealing.seal(encode(self.answer(request)), payload)

    def answer(self, asked: AnyAsk) -> AnyAnswer:
        """Answer a decrypted request of another machine of the contest."""
        try:
            self._tenure.hear(asked.generation)
            with self._one:
                match asked:
                    case StepAsk():
                        return self._step(asked)
                    case PartAsk():
                        return self._part(asked)
                    case RecordAsk():
                        return self._record(asked)
        except UserError as error:
            return Lacks(why=error.phrase)
        return OfficeThere(generation=self._tenure.generation)

    def news(self) -> Iterator[Phrase]:
        """Yield news for the organiser: a second machine has begun to copy, or is silent."""
        if self._asked_s is None:
            return
        is_silent = time.monotonic() - self._asked_s > _SILENT_S
        if is_silent and self._is_told:
            yield say("standby.silent", at=self._address, seconds=_SILENT_S)
        elif not is_silent and not self._is_told:
            yield say("standby.copies", at=self._address)
        self._is_told = not is_silent

    def _step(self, asked: StepAsk) -> AnyAnswer:
        newest = self._store.facts()
        bodies = self._store.bodies(max(0, asked.facts - 1), _FACTS_BYTES)
        if asked.facts:
            if not bodies or hash_of(bodies[0].encode()) != asked.last:
                return Lacks(why=say("standby.other-facts"))
            del bodies[0]
        self._tenure.know(asked.address)
        self._address, self._asked_s = asked.address, time.monotonic()
        waiting = self._applications.waiting
        version = version_of(waiting)
        return There(
            facts=tuple(bodies),
            has_more=asked.facts + len(bodies) < len(newest),
            files=hashes(small_files(self._where)),
            applications=version,
            waiting=None
            if version == asked.applications
            else {name: one.at_ms for name, one in waiting.items()},
            records=with_segments(self._where.records),
        )

    def _part(self, asked: PartAsk) -> AnyAnswer:
        content = self._content(asked)
        if content is None:
            return Lacks(why=say("standby.not-here", name=asked.name[:80]))
        data = content[asked.offset : asked.offset + COPY_PART_BYTES]
        is_whole = asked.offset + len(data) >= len(content)
        part = Copied(file=asked.name, offset=asked.offset, data=data, is_whole=is_whole)
        return Got(part=part)

    def _content(self, asked: PartAsk) -> bytes | None:
        match asked.kind:
            case "entry":
                return encode(self._where.entries.load(asked.name))
            case "application":
                one = self._applications.waiting.get(asked.name)
                return None if one is None else encode((one.at_ms, one.entry))
            case "file":
                path = small_files(self._where).get(asked.name)
                return None if path is None else _read(path)

    def _record(self, asked: RecordAsk) -> AnyAnswer:
        if MatchName.parse(asked.match_id) is None:
            return Lacks(why=say("standby.not-here", name=asked.match_id[:80]))
        try:
            return Got(part=next_part(self._where.records, asked.match_id, asked.have))
        except OSError as error:  # it was packed just now, or the disk fails
            return Lacks(why=say("plain.text", text=error.strerror or str(error)))


def small_files(where: ContestFolder) -> dict[str, Path]:
    """Return the small files that are copied whole, by the names in `messages.FILES`."""
    return {
        "contest": where.file,
        "secrets": where.secrets,
        "code": where.event_code,
        "contacts": where.contacts,
        "stand-ins": where.stand_ins,
    }


def hashes(paths: Mapping[str, Path]) -> dict[str, str]:
    """Return the hashes of files, by name; files that do not exist are left out."""
    contents = {name: _read(path) for name, path in paths.items()}
    return {name: hash_of(data) for name, data in contents.items() if data is not None}


def version_of(waiting: Mapping[str, Application]) -> str:
    """Return a hash of the list of applications, which changes whenever the list does."""
    listed = sorted((name, one.at_ms) for name, one in waiting.items())
    return hashlib.blake2b(encode(listed), digest_size=16).hexdigest()


def with_segments(records: Path) -> tuple[str, ...]:
    """Return the ids of the matches whose records are still in segments, and not in one file.

    Args:
        records: folder of the records.
    """
    names = map(segment_name, records.glob("*.live.mcap"))
    ids = {name[0] for name in names if name is not None}
    return tuple(sorted(one for one in ids if not packed_path(records, one).exists()))


def _read(path: Path) -> bytes | None:
    """Read a small file; None if it does not exist.

    Raises:
        UserError: if it can't be read.
    """
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-read", path=str(path), why=why)) from None
