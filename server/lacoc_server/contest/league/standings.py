"""Ranks teams by the results of matches, and equal teams by a list of tie-break codes."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import msgspec

from lacoc_server.contest.league.matches import NOBODY, ContestMatch
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

WIN, DRAW = 2, 1
"""Points of a match; a bye and a walkover count as a win."""


class Counted(NamedTuple):
    """A match that counts for standings."""

    teams: tuple[str, ...]
    """The teams that met; a single team if it had a bye, or if it and its opponent stayed away."""
    scores: tuple[int, ...]
    """Points in all games of the match, by team."""
    winner: int | None
    """Index of the winner in `teams`; None: a draw. An index outside `teams`: all have lost."""
    played: bool = True
    """False: a bye or a walkover."""


class Standing(msgspec.Struct, frozen=True, kw_only=True):
    """The row of one team in a table."""

    team: str
    rank: int
    """The team's rank, from 1. Tied teams share a rank, and so do teams that went out of a knockout
    in the same round. The next ranks are then left out."""
    won: int = 0
    drawn: int = 0
    lost: int = 0
    points: int = 0
    """The team's points: 2 for a match won, 1 for a draw."""
    scored: int = 0
    """Points that the team scored in all its games."""
    conceded: int = 0
    """Points that the team's opponents scored in its games."""
    tie_breaks: tuple[int, ...] = ()
    """Values of the tie-breaks in the order of the table's codes."""
    decided_by: str = ""
    """The code that ranks the team below the one above it. "seed": all codes left them equal, and
    the seeding says only who is listed first. In a knockout: how the level match of these two was
    decided. "": there is no team above, or no code compared them."""
    shares: bool = False
    """True: it shares its rank with another team, because all codes left them equal."""
    out: bool = False
    """True: the team is disqualified, so it is ranked last."""


class Table(msgspec.Struct, frozen=True, kw_only=True):
    """The standings of a stage or of one of its groups."""

    section: str
    tie_breaks: tuple[str, ...]
    """Codes in the order in which they rank."""
    rows: tuple[Standing, ...]
    """A row for each team, the best first."""


class _Tally:
    """Numbers of each team, counted from the matches: points, matches won, and so on."""

    def __init__(self, teams: Sequence[str], matches: Iterable[Counted]) -> None:
        self.seed = {team: place for place, team in enumerate(teams)}
        self.matches: dict[str, list[tuple[str, int, bool]]] = {team: [] for team in teams}
        """By team, for each of its matches: the opponent (NOBODY after a bye), the points (2, 1 or
        0), and whether it was played."""
        self.won, self.drawn, self.lost = (dict.fromkeys(teams, 0) for _ in range(3))
        self.scored, self.conceded = (dict.fromkeys(teams, 0) for _ in range(2))
        for match in matches:
            self._count(match)
        self.points = {team: WIN * self.won[team] + DRAW * self.drawn[team] for team in teams}

    def _count(self, match: Counted) -> None:
        for seat, team in enumerate(match.teams):
            count = (
                self.drawn
                if match.winner is None
                else self.won
                if match.winner == seat
                else self.lost
            )
            count[team] += 1
            self.scored[team] += match.scores[seat]
            self.conceded[team] += sum(match.scores) - match.scores[seat]
            points = DRAW if match.winner is None else WIN if match.winner == seat else 0
            others = [other for other in match.teams if other != team]
            self.matches[team].append(
                (others[0] if len(others) == 1 else NOBODY, points, match.played)
            )

    def opponents(self, team: str) -> list[int]:
        """Return each opponent's points; for a match that was not played, the team's own points."""
        return [
            self.points[other] if played and other else self.points[team]
            for other, _, played in self.matches[team]
        ]

    def sonneborn(self, team: str) -> int:
        """Sum up the opponents' points: doubled if the team beat the opponent, once if it drew."""
        pairs = zip(self.opponents(team), self.matches[team], strict=True)
        return sum(strength * points for strength, (_, points, _) in pairs)

    def direct(self, team: str, tied: Collection[str]) -> int:
        """Return a team's points in matches against tied teams; 0 if some of them have not met."""
        for one in tied:
            if not {other for other, _, _ in self.matches[one]} >= {*tied} - {one}:
                return 0
        return sum(points for other, points, _ in self.matches[team] if other in tied)


TIE_BREAKS: Mapping[str, Callable[[_Tally, str, Collection[str]], int]] = {
    "points": lambda tally, team, tied: tally.points[team],
    "wins": lambda tally, team, tied: tally.won[team],
    "fewest-lost": lambda tally, team, tied: -tally.lost[team],
    "direct": lambda tally, team, tied: tally.direct(team, tied),
    "difference": lambda tally, team, tied: tally.scored[team] - tally.conceded[team],
    "scored": lambda tally, team, tied: tally.scored[team],
    "buchholz": lambda tally, team, tied: sum(tally.opponents(team)),
    "buchholz-cut": lambda tally, team, tied: sum(sorted(tally.opponents(team))[1:]),
    "sonneborn": lambda tally, team, tied: tally.sonneborn(team),
    "seed": lambda tally, team, tied: -tally.seed[team],
}
"""The published tie-breaks by code (docs/contest.md); the larger value is the better one."""


def standings(
    teams: Sequence[str],
    matches: Iterable[Counted],
    order: Sequence[str],
    last: Collection[str] = (),
    section: str = "",
) -> Table:
    """Count who won, drew and lost, and rank the teams.

    Args:
        teams: the teams by seeding; the seeding orders teams that all codes leave equal.
        matches: matches that count, in any order.
        order: codes of `TIE_BREAKS` in the order in which they are asked; a later code orders only
            those whom all earlier codes left equal.
        last: teams that are ranked below all others.
        section: names the table.

    Raises:
        UserError: if a code is unknown.
    """
    codes = (*order, "seed") if "seed" not in order else tuple(order)
    if unknown := [code for code in codes if code not in TIE_BREAKS]:
        raise UserError(say("league.unknown-tie-break", code=unknown[0], known=[*TIE_BREAKS]))
    tally = _Tally(teams, matches)
    values: dict[str, list[int]] = {team: [] for team in teams}
    groups = [[team for team in teams if (team in last) is out] for out in (False, True)]
    for code in codes:
        groups = [part for group in groups for part in _split(group, code, tally, values)]
    ranked = [team for group in groups for team in group]
    deciders = [
        _decider(codes, values.get(above, ()), values[team])
        if (team in last) is (above in last)
        else ""
        for above, team in pairwise(["", *ranked])
    ]
    ranks: list[int] = []
    for place, decider in enumerate(deciders, 1):
        ranks.append(ranks[-1] if decider == "seed" else place)
    return Table(
        section=section,
        tie_breaks=codes,
        rows=tuple(
            Standing(
                team=team,
                rank=rank,
                won=tally.won[team],
                drawn=tally.drawn[team],
                lost=tally.lost[team],
                points=tally.points[team],
                scored=tally.scored[team],
                conceded=tally.conceded[team],
                tie_breaks=tuple(values[team]),
                decided_by=decider,
                shares=ranks.count(rank) > 1,
                out=team in last,
            )
            for team, rank, decider in zip(ranked, ranks, deciders, strict=True)
        ),
    )


def _decider(codes: Sequence[str], above: Sequence[int], below: Sequence[int]) -> str:
    """Return the first code whose values for two teams differ; "": no code tells them apart."""
    values = zip(codes, above, below, strict=False)
    return next((code for code, one, other in values if one != other), "")


def _split(
    group: Sequence[str], code: str, tally: _Tally, values: dict[str, list[int]]
) -> list[list[str]]:
    """Split a group of equal teams by one more tie-break; add each team's value to `values`."""
    value = {team: TIE_BREAKS[code](tally, team, group) for team in group}
    for team in group:
        values[team].append(value[team])
    return [
        [team for team in group if value[team] == one]
        for one in sorted({*value.values()}, reverse=True)
    ]


def counted(matches: Iterable[ContestMatch]) -> list[Counted]:
    """Return the matches that count for standings: the decided ones that are not void."""
    return [line for match in matches for line in _counted(match)]


def _counted(match: ContestMatch) -> list[Counted]:
    if match.state != "decided" or match.how == "void":
        return []
    teams = tuple(team for team in match.teams if team)
    if match.how == "bye":
        return [Counted(teams, (0,), 0, played=False)] if teams else []
    if match.how == "walkover":
        winner = teams.index(match.winner) if match.winner else None
        if winner is None:  # both stayed away, and both lost
            return [Counted((team,), (0,), 1, played=False) for team in teams]
        return [Counted(teams, match.scores, winner, played=False)]
    winner = teams.index(match.winner) if match.winner else None
    return [Counted(teams, match.scores, winner)]
