"""The card of a student for the teacher: the phase, the robot's speed, whether help is needed."""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, Literal

import msgspec
import numpy as np
import numpy.typing as npt

from lacoc_client.workshop.phases.evidence import Evidence, Hand, Tried
from lacoc_client.workshop.phases.facts import STRAIGHT_DEG_S, TrialFacts
from lacoc_client.workshop.phases.progress import State, StudentProgress
from lacoc_client.workshop.phases.proof.numbers import own_trials
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.studio import TrialReply
from lacoc_shared.words import Phrase, say

Need = Literal["hand", "stuck", "quiet", ""]
"""Why a student needs help: the hand is up, several trials failed in the same way, or the student
has done nothing for long. "": no help is needed."""

QUIET_S = 300.0
"""A student who has a page open and does nothing for this time counts as quiet [s]."""
_EQUAL_FAILURES = 3
_LEANS, _BELLY, _SLOW_MM_S, _STANDS_S = 0.8, 0.05, 15.0, 2.0
_FORWARD = "B2"


class Card(msgspec.Struct, frozen=True, kw_only=True):
    """A student at a glance, for the teacher's page."""

    name: str
    online: bool
    seen_s: float
    """Time when the student last did something or opened a page, in seconds since 1970 (UTC)."""
    phase: int
    states: tuple[State, ...]
    """State of each phase, from phase 0."""
    lesson_step: int
    """The step of the lesson of one leg at which the student was last; 0: none yet."""
    in_lesson: bool
    """Whether the student has a page of the lesson open."""
    share: float
    """How much of the student's present phase is done, from 0 to 1."""
    missing: Phrase | None
    """The first thing that the student must still do in this phase; None: nothing."""
    tries: int
    best_mm_s: float | None
    """Highest forward speed of a trial with numbers of the student's own, and of no others, whose
    last key, which is measured, was B2, and in which the robot stayed upright and off the floor
    [mm/s]; None: there was no such trial."""
    last_mm_s: float | None
    """Forward speed of the last trial [mm/s]; None: there was no trial."""
    legs: tuple[str, ...]
    """Labels of the legs, in the order of `feet`."""
    feet: tuple[tuple[tuple[float, float], ...], ...] | None
    """For each leg the times in which its foot was down in the last trial, each as begin and end,
    in shares of the measured time; None: there was no trial since the class was opened."""
    said: Phrase | None
    """First sentence of the explanation of the last trial; None: there was none since the class
    was opened."""
    hand_up_s: float | None
    """Time at which the hand went up, in seconds since 1970 (UTC); None: it is not up."""
    stuck: Phrase | None
    """What went wrong, if the last three trials failed in the same way; else None."""
    coached: bool
    """Whether the student has taken over a gait that the coach found."""
    need: Need


class SeenStudent(msgspec.Struct, frozen=True, kw_only=True):
    """What is known of a student, for the card, besides the evidence."""

    name: str
    online: bool = False
    in_lesson: bool = False
    seen_s: float = 0.0
    hand_up_s: float | None = None
    trial: TrialReply | None = None
    """The last trial since the class was opened."""
    best_mm_s: float | None = None
    """What `best_speed` finds in the evidence; it changes only with a trial."""


def best_speed(evidence: Sequence[Evidence]) -> float | None:
    """Return the highest speed of a walk with numbers of the student's own; see `Card.best_mm_s`.

    Args:
        evidence: all evidence of the student, in order.
    """
    own = (one.tried.facts for one in own_trials(evidence, 0) if one.is_own)
    speeds = [facts.speed_mm_s for facts in own if facts.keys[-1] == _FORWARD and _walks(facts)]
    return max(speeds, default=None)


def card(
    seen: SeenStudent, evidence: Sequence[Evidence], progress: StudentProgress, now_s: float
) -> Card:
    """Make a student's card.

    Args:
        seen: the facts about the student besides the evidence.
        evidence: all evidence of the student, in order.
        progress: how far the student is.
        now_s: time in seconds since 1970 (UTC).
    """
    tries = [one.facts for one in evidence if isinstance(one, Tried)]
    outcome = progress.outcomes[progress.phase]
    failed = stuck(tries)
    hand_up_s = (seen.hand_up_s or seen.seen_s) if progress.hand_up else None
    need: Need = ""
    if progress.hand_up:
        need = "hand"
    elif failed is not None:
        need = "stuck"
    elif seen.online and now_s - seen.seen_s > QUIET_S:
        need = "quiet"
    trial = seen.trial
    feet = None if trial is None else foot_runs(trial)
    return Card(
        name=seen.name,
        online=seen.online,
        seen_s=seen.seen_s,
        phase=progress.phase,
        states=progress.states,
        lesson_step=progress.lesson_step,
        in_lesson=seen.in_lesson,
        share=outcome.share,
        missing=next(iter(outcome.missing), None),
        tries=len(tries),
        best_mm_s=seen.best_mm_s,
        last_mm_s=tries[-1].speed_mm_s if tries else None,
        legs=leg_labels(len(feet or ())),
        feet=feet,
        said=trial.explained[0].said if trial is not None and trial.explained else None,
        hand_up_s=hand_up_s,
        stuck=failed,
        coached=progress.coached,
        need=need,
    )


def hand_times(kept: Iterable[tuple[float, Evidence]]) -> float | None:
    """Return when the student raised the hand that is up now [s]; None: the hand is not up.

    Args:
        kept: evidence of one student, each with its time [s], in order.
    """
    hands = [(at_s, one.up) for at_s, one in kept if isinstance(one, Hand)]
    return hands[-1][0] if hands and hands[-1][1] else None


def stuck(tries: Sequence[TrialFacts]) -> Phrase | None:
    """Return what went wrong, if the last three trials failed in the same way; else None."""
    last = [failure(facts) for facts in tries[-_EQUAL_FAILURES:]]
    if len(last) < _EQUAL_FAILURES or any(one != last[0] for one in last):
        return None
    return last[0]


def failure(facts: TrialFacts) -> Phrase | None:
    """Return the worst thing that went wrong in a trial; None: nothing went wrong."""
    if facts.stopped:
        return say("class.failed-stopped")
    if facts.upright < _LEANS:
        return say("class.failed-fell")
    if facts.belly_share > _BELLY:
        return say("class.failed-belly")
    if facts.keys[-1].startswith("A"):
        stands = facts.tripod_s >= _STANDS_S or len(facts.keys) > 1
        return None if stands else say("class.failed-stand")
    if facts.keys[-1] != _FORWARD:
        return None
    if abs(facts.drift_deg_s) > STRAIGHT_DEG_S:
        return say("class.failed-turns")
    return say("class.failed-slow") if facts.speed_mm_s < _SLOW_MM_S else None


def foot_runs(trial: TrialReply) -> tuple[tuple[tuple[float, float], ...], ...]:
    """Return for each leg the times in which its foot was down, each as begin and end.

    Begin and end are shares of the measured time, from 0 to 1.
    """
    legs = len(trial.figures["duty"])
    down = np.frombuffer(trial.down, np.uint8)[trial.first : trial.end]
    return tuple(_runs((down >> leg) & 1) for leg in range(legs))


def _runs(down: npt.NDArray[Any]) -> tuple[tuple[float, float], ...]:
    ends = np.flatnonzero(np.diff(down, prepend=2, append=2))
    runs = ((int(begin), int(end)) for begin, end in pairwise(ends) if down[begin])
    return tuple((round(begin / len(down), 3), round(end / len(down), 3)) for begin, end in runs)


def _walks(facts: TrialFacts) -> bool:
    return not facts.stopped and facts.upright >= _LEANS and facts.belly_share <= _BELLY
