"""The courts of a gateway, and who finds room at them."""

import asyncio

from lacoc_client.gateway import wire
from lacoc_client.gateway.feed import CourtFeed
from lacoc_client.gateway.home import ACTING_MOST, Home
from lacoc_client.gateway.referees import Referees
from lacoc_client.gateway.threads import Threads
from lacoc_client.gateway.viewer import Viewer
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, say

_THREADS = 16
_FILES_S = 0.5
_STRANGERS = 4
"""A wrong token holds one for 2 s at a court with keys; no decision and no fetch waits for it."""


class Courts:
    """The feeds of a gateway's courts and who referees there; made when first asked for.

    Args:
        home: the gateway's settings.
    """

    def __init__(self, home: Home) -> None:
        self.home = home
        self.threads = Threads(_THREADS)
        """Where courts are asked."""
        self.strangers = Threads(_STRANGERS)
        """Where tokens are shown that no court has taken yet."""
        self._feeds: dict[str, tuple[CourtFeed, Referees]] = {}
        self.sent_away = 0
        """Pages that were too many."""

    def find(self, name: str | None) -> tuple[CourtFeed, Referees]:
        """A court's feed, listening; without a name that of the first court.

        Raises:
            UserError: if this gateway has no such court.
        """
        courts = self.home.courts
        name = name or next(iter(courts))
        if name not in courts:
            raise UserError(say("gateway.no-court", court=name, courts=list(courts)))
        if name not in self._feeds:
            feed = CourtFeed(courts[name], self.threads)
            self._feeds[name] = (feed, Referees())
            feed.start()
        return self._feeds[name]

    @property
    def feeds(self) -> list[CourtFeed]:
        """The feeds of all courts that were asked for; may be asked from any thread."""
        return [feed for feed, _ in list(self._feeds.values())]

    def over(self) -> list[str]:
        """List the matches that are over and still on at their courts; any thread may ask."""
        pictures = [feed.picture for feed in self.feeds]
        ended = (Phase.OFFICIAL, Phase.VOID)
        return [picture.view.match_id for picture in pictures if picture.phase in ended]

    def why_full(self, viewer: Viewer) -> Phrase | None:
        """Say why there is no room for a page; None if there is.

        Who can act has the key: a hall of spectators, or whoever opens as many pages without it,
        takes no place from them.
        """
        acts = viewer.can_act
        most = ACTING_MOST if acts else self.home.viewers_most
        if sum(feed.audience.others(viewer) for feed in self.feeds) < most:
            return None
        if acts:
            return say("gateway.full-with-key", most=most)
        return say("gateway.full", most=most)

    async def watch_files(self) -> None:
        """Tell the pages that may act when the files on this machine were saved again."""
        own = self.home.prefill.files if self.home.prefill is not None else None
        while own is not None:
            await asyncio.sleep(_FILES_S)
            if await asyncio.to_thread(own.look):
                for feed in self.feeds:
                    feed.audience.send_acting(wire.files_message(own))

    async def close(self) -> None:
        """Close all connections."""
        await asyncio.gather(*(feed.stop() for feed, _ in self._feeds.values()))
        self.threads.close()
        self.strangers.close()
