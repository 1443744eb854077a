"""Swiss: teams with equal points meet, and nobody meets twice where it can be avoided.

Rounds are drawn one by one (`facts.RoundDrawn`), so a later correction changes points but not who
has met. The pairs are those of the FIDE (Dutch) system, with one rule that is stricter: a team that
sat on one side once more than on the other must change. If the system finds no pairing, or the
stage is too large for its engine, a matching algorithm breaks as few rules as possible.
"""

import logging
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence

import msgspec
import networkx
from caissify_pairings.engines.dutch import DutchEngine

from lacoc_server.contest.league.formats.format import DrawnByRound, Pair, Stage
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.standings import DRAW, WIN, counted

# The engine warns when it must break a rule; then the matching takes over, and nothing is wrong.
logging.getLogger("caissify_pairings").setLevel(logging.CRITICAL)

ORDER = ("points", "buchholz-cut", "buchholz", "sonneborn", "direct", "difference", "seed")

LARGEST = 60
"""Largest number of teams that the engine pairs: 60 teams take a second, 200 some minutes."""


class SwissTeam(msgspec.Struct, kw_only=True):
    """What the pairing of the next round must know of a team."""

    team: str
    number: int
    """The team's place in the seeding, from 1."""
    points: int = 0
    """The team's points so far: 2 for a match won, 1 for a draw."""
    met: set[str] = msgspec.field(default_factory=set)
    sides: list[int] = msgspec.field(default_factory=list)
    """For each match with a game: 1 if it sat left, −1 if right."""
    floats: list[str] = msgspec.field(default_factory=list)
    """For each round: "down" if the opponent had fewer points or there was none, "up" if more, else
    "none"."""
    had_bye: bool = False

    @property
    def balance(self) -> int:
        """How many times more it sat left than right."""
        return sum(self.sides)


class Swiss(DrawnByRound):
    """Pairs teams with equal points, round by round; nobody meets twice where it can be avoided."""

    settings = frozenset({"games", "rounds", "tie_breaks"})
    decisive = False
    balanced = False
    order = ORDER

    def rounds(self, stage: Stage) -> int:
        """Return the number of rounds: the stage's setting `rounds`, or, if it is 0, a knockout's.

        A knockout of n teams has as many rounds as the logarithm of n to the base 2, rounded up.
        """
        return stage.settings.rounds or max(1, (len(stage.entries) - 1).bit_length())

    def next_round(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> tuple[Pair, ...]:
        """Pair the teams for the next round, without those that have left the contest (`gone`)."""
        players = [one for one in history(stage, matches) if one.team not in gone]
        return tuple(
            (pair[0].team,) if len(pair) == 1 else seat_pair(pair[0], pair[1])
            for pair in paired(players, len(stage.drawn) + 1)
        )


def history(stage: Stage, matches: Mapping[str, ContestMatch]) -> list[SwissTeam]:
    """Return the teams, each with its points, opponents, sides and byes in the drawn rounds.

    They are in the order of the seeding.
    """
    players = {
        team: SwissTeam(team=team, number=number) for number, team in enumerate(stage.entries, 1)
    }
    for number, pairs in enumerate(stage.drawn, 1):
        before = {team: player.points for team, player in players.items()}
        for order, pair in enumerate(pairs, 1):
            match = matches[stage.id("r", number, order)]
            for side, team in zip((1, -1), pair, strict=False):
                player = players[team]
                others = [other for other in pair if other != team]
                _add(player, side, others, match)
                player.floats.append(_float(before, team, others))
        for player in players.values():  # who is not paired falls, as with a bye
            if len(player.floats) < number:
                player.floats.append("down")
    return [*players.values()]


def _add(player: SwissTeam, side: int, others: Sequence[str], match: ContestMatch) -> None:
    """Add a past match to a player's opponents, sides, points and byes.

    A match without a game adds no side.
    """
    player.met.update(others)
    if match.games:
        player.sides.append(side)
    for line in counted([match]):
        if player.team in line.teams:
            won = line.winner is not None and line.teams[line.winner : line.winner + 1] == (
                player.team,
            )
            player.points += DRAW if line.winner is None else WIN if won else 0
            player.had_bye |= won and not line.played


def _float(before: Mapping[str, int], team: str, others: Sequence[str]) -> str:
    if not others or before[team] > before[others[0]]:
        return "down"
    return "up" if before[team] < before[others[0]] else "none"


def seat_pair(one: SwissTeam, other: SwissTeam) -> tuple[str, str]:
    """Seat a pair; return who sits left, then who sits right.

    The team with the smaller `balance` sits left. If both are equal, the team that sat right in its
    last match sits left. If both sat on the same side, the team that is higher in the seeding sits
    left if its place in the seeding is odd, else right.
    """
    first, second = sorted((one, other), key=lambda player: player.number)
    if first.number % 2 == 0:
        first, second = second, first
    keys = [(player.balance, player.sides[-1:]) for player in (first, second)]
    return (second.team, first.team) if keys[1] < keys[0] else (first.team, second.team)


def paired(players: Sequence[SwissTeam], round_number: int) -> list[tuple[SwissTeam, ...]]:
    """Pair the players of a round; with an odd number one has a bye.

    The engine (`dutch`) pairs them, unless there are too many players for it or the rules can't
    all be kept. Then the pairs break as few rules as possible.

    Returns:
        The pairs, the one with the most points first; a bye last.
    """
    if not players:
        return []
    found = fewest_faults(players)
    # Where the rules can't all be kept, the engine would try all pairings, for minutes or longer.
    if len(players) <= LARGEST and _legal(found, players):
        by_system = dutch(players, round_number)
        found = by_system if _legal(by_system, players) else found
    return sorted(
        found,
        key=lambda pair: (
            len(pair) == 1,
            -max(one.points for one in pair),
            -sum(one.points for one in pair),
            min(one.number for one in pair),
        ),
    )


def dutch(players: Sequence[SwissTeam], round_number: int) -> list[tuple[SwissTeam, ...]]:
    """Pair the players of a round by the FIDE (Dutch) system."""
    by_number = {player.number: player for player in players}
    numbers = {player.team: player.number for player in players}
    engine = DutchEngine(
        players=[
            {
                "id": player.number,
                "name": player.team,
                "score": player.points / WIN,
                "rating": 0,
                "starting_number": player.number,
                "color_hist": _colours(player),
                "float_history": player.floats,
                "bye_count": int(player.had_bye),
            }
            for player in players
        ],
        previous_pairings={
            (player.number, numbers[other])
            for player in players
            for other in player.met
            if other in numbers and player.number < numbers[other]
        },
        round_number=round_number,
        total_rounds=round_number + 2,  # no round is the last: there are no exceptions for its top
    )
    return [
        tuple(by_number[line[side]] for side in ("white_id", "black_id") if line[side] is not None)
        for line in engine.generate_pairings()
    ]


def _colours(player: SwissTeam) -> list[str]:
    """Return colours (sides) of past games that make the engine give a team the side it is due.

    The engine forces a change only after the same colour twice. Here a team must change as soon as
    it has sat more often on one side than on the other. So the engine is told that the team had
    that side's colour in its last two games. If both counts are equal, it is told one of each, the
    last side last.
    """
    if not player.sides:
        return []
    if player.balance == 0:
        return ["black", "white"] if player.sides[-1] > 0 else ["white", "black"]
    due_right = player.balance > 0
    return ["white", "white"] if due_right else ["black", "black"]


def _legal(pairs: Iterable[tuple[SwissTeam, ...]], players: Sequence[SwissTeam]) -> bool:
    """Return whether everybody is paired once, and no pair has one of the faults of `faults`."""
    found = list(pairs)
    everybody = sorted(player.number for pair in found for player in pair)
    byes = sum(len(pair) == 1 for pair in found)
    return (
        everybody == sorted(player.number for player in players)
        and byes == len(players) % 2
        and not any(any(faults(pair)) for pair in found)
    )


def faults(pair: Sequence[SwissTeam]) -> tuple[int, int, int]:
    """Count what is wrong with a pair: met before; a second bye; both teams need the same side."""
    if len(pair) == 1:
        return 0, int(pair[0].had_bye), 0
    one, other = pair
    both_due = one.balance * other.balance > 0
    return int(other.team in one.met), 0, int(both_due)


def fewest_faults(players: Sequence[SwissTeam]) -> list[tuple[SwissTeam, ...]]:
    """Pair so that as few rules as possible are broken.

    First as few pairs as possible have met before; then as few teams as possible get a second bye;
    then in as few pairs as possible both teams are due the same side. Among such pairings, choose
    one in which opponents differ least in points; and among teams with equal points, let the upper
    half meet the lower half.
    """
    ordered = sorted(players, key=lambda player: (-player.points, player.number))
    equals = Counter(player.points for player in players)
    graph = networkx.Graph()
    many = len(players) + 1
    for at, one in enumerate(ordered):
        if len(players) % 2:
            graph.add_edge(at, len(ordered), weight=-_cost((one,), one.points, 0, many))
        for to in range(at + 1, len(ordered)):
            other = ordered[to]
            apart = one.points - other.points
            fold = 0 if apart else abs(to - at - equals[one.points] // 2)
            graph.add_edge(at, to, weight=-_cost((one, other), apart, fold, many))
    matching = networkx.max_weight_matching(graph, maxcardinality=True)
    return [
        tuple(ordered[place] for place in sorted(pair) if place < len(ordered)) for pair in matching
    ]


def _cost(pair: Sequence[SwissTeam], apart: int, fold: int, many: int) -> int:
    """Return the cost of a pair; a graver fault costs more than lesser faults in all other pairs.

    The gravest are those that `faults` counts, in its order. Then comes `apart`, then `fold`.

    Args:
        pair: the pair.
        apart: difference of the points of its two teams.
        fold: for two teams with equal points, by how many places their distance differs from half
            the number of all teams with these points; else 0.
        many: more than the number of teams.
    """
    again, bye, side = faults(pair)
    most = 4 * many**2  # of points in a stage with more rounds than teams
    serious = (again * many + bye) * many + side
    return (serious * many * most**2 + apart**2) * many**2 + fold


FORMAT = Swiss()
