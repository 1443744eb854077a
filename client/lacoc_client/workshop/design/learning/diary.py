"""Keeps the evidence and the documents (table, tokens) of one student."""

import asyncio
import time
from collections.abc import Iterable
from typing import TypeVar

import msgspec

from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.rules import StudentRules
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.phases.evidence import Edited, Evidence, Named, TookStep, Voted
from lacoc_client.workshop.phases.phases import A_CYCLE, PHASES
from lacoc_client.workshop.phases.progress import State, StudentProgress, progress
from lacoc_client.workshop.phases.proof.questions import PhaseQuestion
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_shared.gait.tables import JOINTS_PER_LEG
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import Phrase, say

_READ_HZ, _READ_BURST = 3_000.0, 40_000
"""How many legs in all rows of tables are read for one student: in a second on average, and at
once. Each takes about 30 microseconds of the event loop. The largest shared table has 2,660."""
_KEPT_HZ, _KEPT_BURST = 40.0, 16_000
"""How many changed legs are kept as evidence of one student: in a second on average, and at once.
Each takes about 50 bytes. After a break a page may tell 200 edits of a whole table of postures."""
_REQUEST_COST = 10
"""Each request for evidence counts as so many changed legs."""

_T = TypeVar("_T")


class AskedQuestion(msgspec.Struct, frozen=True, kw_only=True):
    """A question as a page shows it."""

    name: str
    ask: Phrase
    choices: tuple[Phrase, ...]


class PhaseState(msgspec.Struct, frozen=True, kw_only=True):
    """A phase as a page shows it."""

    number: int
    """Number of the phase, from 0 to 6."""
    state: State
    share: float
    """Part of the task that is done, from 0 to 1."""
    title: Phrase
    task: Phrase
    question: Phrase
    hint: Phrase
    explanation: Phrase
    missing: tuple[Phrase, ...]
    """Sentences that say what is still missing, the most useful first."""
    asked: AskedQuestion | None
    """The question of the phase that the student must answer now; None: there is no such
    question."""


class Phases(msgspec.Struct, frozen=True, kw_only=True):
    """How far a student is in the phases, for the student's page."""

    phase: int
    """Number of the student's present phase, from 0 to 6."""
    word: str
    """The word that the student chose for how the robot should walk; "": no word yet."""
    hand_up: bool
    """Whether the student asks for help now."""
    trouble: Phrase | None
    """Why progress can't be kept, or that its file was damaged; None: all is well."""
    lesson_step: int
    """The step of the lesson of one leg at which the student was last; 0: none yet."""
    phases: tuple[PhaseState, ...]
    """All phases; each stands at the index that is its number."""
    rules: StudentRules


class Diary:
    """The evidence and documents of one student; used from the event loop only.

    If the file can't be opened, the evidence stays in memory until the program ends, and the
    keeper can say why.

    Args:
        keeper: keeps the file open.
        student: name of the student; "": a student who designs alone.
    """

    def __init__(self, keeper: Keeper, student: str = "") -> None:
        self._keeper = keeper
        self._student = student
        self._is_read = False
        self._evidence: list[Evidence] = []
        self._progress: StudentProgress | None = None
        self._reading = asyncio.Lock()
        self._is_forgotten = False
        self._readings = Allowance(_READ_HZ, _READ_BURST)
        self._keepings = Allowance(_KEPT_HZ, _KEPT_BURST)
        self.documents: tuple[Document, ...] = ()
        """The student's documents, as earlier runs of the program wrote them."""

    async def read(self) -> None:
        """Read the evidence and documents that earlier runs of the program kept, if any."""
        if await asyncio.to_thread(self._keeper.path.exists):
            await self._opened()

    def begin(self, evidence: Iterable[Evidence], documents: Iterable[Document]) -> None:
        """Take over the evidence and documents that the class file has of this student.

        Args:
            evidence: the student's evidence, in order.
            documents: the student's documents.
        """
        self._is_read = True
        self._evidence[:0] = evidence
        self._progress = None
        self.documents = tuple(documents)

    def spend_request(self) -> None:
        """Count a request of the student for evidence.

        Raises:
            UserError: if the student has made too much evidence lately.
        """
        _spend(self._keepings, _REQUEST_COST)

    def spend_table(self, table: FileTable) -> None:
        """Count a table that must be read for the student; raise an error as `spend_request`."""
        legs = (len(row.angles_deg) // JOINTS_PER_LEG for row in table.rows)
        _spend(self._readings, sum(max(1, one) for one in legs))

    def spend_edit(self, edit: Edited) -> None:
        """Count an edit that is to be kept; raise an error as `spend_request`."""
        _spend(self._keepings, len(edit.legs))

    async def add(self, *evidence: Evidence) -> None:
        """Add evidence.

        When this returns, the evidence is on the disk, or the student's pages can say why not.
        """
        if not evidence or self._is_forgotten:
            return
        self._evidence += evidence
        store = await self._opened()
        if store is not None and not self._is_forgotten:
            now_s = time.time()
            done = [asyncio.wrap_future(store.add(self._student, one, now_s)) for one in evidence]
            await _kept(asyncio.gather(*done))

    async def vote(self, poll: str, choice: str) -> None:
        """Count the student's vote whether A (the sample) or B (the own gait) fits a word better.

        Keep as evidence that the student voted. Do nothing if the student voted in this poll
        before. The name of a poll is its word.
        """
        if self._is_forgotten or Voted(poll=poll) in self._evidence:
            return
        self._evidence.append(Voted(poll=poll))
        store = await self._opened()
        if store is not None and not self._is_forgotten:
            vote = store.vote(self._student, poll, choice, time.time())
            await _kept(asyncio.wrap_future(vote))

    async def write(self, name: str, content: bytes, version: str = "") -> None:
        """Write a document of the student; if that fails, the student's pages can say why."""
        document = Document(self._student, name, version, time.time(), content)
        store = await self._opened()
        if store is not None and not self._is_forgotten:
            await _kept(asyncio.wrap_future(store.write(document)))

    async def forget(self) -> None:
        """Delete everything that is kept of the student, and keep nothing more from now on.

        Evidence of a trial that still runs, or of a page that is just being let in, is dropped.

        Raises:
            UserError: if the file can't be opened or written; then nothing is deleted.
        """
        store = await self._keeper.opened()
        if store is None:
            raise UserError(self._keeper.trouble or say("class.closed"))
        self._is_forgotten = True
        try:
            await asyncio.shield(asyncio.wrap_future(store.forget(self._student)))
        except UserError:
            self._is_forgotten = False
            raise

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        """All evidence of the student, in order."""
        return tuple(self._evidence)

    @property
    def progress(self) -> StudentProgress:
        """How far the student is in the six phases."""
        if self._progress is None or self._progress.seen != len(self._evidence):
            self._progress = progress(self._evidence, self._progress)
        return self._progress

    @property
    def lesson(self) -> tuple[TookStep, ...]:
        """The steps and answers of the student in the lesson of one leg, in order."""
        return tuple(one for one in self._evidence if isinstance(one, TookStep))

    @property
    def has_earned_sample(self) -> bool:
        """Whether the student has earned the sample gait: phase 4 is done."""
        return self.progress.outcomes[A_CYCLE.number].met

    @property
    def word(self) -> str:
        """The word that the student chose for how the robot should walk; "": none yet."""
        words = (one.word for one in reversed(self._evidence) if isinstance(one, Named))
        return next(words, "")

    def phases(self, rules: StudentRules) -> Phases:
        """Describe for a page how far the student is.

        Args:
            rules: the teacher's choices for the class.
        """
        now = self.progress
        return Phases(
            phase=now.phase,
            word=self.word,
            hand_up=now.hand_up,
            trouble=self._keeper.trouble,
            lesson_step=now.lesson_step,
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
                    asked=self._asked(phase.number),
                )
                for phase, state, outcome in zip(PHASES, now.states, now.outcomes, strict=True)
            ),
            rules=rules,
        )

    def question(self, phase: int) -> PhaseQuestion | None:
        """Return the question of a phase that the student must answer now; None: there is none."""
        return self.progress.questions[phase]

    def _asked(self, phase: int) -> AskedQuestion | None:
        found = self.question(phase)
        if found is None:
            return None
        return AskedQuestion(name=found.name, ask=found.ask, choices=found.choices)

    async def _opened(self) -> ClassStore | None:
        """Open the file and read this student's evidence; None if it can't be opened."""
        store = await self._keeper.opened()
        async with self._reading:
            if store is not None and not self._is_read:
                self._is_read = True
                try:
                    kept = await asyncio.wrap_future(store.evidence(self._student))
                except UserError:
                    return store  # `Keeper.trouble` says why
                self.begin((one.evidence for one in kept), store.documents(self._student))
        return store


def _spend(allowance: Allowance, cost: int) -> None:
    if not allowance.take_all(cost, time.monotonic()):
        raise UserError(say("gateway.too-much"))


async def _kept(work: asyncio.Future[_T]) -> None:
    try:
        # Whoever asked may go before it is written. It counts already, so it must be kept.
        await asyncio.shield(work)
    except UserError:
        return  # `Keeper.trouble` says why
