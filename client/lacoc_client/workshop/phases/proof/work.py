"""The work that a phase asks for before its question."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

from lacoc_client.workshop.phases.conditions import foot_guess
from lacoc_client.workshop.phases.evidence import (
    LESSON_STEPS,
    CheckedGait,
    Compared,
    Edited,
    Evidence,
    Guessed,
    Named,
    TookStep,
    Tried,
    Voted,
)
from lacoc_client.workshop.phases.predicates import (
    All,
    Bound,
    LastOf,
    Outcome,
    Predicate,
    counted,
    every,
)
from lacoc_client.workshop.phases.proof.numbers import (
    NUMBER_DEG,
    OwnTrial,
    foot_guesses,
    leg_numbers,
    own_trials,
)
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.tables import LEVEL_NAMES
from lacoc_shared.words import Phrase, say

_TRY = say("phases.try")


class Work(Protocol):
    """The work that a student must do before the question of a phase is asked."""

    @property
    def kinds(self) -> tuple[type, ...]:
        """The kinds of evidence that may change how much of the work is done."""

    def look(self, evidence: Sequence[Evidence], start: int, again: bool) -> Outcome:
        """Return how much of the work is done. More evidence never makes it less.

        Args:
            evidence: all evidence of a student, in order.
            start: index of the first evidence that belongs to the phase, or, with `again`, that
                came after the wrong answer.
            again: whether a question of the phase was answered wrong, so that a little new work is
                enough.
        """


class LessonWork:
    """Work: answer each question of the lesson of one leg, for one robot, and reach its end."""

    kinds = (TookStep,)

    def look(self, evidence: Sequence[Evidence], start: int, again: bool) -> Outcome:
        """Count the steps of the lesson that the student has done.

        After a wrong answer to the phase's question one new answer in the lesson is enough.
        """
        if again:
            new = sum(isinstance(one, TookStep) and one.question >= 0 for one in evidence[start:])
            return counted(min(new, 1), 1, lambda left: say("phases.step-again"))
        done = len(lesson_steps(evidence))
        return counted(done, LESSON_STEPS, lambda left: say("phases.more-steps", left=left))


def lesson_steps(evidence: Sequence[Evidence]) -> set[int]:
    """Return which steps of the lesson are done, for the robot for which most steps are done."""
    answers: dict[str, dict[int, set[int]]] = {}
    done: dict[str, set[int]] = {}
    for one in evidence:
        if not isinstance(one, TookStep) or not 1 <= one.step <= LESSON_STEPS:
            continue
        answered = answers.setdefault(one.robot, {}).setdefault(one.step, set())
        if one.question >= 0:
            answered.add(one.question)
        if one.step == LESSON_STEPS or (one.of and len(answered) >= one.of):
            done.setdefault(one.robot, set()).add(one.step)
    return max(done.values(), key=len, default=set())


@dataclass(frozen=True)
class LegWork:
    """Work: turn the joints of a leg into several postures, and guess where its foot goes."""

    joints: int
    postures: int
    guesses: int
    right: int
    """How many of `guesses` guesses in a row must have been right."""
    kinds: ClassVar = (Edited, Guessed)

    def look(self, evidence: Sequence[Evidence], start: int, again: bool) -> Outcome:
        """Count the joints turned, the postures typed and the right guesses in a row.

        After a wrong answer to the phase's question one new right guess is enough.
        """
        guesses = foot_guesses(evidence, start)
        if again:
            one_more = LastOf(foot_guess, 1, 1, lambda left: say("phases.guess-again"))
            return one_more.look(guesses)
        right = LastOf(foot_guess, self.right, self.guesses, _more_right)
        legs = leg_numbers(evidence)
        return every(
            [
                counted(
                    max((leg.joints for leg in legs), default=0),
                    self.joints,
                    lambda left: say("phases.more-joints", left=left, least_deg=NUMBER_DEG),
                ),
                counted(
                    max((leg.postures for leg in legs), default=0),
                    self.postures,
                    lambda left: say("phases.more-leg-postures", left=left, least_deg=NUMBER_DEG),
                ),
                counted(
                    len(guesses),
                    self.guesses,
                    lambda left: say("phases.more-guesses", left=left, least_deg=NUMBER_DEG),
                ),
                right.look(guesses),
            ]
        )


@dataclass(frozen=True)
class TrialWork:
    """Work: make a trial that keeps all limits, in rows with the student's own numbers."""

    bounds: tuple[Bound, ...]
    numbers: int
    """How many numbers must be the student's own and changed since the phase began."""
    tools: bool = False
    """Whether numbers that a tool made from the student's own numbers count too."""
    kinds: ClassVar = (Tried,)

    def look(self, evidence: Sequence[Evidence], start: int, again: bool) -> Outcome:
        """Return how much of the work the best trial has done.

        After a wrong answer to the phase's question one new number is enough in such a trial.
        """
        trials = own_trials(evidence, start)
        outcomes = [self._judged(one, again) for one in reversed(trials)]
        lacks = (_one_more(1),) if again else (self._more_numbers(self.numbers), _TRY)
        return max(outcomes, key=lambda outcome: outcome.share, default=Outcome(0.0, lacks))

    def _judged(self, one: OwnTrial, again: bool) -> Outcome:
        wanted, lacks = (1, _one_more) if again else (self.numbers, self._more_numbers)
        own = one.typed + (one.made if self.tools else 0)
        foreign = Bound(
            lambda facts: len(one.foreign),
            lambda found: _foreign(one),
            most=0.0,
        )
        bounds = [bound.look(one.tried.facts) for bound in (foreign, *self.bounds)]
        return every([counted(own, wanted, lacks), *bounds])

    def _more_numbers(self, left: int) -> Phrase:
        if not self.tools:
            return _more_numbers(left)
        return say("phases.more-numbers-or-tools", left=left, least_deg=NUMBER_DEG)


def _foreign(one: OwnTrial) -> Phrase:
    """Say how many numbers are foreign, and where the first of them is."""
    first, facts = one.foreign[0], one.tried.facts
    row = first.key if facts.keys[-1].startswith("A") else first.posture + 1
    leg = leg_labels(len(facts.duty))[first.leg]
    cell = say("explain.row-cell", row=row, leg=leg, level=LEVEL_NAMES[first.level])
    return say("phases.foreign", count=len(one.foreign), cell=cell, angle_deg=first.angle_deg)


@dataclass(frozen=True)
class VersionWork:
    """Work: meet rules with one version of the table that has numbers of the student's own."""

    shown: Predicate
    numbers: int
    beside: tuple[Predicate, ...] = ()
    """Further rules, which may be met with any version of the table, also before the phase."""
    kinds: ClassVar = (Tried, CheckedGait, Compared, Named, Voted)

    def look(self, evidence: Sequence[Evidence], start: int, again: bool) -> Outcome:
        """Return how much of the work is done with the best version of the table.

        After a wrong answer to the phase's question a trial with one new number is enough.
        """
        trials = own_trials(evidence, start)
        if again:
            own = max((one.typed for one in trials), default=0)
            return counted(min(own, 1), 1, _one_more)
        typed: dict[str, int] = {}
        for one in trials:
            typed[one.tried.version] = max(one.typed, typed.get(one.tried.version, 0))
        versions: dict[str, list[Evidence]] = {}
        for seen in evidence[start:]:
            if isinstance(seen, Tried | CheckedGait | Compared):
                versions.setdefault(seen.version, []).append(seen)
        found = [
            every([counted(typed.get(name, 0), self.numbers, _more_numbers), self.shown.look(seen)])
            for name, seen in reversed(versions.items())
        ]
        none = every([Outcome(0.0, (_more_numbers(self.numbers),)), self.shown.look(())])
        best = max(found, key=lambda outcome: outcome.share, default=none)
        return every([best, All(*self.beside).look(evidence)]) if self.beside else best


def _more_right(left: int) -> Phrase:
    return say("phases.more-right-guesses")


def _one_more(left: int) -> Phrase:
    return say("phases.try-again")


def _more_numbers(left: int) -> Phrase:
    return say("phases.more-numbers", left=left, least_deg=NUMBER_DEG)
