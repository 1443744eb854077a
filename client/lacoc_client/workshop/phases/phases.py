"""The phases of the workshop, with their tasks and the evidence that they ask for."""

from lacoc_client.workshop.phases.conditions import (
    IS_UPRIGHT,
    NOT_STOPPED,
    acts,
    are_two_postures,
    differs_from_sample,
    within,
)
from lacoc_client.workshop.phases.evidence import CheckedGait, Named, Voted
from lacoc_client.workshop.phases.facts import STRAIGHT_DEG_S, TRIPOD_MARGIN_M
from lacoc_client.workshop.phases.predicates import (
    All,
    Bound,
    Different,
    TriedWhere,
    once,
)
from lacoc_client.workshop.phases.proof.phase import WorkshopPhase
from lacoc_client.workshop.phases.proof.questions import (
    TURNS_DEG_S,
    differs_question,
    keys_question,
    leg_question,
    lesson_question,
    push_question,
    seam_question,
    tripod_question,
)
from lacoc_client.workshop.phases.proof.work import (
    LegWork,
    LessonWork,
    TrialWork,
    VersionWork,
)
from lacoc_shared.words import Phrase, say

_WALKS_MM_S, _STILL_MM = 15.0, 10.0


LESSON = WorkshopPhase(
    number=0,
    title=say("phases.lesson"),
    task=say("phases.lesson-task"),
    question=say("phases.lesson-question"),
    hint=say("phases.lesson-hint"),
    explanation=say("phases.lesson-explanation"),
    work=LessonWork(),
    asks=lesson_question,
)

ONE_LEG = WorkshopPhase(
    number=1,
    title=say("phases.one-leg"),
    task=say("phases.one-leg-task"),
    question=say("phases.one-leg-question"),
    hint=say("phases.one-leg-hint"),
    explanation=say("phases.one-leg-explanation"),
    work=LegWork(joints=3, postures=6, guesses=3, right=2),
    asks=leg_question,
)

_STAND_S = 2.0

THREE_LEGS = WorkshopPhase(
    number=2,
    title=say("phases.three-legs"),
    task=say("phases.three-legs-task"),
    question=say("phases.three-legs-question"),
    hint=say("phases.three-legs-hint"),
    explanation=say("phases.three-legs-explanation"),
    work=TrialWork(
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
                digits=1,
            ),
            Bound(
                lambda facts: facts.belly_share,
                lambda found: say("phases.belly", percent=100 * found),
                most=0.0,
                digits=2,
            ),
            NOT_STOPPED,
        ),
        numbers=3,
    ),
    asks=tripod_question,
)


def _farther(found_mm: float, least_mm: float) -> Phrase:
    """Return the sentence that the robot must move farther forward."""
    if round(found_mm) < 0:
        return say("phases.went-back", found_mm=-found_mm, least_mm=least_mm)
    return say("phases.farther", found_mm=found_mm, least_mm=least_mm)


_HALF_CYCLE_MM = 15.0
_SAME_FEET = 0.9

HALF_CYCLE = WorkshopPhase(
    number=3,
    title=say("phases.half-cycle"),
    task=say("phases.half-cycle-task"),
    question=say("phases.half-cycle-question"),
    hint=say("phases.half-cycle-hint"),
    explanation=say("phases.half-cycle-explanation"),
    work=TrialWork(
        (
            Bound(are_two_postures, lambda found: say("phases.two-postures"), least=1.0),
            Bound(
                lambda facts: facts.forward_mm,
                lambda found: _farther(found, _HALF_CYCLE_MM),
                least=_HALF_CYCLE_MM,
            ),
            Bound(
                lambda facts: facts.same_feet_share,
                lambda found: say("phases.same-feet", percent=100 * found),
                least=_SAME_FEET,
                digits=2,
            ),
            NOT_STOPPED,
        ),
        numbers=3,
    ),
    asks=push_question,
)

_CYCLES, _CYCLES_MM, _POSTURES = 5, 100.0, 4

A_CYCLE = WorkshopPhase(
    number=4,
    title=say("phases.cycle"),
    task=say("phases.cycle-task"),
    question=say("phases.cycle-question"),
    hint=say("phases.cycle-hint"),
    explanation=say("phases.cycle-explanation"),
    work=TrialWork(
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
                lambda found: _farther(found, _CYCLES_MM),
                least=_CYCLES_MM,
            ),
            Bound(
                lambda facts: abs(facts.drift_deg_s),
                lambda found: say("phases.turns", found_deg_s=found, most_deg_s=STRAIGHT_DEG_S),
                most=STRAIGHT_DEG_S,
                digits=1,
            ),
            Bound(
                lambda facts: facts.seam_deg,
                lambda found: say("phases.seam", jump_deg=found),
                most=0.0,
            ),
            NOT_STOPPED,
        ),
        numbers=6,
        tools=True,
    ),
    asks=seam_question,
)

_DIFFERENCES, _NUMBERS = 2, 3

CONCEPT = WorkshopPhase(
    number=5,
    title=say("phases.concept"),
    task=say("phases.concept-task"),
    question=say("phases.concept-question"),
    hint=say("phases.concept-hint"),
    explanation=say("phases.concept-explanation"),
    work=VersionWork(
        All(
            Different(
                differs_from_sample,
                _DIFFERENCES,
                lambda left: say("phases.more-different", left=left),
            ),
            TriedWhere((IS_UPRIGHT, NOT_STOPPED), say("phases.try")),
        ),
        numbers=_NUMBERS,
        beside=(
            once(lambda one: isinstance(one, Named), say("phases.name-word")),
            once(lambda one: isinstance(one, Voted), say("phases.vote")),
        ),
    ),
    asks=differs_question,
)

_STAND, _FORWARD = say("phases.key-stand"), say("phases.key-forward")
_RIGHT, _LEFT = say("phases.key-right"), say("phases.key-left")
_KEYS = 4

CREATIVE = WorkshopPhase(
    number=6,
    title=say("phases.creative"),
    task=say("phases.creative-task"),
    question=say("phases.creative-question"),
    hint=say("phases.creative-hint"),
    explanation=say("phases.creative-explanation"),
    work=VersionWork(
        All(
            once(
                lambda one: isinstance(one, CheckedGait) and not one.mistakes and one.keys >= _KEYS,
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
                within(lambda facts: facts.drift_deg_s, _FORWARD, -STRAIGHT_DEG_S, STRAIGHT_DEG_S),
                lacks=_FORWARD,
            ),
            acts(
                within(lambda facts: facts.drift_deg_s, _RIGHT, most=-TURNS_DEG_S),
                lacks=_RIGHT,
            ),
            acts(within(lambda facts: facts.drift_deg_s, _LEFT, least=TURNS_DEG_S), lacks=_LEFT),
        ),
        numbers=_NUMBERS,
    ),
    asks=keys_question,
)

PHASES = (LESSON, ONE_LEG, THREE_LEGS, HALF_CYCLE, A_CYCLE, CONCEPT, CREATIVE)
"""All phases; each stands at the index that is its number."""
