"""Pairs a Swiss round with py4swiss, to compare its pairs with ours."""

from collections.abc import Sequence

from py4swiss.engines.common import (
    ColorPreference,
    ColorPreferenceSide,
    ColorPreferenceStrength,
    Float,
)
from py4swiss.engines.dutch.bracket import BracketPairer, Brackets
from py4swiss.engines.dutch.engine import Engine
from py4swiss.engines.dutch.player import Player as TheirPlayer
from py4swiss.engines.dutch.validity_matcher import ValidityMatcher
from py4swiss.trf.results import ColorToken

from lacoc_server.contest.league.formats.swiss import SwissTeam

FLOATS = {"down": Float.DOWN, "up": Float.UP, "none": Float.NONE}


def pairs(players: Sequence[SwissTeam], round_number: int) -> set[frozenset[int]] | None:
    """Pair a round by the Dutch system.

    A team that has sat more often on one side must now sit on the other side.

    Returns:
        Each pair as the set of both teams' numbers, and a bye as a set of one number. None if a
        bracket had to collapse: there py4swiss follows rules that ended in January 2026, and our
        engine follows the later rules.
    """
    numbers = {player.team: player.number for player in players}
    theirs = sorted((_their(player, numbers) for player in players), reverse=True)
    valid = ValidityMatcher(theirs, set())
    brackets = Brackets(theirs, round_number)
    found: set[frozenset[int]] = set()
    while not brackets.is_finished():
        bracket = BracketPairer(brackets.get_current_bracket(), valid, ColorToken.WHITE)
        in_bracket = Engine._get_bracket_pairs(bracket)
        if in_bracket is None:
            return None
        brackets.apply_bracket_pairings(in_bracket)
        found |= {frozenset((one.id, other.id)) for one, other in in_bracket}
    return found


def _their(player: SwissTeam, numbers: dict[str, int]) -> TheirPlayer:
    if player.balance:
        strength = ColorPreferenceStrength.ABSOLUTE
    else:
        strength = ColorPreferenceStrength.MILD if player.sides else ColorPreferenceStrength.NONE
    due = player.balance or (player.sides[-1] if player.sides else 0)
    sides = (ColorPreferenceSide.NONE, ColorPreferenceSide.BLACK, ColorPreferenceSide.WHITE)
    floats = [Float.NONE, Float.NONE, *(FLOATS[one] for one in player.floats)]
    return TheirPlayer(
        id=player.number,
        number=player.number,
        points=5 * player.points,
        points_with_acceleration=5 * player.points,
        color_preference=ColorPreference(side=sides[(due > 0) - (due < 0)], strength=strength),
        color_difference=2 * player.balance,
        color_double=player.balance != 0,
        float_1=floats[-1],
        float_2=floats[-2],
        opponents={numbers[other] for other in player.met if other in numbers},
        colors=[],
        bye_received=player.had_bye,
        top_scorer=False,
    )
