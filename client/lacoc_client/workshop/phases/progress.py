"""How far a student is in the phases."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from lacoc_client.workshop.phases.evidence import (
    Coached,
    Evidence,
    Hand,
    TookStep,
    WentToPhase,
)
from lacoc_client.workshop.phases.phases import PHASES
from lacoc_client.workshop.phases.predicates import Outcome
from lacoc_client.workshop.phases.proof.phase import WorkshopPhase
from lacoc_client.workshop.phases.proof.questions import PhaseQuestion

State = Literal["open", "met", "skipped"]
"""State of a phase. It is "skipped" if the student went on without doing its task; the student can
come back at any time. It is "met" as soon as the evidence shows that its task is done."""


@dataclass(frozen=True)
class StudentProgress:
    """How far a student is in the phases."""

    phase: int
    """Number of the student's present phase."""
    states: tuple[State, ...]
    """State of each phase, from phase 0."""
    outcomes: tuple[Outcome, ...]
    """For each phase, the share of it that is done and what is missing."""
    questions: tuple[PhaseQuestion | None, ...]
    """For each phase, the question that the student must answer now; None: there is no such
    question."""
    hand_up: bool
    """Whether the student asks for help now."""
    coached: bool
    """Whether the student has ever taken over changes that the coach found."""
    lesson_step: int
    """The step of the lesson of one leg at which the student was last; 0: none yet."""
    seen: int
    """Number of pieces of evidence from which this progress was computed."""


def progress(
    evidence: Sequence[Evidence], before: StudentProgress | None = None
) -> StudentProgress:
    """Compute how far a student is.

    Args:
        evidence: all evidence of the student, in order.
        before: the result for an earlier part of the same evidence. Tasks that were met then are
            not computed again, because a task that was met stays met.
    """
    visited = [one.phase for one in evidence if isinstance(one, WentToPhase)]
    visited = [number for number in visited if 0 <= number < len(PHASES)]
    steps = [one.step for one in evidence if isinstance(one, TookStep)]
    hands = [one.up for one in evidence if isinstance(one, Hand)]
    new = evidence[before.seen :] if before is not None else evidence
    found = [
        phase.look(evidence)
        if before is None or _may_change(phase, before, new)
        else (before.outcomes[phase.number], before.questions[phase.number])
        for phase in PHASES
    ]
    outcomes = tuple(outcome for outcome, _ in found)
    nearest, farthest = min(visited, default=1), max(visited, default=1)
    return StudentProgress(
        phase=visited[-1] if visited else 1,
        states=tuple(
            _state(outcome, min(1, nearest) <= number < farthest)
            for number, outcome in enumerate(outcomes)
        ),
        outcomes=outcomes,
        questions=tuple(question for _, question in found),
        hand_up=bool(hands) and hands[-1],
        lesson_step=steps[-1] if steps else 0,
        coached=any(isinstance(one, Coached) for one in evidence),
        seen=len(evidence),
    )


def _may_change(phase: WorkshopPhase, before: StudentProgress, new: Sequence[Evidence]) -> bool:
    """Return whether new evidence may change how much of a phase is done.

    Most evidence can't, and then nothing is computed again.
    """
    is_met = before.outcomes[phase.number].met  # then it stays met
    return not is_met and phase.may_change(before.questions[phase.number], new)


def _state(outcome: Outcome, is_behind: bool) -> State:
    if outcome.met:
        return "met"
    return "skipped" if is_behind else "open"
