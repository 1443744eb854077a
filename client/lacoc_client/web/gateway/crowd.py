"""Counts how many pages watch and with which symbols they cheer, without names."""

import asyncio
from collections import Counter, deque

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.audience import Audience
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.wire import MessageKind

SYMBOLS = 4
"""Number of symbols for cheers; the page draws the symbols."""
CHEERS_HZ = 1.0
"""How many cheers of a page count in a second."""
LOOKS_S = 10
"""A page that fetches a match in pieces reports this often that it is there [s]. Of a very large
crowd only a share of the pages reports."""
HEARD_MOST = 200
"""How many reports of pages are wanted in `LOOKS_S`: in a larger crowd only a share of the pages
reports."""
_LEAST_SHARE = 1e-4
"""The smallest share that is asked: pages that report all the same, however many, can't make the
estimates grow without end."""
_SAYS_S = 1.0
_SAYS_AGAIN = 5


class Crowd:
    """Counts the people who watch, and their cheers; used from the event loop only.

    Args:
        courts: the courts of the gateway.
    """

    def __init__(self, courts: Courts) -> None:
        self._courts = courts
        self._cheers: dict[Audience, Counter[int]] = {}
        self._told: dict[Audience, bytes] = {}
        self._heard: deque[float] = deque([0.0] * LOOKS_S, LOOKS_S)
        """For each of the last seconds: how many pages the reports of that second stand for."""
        self.share = 1.0
        """Which share of the pages that fetch pieces is asked to report, 0 to 1."""

    def cheer(self, audience: Audience, symbol: int, count: float = 1) -> None:
        """Count a cheer from a page that watches a court, unless cheers are switched off."""
        if self._courts.home.cheers and 0 <= symbol < SYMBOLS:
            self._cheers.setdefault(audience, Counter())[symbol] += round(count)

    def hear(self, audience: Audience, cheers: list[int]) -> None:
        """Count the report of a page that watches the match in pieces.

        The report also stands for pages that were not asked to report.

        Args:
            audience: the pages that watch the same court.
            cheers: for each symbol, how often the page cheered since its last report.
        """
        self._heard[-1] += 1 / self.share
        for symbol, count in enumerate(cheers):
            if count > 0:
                self.cheer(audience, symbol, min(count, CHEERS_HZ * LOOKS_S) / self.share)

    def watching(self) -> int:
        """Return how many pages watch; those that fetch pieces are estimated from their reports."""
        return self._courts.watching() + round(sum(self._heard))

    async def tell(self) -> None:
        """Tell the pages how many watch and cheer: each second if it has changed, else each fifth.

        Runs until it is cancelled. A page that is too slow is not told.
        """
        seconds = 0
        while True:
            await asyncio.sleep(_SAYS_S)
            seconds += 1
            watching = self.watching()
            for feed in self._courts.feeds:
                for audience in self._courts.audiences(feed):
                    self.say(audience, watching, again=seconds % _SAYS_AGAIN == 0)
            self.pass_second()

    def say(self, audience: Audience, watching: int, *, again: bool = False) -> None:
        """Tell some pages how often each symbol came in this second, and how many pages watch.

        Args:
            audience: the pages.
            watching: how many watch the event.
            again: whether to send the message even if nothing has changed.
        """
        cheers = self._cheers.get(audience, Counter[int]())
        body = {"watching": watching, "cheers": [cheers[one] for one in range(SYMBOLS)]}
        message = wire.map_message(MessageKind.CROWD, body)
        if again or cheers or message != self._told.get(audience):
            self._told[audience] = message
            audience.tell(message)

    def pass_second(self) -> None:
        """Forget the cheers of this second, and compute the share of pages that should report."""
        self._cheers.clear()
        wanted = HEARD_MOST / max(1.0, sum(self._heard))
        self.share = min(1.0, max(_LEAST_SHARE, wanted))
        self._heard.append(0.0)
