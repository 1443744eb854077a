"""A bracket as a table: each pairing with the sources of its teams and what is known of them."""

from collections.abc import Iterable

import msgspec

from lacoc_server.contest.league.matches import How, Match, State, Team
from lacoc_server.contest.league.pairing import AnySource


class Line(msgspec.Struct, frozen=True, kw_only=True):
    """A place of a pairing."""

    source: AnySource
    team: Team
    """None: not known yet; "": nobody."""
    games_won: int
    score: int
    """Points in all games."""
    won: bool


class Box(msgspec.Struct, frozen=True, kw_only=True):
    """A pairing of the bracket."""

    pairing: str
    section: str
    round: int
    lines: tuple[Line, ...]
    state: State
    how: How


def bracket(matches: Iterable[Match]) -> tuple[Box, ...]:
    """Return the table of a stage, without pairings that are byes from the beginning."""
    return tuple(
        Box(
            pairing=match.pairing.id,
            section=match.pairing.section,
            round=match.pairing.round,
            lines=tuple(
                Line(
                    source=source,
                    team=team,
                    games_won=sum(bool(team) and game.winner == team for game in match.games),
                    score=score,
                    won=bool(team) and match.winner == team,
                )
                for source, team, score in zip(
                    match.pairing.sources, match.teams, match.scores, strict=True
                )
            ),
            state=match.state,
            how=match.how,
        )
        for match in matches
        if match.how != "bye"
    )
