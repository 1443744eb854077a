"""What one page asks, and how it is answered."""

import asyncio
import hmac
import time
from collections.abc import Callable, Coroutine
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from lacoc_client.asking import NoCourt
from lacoc_client.gateway import wire
from lacoc_client.gateway.courts import Courts
from lacoc_client.gateway.feed import CourtFeed
from lacoc_client.gateway.referees import Referees, as_referee
from lacoc_client.gateway.seat import SeatThread
from lacoc_client.gateway.viewer import MOST_HZ, USUAL_HZ, Viewer
from lacoc_client.gateway.wire import Kind
from lacoc_client.referee import RefereeClient
from lacoc_client.seat_files import SeatFiles
from lacoc_shared import __version__
from lacoc_shared.access import Access
from lacoc_shared.codec import BadMessage
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import FileRefused, UserError

TRY_LATER = 1013
"""WebSocket close code: come again later."""
GARBAGE = 1008
"""WebSocket close code: what was sent can't be read at all."""

_ASKS_HZ, _ASKS_BURST = 100.0, 200
_TOKENS_HZ, _TOKENS_BURST = 1.0, 10
_COURTS_HZ, _COURTS_BURST = 1.0, 5
_AT_ONCE = 8
_FIRST_S = 10.0
_TOO_MUCH = "Too much at once: wait for the answers."


class Allowance:
    """So many now, and so many a second from then on."""

    def __init__(self, hz: float, burst: int) -> None:
        self._hz = hz
        self._burst = burst
        self._left = float(burst)
        self._at_s = time.monotonic()

    def take(self) -> float:
        """Take one; returns how long it is to be waited for."""
        now_s = time.monotonic()
        self._left = min(self._burst, self._left + (now_s - self._at_s) * self._hz) - 1
        self._at_s = now_s
        return max(0.0, -self._left / self._hz)

    @property
    def spent(self) -> bool:
        """Whether the next one would have to wait."""
        return self._left + (time.monotonic() - self._at_s) * self._hz < 1


class Page:
    """One page's connection.

    Args:
        websocket: not yet accepted.
        courts: the courts of the gateway.
    """

    def __init__(self, websocket: WebSocket, courts: Courts) -> None:
        self._websocket = websocket
        self._courts = courts
        self._home = courts.home
        self._viewer = Viewer(websocket.state.socket)
        self._feed: CourtFeed | None = None
        self._referees: Referees | None = None
        self._seat: SeatThread | None = None
        self._hold = ("", "")
        """The seat and how it is held, as it was told last."""
        self._asks = Allowance(_ASKS_HZ, _ASKS_BURST)
        self._tokens = Allowance(_TOKENS_HZ, _TOKENS_BURST)
        self._told = Allowance(_TOKENS_HZ, _TOKENS_BURST)
        self._greetings = Allowance(_COURTS_HZ, _COURTS_BURST)
        self._entering = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()

    async def serve(self) -> None:
        """Answer the page until it goes."""
        await self._websocket.accept()
        try:
            # A connection that never says what it wants must not be kept.
            first = await asyncio.wait_for(self._websocket.receive(), _FIRST_S)
            while first["type"] == "websocket.receive":
                if not await self._take(first.get("bytes") or b""):
                    return
                # Who asks too much is not read until it is its turn again: nobody else notices.
                await asyncio.sleep(self._asks.take())
                first = await self._websocket.receive()
        except (TimeoutError, WebSocketDisconnect):
            pass
        finally:
            self._gone()

    async def _take(self, data: bytes) -> bool:
        """Answer one message; False if the page is to go."""
        try:
            asked = wire.read(data)
        except BadMessage as error:
            to = wire.read_id(data)
            if to is None:
                await self._websocket.close(GARBAGE, "not a message")
                return False
            self._viewer.send(wire.refusal(to, f"This was not understood: {error}."))
            return True
        try:
            return await self._answer(asked)
        except (UserError, FileRefused) as error:
            self._refuse(asked.id, error)
            return True

    async def _answer(self, asked: wire.Asked) -> bool:
        viewer = self._viewer
        match asked:
            case wire.Watch():
                return await self._watch(asked)
            case wire.Rate():
                viewer.rate(asked.hz)
                viewer.send(wire.reply(asked.id, {}))
            case wire.Ping():
                viewer.send(wire.reply(asked.id, {"t": asked.t}))
            case wire.JoinAsk():
                self._join(asked)
            case wire.ReadyAsk() | wire.LeaveAsk() | wire.KeyAsk():
                self._steer(asked)
            case wire.EnterAsk():
                feed, referees = self._acting()
                _spend(self._tokens)
                self._start(asked.id, self._enter(asked, feed, referees))
            case wire.TakeOver():
                self._acting()[1].take_over(viewer)
                viewer.send(wire.reply(asked.id, {}))
            case wire.DecideAsk():
                self._start(asked.id, self._decide(asked, self._acting()[1]))
        return True

    async def _watch(self, asked: wire.Watch) -> bool:
        _spend(self._greetings)  # some bytes ask for all that has happened in a match
        viewer = self._viewer
        viewer.can_act = asked.key is not None and hmac.compare_digest(
            asked.key.encode("utf-8", "surrogatepass"), self._home.key.encode()
        )
        viewer.rate(USUAL_HZ if asked.hz is None else asked.hz)
        if why := self._courts.why_full(viewer):
            self._courts.sent_away += 1
            viewer.send(wire.refusal(asked.id, why))
            await self._websocket.close(TRY_LATER, "full")
            return False
        self._leave_court()
        try:
            self._feed, self._referees = self._courts.find(asked.court)
        except UserError:
            viewer.send(self._welcome(None))  # it says which courts there are
            raise
        viewer.send(self._welcome(self._feed.court))
        self._feed.add(viewer)
        if viewer.can_act:
            viewer.send(self._referees.state(viewer))
        viewer.send(wire.reply(asked.id, {}))
        return True

    def _welcome(self, court: str | None) -> bytes:
        home, prefill = self._home, self._home.prefill
        filled = None
        if prefill is not None and self._viewer.can_act:
            filled = {
                "seat": prefill.seat,
                "name": prefill.name,
                "has_token": bool(prefill.token),
                "files": [file.name for file in prefill.files if file is not None],
            }
        body = {
            "protocol": PROTOCOL,
            "version": __version__,
            "courts": list(home.courts),
            "court": court,
            "can_act": self._viewer.can_act,
            "home": home.kind,
            "prefill": filled,
        }
        return wire.map_message(Kind.WELCOME, body)

    def _acting(self) -> tuple[CourtFeed, Referees]:
        if self._feed is None or self._referees is None:
            raise UserError("Say first which court to watch.")
        if not self._viewer.can_act:
            raise UserError(
                "This page may only watch: open the address with its key, as the one who started "
                "the gateway has it."
            )
        return self._feed, self._referees

    def _join(self, asked: wire.JoinAsk) -> None:
        feed, _ = self._acting()
        _spend(self._tokens)
        access, name, files = self._entry(asked, feed)
        if self._seat is not None:
            self._seat.end()
        loop, viewer = asyncio.get_running_loop(), self._viewer
        viewer.watch_closely()
        viewer.at_least(MOST_HZ)

        def tell(seat: dict[str, Any]) -> None:
            _in_loop(loop, lambda: self._tell_seat(seat))

        self._seat = SeatThread(
            access, name, files, viewer.unheard_s, tell, self._answerer(asked.id)
        )

    def _tell_seat(self, seat: dict[str, Any]) -> None:
        self._viewer.send(wire.map_message(Kind.SEAT, seat))
        hold = (seat["seat"], seat["hold"])
        if self._feed is not None and hold != self._hold:
            self._hold = hold
            because = f" ({seat['reason']})" if seat["reason"] else ""
            self._log(f"Seat {hold[0]}: {hold[1]}{because}.", "seat", seat=hold[0], hold=hold[1])

    def _entry(self, asked: wire.JoinAsk, feed: CourtFeed) -> tuple[Access, str, SeatFiles]:
        """The way to the seat and what it brings; what the page left open is prefilled."""
        token, name = asked.token, asked.name
        files = SeatFiles(asked.robot, asked.postures, asked.locomotion)
        prefill = self._home.prefill
        if prefill is not None and (not token or not prefill.token):
            own, theirs = files, prefill.files
            if own.postures is None and own.locomotion is None:
                files = SeatFiles(own.robot or theirs.robot, theirs.postures, theirs.locomotion)
            token, name = token or prefill.token, name or prefill.name
        if not token:
            raise UserError("The token is missing: the organiser has it.")
        return feed.access.of_seat(asked.seat, token), name or f"Team {asked.seat}", files

    def _steer(self, asked: wire.ReadyAsk | wire.LeaveAsk | wire.KeyAsk) -> None:
        self._acting()
        if self._seat is None:
            raise UserError("This page holds no seat: join one first.")
        answer = self._answerer(asked.id)
        match asked:
            case wire.ReadyAsk(ready=ready):
                self._seat.do(lambda controller: {"text": controller.ready(ready)}, answer)
            case wire.LeaveAsk():
                self._seat.do(lambda controller: {"text": controller.leave()}, answer)
            case wire.KeyAsk(level=level, key=key):
                self._seat.do(lambda controller: {"seq": controller.press(level, key)}, answer)

    async def _enter(self, asked: wire.EnterAsk, feed: CourtFeed, referees: Referees) -> Any:
        by = asked.by.strip()
        if not (by and by.isprintable()):
            raise UserError("Say who you are: it stands in the record.")
        if feed.session is None:
            raise UserError(f"Court {feed.court!r} is not there yet.")
        access = feed.access.of_referee(asked.token)
        # One at a time, so that a page with wrong tokens is one of those that wait, not many.
        if self._entering.locked():
            raise UserError(_TOO_MUCH)
        async with self._entering:
            await self._show_token(access, feed, referees)
        if referees is self._referees:  # it may have gone to another court meanwhile
            referees.enter(self._viewer, access, by)
            self._log(f"{by} sits down as a referee.", "referee", by=by)
        return {}

    async def _show_token(self, access: Access, feed: CourtFeed, referees: Referees) -> None:
        courts = self._courts
        # A referee who comes back stands in no queue with those who try.
        threads = courts.threads if referees.knows(access) else courts.strangers
        try:
            await threads.run(lambda: as_referee(access, RefereeClient.enter))
        except NoCourt:
            raise
        except UserError as error:
            # The court is there, as it sends frames to this gateway: so it is the token.
            raise wire.TokenRefused(str(error)) if feed.connected else error from None

    async def _decide(self, asked: wire.DecideAsk, referees: Referees) -> Any:
        access, by = referees.acting(self._viewer)
        return await self._courts.threads.run(
            lambda: as_referee(
                access, lambda client: client.decide(asked.decision, asked.reason, by)
            )
        )

    def _start(self, to: int, work: Coroutine[Any, Any, Any]) -> None:
        """Answer later, and go on reading meanwhile."""
        if len(self._tasks) >= _AT_ONCE:
            work.close()
            raise UserError(_TOO_MUCH)

        async def answer() -> None:
            try:
                self._viewer.send(wire.reply(to, await work))
            except (UserError, FileRefused) as error:
                self._refuse(to, error)
            except Exception:  # a bug, but no page waits for ever
                self._viewer.send(wire.refusal(to, wire.FAULT))
                raise

        task = asyncio.get_running_loop().create_task(answer())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _answerer(self, to: int) -> Callable[[Any, Exception | None], None]:
        """Takes an answer on any thread."""
        loop, viewer = asyncio.get_running_loop(), self._viewer

        def answer(value: Any, error: Exception | None) -> None:
            if error is None:
                _in_loop(loop, lambda: viewer.send(wire.reply(to, value)))
            else:
                _in_loop(loop, lambda: self._refuse(to, error))

        return answer

    def _refuse(self, to: int, error: Exception) -> None:
        self._viewer.send(wire.refusal(to, error))
        # The sentences name no token; a page that asks for more of them is heard less often.
        if self._feed is not None and not self._told.spent:
            self._told.take()
            self._log(f"Refused: {error}", "refused")

    def _log(self, text: str, kind: str, **particulars: object) -> None:
        """Log something about this page."""
        assert self._feed is not None
        client = self._websocket.client
        self._feed.log(text, kind, page=client and f"{client.host}:{client.port}", **particulars)

    def _leave_court(self) -> None:
        if self._seat is not None:
            self._seat.end()
            self._seat = None
        if self._referees is not None:
            self._referees.leave(self._viewer)
        if self._feed is not None:
            self._feed.remove(self._viewer)
            if self._hold[0]:
                self._log(f"The page of seat {self._hold[0]} has gone.", "seat", seat=self._hold[0])
        self._feed = self._referees = None
        self._hold = ("", "")

    def _gone(self) -> None:
        self._leave_court()
        for task in self._tasks:
            task.cancel()


def _spend(allowance: Allowance) -> None:
    if allowance.spent:
        raise UserError("Too many tries: wait a few seconds.")
    allowance.take()


def _in_loop(loop: asyncio.AbstractEventLoop, do: Callable[[], None]) -> None:
    try:
        loop.call_soon_threadsafe(do)
    except RuntimeError:  # the gateway has ended
        return
