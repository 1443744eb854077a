"""The six phases of workshop 4-2 as tasks with evidence (docs/studio.md 7 has the thresholds)."""

from collections.abc import Sequence
from dataclasses import dataclass

from lacoc_client.workshop.phases.conditions import (
    IS_UPRIGHT,
    NOT_STOPPED,
    acts,
    are_two_postures,
    differs_from_sample,
    foot_guess,
    leg_joints,
    leg_postures,
    own_cells,
    within,
)
from lacoc_client.workshop.phases.evidence import CheckedGait, Evidence, Named, Voted
from lacoc_client.workshop.phases.facts import STRAIGHT_DEG_S, TRIPOD_MARGIN_M
from lacoc_client.workshop.phases.predicates import (
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

_TURNS_DEG_S, _WALKS_MM_S, _STILL_MM = 5.0, 15.0, 10.0


@dataclass(frozen=True)
class WorkshopPhase:
    """One step of the workshop."""

    number: int
    """From 1 to 6."""
    id: str
    title: Phrase
    task: Phrase
    question: Phrase
    """A question that makes a student think before trying."""
    hint: Phrase
    explanation: Phrase
    """What a student should have understood after the task."""
    shown: tuple[Predicate, ...]
    """The rules that the evidence must meet, all of them, in any order."""

    def look(self, evidence: Sequence[Evidence]) -> Outcome:
        """Return how far a student is; `evidence` is all evidence of the student, in order."""
        return All(*self.shown).look(evidence)


ONE_LEG = WorkshopPhase(
    number=1,
    id="one-leg",
    title=say("phases.one-leg"),
    task=say("phases.one-leg-task"),
    question=say("phases.one-leg-question"),
    hint=say("phases.one-leg-hint"),
    explanation=say("phases.one-leg-explanation"),
    shown=(
        Different(leg_joints, 3, lambda left: say("phases.more-joints", left=left)),
        Different(leg_postures, 6, lambda left: say("phases.more-leg-postures", left=left)),
        Times(
            lambda one: foot_guess(one) is not None,
            3,
            lambda left: say("phases.more-guesses", left=left),
        ),
        LastOf(foot_guess, 2, 3, lambda left: say("phases.more-right-guesses")),
    ),
)

_STAND_S = 2.0

THREE_LEGS = WorkshopPhase(
    number=2,
    id="three-legs",
    title=say("phases.three-legs"),
    task=say("phases.three-legs-task"),
    question=say("phases.three-legs-question"),
    hint=say("phases.three-legs-hint"),
    explanation=say("phases.three-legs-explanation"),
    shown=(
        After(
            own_cells(3),
            TriedWhere(
                (
                    Bound(
                        lambda facts: facts.tripod_s,
                        lambda found: say(
                            "phases.stand-longer",
                            found_s=found,
                            least_s=_STAND_S,
                            margin_mm=1000 * TRIPOD_MARGIN_M,
                        ),
                        least=_STAND_S,
                    ),
                    Bound(
                        lambda facts: facts.belly_share,
                        lambda found: say("phases.belly", percent=100 * found),
                        most=0.0,
                    ),
                    NOT_STOPPED,
                ),
                say("phases.try"),
            ),
        ),
    ),
)

_HALF_CYCLE_MM = 15.0
_SAME_FEET = 0.9

HALF_CYCLE = WorkshopPhase(
    number=3,
    id="half-cycle",
    title=say("phases.half-cycle"),
    task=say("phases.half-cycle-task"),
    question=say("phases.half-cycle-question"),
    hint=say("phases.half-cycle-hint"),
    explanation=say("phases.half-cycle-explanation"),
    shown=(
        After(
            own_cells(3),
            TriedWhere(
                (
                    Bound(are_two_postures, lambda found: say("phases.two-postures"), least=1.0),
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
                    NOT_STOPPED,
                ),
                say("phases.try"),
            ),
        ),
    ),
)

_CYCLES, _CYCLES_MM, _POSTURES = 5, 100.0, 4

A_CYCLE = WorkshopPhase(
    number=4,
    id="cycle",
    title=say("phases.cycle"),
    task=say("phases.cycle-task"),
    question=say("phases.cycle-question"),
    hint=say("phases.cycle-hint"),
    explanation=say("phases.cycle-explanation"),
    shown=(
        After(
            own_cells(6),
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
                    IS_UPRIGHT,
                    Bound(
                        lambda facts: facts.forward_mm,
                        lambda found: say("phases.farther", found_mm=found, least_mm=_CYCLES_MM),
                        least=_CYCLES_MM,
                    ),
                    Bound(
                        lambda facts: abs(facts.drift_deg_s),
                        lambda found: say(
                            "phases.turns", found_deg_s=found, most_deg_s=STRAIGHT_DEG_S
                        ),
                        most=STRAIGHT_DEG_S,
                    ),
                    Bound(
                        lambda facts: facts.seam_deg,
                        lambda found: say("phases.seam", jump_deg=found),
                        most=0.0,
                    ),
                    NOT_STOPPED,
                ),
                say("phases.try"),
            ),
        ),
    ),
)

_DIFFERENCES = 2

CONCEPT = WorkshopPhase(
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
                    differs_from_sample,
                    _DIFFERENCES,
                    lambda left: say("phases.more-different", left=left),
                ),
                TriedWhere((IS_UPRIGHT, NOT_STOPPED), say("phases.try")),
            )
        ),
        once(lambda one: isinstance(one, Voted), say("phases.vote")),
    ),
)

_STAND, _FORWARD = say("phases.key-stand"), say("phases.key-forward")
_RIGHT, _LEFT = say("phases.key-right"), say("phases.key-left")
_KEYS = 4

CREATIVE = WorkshopPhase(
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
                    lambda one: (
                        isinstance(one, CheckedGait) and not one.mistakes and one.keys >= _KEYS
                    ),
                    say("phases.check"),
                ),
                acts(
                    within(lambda facts: facts.forward_mm, _STAND, -_STILL_MM, _STILL_MM),
                    within(lambda facts: facts.left_mm, _STAND, -_STILL_MM, _STILL_MM),
                    within(lambda facts: facts.drift_deg_s, _STAND, -1.0, 1.0),
                    lacks=_STAND,
                ),
                acts(
                    within(lambda facts: facts.speed_mm_s, _FORWARD, least=_WALKS_MM_S),
                    within(
                        lambda facts: facts.drift_deg_s, _FORWARD, -STRAIGHT_DEG_S, STRAIGHT_DEG_S
                    ),
                    lacks=_FORWARD,
                ),
                acts(
                    within(lambda facts: facts.drift_deg_s, _RIGHT, most=-_TURNS_DEG_S),
                    lacks=_RIGHT,
                ),
                acts(
                    within(lambda facts: facts.drift_deg_s, _LEFT, least=_TURNS_DEG_S), lacks=_LEFT
                ),
            )
        ),
    ),
)

PHASES = (ONE_LEG, THREE_LEGS, HALF_CYCLE, A_CYCLE, CONCEPT, CREATIVE)
