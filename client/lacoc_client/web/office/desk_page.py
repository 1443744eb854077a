"""One /office or /enter page's connection: it passes requests on to the office's desk."""

import asyncio
import time
from typing import Annotated, Any

import msgspec
from starlette.websockets import WebSocket

from lacoc_client.web.gateway.answers import Answers
from lacoc_client.web.gateway.guesses import Guesses
from lacoc_client.web.gateway.page_requests import serve_requests
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import Ask, Ping, Unreadable
from lacoc_client.web.office.desk import DeskLine
from lacoc_client.web.office.hand_ins import HandIns
from lacoc_client.web.office.links import ContestLinks, LinkMaker, TeamLink, qr_code
from lacoc_shared import codec
from lacoc_shared.messages.desk import REPLY_MAX_BYTES, Own, OwnEntry, TokenList, Tokens
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_ASKS_HZ, _ASKS_BURST = 20.0, 60
_WRONG = (
    "desk.wrong-code",
    "desk.no-such-team",
    "desk.not-organiser",
    "desk.slower",
    "refused.no-referee-token",
)
"""The codes of refusals that mean that a secret was wrong."""


class DeskAsk(Ask, frozen=True, kw_only=True, tag="desk"):
    """Pass a request on to the office's desk; the reply is the desk's answer."""

    request: msgspec.Raw


class LinkAsk(Ask, frozen=True, kw_only=True, tag="link"):
    """Ask for the link of the team that has this token."""

    token: Annotated[str, msgspec.Meta(max_length=200)]


class LinksAsk(Ask, frozen=True, kw_only=True, tag="links"):
    """Ask for the links of `ContestLinks`; only the organiser and the staff get them."""

    secret: Annotated[str, msgspec.Meta(max_length=200)]
    team: Annotated[str, msgspec.Meta(max_length=64)] = ""
    """The team whose link is wanted, and no other; "": all links."""


Asked = DeskAsk | LinkAsk | LinksAsk | Ping
"""Every request of these pages."""

_asked: msgspec.msgpack.Decoder[Asked] = msgspec.msgpack.Decoder(Asked)


def read(data: bytes) -> Asked:
    """Decode a request of a page /office or /enter.

    Raises:
        Unreadable: if it is no known request.
    """
    try:
        return _asked.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise Unreadable(say("gateway.bad-message", error=str(error))) from None


class DeskPage:
    """The connection of one page /office or /enter.

    Args:
        websocket: the page's WebSocket, not accepted yet.
        desk: the connection to the desk.
        guesses: slows down whoever shows wrong secrets.
        hand_ins: limits how often files are handed in.
        make: makes links.
    """

    def __init__(
        self,
        websocket: WebSocket,
        desk: DeskLine,
        guesses: Guesses,
        hand_ins: HandIns,
        make: LinkMaker,
    ) -> None:
        self._websocket = websocket
        self._desk = desk
        self._guesses = guesses
        self._hand_ins = hand_ins
        self._machine = websocket.client.host if websocket.client is not None else ""
        self._make = make
        self._answers = Answers(Viewer(websocket.state.socket), lambda *_: None)

    async def serve(self) -> None:
        """Answer the page's requests until the page goes."""
        try:
            await serve_requests(
                self._websocket, self._answers, read, self._take, _ASKS_HZ, _ASKS_BURST
            )
        finally:
            self._answers.stop()

    async def _take(self, asked: Asked) -> bool:
        match asked:
            case Ping():
                self._answers.reply(asked.id, {"t": asked.t})
            case DeskAsk():
                self._answers.later(asked.id, self._passed_on(bytes(asked.request)))
            case LinkAsk():
                self._answers.later(asked.id, self._link(asked.token))
            case LinksAsk():
                self._answers.later(asked.id, self._links(asked.secret, asked.team))
        return True

    async def _passed_on(self, request: bytes) -> Any:
        self._hand_ins.count(self._machine, request, time.monotonic())
        return msgspec.Raw(await self._asked(request))

    async def _link(self, token: str) -> TeamLink:
        answer = await self._asked(codec.encode(Own(secret=token)))
        entry = codec.decode(answer, OwnEntry, REPLY_MAX_BYTES)
        return self._make.team(entry.team, entry.token)

    async def _links(self, secret: str, wanted: str) -> ContestLinks:
        answer = await self._asked(codec.encode(Tokens(secret=secret)))
        tokens = codec.decode(answer, TokenList, REPLY_MAX_BYTES)
        return await asyncio.to_thread(self._made, tokens, wanted)

    def _made(self, tokens: TokenList, wanted: str) -> ContestLinks:
        enter = f"{self._make.address}/enter"
        teams = tuple(
            self._make.team(team, token)
            for team, token in tokens.teams.items()
            if wanted in ("", team)
        )
        referees = tuple(
            self._make.referee(court, token)
            for court, token in tokens.referees.items()
            if not wanted
        )
        seats = tuple(
            self._make.seat(one.court, one.seat, one.token) for one in tokens.seats if not wanted
        )
        staff = tuple(
            self._make.staff(name, token) for name, token in tokens.staff.items() if not wanted
        )
        return ContestLinks(
            enter=enter,
            enter_qr=qr_code(enter),
            teams=teams,
            referees=referees,
            seats=seats,
            staff=staff,
        )

    async def _asked(self, request: bytes) -> bytes:
        try:
            return await self._desk.ask(request)
        except UserError as error:
            if error.phrase.code in _WRONG:
                await asyncio.sleep(self._guesses.wait_s(self._machine, time.monotonic()))
            raise
