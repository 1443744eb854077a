"""Decides which beats of a match a film shows, picture by picture."""

from collections.abc import Iterable
from dataclasses import dataclass

from lacoc_client.film.moments import Moment
from lacoc_shared.seat import BEATS_PER_S

RUN_UP_BEATS = 4 * BEATS_PER_S
"""How long before a moment its shot begins [beats]."""
AFTER_BEATS = 3 * BEATS_PER_S
"""How long after a moment its shot ends [beats]."""
OPENING_BEATS = 2 * BEATS_PER_S
"""How long the card with the teams is shown in a reel [beats]."""
END_BEATS = 4 * BEATS_PER_S
"""How long the end of the match is shown, after the moments [beats]."""


@dataclass(frozen=True)
class Shot:
    """A part of a match that is shown without a cut: from a beat to another, both included."""

    first: int
    last: int


@dataclass(frozen=True)
class Picture:
    """One picture of a film."""

    beat: float
    """Beat of the match; a number that is not whole lies between two beats."""
    cut: bool
    """Whether this picture begins a new shot."""


def whole(first: int, last: int) -> list[Shot]:
    """Return one shot that shows a whole match.

    Args:
        first: beat at which a replay begins.
        last: beat at which it ends.
    """
    return [Shot(first, last)]


def highlights(
    moments: Iterable[Moment], first: int, last: int, *, opening: int | None = None
) -> list[Shot]:
    """Return the shots of some moments, and of the end of the match, in the order of time.

    Shots that touch or overlap become one.

    Args:
        moments: the moments to show, in any order; a moment outside of the match is left out.
        first: beat at which a replay begins.
        last: beat at which it ends.
        opening: the beat from which the card with the teams is shown too; None: it is not.
    """
    wanted = [
        Shot(max(first, moment.beat - RUN_UP_BEATS), min(last, moment.beat + AFTER_BEATS))
        for moment in moments
        if first <= moment.beat <= last
    ]
    if opening is not None:
        begin = min(max(first, opening), last)
        wanted.append(Shot(begin, min(last, begin + OPENING_BEATS)))
    wanted.append(Shot(max(first, last - END_BEATS), last))
    joined: list[Shot] = []
    for shot in sorted(wanted, key=lambda shot: shot.first):
        if joined and shot.first <= joined[-1].last + 1:
            joined[-1] = Shot(joined[-1].first, max(joined[-1].last, shot.last))
        else:
            joined.append(shot)
    return joined


def pictures(shots: Iterable[Shot], fps: int) -> list[Picture]:
    """Return the pictures of a film that shows these shots.

    A shot has a picture at its first beat, and then one each 1/`fps` seconds up to its last beat.

    Args:
        shots: in the order in which they are shown.
        fps: pictures a second.
    """
    found: list[Picture] = []
    for shot in shots:
        count = (shot.last - shot.first) * fps // BEATS_PER_S + 1
        found += [
            Picture(shot.first + index * BEATS_PER_S / fps, index == 0) for index in range(count)
        ]
    return found
