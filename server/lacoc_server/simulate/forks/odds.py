"""The odds of a match over its course, from how its forks ended; pure.

At some moments of the match, bots play forks to the end. A moment has few forks, so the share that
the first seat won would be a rough number. The chance is instead the probability that it would win
one more fork. That is computed by Student's t, as if margins (its points less those of the other
seat) were normally distributed. Moments close to each other share their forks.
"""

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import msgspec

PRIOR_SPREAD = 1.0
"""Standard deviation of margins [points] that is assumed before any fork is seen."""
PRIOR_WEIGHT = 2
"""Number of forks that weigh as much as this assumption."""
NEAR_S = 1.0
"""Moments that are at most this far apart on the clock share their forks [s]."""
_SPARE_S = 0.001  # differences of times are not exact


class Moment(msgspec.Struct, frozen=True, kw_only=True):
    """A moment of a match, and how its forks ended."""

    beat: int
    """First beat that the forks play themselves."""
    clock_s: float
    """Seconds played until then."""
    margins: tuple[float, ...]
    """Points of the first seat less those of the second, at the end of each fork."""
    chance: float
    """Chance of the first seat to win, from 0 to 1; a draw counts half."""
    key: str = ""
    """Hash of all that decides how these forks go (`chances.key`); "": the match was over."""


class Swing(NamedTuple):
    """A stretch of a match in which the odds changed."""

    before: Moment
    after: Moment

    @property
    def change(self) -> float:
        """How much the chance of the first seat grew; negative: it fell."""
        return self.after.chance - self.before.chance


def chance(margins: Sequence[float]) -> float:
    """Return the chance of the first seat to win one more fork, from 0 to 1.

    Args:
        margins: how the forks ended, at least one (`Moment.margins`).
    """
    count = len(margins)
    mean = math.fsum(margins) / count
    squares = math.fsum((margin - mean) ** 2 for margin in margins)
    freedom = PRIOR_WEIGHT + count - 1
    spread = math.sqrt((PRIOR_WEIGHT * PRIOR_SPREAD**2 + squares) / freedom)
    return student(mean / (spread * math.sqrt(1 + 1 / count)), freedom)


def pooled(moments: Iterable[Moment]) -> tuple[Moment, ...]:
    """Return moments in their order, with the chances that follow from all their forks.

    A second earlier or later, two bots go on from nearly the same position. So the forks of moments
    at most `NEAR_S` away count too. The end of the match keeps its chance.

    Args:
        moments: moments of a match, with the forks of each.
    """
    ordered = sorted(moments, key=lambda moment: moment.beat)
    forked = [moment for moment in ordered if moment.key]

    def of(moment: Moment) -> Moment:
        if not moment.key:
            return moment
        near = [one for one in forked if abs(one.clock_s - moment.clock_s) <= NEAR_S + _SPARE_S]
        found = chance([margin for one in near for margin in one.margins])
        return msgspec.structs.replace(moment, chance=found)

    return tuple(map(of, ordered))


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


def swings(moments: Sequence[Moment]) -> list[Swing]:
    """Return the stretches between moments, the largest change first."""
    ordered = sorted(moments, key=lambda moment: moment.beat)
    found = [Swing(*pair) for pair in pairwise(ordered)]
    return sorted(found, key=lambda swing: (-abs(swing.change), swing.before.beat))


def grid(playing: Sequence[int], step: int) -> list[int]:
    """Return the first moments of a curve, at equal distances in play.

    Args:
        playing: all beats in which play went on, in order.
        step: beats of play between two moments.
    """
    return list(playing[::step])


def jumps(playing: Sequence[int], leads: Sequence[float], width: int, most: int) -> list[int]:
    """Return the moments just before and after the largest changes of the lead, in order.

    Without them a curve would miss what goes up and comes back between two moments.

    Args:
        playing: all beats in which play went on, in order.
        leads: points of the first seat less those of the second, at the end of each of these beats.
        width: beats of play that one change may take.
        most: largest number of changes.
    """
    starts = [index for index in range(1, len(playing)) if leads[index] != leads[index - 1]]
    stretches = [(start, min(start + width, len(playing) - 1)) for start in starts]

    def size(stretch: tuple[int, int]) -> float:
        start, end = stretch
        return abs(leads[end - 1] - leads[start - 1])

    chosen: list[tuple[int, int]] = []
    for one in sorted(stretches, key=size, reverse=True):
        apart = all(one[0] >= other[1] or one[1] <= other[0] for other in chosen)
        if len(chosen) < most and apart and size(one) > 0:
            chosen.append(one)
    return sorted({playing[index] for stretch in chosen for index in stretch})


def between(playing: Sequence[int], told: Sequence[int], swing: Swing, least: int) -> int | None:
    """Return the moment to add in a swing, to see what caused it.

    It is just after the event that is nearest to the middle of the stretch; without an event it is
    the middle.

    Args:
        playing: all beats in which play went on, in order.
        told: beats with an event of the game, in order.
        swing: the stretch.
        least: smallest number of beats of play between two moments.

    Returns:
        A beat; None: the stretch is too short.
    """
    inner = [beat for beat in playing if swing.before.beat < beat < swing.after.beat]
    inner = inner[least - 1 : len(inner) - least + 1]
    if not inner:
        return None
    middle = inner[len(inner) // 2]
    after = [beat + 1 for beat in told if inner[0] <= beat + 1 <= inner[-1]]
    return min(after, key=lambda beat: abs(beat - middle), default=middle)


def highlights(moments: Sequence[Moment], most: int = 8, least: float = 0.05) -> list[Swing]:
    """Return the stretches in which the odds changed most, the largest change first.

    Args:
        moments: moments of a match.
        most: largest number of stretches.
        least: smallest change.
    """
    return [swing for swing in swings(moments) if abs(swing.change) >= least][:most]
