"""The six phases of workshop 4-2 as tasks with evidence (docs/studio.md 5 has the thresholds)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from lacoc_client.phases.evidence import (
    SAMPLE,
    Checked,
    Compared,
    Edited,
    Evidence,
    Guessed,
    Named,
    Voted,
)
from lacoc_client.phases.facts import TRIPOD_MARGIN_M, TrialFacts
from lacoc_client.phases.predicates import (
    After,
    All,
    Bound,
    Different,
    LastOf,
    OneVersion,
    Outcome,
    Predicate,
    Times,
    TriedWhere,
    once,
)
from lacoc_shared.words import Phrase, say

_OWN = ("hand", "tool")
_UPRIGHT = 0.8
"""A robot has tipped over below this (docs/studio.md 3)."""
_BELLY = 0.05
"""A robot lies on its body if it rests on it for a larger share of time."""
_STRAIGHT_DEG_S, _TURNS_DEG_S, _WALKS_MM_S, _STILL_MM = 3.0, 5.0, 15.0, 10.0


@dataclass(frozen=True)
class Phase:
    """One step of the workshop."""

    number: int
    """From 1 to 6."""
    id: str
    title: Phrase
    task: Phrase
    question: Phrase
    """Makes a student think before trying."""
    hint: Phrase
    explanation: Phrase
    """What there is to understand."""
    shown: tuple[Predicate, ...]
    """What evidence must show, each on its own."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Say how far a student is; `evidence` is all that the student did, in order."""
        return All(*self.shown).look(evidence)

    def first(self, explain_first: bool) -> tuple[Phrase, ...]:
        """Return what a student reads before trying.

        Args:
            explain_first: whether the teacher wants the explanation before the task. Students
                usually learn more if they try first, children of grades 2 to 5 if they read first
                (docs/studio.md 6).
        """
        return (self.explanation, self.task) if explain_first else (self.task, self.question)

    def afterwards(self, explain_first: bool) -> Phrase:
        """Return what a student reads when the task is done; argument as in `first`."""
        return self.question if explain_first else self.explanation


def _own_cells(cells: int) -> Different:
    """Ask for a number of different cells that the student changed, not the coach or a paste."""
    return Different(_cells, cells, lambda left: say("phases.more-cells", left=left))


def _cells(one: Evidence) -> Iterator[tuple[None, tuple[int, ...]]]:
    if isinstance(one, Edited) and one.by in _OWN:
        for leg in one.legs:
            for level in leg.changed:
                yield None, (leg.key, leg.posture, leg.leg, level)


def _leg_postures(one: Evidence) -> Iterator[tuple[int, tuple[float, ...]]]:
    if isinstance(one, Edited) and one.by in _OWN:
        for leg in one.legs:
            yield leg.leg, leg.angles_deg


def _leg_joints(one: Evidence) -> Iterator[tuple[int, int]]:
    if isinstance(one, Edited) and one.by in _OWN:
        for leg in one.legs:
            for level in leg.changed:
                yield leg.leg, level


def _foot_guess(one: Evidence) -> bool | None:
    return one.right if isinstance(one, Guessed) and one.about == "foot" else None


ONE_LEG = Phase(
    number=1,
    id="one-leg",
    title=say("phases.one-leg"),
    task=say("phases.one-leg-task"),
    question=say("phases.one-leg-question"),
    hint=say("phases.one-leg-hint"),
    explanation=say("phases.one-leg-explanation"),
    shown=(
        Different(_leg_joints, 3, lambda left: say("phases.more-joints", left=left)),
        Different(_leg_postures, 6, lambda left: say("phases.more-leg-postures", left=left)),
        Times(
            lambda one: _foot_guess(one) is not None,
            3,
            lambda left: say("phases.more-guesses", left=left),
        ),
        LastOf(_foot_guess, 2, 3, lambda left: say("phases.more-right-guesses")),
    ),
)


_NOT_STOPPED = Bound(
    lambda facts: float(facts.stopped), lambda stopped: say("phases.stopped"), most=0.0
)
_IS_UPRIGHT = Bound(
    lambda facts: facts.upright, lambda upright: say("phases.tipped"), least=_UPRIGHT
)
_STANDS = 2.0

THREE_LEGS = Phase(
    number=2,
    id="three-legs",
    title=say("phases.three-legs"),
    task=say("phases.three-legs-task"),
    question=say("phases.three-legs-question"),
    hint=say("phases.three-legs-hint"),
    explanation=say("phases.three-legs-explanation"),
    shown=(
        After(
            _own_cells(3),
            TriedWhere(
                (
                    Bound(
                        lambda facts: facts.tripod_s,
                        lambda found: say(
                            "phases.stand-longer",
                            found_s=found,
                            least_s=_STANDS,
                            margin_mm=1000 * TRIPOD_MARGIN_M,
                        ),
                        least=_STANDS,
                    ),
                    Bound(
                        lambda facts: facts.belly_share,
                        lambda found: say("phases.belly", percent=100 * found),
                        most=0.0,
                    ),
                    _NOT_STOPPED,
                ),
                say("phases.try"),
            ),
        ),
    ),
)

_HALF_CYCLE_MM = 15.0
_SAME_FEET = 0.9


def _are_two_postures(facts: TrialFacts) -> float:
    """Return 1 if the last two keys were two different postures of level A, else 0."""
    last = facts.keys[-2:]
    return float(len(set(last)) == 2 and all(key.startswith("A") for key in last))


HALF_CYCLE = Phase(
    number=3,
    id="half-cycle",
    title=say("phases.half-cycle"),
    task=say("phases.half-cycle-task"),
    question=say("phases.half-cycle-question"),
    hint=say("phases.half-cycle-hint"),
    explanation=say("phases.half-cycle-explanation"),
    shown=(
        After(
            _own_cells(3),
            TriedWhere(
                (
                    Bound(_are_two_postures, lambda found: say("phases.two-postures"), least=1.0),
                    Bound(
                        lambda facts: facts.forward_mm,
                        lambda found: say(
                            "phases.farther", found_mm=found, least_mm=_HALF_CYCLE_MM
                        ),
                        least=_HALF_CYCLE_MM,
                    ),
                    Bound(
                        lambda facts: facts.same_feet_share,
                        lambda found: say("phases.same-feet", percent=100 * found),
                        least=_SAME_FEET,
                    ),
                    _NOT_STOPPED,
                ),
                say("phases.try"),
            ),
        ),
    ),
)

_CYCLES, _CYCLES_MM, _POSTURES = 5, 100.0, 4

A_CYCLE = Phase(
    number=4,
    id="cycle",
    title=say("phases.cycle"),
    task=say("phases.cycle-task"),
    question=say("phases.cycle-question"),
    hint=say("phases.cycle-hint"),
    explanation=say("phases.cycle-explanation"),
    shown=(
        After(
            _own_cells(6),
            TriedWhere(
                (
                    Bound(
                        lambda facts: facts.cycles,
                        lambda found: say("phases.more-cycles", found=found, least=_CYCLES),
                        least=_CYCLES,
                    ),
                    Bound(
                        lambda facts: facts.postures,
                        lambda found: say("phases.four-postures", found=found, least=_POSTURES),
                        least=_POSTURES,
                    ),
                    _IS_UPRIGHT,
                    Bound(
                        lambda facts: facts.forward_mm,
                        lambda found: say("phases.farther", found_mm=found, least_mm=_CYCLES_MM),
                        least=_CYCLES_MM,
                    ),
                    Bound(
                        lambda facts: abs(facts.drift_deg_s),
                        lambda found: say(
                            "phases.turns", found_deg_s=found, most_deg_s=_STRAIGHT_DEG_S
                        ),
                        most=_STRAIGHT_DEG_S,
                    ),
                    Bound(
                        lambda facts: facts.seam_deg,
                        lambda found: say("phases.seam", jump_deg=found),
                        most=0.0,
                    ),
                    _NOT_STOPPED,
                ),
                say("phases.try"),
            ),
        ),
    ),
)

_DIFFERENCES = 2


def _differs(one: Evidence) -> Iterator[tuple[None, str]]:
    if isinstance(one, Compared) and one.against == SAMPLE:
        for difference in one.differs:
            yield None, difference


CONCEPT = Phase(
    number=5,
    id="concept",
    title=say("phases.concept"),
    task=say("phases.concept-task"),
    question=say("phases.concept-question"),
    hint=say("phases.concept-hint"),
    explanation=say("phases.concept-explanation"),
    shown=(
        once(lambda one: isinstance(one, Named), say("phases.name-word")),
        OneVersion(
            All(
                Different(
                    _differs, _DIFFERENCES, lambda left: say("phases.more-different", left=left)
                ),
                TriedWhere((_IS_UPRIGHT, _NOT_STOPPED), say("phases.try")),
            )
        ),
        once(lambda one: isinstance(one, Voted), say("phases.vote")),
    ),
)


def _acts(*bounds: Bound, lacks: Phrase) -> Predicate:
    """Ask for a trial of a key of level B, in which the robot does something upright."""
    level_b = Bound(lambda facts: float(facts.keys[-1].startswith("B")), lambda _: lacks, least=1)
    belly = Bound(lambda facts: facts.belly_share, lambda _: lacks, most=_BELLY)
    return TriedWhere((level_b, _IS_UPRIGHT, belly, _NOT_STOPPED, *bounds), lacks)


def _within(
    number: str, lacks: Phrase, least: float = -float("inf"), most: float = float("inf")
) -> Bound:
    return Bound(lambda facts: getattr(facts, number), lambda _: lacks, least, most)


_STAND, _FORWARD = say("phases.key-stand"), say("phases.key-forward")
_RIGHT, _LEFT = say("phases.key-right"), say("phases.key-left")
_KEYS = 4

CREATIVE = Phase(
    number=6,
    id="creative",
    title=say("phases.creative"),
    task=say("phases.creative-task"),
    question=say("phases.creative-question"),
    hint=say("phases.creative-hint"),
    explanation=say("phases.creative-explanation"),
    shown=(
        OneVersion(
            All(
                once(
                    lambda one: isinstance(one, Checked) and not one.mistakes and one.keys >= _KEYS,
                    say("phases.check"),
                ),
                _acts(
                    _within("forward_mm", _STAND, -_STILL_MM, _STILL_MM),
                    _within("left_mm", _STAND, -_STILL_MM, _STILL_MM),
                    _within("drift_deg_s", _STAND, -1.0, 1.0),
                    lacks=_STAND,
                ),
                _acts(
                    _within("speed_mm_s", _FORWARD, least=_WALKS_MM_S),
                    _within("drift_deg_s", _FORWARD, -_STRAIGHT_DEG_S, _STRAIGHT_DEG_S),
                    lacks=_FORWARD,
                ),
                _acts(_within("drift_deg_s", _RIGHT, most=-_TURNS_DEG_S), lacks=_RIGHT),
                _acts(_within("drift_deg_s", _LEFT, least=_TURNS_DEG_S), lacks=_LEFT),
            )
        ),
    ),
)

PHASES = (ONE_LEG, THREE_LEGS, HALF_CYCLE, A_CYCLE, CONCEPT, CREATIVE)
