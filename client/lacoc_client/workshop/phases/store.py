"""Keeps the evidence and documents of a class on disk; `class_file` reads and writes the file."""

import sqlite3
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, Generic, TypeVar

from lacoc_client.workshop.phases.class_file import ClassFile, Document, Kept, set_aside
from lacoc_client.workshop.phases.evidence import Evidence
from lacoc_shared.command.database import Damaged
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import Phrase, say

DOCUMENT_S = 1.0
"""Longest time that a new document waits before it is written [s]."""

_T = TypeVar("_T")


class _StoreJob(Generic[_T]):
    """A job for the store's thread.

    Args:
        work: what the job does.
        writes: whether it writes to the file.
        adds: the student for whom it adds to the file; None: it adds nothing.
    """

    def __init__(
        self, work: Callable[[ClassFile], _T], writes: bool = False, adds: str | None = None
    ) -> None:
        self.work = work
        self.writes = writes
        self.adds = adds
        self.done: Future[_T] = Future()


class ClassStore:
    """The evidence and documents of a class, kept on disk; may be used from any thread.

    A thread of its own works on the file, so that no event loop waits for the disk. The methods
    that write, except `keep`, return futures, which are done when the data are on the disk (await
    one with `asyncio.wrap_future`). If the process is killed, evidence whose future is done is not
    lost. A document is lost only if it was newer than `DOCUMENT_S` plus the time of a write.

    A damaged file is renamed, and the class goes on in a fresh file. While the disk is full,
    futures fail with a `UserError`; evidence, votes and documents wait until there is room.

    Args:
        path: the file; it is made if there is none.

    Raises:
        UserError: if another program has the file open, if it is a database of something else, or
            if it can't be opened.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._damage: Phrase | None = None
        self._no_room: Phrase | None = None
        try:
            self._file = ClassFile(path)
        except Damaged:
            self._file = self._fresh()
        self._documents = {(one.student, one.name): one for one in self._file.documents()}
        self._waiting: set[tuple[str, str]] = set()
        """Student and name of each document that is not on the disk yet."""
        self._late: deque[_StoreJob[Any]] = deque()
        """The jobs whose evidence or vote waits, in order; for the store's own thread only."""
        self._jobs: SimpleQueue[_StoreJob[Any] | None] = SimpleQueue()
        self._closed = False
        self._lock = threading.Lock()
        """Guards `_documents`, `_waiting` and `_closed`."""
        self._thread = threading.Thread(target=self._run, name="class-store", daemon=True)
        self._thread.start()

    @property
    def trouble(self) -> Phrase | None:
        """A sentence that says what is wrong with the class file; None: nothing is wrong.

        It names a full disk until a write succeeds and no evidence waits, and a damaged file until
        the store is closed.
        """
        return self._no_room or self._damage

    def add(self, student: str, evidence: Evidence, at_s: float) -> "Future[int]":
        """Write evidence, together with the student's documents that are not on the disk yet.

        Args:
            student: name of the student.
            evidence: what the student did.
            at_s: time when the student did it, in seconds since 1970 (UTC).

        Returns:
            The number of the evidence in the class.
        """

        def work(file: ClassFile) -> int:
            documents = self._waiting_documents(student)
            number = file.add(student, evidence, at_s, documents)
            self._written(documents)
            return number

        return self._do(_StoreJob(work, writes=True, adds=student))

    def vote(self, student: str, poll: str, choice: str, at_s: float) -> "Future[bool]":
        """Count a vote in a poll; the result is False if the student has voted in it before."""
        job = _StoreJob(
            lambda file: file.vote(student, poll, choice, at_s), writes=True, adds=student
        )
        return self._do(job)

    def votes(self, poll: str) -> "Future[dict[str, int]]":
        """Read how many votes each choice of a poll has."""
        return self._do(_StoreJob(lambda file: file.votes(poll)))

    def evidence(self, student: str | None = None, after: int = 0) -> "Future[list[Kept]]":
        """Read evidence of a student, or of all (None), whose number is larger than `after`."""
        return self._do(_StoreJob(lambda file: file.evidence(student, after)))

    def keep(self, document: Document) -> None:
        """Take the newest content of a document; it is written to the disk within `DOCUMENT_S`.

        Raises:
            UserError: if the store is closed.
            ValueError: if a name can't be encoded as UTF-8.
        """
        # One name that can't be encoded would stop all documents.
        f"{document.student}{document.name}{document.version}".encode()
        with self._lock:
            if self._closed:
                raise UserError(say("class.closed"))
            self._documents[document.student, document.name] = document
            self._waiting.add((document.student, document.name))

    def write(self, document: Document) -> "Future[None]":
        """Take the newest content of a document, and write it to the disk at once.

        It raises the same errors as `keep`.
        """
        self.keep(document)  # so that it is written later if the disk is full now
        return self._do(_StoreJob(lambda file: file.write_documents([document]), writes=True))

    def forget(self, student: str) -> "Future[None]":
        """Delete everything that is kept of a student."""

        def work(file: ClassFile) -> None:
            file.forget(student)  # first: if this fails, everything is as before
            self._late = deque(job for job in self._late if job.adds != student)
            with self._lock:
                gone = [key for key in self._documents if key[0] == student]
                for key in gone:
                    del self._documents[key]
                    self._waiting.discard(key)

        return self._do(_StoreJob(work, writes=True))

    def documents(self, student: str | None = None) -> list[Document]:
        """Return the newest documents of a student or of all (None), sorted by student and name."""
        with self._lock:
            documents = sorted(self._documents.items())
        return [document for (who, _), document in documents if student in (None, who)]

    def close(self) -> None:
        """Write the documents that are not on the disk yet, and close the file."""
        with self._lock:
            if not self._closed:
                self._closed = True
                self._jobs.put(None)
        self._thread.join()

    def __enter__(self) -> "ClassStore":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def _do(self, job: _StoreJob[_T]) -> "Future[_T]":
        with self._lock:
            if self._closed:
                job.done.set_exception(UserError(say("class.closed")))
            else:
                self._jobs.put(job)
        return job.done

    # What follows runs in the store's own thread.

    def _run(self) -> None:
        next_s = time.monotonic() + DOCUMENT_S
        going_on = True
        while going_on:
            try:
                job = self._jobs.get(timeout=max(0.0, next_s - time.monotonic()))
            except Empty:
                pass
            else:
                if job is not None:
                    self._work(job)
                going_on = job is not None
            if not going_on or time.monotonic() >= next_s:
                self._write_waiting()
                next_s = time.monotonic() + DOCUMENT_S
        self._file.close()

    def _work(self, job: _StoreJob[Any]) -> None:
        if not job.done.set_running_or_notify_cancel():
            return  # whoever asked has gone
        try:
            try:
                result = self._once(job)
            except Damaged:
                self._file.close()
                self._file = self._fresh()
                with self._lock:
                    self._waiting |= self._documents.keys()
                result = self._once(job)
        except Exception as error:
            if job.writes and isinstance(error, UserError):
                self._no_room = error.phrase
                if job.adds is not None:
                    self._late.append(job)
            job.done.set_exception(error)
        else:
            if job.writes and not self._late:
                self._no_room = None
            job.done.set_result(result)

    def _once(self, job: _StoreJob[_T]) -> _T:
        try:
            if job.adds is not None:
                self._add_late()
            return job.work(self._file)
        except sqlite3.Error as error:
            raise self._file.problem(error) from error

    def _add_late(self) -> None:
        """Do the jobs that failed before, each in its turn, so that evidence stays in order."""
        while self._late:
            self._late[0].work(self._file)
            self._late.popleft()

    def _write_waiting(self) -> None:
        documents = self._waiting_documents()
        if not documents and not self._late:
            return

        def work(file: ClassFile) -> None:
            self._add_late()
            file.write_documents(documents)

        job = _StoreJob(work, writes=True)
        self._work(job)
        if job.done.exception() is None:  # else `trouble` says why, and the documents go on waiting
            self._written(documents)

    def _waiting_documents(self, student: str | None = None) -> list[Document]:
        """Return the documents of a student, or of all (None), that are not on the disk yet."""
        with self._lock:
            return [
                self._documents[key] for key in sorted(self._waiting) if student in (None, key[0])
            ]

    def _written(self, documents: Iterable[Document]) -> None:
        """Note that documents are on the disk.

        A document that has got newer content meanwhile still waits.
        """
        with self._lock:
            for document in documents:
                key = document.student, document.name
                if self._documents.get(key) is document:
                    self._waiting.discard(key)

    def _fresh(self) -> ClassFile:
        """Rename the damaged file, and make a fresh one."""
        kept = set_aside(self._path)
        file, kept_name = text_of(self._path.name), text_of(kept.name)
        self._damage = say("class.damaged", file=file, kept=kept_name)
        return ClassFile(self._path)
