"""Round robin: everybody of a group meets everybody."""

from collections.abc import Collection, Iterator, Mapping

from lacoc_server.contest.league.formats.format import DrawnAtOnce, Stage
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.pairing import Entrant, Pairing
from lacoc_server.contest.league.standings import Table, counted, standings

ORDER = ("points", "direct", "difference", "scored", "wins", "seed")


class RoundRobin(DrawnAtOnce):
    """Groups in which everybody meets everybody, by the circle method."""

    settings = frozenset({"games", "groups", "rounds", "tie_breaks"})
    decisive = False
    balanced = False

    def pairings(self, stage: Stage) -> tuple[Pairing, ...]:
        """Return the pairings of all groups, round by round."""
        found = [
            Pairing(
                id=stage.id(section, number, order),
                section=section,
                round=number,
                sources=(Entrant(teams[left]), Entrant(teams[right])),
            )
            for section, teams in groups(stage).items()
            for number in range(1, _rounds(stage, len(teams)) + 1)
            for order, (left, right) in enumerate(circle_round(len(teams), number - 1), 1)
        ]
        return tuple(sorted(found, key=lambda pairing: pairing.round))

    def tables(
        self, stage: Stage, matches: Mapping[str, ContestMatch], last: Collection[str]
    ) -> tuple[Table, ...]:
        """Rank the teams of each group."""
        return tuple(
            standings(
                teams,
                counted(match for match in matches.values() if match.pairing.section == section),
                stage.order(ORDER),
                last,
                section,
            )
            for section, teams in groups(stage).items()
        )


def groups(stage: Stage) -> dict[str, tuple[str, ...]]:
    """Deal the teams into groups "a", "b", ... in snake order: 1 2 3, 6 5 4, 7 8 9.

    There are fewer groups than planned if one would have less than two teams.
    """
    number = max(1, min(stage.settings.groups, len(stage.entries) // 2))
    dealt: list[list[str]] = [[] for _ in range(number)]
    for place, team in enumerate(stage.entries):
        lap, at = divmod(place, number)
        dealt[number - 1 - at if lap % 2 else at].append(team)
    return {_letters(at): tuple(teams) for at, teams in enumerate(dealt)}


def _letters(number: int) -> str:
    """Name a group: a to z, then aa, ab, ..."""
    rest, last = divmod(number, 26)
    return (_letters(rest - 1) if rest else "") + "abcdefghijklmnopqrstuvwxyz"[last]


def _rounds(stage: Stage, teams: int) -> int:
    return stage.settings.rounds or teams - 1 + teams % 2


def circle_round(players: int, number: int) -> Iterator[tuple[int, int]]:
    """Yield the matches of a round of the circle method: the left player and the right one.

    With an odd number of players one of them rests in each round, and they take turns. When
    everybody has met everybody, the rounds come again in reverse order with seats swapped. So after
    any number of rounds, each player's numbers of matches in the two seats differ by at most one.

    The players sit on a circle; if their number is even, the last one sits outside. In each round
    another player on the circle is the pivot. Two players at the same distance from the pivot meet.
    The pivot meets the player outside, or rests. The seats depend on the distance and on the side
    of the pivot. So a player changes the seat in each round, except as pivot. The pivot takes the
    left seat if the round's number is even, else the right one.

    Args:
        players: number of players; fewer than two have no match.
        number: number of the round, from 0.
    """
    if players < 2:
        return
    circle = players - 1 + players % 2  # odd; after so many rounds everybody has met everybody
    lap, pivot = divmod(number, circle)
    if lap % 2:
        pivot = circle - 1 - pivot
    for distance in range(1, circle // 2 + 1):
        after, before = (pivot + distance) % circle, (pivot - distance) % circle
        yield (after, before) if (distance + lap) % 2 else (before, after)
    if circle < players:
        yield (pivot, circle) if (pivot + lap) % 2 == 0 else (circle, pivot)


FORMAT = RoundRobin()
