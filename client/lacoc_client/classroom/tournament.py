"""A friendly tournament of a class's gaits: the runner comes in the next commit."""

from collections.abc import Callable, Mapping
from pathlib import Path

import msgspec

from lacoc_client.seat_files import SeatFiles


class TournamentState(msgspec.Struct, frozen=True, kw_only=True):
    """How a tournament stands."""

    state: str = "none"


class Tournament:
    """A tournament."""

    def __init__(self, folder: Path, tell: Callable[[], None]) -> None:
        self.state = TournamentState()
        self.recordings = folder / "recordings"

    async def play(
        self, players: Mapping[str, SeatFiles], arena: str, rounds: int, seconds: float
    ) -> None:
        """Begin."""
        raise NotImplementedError

    async def stop(self) -> None:
        """End early."""
