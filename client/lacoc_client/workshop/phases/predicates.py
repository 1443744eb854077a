"""Rules that compute from a student's evidence how much of a task is done.

Small rules can be combined into larger ones. More evidence never lowers the result: a rule that was
once met stays met. A test checks this for all phases.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from lacoc_client.workshop.phases.evidence import Evidence, Tried
from lacoc_client.workshop.phases.facts import TrialFacts
from lacoc_shared.words import Phrase

_NEARLY = 0.99
"""Largest share that is reported for a rule that is not met yet."""


@dataclass(frozen=True)
class Outcome:
    """How far one rule is met."""

    share: float
    """Part that is done, from 0 to 1; 1: the rule is met."""
    missing: tuple[Phrase, ...]
    """Sentences that say what is still missing, the most useful first; empty: nothing, the rule is
    met."""

    @property
    def met(self) -> bool:
        """Whether the rule is met."""
        return not self.missing


MET = Outcome(1.0, ())


class Predicate(Protocol):
    """A rule about evidence."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Return how far the rule is met.

        Args:
            evidence: all evidence of the student, in order.
        """


Lacks = Callable[[int], Phrase]
"""Takes how many things are missing; returns the sentence that says so."""


@dataclass(frozen=True)
class Times:
    """The rule that something must happen a number of times."""

    test: Callable[[Evidence], bool]
    """Returns whether a piece of evidence counts."""
    times: int
    lacks: Lacks
    """Takes how many times are still missing; returns the sentence that says so."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Count the evidence that passes the test."""
        return counted(sum(map(self.test, evidence)), self.times, self.lacks)


def once(test: Callable[[Evidence], bool], lacks: Phrase) -> Times:
    """Make the rule that something must happen at least once."""
    return Times(test, 1, lambda left: lacks)


@dataclass(frozen=True)
class Different:
    """The rule that one group must have `count` different things, such as six postures of a leg."""

    things: Callable[[Evidence], Iterable[tuple[Hashable, Hashable]]]
    """Takes a piece of evidence; returns a pair of a group and a thing for each thing in it."""
    count: int
    lacks: Lacks
    """Takes how many things are missing in the fullest group; returns the sentence that says so."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Count the different things of each group; return how far the fullest group is."""
        groups: defaultdict[Hashable, set[Hashable]] = defaultdict(set)
        for one in evidence:
            for group, thing in self.things(one):
                groups[group].add(thing)
        return counted(max(map(len, groups.values()), default=0), self.count, self.lacks)


@dataclass(frozen=True)
class LastOf:
    """The rule that among `last` answers in a row at least `right` must be right."""

    answer: Callable[[Evidence], bool | None]
    """Returns whether an answer was right; None: this evidence is no answer."""
    right: int
    last: int
    lacks: Lacks
    """Takes how many right answers the best `last` answers in a row still lack; returns the
    sentence that says so."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Return how far the rule is met by the `last` answers in a row of which most are right."""
        answers = [right for one in evidence if (right := self.answer(one)) is not None]
        runs = (answers[start : start + self.last] for start in range(len(answers)))
        return counted(max(map(sum, runs), default=0), self.right, self.lacks)


@dataclass(frozen=True)
class Bound:
    """A limit: one number of a trial must be from `least` to `most`."""

    number: Callable[[TrialFacts], float | None]
    """Returns the number of a trial. None, NaN or infinity: the trial has no such number and does
    not keep the limit."""
    lacks: Callable[[float], Phrase]
    """Takes the trial's number (0 if it has none); returns a sentence that says what is missing."""
    least: float = -math.inf
    most: float = math.inf
    digits: int = 0
    """Decimals of the number in the sentence. It is rounded away from the limit, or a sentence
    could say "15 mm, at least 15 mm"."""

    def look(self, facts: TrialFacts) -> Outcome:
        """Compare the trial's number with the limits."""
        number = self.number(facts)
        if number is None or not math.isfinite(number):
            return Outcome(0.0, (self.lacks(0.0),))
        if self.least <= number <= self.most:
            return MET
        if number < self.least and self.least > 0:
            share = max(0.0, number) / self.least
        else:
            limit = abs(self.least if number < self.least else self.most)
            beyond = max(self.least - number, number - self.most)
            share = limit / (limit + beyond)
        shown = (math.floor if number < self.least else math.ceil)(number * 10**self.digits)
        return Outcome(min(_NEARLY, share), (self.lacks(shown / 10**self.digits),))


@dataclass(frozen=True)
class TriedWhere:
    """The rule that one trial must keep all limits."""

    bounds: tuple[Bound, ...]
    none: Phrase
    """Sentence that says what is missing while there is no trial."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Return how far the rule is met by the trial with the largest share that is done.

        If several trials have the same share, it is the last of these.
        """
        tries = [one.facts for one in evidence if isinstance(one, Tried)]
        best = [every([bound.look(facts) for bound in self.bounds]) for facts in reversed(tries)]
        return max(best, key=_share, default=Outcome(0.0, (self.none,)))


class All:
    """The rule that several rules must be met.

    Args:
        *parts: the rules.
    """

    def __init__(self, *parts: Predicate) -> None:
        self.parts = parts

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Look at each of the rules; the share that is done is the mean of their shares."""
        return every([part.look(evidence) for part in self.parts])


def _share(outcome: Outcome) -> float:
    return outcome.share


def counted(found: int, wanted: int, lacks: Lacks) -> Outcome:
    """Return how far a rule is met for which `wanted` things must be found."""
    return MET if found >= wanted else Outcome(found / wanted, (lacks(wanted - found),))


def every(outcomes: Sequence[Outcome]) -> Outcome:
    """Return how far a rule is met that asks for several rules, from the outcomes of these."""
    missing = tuple(dict.fromkeys(phrase for outcome in outcomes for phrase in outcome.missing))
    if not missing:
        return MET
    share = sum(outcome.share for outcome in outcomes) / len(outcomes)
    return Outcome(min(_NEARLY, share), missing)
