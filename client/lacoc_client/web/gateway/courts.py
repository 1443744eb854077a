"""The courts of a gateway, and the limits on how many pages may connect."""

import asyncio
import hmac
from typing import TYPE_CHECKING

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.audience import Audience
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_client.web.gateway.home import ACTING_MOST, CLAIMING_MOST, Home
from lacoc_client.web.gateway.notice import Notice
from lacoc_client.web.gateway.referees import Referees
from lacoc_client.web.gateway.threads import Threads
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_shared.contest.tokens import digest
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, say

if TYPE_CHECKING:
    from lacoc_client.web.director.programme import Programme

_THREADS = 16
_FILES_S = 0.5
_STRANGERS = 4
"""Number of threads that ask courts about unknown tokens: those that no court has accepted yet.
Decisions and other requests run on other threads, so they never wait for these."""
_TRIES = 4
"""Number of threads that wait for courts while players try keys in the lobby. A court lets a robot
walk for some seconds, one after another; nothing else waits for that."""


class Courts:
    """The courts of a gateway: for each one its feed, and its pages that act for referees.

    The feed of a court is made when somebody first needs the court.

    Args:
        home: the gateway's settings.
    """

    def __init__(self, home: Home) -> None:
        self.home = home
        self.threads = Threads(_THREADS)
        """Threads for requests to courts."""
        self.strangers = Threads(_STRANGERS)
        """Threads that ask courts about unknown tokens: those that no court has accepted yet."""
        self.tries = Threads(_TRIES)
        """Threads that wait for courts while players try keys in the lobby."""
        self._feeds: dict[str, tuple[CourtFeed, Referees]] = {}
        self._programme: Programme | None = None
        self.claiming: set[Viewer] = set()
        """Pages that were let in only because they have a token that no court has accepted yet."""
        self.pages: set[Viewer] = set()
        """All pages that have named a court, or follow the director."""
        self.notice = Notice(home.sheet)
        """What the organiser tells all pages."""
        self._accepted: set[bytes] = set()
        """Digests of the tokens that a court has accepted."""
        self.sent_away = 0
        """Number of pages that were refused for lack of room. Pages that only watch can then fetch
        the match in pieces of a second."""
        self.pieces_asked = 0
        """Number of requests for pieces (a second of a match) that reached this gateway; caches on
        the way answered the others."""

    def find(self, name: str | None) -> tuple[CourtFeed, Referees]:
        """Return the feed of a court, and the object that knows which pages act for its referees.

        Without a name it is the first court. The feed is started if it was not.

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
    def programme(self) -> "Programme":
        """The director's two pictures; they are made when the first page follows the director."""
        if self._programme is None:
            from lacoc_client.web.director.programme import Programme  # no court needs it

            self._programme = Programme(self._all)
        return self._programme

    def _all(self) -> list[CourtFeed]:
        """Return the feeds of all courts of this gateway, and start those that are not started."""
        return [self.find(name)[0] for name in list(self.home.courts)]

    @property
    def feeds(self) -> list[CourtFeed]:
        """The feeds of all courts that somebody has needed so far; any thread may read."""
        return [feed for feed, _ in list(self._feeds.values())]

    def audiences(self, feed: CourtFeed) -> list[Audience]:
        """Return the pages that see a court, in one or two groups.

        The first group sees it at once. The second follows the director, so it sees it some seconds
        late if there are several courts. Any thread may call it.
        """
        followers = None if self._programme is None else self._programme.audience(feed.court)
        return [feed.audience] if followers is None else [feed.audience, followers]

    def over(self) -> list[str]:
        """List the ids of matches that are over, at courts that have not begun another match.

        Any thread may call it.
        """
        pictures = [feed.picture for feed in self.feeds]
        ended = (Phase.OFFICIAL, Phase.VOID)
        return [picture.view.match_id for picture in pictures if picture.phase in ended]

    def accept(self, token: str) -> None:
        """Remember that a court has accepted a token."""
        self._accepted.add(digest(token))

    def has_accepted(self, token: str | None) -> bool:
        """Return whether a court has accepted a token."""
        return token is not None and digest(token) in self._accepted

    def threads_for(self, token: str) -> Threads:
        """Return the threads on which a court is asked about a token.

        So somebody with an accepted token, who comes back, does not wait behind people who try
        tokens.
        """
        return self.threads if self.has_accepted(token) else self.strangers

    def owns(self, key: str | None) -> bool:
        """Return whether a key that a page shows is this gateway's page key."""
        return key is not None and hmac.compare_digest(
            key.encode("utf-8", "surrogatepass"), self.home.key.encode()
        )

    def lets_act(self, secret: str) -> bool:
        """Return whether a secret is the page key, or a token that a court has accepted."""
        return self.owns(secret) or self.has_accepted(secret)

    def why_full(self, viewer: Viewer, claims: bool = False) -> Phrase | None:
        """Return why there is no room for a page; None if there is room.

        Pages whose token a court has accepted have a limit of their own. So no crowd of spectators
        can take their places. A page whose token no court has accepted yet may come even if all
        places of spectators are taken; it must then show its token to a court soon.

        Args:
            viewer: the page.
            claims: whether it has a token that no court has accepted yet.
        """
        acts = viewer.can_act
        most = ACTING_MOST if acts else self.home.viewers_most
        if self._others(acts, viewer) < most:
            return None
        if acts:
            return say("gateway.full-acting", most=most)
        if claims and len(self.claiming - {viewer}) < CLAIMING_MOST:
            self.claiming.add(viewer)
            return None
        return say("gateway.full", most=most)

    def watching(self) -> int:
        """Return how many pages only watch."""
        return self._others(False)

    def free_places(self) -> int:
        """Return how many more pages that only watch may come."""
        return max(0, self.home.viewers_most - self.watching())

    def _others(self, can_act: bool, but: Viewer | None = None) -> int:
        others = sum(feed.audience.others(can_act, but) for feed in self.feeds)
        return others + (self._programme.others(can_act, but) if self._programme else 0)

    def dismiss(self, viewer: Viewer) -> None:
        """Remove a page that has gone from all feeds and from the list of pages."""
        self.pages.discard(viewer)
        for feed in self.feeds:
            feed.audience.remove(viewer)
        if self._programme is not None:
            self._programme.remove(viewer)

    async def watch_files(self) -> None:
        """Watch the user's gait files and the contest's sheet, and tell pages what has changed.

        Changes of the gait files go to the pages of the person who started the gateway. A new
        message of the organiser in the sheet goes to all pages.
        """
        own = self.home.prefill.files if self.home.prefill is not None else None
        while own is not None or self.home.sheet is not None:
            await asyncio.sleep(_FILES_S)
            if own is not None and await asyncio.to_thread(own.look):
                for feed in self.feeds:
                    feed.audience.send_own(wire.files_message(own))
            if await asyncio.to_thread(self.notice.look):
                for page in self.pages:
                    page.send(self.notice.message)

    async def close(self) -> None:
        """Close the connections to all courts."""
        if self._programme is not None:
            self._programme.stop()
        await asyncio.gather(*(feed.stop() for feed, _ in self._feeds.values()))
        self.threads.close()
        self.strangers.close()
        self.tries.close()
