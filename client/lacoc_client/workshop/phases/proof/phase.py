"""A phase of the workshop: its task, the work that it asks for, and its question.

A phase begins when the student goes to it. It is done when its work is done and its question is
answered right. After a wrong answer a little more work leads to another question.
"""

from bisect import bisect_left
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from lacoc_client.workshop.phases.evidence import Answered, Evidence, TookStep, WentToPhase
from lacoc_client.workshop.phases.predicates import MET, Outcome
from lacoc_client.workshop.phases.proof.questions import PhaseQuestion
from lacoc_client.workshop.phases.proof.work import Work
from lacoc_shared.words import Phrase, say

_LESSON, _FIRST = 0, 1
"""Number of the lesson, and of the phase in which a student begins."""
_WORK_SHARE, _ASKED_SHARE = 0.8, 0.9
"""Share of a phase that is done when its work is done, and when its question has been asked."""


@dataclass(frozen=True)
class WorkshopPhase:
    """A phase: one of the steps of the workshop."""

    number: int
    """Number of the phase, from 0 to 6."""
    title: Phrase
    task: Phrase
    question: Phrase
    """A question to think about before the task; it needs no answer."""
    hint: Phrase
    explanation: Phrase
    """The explanation that a student should understand after the task."""
    work: Work
    asks: Callable[[Sequence[Evidence], int], PhaseQuestion]
    """Makes the question that the student must answer. It takes the evidence with which the work
    was done, and how many questions of the phase were answered wrong."""

    def look(self, evidence: Sequence[Evidence]) -> tuple[Outcome, PhaseQuestion | None]:
        """Return how far a student is in this phase, and the question that the student must answer.

        The question is None if the student need not answer one now.

        Args:
            evidence: all evidence of the student, in order.
        """
        start, wrong = self._begins(evidence), 0
        if start is None:
            return Outcome(0.0, (say("phases.go-to", number=self.number),)), None
        for at in range(start, len(evidence)):
            one = evidence[at]
            if not isinstance(one, Answered) or one.phase != self.number:
                continue
            if self.work.look(evidence[:at], start, wrong > 0).met:  # else nothing was asked
                if one.right:
                    return MET, None
                start, wrong = at + 1, wrong + 1
        work = self.work.look(evidence, start, wrong > 0)
        if not work.met:
            share = _ASKED_SHARE if wrong else _WORK_SHARE * work.share
            return Outcome(share, work.missing), None
        question = self.asks(evidence[: self._done(evidence, start, wrong > 0)], wrong)
        return Outcome(_ASKED_SHARE, (say("phases.answer"),)), question

    def may_change(self, known: PhaseQuestion | None, new: Sequence[Evidence]) -> bool:
        """Return whether new evidence may change how far the student is in this phase.

        Args:
            known: the question that `look` has returned; None: none.
            new: the new evidence.
        """
        if known is not None:
            return any(isinstance(one, Answered) and one.phase == self.number for one in new)
        return any(
            one.phase == self.number
            if isinstance(one, WentToPhase | Answered)
            else isinstance(one, self.work.kinds)
            for one in new
        )

    def _begins(self, evidence: Sequence[Evidence]) -> int | None:
        """Return the index of the first evidence that belongs to the phase.

        None: the student has not begun this phase.
        """
        if self.number == _FIRST:
            return 0
        for at, one in enumerate(evidence):
            if isinstance(one, WentToPhase) and one.phase == self.number:
                return at + 1
            if self.number == _LESSON and isinstance(one, TookStep):
                return at
        return None

    def _done(self, evidence: Sequence[Evidence], start: int, again: bool) -> int:
        """Return after how many pieces of all evidence the work of this phase was done.

        May be called only when the work is done.
        """
        # Work that is done stays done, so bisection finds when that was.
        counts = range(start, len(evidence) + 1)
        return start + bisect_left(
            counts, True, key=lambda count: self.work.look(evidence[:count], start, again).met
        )
