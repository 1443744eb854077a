"""A small contest whose games a test calls and ends itself."""

from random import Random
from typing import Any

from chance_event import Event

from lacoc_server.contest.league.facts import Called, Played

NOW_MS = 1_020_000
"""The time at which each of these contests begins: a full minute."""


class Cup(Event):
    """A contest of one stage, "cup", with the teams t001, t002 and so on."""

    def __init__(self, how: str = "round-robin", teams: int = 4, **settings: Any) -> None:
        super().__init__(teams, 2, Random(1))
        self.now_ms = NOW_MS
        self.begin("cup", how, self.names, **settings)

    def call(self, pairing: str, court: str, teams: tuple[str, str], game: int = 1) -> str:
        """Call a game to a court, and return the id of the call."""
        return self.add(Called, pairing=pairing, game=game, teams=teams, court=court).id

    def won(self, pairing: str, teams: tuple[str, str], game: int = 1) -> None:
        """Let the left team win a game."""
        self.add(Played, pairing=pairing, game=game, teams=teams, scores=(3, 1), outcome="left")
