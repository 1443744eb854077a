"""What a student has done in a folder, kept there while it happens."""

import asyncio
import time
from collections.abc import Awaitable
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from lacoc_client.phases.evidence import Evidence, Named, Voted
from lacoc_client.phases.phases import PHASES
from lacoc_client.phases.progress import State, progress
from lacoc_client.phases.store import ClassStore
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase

FILE = "lacoc-evidence.sqlite"
"""Name of the file in the folder."""

_ALONE = ""
"""Name of the student who designs alone."""

_T = TypeVar("_T")


class PhaseState(msgspec.Struct, frozen=True, kw_only=True):
    """A phase as a page shows it."""

    number: int
    """From 1 to 6."""
    state: State
    share: float
    """How much of the task is done, from 0 to 1."""
    title: Phrase
    task: Phrase
    question: Phrase
    hint: Phrase
    explanation: Phrase
    missing: tuple[Phrase, ...]
    """What is still missing, the most useful first."""


class Phases(msgspec.Struct, frozen=True, kw_only=True):
    """How far the student of a folder is."""

    phase: int
    """Number of the phase that the student is at."""
    word: str
    """The word that the robot shall walk like; "": none yet."""
    trouble: Phrase | None
    """Why progress is not kept, or what happened to its file; None: all is well."""
    phases: tuple[PhaseState, ...]


class Diary:
    """The evidence of a folder; used from the event loop only.

    The file is made with the first evidence. Where it can't be written, evidence lasts as long as
    the program, and `trouble` says why.

    Args:
        folder: the folder.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / FILE
        self._store: ClassStore | None = None
        self._refused: Phrase | None = None
        self._evidence: list[Evidence] = []
        self._lock = asyncio.Lock()

    async def read(self) -> None:
        """Read what was kept before."""
        if await asyncio.to_thread(self._path.exists):
            await self._opened()

    async def add(self, *evidence: Evidence) -> None:
        """Keep evidence; it is on the disk when this returns, unless there is trouble."""
        self._evidence += evidence
        store = await self._opened() if evidence else None
        if store is not None:
            now_s = time.time()
            done = [asyncio.wrap_future(store.add(_ALONE, one, now_s)) for one in evidence]
            await self._kept(asyncio.gather(*done))

    async def vote(self, poll: str, choice: str) -> None:
        """Keep a vote; for a poll in which the student has voted before, nothing is kept."""
        if Voted(poll=poll) in self._evidence:
            return
        store = await self._opened()
        self._evidence.append(Voted(poll=poll))
        if store is not None:
            vote = store.vote(_ALONE, poll, choice, time.time())
            await self._kept(asyncio.wrap_future(vote))

    async def close(self) -> None:
        """Close the file."""
        if self._store is not None:
            await asyncio.to_thread(self._store.close)

    @property
    def phases(self) -> Phases:
        """How far the student is."""
        now = progress(self._evidence)
        words = [one.word for one in self._evidence if isinstance(one, Named)]
        return Phases(
            phase=now.phase,
            word=words[-1] if words else "",
            trouble=self._store.trouble if self._store is not None else self._refused,
            phases=tuple(
                PhaseState(
                    number=phase.number,
                    state=state,
                    share=outcome.share,
                    title=phase.title,
                    task=phase.task,
                    question=phase.question,
                    hint=phase.hint,
                    explanation=phase.explanation,
                    missing=outcome.missing,
                )
                for phase, state, outcome in zip(PHASES, now.states, now.outcomes, strict=True)
            ),
        )

    async def _opened(self) -> ClassStore | None:
        """Return the file, after it was opened; None if it can't be."""
        async with self._lock:
            if self._store is None and self._refused is None:
                try:
                    self._store = await asyncio.to_thread(ClassStore, self._path)
                    kept = await asyncio.wrap_future(self._store.evidence(_ALONE))
                except UserError as error:
                    self._refused = error.phrase
                else:
                    before = [one.evidence for one in kept]
                    self._evidence = before + self._evidence
        return self._store

    async def _kept(self, work: Awaitable[_T]) -> Any:
        try:
            await work
        except UserError:
            return  # `trouble` has the reason
