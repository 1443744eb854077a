"""Small predicates over evidence, and how they are put together.

Each says how far a student is. Evidence that is added never takes anything back: what was reached
once stays reached. A test checks this for all phases.
"""

import math
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from lacoc_client.phases.evidence import Checked, Coached, Compared, Edited, Evidence, Tried
from lacoc_client.phases.facts import TrialFacts
from lacoc_shared.words import Phrase

_NEARLY = 0.99
"""Largest share of what is not met."""


@dataclass(frozen=True)
class Outcome:
    """How far a student is with one thing."""

    share: float
    """From 0 to 1; 1: it is done."""
    missing: tuple[Phrase, ...]
    """What is still missing, the most useful first; empty: it is done."""

    @property
    def met(self) -> bool:
        """Whether it is done."""
        return not self.missing


MET = Outcome(1.0, ())


class Predicate(Protocol):
    """Something that evidence shows, or does not show yet."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Say how far it is shown; `evidence` is in the order in which it came."""


Lacks = Callable[[int], Phrase]
"""Says what is missing, from a count."""


@dataclass(frozen=True)
class Times:
    """Something happened a number of times."""

    test: Callable[[Evidence], bool]
    times: int
    lacks: Lacks
    """Gets how many times are missing."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Count."""
        return _counted(sum(map(self.test, evidence)), self.times, self.lacks)


def once(test: Callable[[Evidence], bool], lacks: Phrase) -> Times:
    """Ask that something happened at all."""
    return Times(test, 1, lambda left: lacks)


@dataclass(frozen=True)
class Different:
    """One group has a number of different things: six postures of one leg."""

    things: Callable[[Evidence], Iterable[tuple[Hashable, Hashable]]]
    """Gives pairs of a group and a thing."""
    count: int
    lacks: Lacks
    """Gets how many are missing in the best group."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Count the things of each group."""
        groups: defaultdict[Hashable, set[Hashable]] = defaultdict(set)
        for one in evidence:
            for group, thing in self.things(one):
                groups[group].add(thing)
        return _counted(max(map(len, groups.values()), default=0), self.count, self.lacks)


@dataclass(frozen=True)
class LastOf:
    """At some time, enough of the last answers were right."""

    answer: Callable[[Evidence], bool | None]
    """Says whether an answer was right; None: this is no answer."""
    right: int
    last: int
    lacks: Lacks
    """Gets how many of the last answers should have been right, and were not."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Find the best run of answers."""
        answers = [right for one in evidence if (right := self.answer(one)) is not None]
        runs = (answers[start : start + self.last] for start in range(len(answers)))
        return _counted(max(map(sum, runs), default=0), self.right, self.lacks)


@dataclass(frozen=True)
class Bound:
    """A limit for one number of a trial."""

    number: Callable[[TrialFacts], float | None]
    """None, NaN or infinite: the trial does not say, so the limit is not kept."""
    lacks: Callable[[float], Phrase]
    """Says what is missing, from the number that was found, or 0."""
    least: float = -math.inf
    most: float = math.inf

    def look(self, facts: TrialFacts) -> Outcome:
        """Compare."""
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
        return Outcome(min(_NEARLY, share), (self.lacks(number),))


@dataclass(frozen=True)
class TriedWhere:
    """One trial keeps all limits. The trial that comes nearest says what is missing."""

    bounds: tuple[Bound, ...]
    none: Phrase
    """Said while there is no trial."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Compare each trial; of equals the last one counts."""
        tries = [one.facts for one in evidence if isinstance(one, Tried)]
        best = [_all([bound.look(facts) for bound in self.bounds]) for facts in reversed(tries)]
        return max(best, key=_share, default=Outcome(0.0, (self.none,)))


class All:
    """Everything is shown.

    Args:
        *parts: what must be shown.
    """

    def __init__(self, *parts: Predicate) -> None:
        self.parts = parts

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Look at each part; the share is their mean."""
        return _all([part.look(evidence) for part in self.parts])


@dataclass(frozen=True)
class After:
    """Something is shown by evidence that came after something else was shown."""

    first: Predicate
    then: Predicate

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Find when the first thing was shown, and look at what came after it."""
        start = self.first.look(evidence)
        if not start.met:
            return Outcome(start.share / 2, start.missing)
        # What is shown once stays shown, so the earliest time can be found by halving.
        counts = range(len(evidence) + 1)
        shown = bisect_left(counts, True, key=lambda count: self.first.look(evidence[:count]).met)
        rest = self.then.look(evidence[shown:])
        return MET if rest.met else Outcome(0.5 + rest.share / 2, rest.missing)


@dataclass(frozen=True)
class OneVersion:
    """Something is shown by what was done with one version of the table."""

    shown: Predicate

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Look at each version; the one that is nearest counts, of equals the last."""
        versions: dict[str, list[Evidence]] = {}
        for one in evidence:
            if isinstance(one, Edited | Tried | Checked | Compared | Coached):
                versions.setdefault(one.version, []).append(one)
        found = [self.shown.look(seen) for seen in reversed(versions.values())]
        return max(found, key=_share, default=self.shown.look(()))


def _share(outcome: Outcome) -> float:
    return outcome.share


def _counted(found: int, wanted: int, lacks: Lacks) -> Outcome:
    return MET if found >= wanted else Outcome(found / wanted, (lacks(wanted - found),))


def _all(outcomes: Sequence[Outcome]) -> Outcome:
    missing = tuple(dict.fromkeys(phrase for outcome in outcomes for phrase in outcome.missing))
    if not missing:
        return MET
    share = sum(outcome.share for outcome in outcomes) / len(outcomes)
    return Outcome(min(_NEARLY, share), missing)
