"""Sequential: everybody meets everybody again and again, until the first places are decided.

In a lap everybody meets everybody once. After each lap a test says whether the teams at the first
places are stronger than the next ones, with the chosen confidence. If they are, or if the largest
number of laps is played, the stage is over. So a clear order needs few games, and a close one many.
"""

import math
from collections.abc import Collection, Iterable, Mapping
from itertools import pairwise
from statistics import NormalDist, fmean, pvariance

from lacoc_server.contest.league.formats.format import DrawnByRound, Pair, Stage
from lacoc_server.contest.league.formats.round_robin import ORDER, circle_round
from lacoc_server.contest.league.matches import ContestMatch, CountedGame

_LAPS = 10
"""How many laps are played at most, if the plan gives no number of rounds."""


class Sequential(DrawnByRound):
    """Lets everybody meet everybody again and again, until the first places are decided."""

    settings = frozenset({"confidence", "games", "places", "rounds", "tie_breaks"})
    decisive = False
    balanced = False
    order = ORDER

    def rounds(self, stage: Stage) -> int:
        """Return the largest number of rounds that the stage can have; 0 if no team is left."""
        return (stage.settings.rounds or _LAPS * _lap(stage)) if stage.entries else 0

    def is_decided(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> bool:
        """Return whether a lap has just ended, and the first places are decided.

        The test is made after each lap and for each place, and any of these tests could be wrong.
        So the allowed probability of an error is divided by their number (Bonferroni).
        """
        drawn, lap, places = len(stage.drawn), _lap(stage), stage.settings.places
        if not drawn or drawn % lap:
            return False
        (table,) = self.tables(stage, matches, gone)
        here = [row.team for row in table.rows if row.team not in gone][: places + 1]
        games = [game for match in matches.values() for game in match.games]
        looks = max(1, self.rounds(stage) // lap)
        least = NormalDist().inv_cdf(1 - (1 - stage.settings.confidence) / (looks * places))
        return all(lead(games, one, other) > least for one, other in pairwise(here))

    def next_round(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> tuple[Pair, ...]:
        """Pair the next round, by the circle method.

        A team rests if its opponent has left the contest.
        """
        teams = stage.entries
        pairs = [
            (teams[left], teams[right])
            for left, right in circle_round(len(teams), len(stage.drawn))
        ]
        return tuple(pair for pair in pairs if not {*pair} & {*gone})


def lead(games: Iterable[CountedGame], one: str, other: str) -> float:
    """Return by how much a team is ahead of another one, in standard deviations (a score test).

    The lead compares what both teams won against each other and against the same opponents. Its
    standard deviation is computed as if both teams were equally strong.

    Args:
        games: all games of the stage; games against opponents of only one of the two do not matter.
        one: the team.
        other: the other team.
    """
    direct: list[float] = []
    against: dict[str, dict[str, list[float]]] = {}
    for game in games:
        for team, opponent in (game.teams, game.teams[::-1]):
            won = 0.5 if not game.winner else float(game.winner == team)
            if (team, opponent) == (one, other):
                direct.append(won - 0.5)
            elif team in (one, other) and opponent not in (one, other):
                against.setdefault(opponent, {one: [], other: []})[team].append(won)
    ahead, variance = math.fsum(direct), math.fsum(won**2 for won in direct)
    for results in against.values():
        mine, theirs = results[one], results[other]
        if not mine or not theirs:
            continue
        both = [*mine, *theirs]
        weight = len(mine) * len(theirs) / len(both)
        ahead += weight * (fmean(mine) - fmean(theirs))
        variance += weight * pvariance(both)
    return ahead / math.sqrt(variance) if variance > 0 else 0.0


def _lap(stage: Stage) -> int:
    """Return the number of rounds in a lap, in which everybody meets everybody once."""
    return len(stage.entries) - 1 + len(stage.entries) % 2


FORMAT = Sequential()
