"""A page without a browser: it keeps what the gateway sends, and sends requests."""

import socket
import struct
import threading
import time
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

import msgpack
import pytest
from page_connection import PageConnection, Refused
from waiting import LIMIT_S
from websockets.client import ClientProtocol
from websockets.exceptions import ConnectionClosed
from websockets.frames import Opcode
from websockets.uri import parse_uri

from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import decode
from lacoc_shared.messages import Event, Frame, Health, Scene, SeatFrame, Sheet
from lacoc_shared.seat import Phase

_SIGN_S = 0.09
"""With a frame every 20 ms, a page shows every fifth one in a sign of life."""


def refusal(code: str) -> pytest.RaisesExc[Refused]:
    """Return a context manager that expects `Refused` with the phrase of this code."""
    return pytest.raises(Refused, check=lambda error: error.why.code == code)


class PageClient(PageConnection):
    """A page's connection to courts; a thread of its own receives the messages."""

    def __init__(
        self, url: str, key: str | None = None, *, watch: bool = True, **options: Any
    ) -> None:
        fields = {name: options.pop(name, None) for name in ("court", "hz", "token")}
        super().__init__(url, "/ws", compression=None, **options)
        self.order: list[MessageKind] = []
        self.welcome: dict[str, Any] = {}
        self.link: dict[str, Any] = {}
        self.links: list[dict[str, Any]] = []
        self.seat: dict[str, Any] = {}
        self.referee: dict[str, Any] = {}
        self.files: dict[str, Any] = {}
        self.notice: dict[str, Any] = {}
        self.crowd: dict[str, Any] = {}
        self.cheers = [0, 0, 0, 0]
        """How often each symbol was cheered since the page came."""
        self.sheet: Sheet | None = None
        self.scene: tuple[bytes, Scene] | None = None
        self.frame: Frame | None = None
        self.frames: list[tuple[float, int]] = []
        """The arrival time [s] and the beat of each frame."""
        self.health: Health | None = None
        self.events: list[Event] = []
        self.closed = threading.Event()
        self.signs = True
        """Whether the page shows signs of life while it holds a seat; False: a frozen tab."""
        self._signed_s = 0.0
        self._signed: set[int] = set()
        """Ids of the signs of life that were not answered yet."""
        self._changed = threading.Condition()
        threading.Thread(target=self._listen, daemon=True).start()
        if watch:
            self.ask("watch", key=key, **fields)

    @property
    def waits_why(self) -> str:
        """Return the code of the phrase that says why there is no court, or "" without a phrase."""
        return (self.link.get("why") or {"code": ""})["code"]

    def press(self, level: int, key: int) -> int:
        """Press a key upon the newest frame; return its sequence number."""
        return int(self.ask("key", level=level, key=key, **self.shown())["seq"])

    def shown(self) -> dict[str, int]:
        """Return the fields that name the newest frame."""
        frame = self.frame
        return {"match": frame.match, "beat": frame.beat} if frame else {"match": 0, "beat": 0}

    def waits_for(self, number: int) -> bool:
        """Return whether a request still waits for its reply; call this only before `reply`."""
        return number not in self._replies

    def until(self, condition: Callable[[], Any]) -> None:
        """Wait until a condition is true; the page's own thread takes in messages."""
        self.wait(condition)

    def wait(self, condition: Callable[[], Any], timeout_s: float = LIMIT_S) -> None:
        """Wait until a condition is true."""
        with self._changed:
            assert self._changed.wait_for(condition, timeout_s), "it did not become true"

    def phase(self, phase: Phase) -> None:
        """Wait until the match is in this phase."""
        self.wait(lambda: self.frame is not None and self.frame.phase == phase)

    def wait_own(self, condition: Callable[[SeatFrame], Any]) -> None:
        """Wait until a condition is true of the seat that this page holds."""
        self.wait(lambda: self.frame is not None and condition(self.own()))

    def code(self) -> int | None:
        """Return the gateway's close code; None while the connection is open."""
        return self.socket.protocol.close_code

    def own(self) -> SeatFrame:
        """Return the newest frame's data of the seat that this page holds."""
        assert self.frame is not None
        return self.frame.seats[self.seat["index"]]

    def _listen(self) -> None:
        try:
            for message in self.socket:
                with self._changed:
                    self._receive(message)
                    self._changed.notify_all()
        except ConnectionClosed:
            pass
        with self._changed:
            self.closed.set()
            self._changed.notify_all()

    def _take(self, kind: MessageKind, payload: bytes) -> None:
        self.order.append(kind)
        match kind:
            case MessageKind.FRAME:
                self.frame = decode(payload, Frame)
                self.frames.append((time.monotonic(), self.frame.beat))
                self._sign()
            case MessageKind.EVENT:
                event = decode(payload, Event)
                if not any(event.number == known.number for known in self.events):
                    self.events.append(event)
            case MessageKind.SHEET:
                self.sheet = decode(payload, Sheet)
            case MessageKind.SCENE:
                self.scene = (payload[:8], decode(payload[8:], Scene, 1 << 20))
            case MessageKind.HEALTH:
                self.health = decode(payload, Health)
            case _:
                self._take_own(kind, msgpack.unpackb(payload))

    def _take_own(self, kind: MessageKind, body: dict[str, Any]) -> None:
        match kind:
            case MessageKind.WELCOME:
                self.welcome = body
            case MessageKind.LINK:
                if self.link and self.link["log"] != body["log"]:
                    self.events = []
                self.link = body
                self.links.append(body)
            case MessageKind.SEAT:
                self.seat = body
            case MessageKind.REFEREE:
                self.referee = body
            case MessageKind.FILES:
                self.files = body
            case MessageKind.NOTICE:
                self.notice = body
            case MessageKind.CROWD:
                self.crowd = body
                cheers = zip(self.cheers, body["cheers"], strict=True)
                self.cheers = [before + new for before, new in cheers]
            case MessageKind.REPLY if body["id"] in self._signed:
                self._signed.discard(body["id"])
            case MessageKind.REPLY:
                self._replies[body["id"]] = body

    def _sign(self) -> None:
        """Show a sign of life with a new frame, as often as a page does."""
        now_s = time.monotonic()
        if self.signs and self.seat.get("hold") == "held" and now_s - self._signed_s > _SIGN_S:
            self._signed_s = now_s
            self._signed.add(self.send("saw", **self.shown()))


class SleepyPage:
    """A page that reads only on request and has a small receive buffer."""

    def __init__(self, url: str) -> None:
        parts = urlsplit(url)
        assert parts.hostname is not None
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self._socket.connect((parts.hostname, parts.port))
        self._protocol = ClientProtocol(parse_uri(f"ws://{parts.netloc}/ws"))
        self._protocol.send_request(self._protocol.connect())
        self._flush()
        self._protocol.receive_data(self._socket.recv(4096))

    def watch(self, **fields: Any) -> None:
        self._protocol.send_binary(msgpack.packb({"id": 1, "do": "watch", **fields}))
        self._flush()

    def read_until(self, beat: int) -> list[int]:
        """Read frames up to a beat, and return the beats of all frames in order of arrival."""
        beats: list[int] = []
        deadline_s = time.monotonic() + LIMIT_S
        while not beats or beats[-1] < beat:
            assert time.monotonic() < deadline_s
            self._protocol.receive_data(self._socket.recv(65_536))
            self._flush()  # answers pings
            for event in self._protocol.events_received():
                data = bytes(getattr(event, "data", b""))
                is_message = getattr(event, "opcode", None) is Opcode.BINARY  # not a ping
                if is_message and data[:1] == bytes((MessageKind.FRAME,)):
                    beats.append(decode(data[1:], Frame).beat)
        return beats

    def _flush(self) -> None:
        for data in self._protocol.data_to_send():
            self._socket.sendall(data)

    def __enter__(self) -> "SleepyPage":
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()


def x_of(frame: Frame, robot: int, bytes_a_robot: int) -> float:
    """Return a robot's x coordinate [m] in a frame.

    Args:
        frame: the frame.
        robot: index of the robot's seat.
        bytes_a_robot: size of one robot's part of the frame's poses.
    """
    (x_m,) = struct.unpack_from("<f", frame.poses, robot * bytes_a_robot)
    return float(x_m)
