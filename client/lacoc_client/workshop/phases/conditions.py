"""The conditions that the six phases ask for, made of the general rules in `predicates`."""

import math
from collections.abc import Callable, Iterator

from lacoc_client.workshop.phases.evidence import SAMPLE, Compared, Evidence, Guessed
from lacoc_client.workshop.phases.facts import TrialFacts
from lacoc_client.workshop.phases.predicates import Bound, Predicate, TriedWhere
from lacoc_shared.words import Phrase, say

_UPRIGHT = 0.8
"""A robot has tipped over if its `upright` is below this (docs/studio.md 3)."""
_BELLY = 0.05
"""A robot does not walk on its feet if its body rests on the floor for a larger share of the time
than this."""


def foot_guess(one: Evidence) -> bool | None:
    """Return whether a guess of where a foot goes was right; None for all other evidence."""
    return one.right if isinstance(one, Guessed) and one.about == "foot" else None


def differs_from_sample(one: Evidence) -> Iterator[tuple[None, str]]:
    """Yield each visible difference of the student's walk from the walk with the sample gait."""
    if isinstance(one, Compared) and one.against == SAMPLE:
        for difference in one.differs:
            yield None, difference


def are_two_postures(facts: TrialFacts) -> float:
    """Return 1 if the last two keys of a trial are two different keys of level A, else 0."""
    last = facts.keys[-2:]
    return float(len(set(last)) == 2 and all(key.startswith("A") for key in last))


NOT_STOPPED = Bound(
    lambda facts: float(facts.stopped), lambda stopped: say("phases.stopped"), most=0.0
)
IS_UPRIGHT = Bound(
    lambda facts: facts.upright, lambda upright: say("phases.tipped"), least=_UPRIGHT
)


def acts(*bounds: Bound, lacks: Phrase) -> Predicate:
    """Make the rule that the robot stays on its feet in a trial of a key of level B.

    Args:
        *bounds: further limits that the same trial must keep.
        lacks: sentence that says what is missing in all cases except two: for a robot that tips
            over and for physics that stops there are other sentences.
    """
    level_b = Bound(lambda facts: float(facts.keys[-1].startswith("B")), lambda _: lacks, least=1)
    belly = Bound(lambda facts: facts.belly_share, lambda _: lacks, most=_BELLY)
    return TriedWhere((level_b, IS_UPRIGHT, belly, NOT_STOPPED, *bounds), lacks)


def within(
    number: Callable[[TrialFacts], float],
    lacks: Phrase,
    least: float = -math.inf,
    most: float = math.inf,
) -> Bound:
    """Make the limit that a number of a trial is between `least` and `most`.

    Args:
        number: returns the number from the facts of a trial.
        lacks: sentence that says what is missing if the number lies outside.
        least: smallest number allowed.
        most: largest number allowed.
    """
    return Bound(number, lambda _: lacks, least, most)
