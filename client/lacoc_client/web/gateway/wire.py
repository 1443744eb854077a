"""Messages between the gateway and a page (docs/gateway.md lists them).

A message to a page is one byte for its kind, then the payload. A court's messages are passed on
unchanged, except that the gateway puts the hash of a scene before the scene. A message from a page
is a msgpack map with an `id` and the kind of request, `do`; the gateway answers each with a reply.
"""

from enum import IntEnum
from typing import Annotated, Any

import msgspec

from lacoc_client.play.asking import NoAnswer, NotNow
from lacoc_client.play.own_files import OwnFiles
from lacoc_shared.codec import encode
from lacoc_shared.decisions import Decision
from lacoc_shared.keyspace import JOIN_MAX_BYTES
from lacoc_shared.messages import TRY_OUT_KEYS, TRY_OUT_TICKS, SentFile, TriedKey
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import Phrase, say

JOIN_BYTES = JOIN_MAX_BYTES
"""Longest message of a page; a longer one closes its connection."""
REQUEST_BYTES = 4096
"""Longest message that does not ask for a join; a longer one is refused."""


FAULT = say("gateway.fault")


class Unreadable(UserError):
    """Raised when a page has sent something that is not a known request."""


class TokenRefused(UserError):
    """A court refused a referee's token, so it is useless to show this token again."""


class MessageKind(IntEnum):
    """Kinds of messages to a page."""

    WELCOME = 1
    FRAME = 2
    EVENT = 3
    SHEET = 4
    SCENE = 5
    HEALTH = 6
    LINK = 7
    SEAT = 8
    REPLY = 9
    REFEREE = 10
    FILES = 11
    FOLDER = 12
    PROGRESS = 13
    STUDIO = 14
    PHASES = 15
    HANDED = 16
    FORGOTTEN = 17
    CLASS = 18
    CARD = 19
    GONE = 20
    TOURNAMENT = 21
    PROGRAMME = 22
    NOTICE = 23
    CROWD = 24
    TABLE = 25
    PEOPLE = 26
    GROUP = 27


_Id = Annotated[int, msgspec.Meta(ge=0, le=2**53)]
_Short = Annotated[str, msgspec.Meta(max_length=200)]
_Digit = Annotated[int, msgspec.Meta(ge=0, le=9)]
_Token = Annotated[str, msgspec.Meta(max_length=200)]
_Count = Annotated[int, msgspec.Meta(ge=0, le=2**53)]


class Ask(msgspec.Struct, frozen=True, kw_only=True, tag_field="do"):
    """A request of a page."""

    id: _Id
    """Number of the request; its reply has the same number."""


class Watch(Ask, frozen=True, kw_only=True, tag="watch"):
    """Watch a court, or what the director shows.

    It is a page's first request, and a page sends it again to watch something else.
    """

    court: _Short | None = None
    director: bool = False
    """Whether the page follows the director instead of one court; then it can't act."""
    aside: bool = False
    """Whether the page follows the director's second picture instead of the first."""
    hz: float | None = None
    key: _Token | None = None
    """The gateway's page key, which only the person who started the gateway has; None: another
    page."""
    token: _Token | None = None
    """The token of a team or a referee with which the page will act; None: the page only
    watches."""


class Rate(Ask, frozen=True, kw_only=True, tag="rate"):
    """Set how many frames a second the page gets."""

    hz: float


class Ping(Ask, frozen=True, kw_only=True, tag="ping"):
    """Ask for a reply, to show that the page is still there.

    The reply says how long an answer of the court takes, if the page has a court.
    """

    t: float | int | str | None = None


class JoinAsk(Ask, frozen=True, kw_only=True, tag="join"):
    """Take a seat for a team."""

    seat: _Short
    token: _Token | None = None
    name: _Short = ""
    robot: SentFile | None = None
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    sequences: tuple[tuple[_Digit, ...], ...] | None = None
    """The postures that each key of level B goes through, if there is no locomotion file; None: as
    in the sample gait."""


class WhereAsk(Ask, frozen=True, kw_only=True, tag="where"):
    """Ask where the team with a token plays."""

    token: _Token | None = None
    """The team's token; None: the one that was given on the command line."""


class ReadyAsk(Ask, frozen=True, kw_only=True, tag="ready"):
    """Tell the court that the team is ready, or no longer ready."""

    ready: bool = True


class LeaveAsk(Ask, frozen=True, kw_only=True, tag="leave"):
    """Give up the seat that the page holds."""


class KeyAsk(Ask, frozen=True, kw_only=True, tag="key"):
    """Press a key, as an answer to a frame that the page has shown."""

    level: Annotated[int, msgspec.Meta(ge=0, le=1)]
    key: Annotated[int, msgspec.Meta(ge=0, le=10)]
    match: _Count
    """The match of the frame that the page showed when the key was pressed."""
    beat: _Count
    """The beat of this frame."""


class SawAsk(Ask, frozen=True, kw_only=True, tag="saw"):
    """Report that the page has shown a new frame: a sign of life of a page that holds a seat."""

    match: _Count
    beat: _Count


class CheerAsk(Ask, frozen=True, kw_only=True, tag="cheer"):
    """Cheer a match with one of the symbols for cheers."""

    symbol: Annotated[int, msgspec.Meta(ge=0, le=3)]


class TryAsk(Ask, frozen=True, kw_only=True, tag="try"):
    """Ask how the robot would walk alone with some keys, before the match."""

    keys: Annotated[tuple[TriedKey, ...], msgspec.Meta(max_length=TRY_OUT_KEYS)]
    first: Annotated[int, msgspec.Meta(ge=0, lt=TRY_OUT_TICKS)]
    until: Annotated[int, msgspec.Meta(ge=0, le=TRY_OUT_TICKS)]
    drawn: bool = False
    """Whether the reply must contain the scene, so that the page can draw the robot."""


class EnterAsk(Ask, frozen=True, kw_only=True, tag="enter"):
    """Enter as a referee, with a token and the referee's name."""

    token: _Token
    by: _Short
    acts: bool = True
    """Whether this page may decide from now on if no other page does."""


class TakeOver(Ask, frozen=True, kw_only=True, tag="take_over"):
    """Act for the referee from now on, in place of another page of the court's referees."""


class DecideAsk(Ask, frozen=True, kw_only=True, tag="decide"):
    """Make a decision as a referee."""

    decision: Decision
    reason: Phrase | str = ""


class OutlookAsk(Ask, frozen=True, kw_only=True, tag="outlook"):
    """Ask, as a referee, what would happen if play went on."""

    decision: Decision | None = None
    """A decision that would be made before play goes on; None: no decision."""


Asked = (
    Watch
    | Rate
    | Ping
    | JoinAsk
    | WhereAsk
    | ReadyAsk
    | LeaveAsk
    | KeyAsk
    | SawAsk
    | CheerAsk
    | TryAsk
    | EnterAsk
    | TakeOver
    | DecideAsk
    | OutlookAsk
)
"""Every request of a page."""


class _AnyId(msgspec.Struct):
    id: _Id


class _AnyDo(msgspec.Struct):
    do: str


_asked: msgspec.msgpack.Decoder[Asked] = msgspec.msgpack.Decoder(Asked)
_any_id = msgspec.msgpack.Decoder(_AnyId)
_any_do = msgspec.msgpack.Decoder(_AnyDo)


def read(data: bytes) -> Asked:
    """Decode a request of a page.

    Raises:
        Unreadable: if it is no known request, or too long for its kind.
    """
    try:
        if len(data) > REQUEST_BYTES and do_of(data) != "join":
            raise too_long(len(data), REQUEST_BYTES)
        return _asked.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise Unreadable(say("gateway.bad-message", error=str(error))) from None


def do_of(data: bytes) -> str:
    """Return the kind of a request (its field `do`), without reading its other fields.

    Raises:
        msgspec.DecodeError: if it has no kind.
    """
    return _any_do.decode(data).do


def too_long(size: int, most: int) -> Unreadable:
    """Make the error for a request of `size` bytes where at most `most` are allowed."""
    return Unreadable(
        say("gateway.bad-message", error=say("gateway.too-long", bytes=size, most=most))
    )


def read_id(data: bytes) -> int | None:
    """Return the id of a request whose other fields can't be read.

    None: its id can't be read either.
    """
    try:
        return _any_id.decode(data).id
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None


def message(kind: MessageKind, payload: bytes) -> bytes:
    """Make a finished WebSocket frame of a message; the same bytes can go to all pages."""
    size = len(payload) + 1
    if size < 126:
        head = bytes((0x82, size, kind))
    elif size < 65_536:
        head = b"\x82\x7e" + size.to_bytes(2) + bytes((kind,))
    else:
        head = b"\x82\x7f" + size.to_bytes(8) + bytes((kind,))
    return head + payload


def inside(framed: bytes) -> bytes:
    """Undo `message`: return the byte of the kind and the payload, without the WebSocket frame."""
    return framed[{126: 4, 127: 10}.get(framed[1], 2) :]


def opened(framed: bytes) -> tuple[MessageKind, bytes]:
    """Undo `message`: return the kind of message and the payload, as two values."""
    data = inside(framed)
    return MessageKind(data[0]), data[1:]


def map_message(kind: MessageKind, value: dict[str, Any]) -> bytes:
    """Make the WebSocket frame of a message whose payload the gateway writes as a msgpack map."""
    return message(kind, encode(value))


def files_message(own: OwnFiles, used: int | None = None) -> bytes:
    """Make the message that tells a page which files are on this machine.

    Args:
        own: the files.
        used: version of the files with which the page is asking for a seat; None: it is not asking.
    """
    names = {name: file.name if file else "" for name, file in own.files._asdict().items()}
    refused = own.refused
    body = {
        **names,
        "version": own.version,
        "used": used,
        "changed": own.changed,
        "error": None if refused is None else _said(refused),
        "mistakes": refused.mistakes if isinstance(refused, FileRefused) else [],
    }
    return map_message(MessageKind.FILES, body)


def reply(to: int, value: Any) -> bytes:
    """Make the reply to the request with the number `to`, which was done."""
    return map_message(MessageKind.REPLY, {"id": to, "ok": True, "value": value})


def refusal(to: int, error: UserError | FileRefused) -> bytes:
    """Make the reply to the request with the number `to`, which was refused."""
    mistakes = error.mistakes if isinstance(error, FileRefused) else []
    body = {
        "id": to,
        "ok": False,
        "error": _said(error),
        "mistakes": mistakes,
        "token_refused": isinstance(error, TokenRefused),
        "again": isinstance(error, NotNow),
        "unanswered": isinstance(error, NoAnswer),
    }
    return map_message(MessageKind.REPLY, body)


def _said(error: UserError | FileRefused) -> Phrase:
    if isinstance(error, FileRefused):
        return say("refused.mistakes", count=len(error.mistakes), first=None)
    return error.phrase
