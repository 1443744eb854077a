"""Finds what would happen if play went on: a copy of the match is played on another thread."""

from collections.abc import Callable
from concurrent.futures import Future

from lacoc_server.match.match import Match
from lacoc_server.match.outlook import look_ahead
from lacoc_server.world.world import World
from lacoc_shared.messages import Outlook, OutlookRequest, Refusal
from lacoc_shared.words import say

Seen = Outlook | Refusal


class Outlooks:
    """Answers referees who ask for an outlook on the open match.

    Args:
        aside: calls a function on another thread than the beat's.
    """

    def __init__(self, aside: Callable[[Callable[[], Seen]], Future[Seen]]) -> None:
        self._aside = aside
        self._match: Match

    def hold(self, match: Match) -> None:
        """Take note of the court's match, which a referee may ask about."""
        self._match = match

    def __call__(self, request: OutlookRequest) -> Callable[[], Seen | None]:
        """Begin to play a copy of the match; return a function that returns its outlook.

        The function returns None until the copy is played.

        Call this object between two beats: during a beat the state of the match is incomplete.
        """
        setup, folder, saved = self._match.setup, self._match.arena.folder, self._match.save()

        def look() -> Seen:
            try:
                copy = Match(setup, World, folder)
                copy.load(saved)
                return look_ahead(copy, request.decision, request.seconds)
            except Exception as error:  # another package's code; no beat may fail by it
                why = f"{type(error).__name__}: {error!s:.200}"
                return Refusal(say("refused.outlook", why=why))

        future = self._aside(look)
        return lambda: future.result() if future.done() else None
