"""The odds of a match over its course, from how its forks ended; pure.

At some moments of the match, bots play forks to the end. A moment has few forks, so the share that
the first seat won would be a rough number. The chance is instead the probability that the first
seat would win one more fork. Student's t gives it, as if margins (points of the first seat minus
those of the second) were normally distributed. Neighbouring moments share their forks.
"""

import math
from collections.abc import Iterable, Sequence
from itertools import groupby, pairwise
from typing import NamedTuple

import msgspec

PRIOR_SPREAD = 1.0
"""Standard deviation of margins [points] that is assumed before any fork is seen."""
PRIOR_WEIGHT = 2
"""Number of forks that weigh as much as the assumed `PRIOR_SPREAD`."""
NEAR_S = 5.0
"""Neighbouring moments that are at most this far apart on the clock share their forks [s]."""
_SPARE_S = 0.001  # differences of times are not exact
_SLOW = 0.1
"""Part of a swing's change; stretches at its ends are cut off if they change the odds by less."""


class MomentOdds(msgspec.Struct, frozen=True, kw_only=True):
    """A moment of a match, and how its forks ended."""

    beat: int
    """First beat that the forks play themselves."""
    clock_s: float
    """The match's clock at this beat [s]."""
    margins: tuple[float, ...]
    """Points of the first seat minus those of the second, at the end of each fork."""
    chance: float
    """Chance of the first seat to win, from 0 to 1; a draw counts half."""
    key: str = ""
    """Hash of all that decides how these forks end (`chances.key`); "": the match was over."""


class Swing(NamedTuple):
    """A stretch of a match in which the odds changed."""

    before: MomentOdds
    after: MomentOdds

    @property
    def change(self) -> float:
        """How much the chance of the first seat grew; negative: it fell."""
        return self.after.chance - self.before.chance


def chance(margins: Sequence[float]) -> float:
    """Return the chance of the first seat to win one more fork, from 0 to 1.

    Args:
        margins: margin of each fork, at least one (`MomentOdds.margins`).
    """
    count = len(margins)
    mean = math.fsum(margins) / count
    squares = math.fsum((margin - mean) ** 2 for margin in margins)
    freedom = PRIOR_WEIGHT + count - 1
    spread = math.sqrt((PRIOR_WEIGHT * PRIOR_SPREAD**2 + squares) / freedom)
    return student(mean / (spread * math.sqrt(1 + 1 / count)), freedom)


def pooled(moments: Iterable[MomentOdds]) -> tuple[MomentOdds, ...]:
    """Return moments in order, with chances from their own forks and those of their neighbours.

    A little earlier or later, two bots go on from nearly the same position. So the forks of the
    moments before and after count too, if they are at most `NEAR_S` away. The end of the match
    keeps its chance.

    Args:
        moments: moments of a match, with the forks of each.
    """
    ordered = sorted(moments, key=lambda moment: moment.beat)

    def of(moment: MomentOdds, near: Sequence[float]) -> MomentOdds:
        if not moment.key:
            return moment
        return msgspec.structs.replace(moment, chance=chance([*moment.margins, *near]))

    return tuple(map(of, ordered, near_margins(ordered)))


def near_margins(ordered: Sequence[MomentOdds]) -> list[list[float]]:
    """Return, for each moment, the margins of its neighbours' forks that count for its chance too.

    Args:
        ordered: the moments of a match, in order.
    """
    near_s = NEAR_S + _SPARE_S

    def of(index: int, moment: MomentOdds) -> list[float]:
        neighbours = [*ordered[max(0, index - 1) : index], *ordered[index + 1 : index + 2]]
        near = [one for one in neighbours if abs(one.clock_s - moment.clock_s) <= near_s]
        return [margin for one in near if one.key for margin in one.margins] if moment.key else []

    return [of(index, moment) for index, moment in enumerate(ordered)]


def student(t: float, freedom: int) -> float:
    """Return the distribution function of Student's t: the probability of a value up to `t`.

    Args:
        t: the value.
        freedom: degrees of freedom, at least 1.
    """
    # The closed form for whole degrees of freedom (Abramowitz and Stegun 26.7.3 and 26.7.4).
    angle = math.atan2(t, math.sqrt(freedom))
    cos, sin = math.cos(angle), math.sin(angle)
    if freedom % 2:
        term, total = cos, 0.0
        for number in range(1, freedom - 1, 2):
            total += term
            term *= cos * cos * (number + 1) / (number + 2)
        inside = 2 / math.pi * (angle + sin * total)
    else:
        term, total = 1.0, 0.0
        for number in range(0, freedom - 1, 2):
            total += term
            term *= cos * cos * (number + 1) / (number + 2)
        inside = sin * total
    return min(1.0, max(0.0, (1 + inside) / 2))


def steps(moments: Iterable[MomentOdds]) -> list[Swing]:
    """Return the stretches of the match between neighbouring moments, in order."""
    ordered = sorted(moments, key=lambda moment: moment.beat)
    return [Swing(*pair) for pair in pairwise(ordered)]


def swings(moments: Iterable[MomentOdds]) -> list[Swing]:
    """Return the stretches in which the odds only grew or only fell, the largest change first.

    A beginning or end of a stretch is left out if the odds changed little in it (`_SLOW`).
    """
    runs = [[*run] for _, run in groupby(steps(moments), lambda step: step.change > 0)]
    found = [_without_slow_ends(run) for run in runs]
    return sorted(found, key=lambda swing: (-abs(swing.change), swing.before.beat))


def _without_slow_ends(run: Sequence[Swing]) -> Swing:
    least = _SLOW * abs(run[-1].after.chance - run[0].before.chance)
    fast = [step for step in run if abs(step.change) >= least] or run
    return Swing(fast[0].before, fast[-1].after)


def grid(playing: Sequence[int], step: int) -> list[int]:
    """Return the beats at which a curve of the odds has its moments, at equal distances in play.

    Args:
        playing: all beats in which play went on, in order.
        step: beats of play between two moments.
    """
    return list(playing[::step])


def highlights(moments: Sequence[MomentOdds], most: int = 8, least: float = 0.05) -> list[Swing]:
    """Return the stretches in which the odds changed most, the largest change first.

    Args:
        moments: moments of a match.
        most: largest number of stretches.
        least: smallest change of the chance.
    """
    return [swing for swing in swings(moments) if abs(swing.change) >= least][:most]
