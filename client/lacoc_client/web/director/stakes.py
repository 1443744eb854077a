"""How important a match is, by its place in the contest. Pure."""

from lacoc_shared.words import Phrase

USUAL = 1.0
"""Weight of a match whose place in the contest is not known."""

_WEIGHTS = {
    "fixture.deciding-final": 3.0,
    "fixture.final": 3.0,
    "fixture.semi-final": 2.0,
    "fixture.third-place": 1.5,
    "fixture.quarter-final": 1.5,
    "fixture.knockout": 1.25,
    "fixture.losers": 1.25,
}
"""Weights by the code of the match's name (`fixture.*`); all other matches have the usual
weight."""

_LAST_GAME = 1.25
"""Factor for the last game that a match can have: it often decides the match."""


def stake(fixture: Phrase | None) -> float:
    """Return how important a match is in its contest, as a weight.

    Args:
        fixture: the name of the match in its contest (`fixture.*`); None: it is in no contest.

    Returns:
        `USUAL` or more.
    """
    if fixture is None:
        return USUAL
    if fixture.code == "fixture.game":
        match = fixture.values.get("match")
        games = fixture.values.get("games")
        last = games is not None and fixture.values.get("game") == games
        return stake(match if isinstance(match, Phrase) else None) * (_LAST_GAME if last else 1)
    return _WEIGHTS.get(fixture.code, USUAL)
