"""The connection of one page: answers each request that the page may make."""

import asyncio
import time
from functools import partial
from typing import TYPE_CHECKING, Any

from starlette.websockets import WebSocket

from lacoc_client.play.asking import NoCourt
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.team_way import where
from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.answers import TOO_MUCH, Answers, in_future
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.crowd import CHEERS_HZ, Crowd
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_client.web.gateway.page_requests import serve_requests
from lacoc_client.web.gateway.page_seat import PageSeat
from lacoc_client.web.gateway.referees import Referees
from lacoc_client.web.gateway.viewer import USUAL_HZ, Viewer
from lacoc_client.web.gateway.welcome import welcome
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.names import read_name
from lacoc_shared.decisions import REFEREE_NAME_MAX
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

if TYPE_CHECKING:
    from lacoc_client.web.director.programme import Programme

TRY_LATER = 1013
"""WebSocket close code: try again later."""

_ASKS_HZ, _ASKS_BURST = 100.0, 200
_TOKENS_HZ, _TOKENS_BURST = 1.0, 10
_COURTS_HZ, _COURTS_BURST = 1.0, 5
_CLAIM_S = 15.0
"""A page that was let in only because of its token must show the token to a court within this time
[s]."""
_LOOKS_S = 10.0
"""For how long play goes on in an outlook that a referee sees [s]."""


class Page:
    """The connection of one page that watches a court or follows the director.

    Args:
        websocket: the page's WebSocket, not accepted yet.
        courts: the courts of the gateway.
        crowd: counts what people cheer.
    """

    def __init__(self, websocket: WebSocket, courts: Courts, crowd: Crowd) -> None:
        self._websocket = websocket
        self._courts = courts
        self._crowd = crowd
        self._home = courts.home
        self._viewer = Viewer(websocket.state.socket)
        self._feed: CourtFeed | None = None
        self._referees: Referees | None = None
        self._follows: Programme | None = None
        """The programme, if the page follows the director; then the page has no court of its
        own."""
        self._answers = answers = Answers(self._viewer, self._log)
        self._seat = PageSeat(self._viewer, answers, self._home.prefill, self._log)
        self._tokens = Allowance(_TOKENS_HZ, _TOKENS_BURST)
        self._cheers = Allowance(CHEERS_HZ, 1)
        self._greetings = Allowance(_COURTS_HZ, _COURTS_BURST)
        self._entering = asyncio.Lock()
        self._leaving: asyncio.TimerHandle | None = None
        """Closes a page that was let in only because of its token and has not shown it in time."""

    async def serve(self) -> None:
        """Answer the page's requests until the page goes."""
        try:
            await serve_requests(
                self._websocket, self._answers, wire.read, self._answer, _ASKS_HZ, _ASKS_BURST
            )
        finally:
            self._gone()

    async def _answer(self, asked: wire.Asked) -> bool:
        viewer, answers = self._viewer, self._answers
        match asked:
            case wire.Watch():
                return await self._watch(asked)
            case wire.Rate():
                viewer.rate(asked.hz)
                answers.reply(asked.id, {})
            case wire.Ping():
                court_ms = self._feed.trip_ms() if self._feed is not None else None
                answers.reply(asked.id, {"t": asked.t, "court_ms": court_ms})
            case wire.JoinAsk():
                feed, _ = self._acting()
                _spend(self._tokens)
                if viewer.is_own:
                    self._join(asked, feed)
                elif asked.token and self._courts.has_accepted(asked.token):
                    self._accepted(asked.token)
                    self._join(asked, feed)
                else:
                    answers.later(asked.id, self._proven_join(asked, feed))
            case wire.WhereAsk():
                feed, _ = self._acting()
                _spend(self._tokens)
                answers.later(asked.id, self._where(asked, feed))
            case wire.ReadyAsk() | wire.LeaveAsk() | wire.KeyAsk() | wire.SawAsk():
                self._acting()
                self._seat.steer(asked)
            case wire.CheerAsk():
                self._cheer(asked.symbol)
                answers.reply(asked.id, {})
            case wire.TryAsk():
                self._acting()
                answers.later(asked.id, self._seat.try_out(asked, self._courts.tries))
            case wire.EnterAsk():
                feed, referees = self._acting()
                _spend(self._tokens)
                answers.later(asked.id, self._enter(asked, feed, referees))
            case wire.TakeOver():
                self._acting()[1].take_over(viewer)
                answers.reply(asked.id, {})
            case wire.DecideAsk():
                answers.later(asked.id, self._decide(asked, *self._acting()))
            case wire.OutlookAsk():
                answers.later(asked.id, self._look_ahead(asked, *self._acting()))
        return True

    async def _watch(self, asked: wire.Watch) -> bool:
        _spend(self._greetings)  # a few bytes ask for a whole match
        viewer = self._viewer
        viewer.is_own = not asked.director and self._courts.owns(asked.key)
        accepted = self._courts.has_accepted(asked.token)
        viewer.can_act = not asked.director and (viewer.is_own or accepted)
        viewer.rate(USUAL_HZ if asked.hz is None else asked.hz)
        claims = self._may_act and asked.token is not None and not asked.director
        if (why := self._courts.why_full(viewer, claims)) is not None:
            self._courts.sent_away += 1
            self._answers.refuse(asked.id, UserError(why))
            await self._websocket.close(TRY_LATER, "full")
            return False
        self._leave_court()
        self._courts.pages.add(viewer)
        if viewer in self._courts.claiming and self._leaving is None:
            loop = asyncio.get_running_loop()
            self._leaving = loop.call_later(_CLAIM_S, self._give_up)
        if asked.director:
            self._follows = programme = self._courts.programme
            viewer.send(self._welcome(None))
            viewer.send(self._courts.notice.message)
            programme.add(viewer, asked.aside)
            self._answers.reply(asked.id, {})
            return True
        try:
            self._feed, self._referees = self._courts.find(asked.court)
        except UserError:
            viewer.send(self._welcome(None))  # it lists the courts
            raise
        viewer.send(self._welcome(self._feed.court))
        prefill = self._home.prefill
        if viewer.is_own and prefill is not None and prefill.files is not None:
            viewer.send(wire.files_message(prefill.files))
        viewer.send(self._courts.notice.message)
        self._feed.add(viewer)
        if self._may_act:
            viewer.send(self._referees.state(viewer))
        self._answers.reply(asked.id, {})
        return True

    def _cheer(self, symbol: int) -> None:
        """Count a cheer of this page; ignore one that comes too soon after the last."""
        audience = self._feed.audience if self._feed is not None else None
        if self._follows is not None:
            audience = self._follows.seen_by(self._viewer)
        if audience is not None and self._cheers.take(1, time.monotonic()):
            self._crowd.cheer(audience, symbol)

    def _welcome(self, court: str | None) -> bytes:
        return welcome(self._home, court, self._may_act, self._viewer.is_own)

    @property
    def _may_act(self) -> bool:
        """Whether the page may act as a player or referee, once a court has accepted its token."""
        return self._home.kind == "venue" or self._viewer.is_own

    def _acting(self) -> tuple[CourtFeed, Referees]:
        if self._feed is None or self._referees is None:
            raise UserError(say("gateway.which-court"))
        if not self._may_act:
            raise UserError(say("gateway.only-watch"))
        return self._feed, self._referees

    def _join(self, asked: wire.JoinAsk, feed: CourtFeed) -> None:
        self._seat.join(asked, feed.access, self._answers.from_thread(asked.id))

    async def _proven_join(self, asked: wire.JoinAsk, feed: CourtFeed) -> Any:
        """Take a seat with a token that no court has accepted yet; first ask the court about it.

        To take a seat needs a thread and a connection of its own. So a page with a wrong token gets
        neither.
        """
        await self._ask_where(asked.token or "", feed)
        joined = asyncio.get_running_loop().create_future()
        self._seat.join(asked, feed.access, partial(in_future, joined))
        return await joined

    async def _where(self, asked: wire.WhereAsk, feed: CourtFeed) -> Any:
        own = self._home.prefill if self._viewer.is_own else None
        found = await self._ask_where(asked.token or (own.token if own else ""), feed)
        if self._home.kind == "player" and found.address:
            # Only the court of the command line was known; the office names the others.
            self._home.courts[found.court] = Access(
                court=found.court, connect=found.address, authority=feed.access.authority
            )
        return found

    async def _ask_where(self, token: str, feed: CourtFeed) -> Whereabouts:
        """Ask a court where the team with a token plays.

        The answer shows whether the token is valid.
        """
        if not token:
            raise UserError(say("gateway.no-token"))
        session = await feed.joined()
        threads = self._courts.threads_for(token)
        found = await threads.run(lambda: where(session, feed.court, token))
        self._accepted(token)
        self._seat.brings = found.open
        return found

    def _accepted(self, token: str) -> None:
        """Let the page play or referee from now on, because a court has accepted its token.

        The number of such pages is limited.

        Raises:
            UserError: if there is no room.
        """
        courts, viewer = self._courts, self._viewer
        courts.accept(token)
        if viewer.can_act:
            return
        viewer.can_act = True
        if (why := courts.why_full(viewer)) is not None:
            viewer.can_act = False
            raise UserError(why)
        courts.claiming.discard(viewer)

    def _give_up(self) -> None:
        """Close a page that was let in because of a token which it has not shown to a court yet."""
        if self._viewer in self._courts.claiming:
            self._courts.sent_away += 1
            asyncio.get_running_loop().create_task(self._websocket.close(TRY_LATER, "full"))

    async def _enter(self, asked: wire.EnterAsk, feed: CourtFeed, referees: Referees) -> Any:
        by = read_name(asked.by, REFEREE_NAME_MAX)
        if by is None:
            raise UserError(say("refused.who-decides", most=REFEREE_NAME_MAX))
        # One at a time, so that a page that tries wrong tokens uses one thread, not many.
        if self._entering.locked():
            raise UserError(TOO_MUCH)
        async with self._entering:
            await self._show_token(asked.token, feed)
        self._accepted(asked.token)
        if referees is self._referees:  # the page may have gone to another court
            referees.enter(self._viewer, asked.token, by, asked.acts)
            self._log(f"{by} sits down as a referee.", "referee", by=by)
        return {}

    async def _show_token(self, token: str, feed: CourtFeed) -> None:
        client = self._client(feed, token)
        try:
            await self._courts.threads_for(token).run(client.enter)
        except NoCourt:
            raise
        except UserError as error:
            # The court sends frames to this gateway, so it is there: the token must be wrong.
            raise wire.TokenRefused(*error.said) if feed.connected else error from None

    def _client(self, feed: CourtFeed, token: str) -> RefereeClient:
        if feed.session is None:
            raise UserError(say("gateway.court-not-there", court=feed.court))
        return RefereeClient(feed.session, feed.court, token)

    async def _decide(self, asked: wire.DecideAsk, feed: CourtFeed, referees: Referees) -> Any:
        token, by = referees.acting(self._viewer)
        client = self._client(feed, token)
        return await self._courts.threads.run(
            lambda: client.decide(asked.decision, asked.reason, by)
        )

    async def _look_ahead(self, asked: wire.OutlookAsk, feed: CourtFeed, referees: Referees) -> Any:
        client = self._client(feed, referees.acting(self._viewer)[0])
        return await self._courts.threads.run(lambda: client.look_ahead(asked.decision, _LOOKS_S))

    def _log(self, text: str, kind: str, **particulars: object) -> None:
        """Write a line about this page and its court into the log; without a court, do nothing."""
        client, feed = self._websocket.client, self._feed
        if feed is not None:
            feed.log(text, kind, page=client and f"{client.host}:{client.port}", **particulars)

    def _leave_court(self) -> None:
        self._seat.leave()
        if self._referees is not None:
            self._referees.leave(self._viewer)
        if self._feed is not None:
            self._feed.audience.remove(self._viewer)
        if self._follows is not None:
            self._follows.remove(self._viewer)
        self._feed = self._referees = self._follows = None

    def _gone(self) -> None:
        self._leave_court()
        self._courts.pages.discard(self._viewer)
        self._courts.claiming.discard(self._viewer)
        if self._leaving is not None:
            self._leaving.cancel()
        self._answers.stop()


def _spend(allowance: Allowance) -> None:
    if not allowance.take(1, time.monotonic()):
        raise UserError(say("gateway.too-many-tries"))
