"""Explains why a robot walks as it does: at most three sentences, the most useful one first.

Each rule finds situations that docs/studio.md 3 lists. Its sentence names the leg, the table's cell
or the figure that shows the situation. The sentence about a cause in the table usually comes before
those about its effects.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.balance import balance
from lacoc_server.trial.reasons.form import KeyForm
from lacoc_server.trial.reasons.goal import goal_of
from lacoc_server.trial.reasons.legs import (
    at_limits,
    half_cycle,
    missing_posture,
    odd_legs,
    seam,
)
from lacoc_server.trial.reasons.likely import likely_mistake
from lacoc_server.trial.reasons.repairs import Repair
from lacoc_server.trial.reasons.seen import SeenTrial, TrialFinding
from lacoc_server.trial.steps import steps_of
from lacoc_server.trial.walk import Press, Walk
from lacoc_shared.gait.tables import Posture
from lacoc_shared.studio import Sentence
from lacoc_shared.words import say

MOST_SENTENCES = 3

_TIPPED = 0.8
"""A robot has tipped over if its `upright` is below this: it leans by more than 37 degrees."""
_TURNS_DEG_S, _SLIDES_MM_S, _SLOW_MM_S = 3.0, 20.0, 15.0
_STILL_MM_S, _BACK_MM_S = 5.0, 5.0
_SLIDES_MOST = 1.25
"""The sentence about sliding comes early if the feet slide more than this many times as fast as the
robot goes."""
_HANGS, _WHOLE, _LEG = 97.0, 95.0, 69.0
"""Ranks of mistakes in the table: feet do not reach the floor, any other, one of a single leg. The
last is low, so that an effect of the leg's mistake (`legs`) is told instead of it."""
_RANKS = dict.fromkeys(("odd-joint", "odd-joint-sign", "odd-leg", "too-late", "too-early"), _LEG)
_RANKS |= dict.fromkeys(("none-reaches", "few-reach"), _HANGS)
_OPPOSED = 0.2
"""The sides push in opposite directions if the weaker push is more than this part of the other."""


def explain(
    robot: RobotSpec,
    walk: Walk,
    figures: Figures,
    press: Press,
    sequence: Sequence[Posture],
    before: tuple[int, Posture] | None = None,
) -> list[Sentence]:
    """Explain a walk.

    Args:
        robot: the robot.
        walk: the trial of the robot.
        figures: figures of the trial.
        press: the key that was measured.
        sequence: postures of the key [rad].
        before: if `press` is of level A: digit and posture [rad] of the key of level A that was
            pressed before it; None: there was none.

    Returns:
        At most `MOST_SENTENCES` sentences, the most useful first.
    """
    form = KeyForm.of(robot, sequence, goal_of(press, figures), press.digit, press.level)
    seen = SeenTrial(robot, walk, figures, form, before)
    found = [finding for rule in _RULES for finding in rule(seen)]
    found.sort(key=lambda finding: -finding.rank)
    told: list[TrialFinding] = []
    for finding in found:
        # What a leg does is told once: by its mistake, or by what came of it.
        if finding.leg < 0 or all(finding.leg != one.leg for one in told):
            told.append(finding)
    return [
        Sentence(
            said=one.said, cell=None if one.cell is None else form.place(one.cell), leg=one.leg
        )
        for one in told[:MOST_SENTENCES]
    ]


def _mistake(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Name the mistake that the table most probably has, and further mistakes of single legs.

    A leg is not mentioned if it would do nothing wrong in the repaired table: advice about it would
    lead away from the repair.
    """
    found = likely_mistake(seen.form)
    if found is not None and _rank(found) == _HANGS and seen.stands:
        # The table only knows a level body. One that leans brings other feet to the floor.
        found = None
    legs = list(odd_legs(seen))
    if found is None:
        yield from legs
        return
    yield TrialFinding(_rank(found), found.said, found.leg, found.cell)
    if found.form is seen.form:
        return  # no number is wrong: what legs do in these postures is no advice
    if found.leg < 0:
        left = {(one.said.code, one.leg) for one in odd_legs(replace(seen, form=found.form))}
        legs = [one for one in legs if (one.said.code, one.leg) in left]
    yield from legs


def _rank(mistake: Repair) -> float:
    return _RANKS.get(mistake.said.code.removeprefix("explain."), _WHOLE)


def _ended(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Yield a finding if MuJoCo reported a fault, or the robot tipped over."""
    if seen.walk.fault is not None:
        yield TrialFinding(100, say("explain.fault", why=seen.walk.fault))
    elif seen.figures.upright < _TIPPED:
        lean_deg = math.degrees(math.acos(max(-1.0, seen.figures.upright)))
        yield TrialFinding(55, say("explain.tipped", lean_deg=lean_deg))


def _way(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Yield findings on how the robot moves: hardly, backward, by turning, by sliding, or well."""
    figures = seen.figures
    if not figures.cycles:
        return
    speed_mm_s = abs(figures.speed_mm_s)
    goes_mm_s = math.hypot(figures.speed_mm_s, figures.lateral_mm_s)
    turns = abs(figures.drift_deg_s) > _TURNS_DEG_S
    if goes_mm_s < _STILL_MM_S and not turns and seen.form.postures > 1:
        yield TrialFinding(50, say("explain.still", speed_mm_s=figures.speed_mm_s))
    elif figures.speed_mm_s < -max(_BACK_MM_S, abs(figures.lateral_mm_s)):
        yield TrialFinding(50, say("explain.goes-back", speed_mm_s=speed_mm_s))
    if turns:
        side, other = ("left", "right") if figures.drift_deg_s > 0 else ("right", "left")
        drift_deg_s = abs(figures.drift_deg_s)
        said = say("explain.turns", side=side, drift_deg_s=drift_deg_s)
        if _pushes_back(seen, -1 if side == "left" else 1):
            said = say("explain.opposed", side=side, other=other, drift_deg_s=drift_deg_s)
        yield TrialFinding(40, said)
    if figures.slip_mm_s > _SLIDES_MM_S:
        legs = figures.slip_legs_mm_s
        leg = max(range(len(legs)), key=legs.__getitem__)
        is_story = figures.slip_mm_s > _SLIDES_MOST * speed_mm_s
        yield TrialFinding(
            30 if is_story else 10,
            say(
                "explain.slides",
                slip_mm_s=figures.slip_mm_s,
                speed_mm_s=speed_mm_s,
                leg=seen.walk.legs[leg],
                leg_mm_s=legs[leg],
            ),
            leg,
        )
    if figures.speed_mm_s > _SLOW_MM_S:
        yield TrialFinding(20, say("explain.walks", speed_mm_s=figures.speed_mm_s))


def _pushes_back(seen: SeenTrial, side: int) -> bool:
    """Return whether the legs on a side push the body back, and those on the other side forward."""
    swings = steps_of(seen.robot, seen.form.sequence).swing_m2
    back = -sum(m2 for m2, leg in zip(swings, seen.robot.legs, strict=True) if leg.side == side)
    ahead = sum(m2 for m2, leg in zip(swings, seen.robot.legs, strict=True) if leg.side != side)
    return min(back, ahead) > _OPPOSED * max(back, ahead)


_RULES: tuple[Callable[[SeenTrial], Iterator[TrialFinding]], ...] = (
    _ended,
    _mistake,
    at_limits,
    seam,
    missing_posture,
    half_cycle,
    balance,
    _way,
)
