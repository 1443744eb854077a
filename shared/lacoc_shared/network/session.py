"""The only module that uses Zenoh: courts and clients exchange bytes through its sessions.

A court polls: its subscribers and queryables are ring buffers that it empties once a beat. So all
of the court's code runs on its own thread, in an order that the court decides. A client may wait:
Zenoh's receiving thread puts messages into its mailboxes. No other module imports zenoh.
"""

import atexit
import json
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any, NamedTuple, Self

import zenoh
from zenoh.handlers import Callback, RingChannel

from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address, heap
from lacoc_shared.network import config as network_config
from lacoc_shared.network.certificate import Pair

_OTHER_FILES = 200
"""How many files a court's process opens besides one for each session: records, modules, Zenoh's
own."""


class NotConnected(UserError):
    """There is no connection to a court now, but there may be one later."""


class NoReply(Exception):
    """Nobody answered a request: there is no receiver, it is not allowed, or the time was up."""


class TooLate(NoReply):
    """Nobody answered a request in time; it may still have been carried out."""


class Refused(Exception):
    """A request was answered with an error; `payload` has the bytes of the error."""

    def __init__(self, payload: bytes) -> None:
        super().__init__(f"refused with {len(payload)} bytes")
        self.payload = payload


class Publisher:
    """Sends bytes under one key expression; a receiver that is too slow loses some of them."""

    def __init__(self, publisher: zenoh.Publisher) -> None:
        self._publisher = publisher

    def put(self, payload: bytes) -> None:
        """Send a message to all subscribers; never wait for them."""
        self._publisher.put(payload)


class Ring:
    """Keeps the newest messages of a subscription until its owner takes them; it never waits."""

    def __init__(self, subscriber: "zenoh.Subscriber[zenoh.Handler[zenoh.Sample]]") -> None:
        self._subscriber = subscriber

    def take(self) -> bytes | None:
        """Return the oldest message that was not taken yet; None if there is none. Never blocks."""
        sample = self._subscriber.try_recv()
        return None if sample is None else sample.payload.to_bytes()


class Mail(NamedTuple):
    """A message that was received, and its time of arrival on this machine."""

    payload: bytes
    arrived_s: float
    """Time of arrival by `time.monotonic()`."""


class Mailbox:
    """Keeps the newest messages of a subscription for its reader, who takes or awaits them."""

    def __init__(self, depth: int, notify: Callable[[], None] | None = None) -> None:
        self._mails: deque[Mail] = deque(maxlen=depth)
        self._arrived = threading.Event()
        self._notify = notify
        self.subscriber: zenoh.Subscriber[None] | None = None

    def close(self) -> None:
        """End the subscription; messages that have come before can still be taken."""
        if self.subscriber is not None:
            with suppress(zenoh.ZError):  # its session may be closed already
                self.subscriber.undeclare()  # type: ignore[no-untyped-call]

    def deliver(self, sample: zenoh.Sample) -> None:
        """Put a message that has come into the mailbox; called on Zenoh's thread."""
        self._mails.append(Mail(sample.payload.to_bytes(), time.monotonic()))
        self._arrived.set()
        if self._notify is not None:
            self._notify()

    def take(self) -> Mail | None:
        """Return the oldest message that was not taken yet; None if there is none."""
        return self._mails.popleft() if self._mails else None

    def wait(self, timeout_s: float) -> bool:
        """Wait until there is a message in the mailbox; return False if none came in time."""
        self._arrived.clear()
        return bool(self._mails) or self._arrived.wait(timeout_s)


class Question:
    """A request that this session has sent, and its answer once it has come."""

    def __init__(self, key: str, replies: "zenoh.Handler[zenoh.Reply]") -> None:
        self._key = key
        self._replies = replies

    def take(self) -> bytes | None:
        """Return the answer to the request, or None if it has not come yet; never block.

        Raises:
            NoReply: as in `Session.ask`.
            Refused: if the answer is an error.
        """
        try:
            reply = self._replies.try_recv()
        except zenoh.ZError:  # no answer will come
            raise NoReply(self._key) from None
        return None if reply is None else self._read(reply)

    def wait(self) -> bytes:
        """Wait for the answer to the request; raise the same errors as `take`."""
        for reply in self._replies:
            return self._read(reply)
        raise NoReply(self._key)

    def _read(self, reply: zenoh.Reply) -> bytes:
        if reply.ok is not None:
            return reply.ok.payload.to_bytes()
        assert reply.err is not None
        error = reply.err.payload.to_bytes()
        if error == b"Timeout":  # the text that Zenoh sends
            raise TooLate(self._key)
        raise Refused(error)


class Request:
    """A request that this session has received and must answer.

    If it is never answered, its sender gets `NoReply`.
    """

    def __init__(self, query: zenoh.Query) -> None:
        self._query = query
        self.key = str(query.key_expr)
        payload = query.payload
        self.payload = b"" if payload is None else payload.to_bytes()

    def reply(self, payload: bytes) -> None:
        """Answer this request."""
        with self._query as query:
            query.reply(self.key, payload)

    def refuse(self, payload: bytes) -> None:
        """Answer this request with an error."""
        with self._query as query:
            query.reply_err(payload)


class RequestQueue:
    """Keeps the requests under one key expression until their owner takes and answers them."""

    def __init__(self, queryable: "zenoh.Queryable[zenoh.Handler[zenoh.Query]]") -> None:
        self._queryable = queryable

    def take(self) -> Request | None:
        """Return the oldest request that was not taken yet; None if there is none. Never blocks."""
        while (query := self._queryable.try_recv()) is not None:
            request = Request(query)
            if "*" not in request.key:  # a request must name one seat or one decision
                return request
        return None


class Session:
    """A connection to the network; made by `open_court` or `open_client`, closed by `with`."""

    def __init__(self, session: zenoh.Session, endpoints: Sequence[str]) -> None:
        self._session = session
        self.endpoints = tuple(endpoints)
        """The complete addresses with which it was opened."""
        self._announcements: list[zenoh.LivelinessToken] = []
        # Zenoh's threads must end before the interpreter does, even if the program ends by an
        # exception outside any `with`.
        atexit.register(self.close)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection, and with it all subscriptions and answers of this session.

        This takes ten seconds if the cable of another machine was pulled a moment ago.
        """
        atexit.unregister(self.close)
        if not self._session.is_closed():
            with suppress(zenoh.ZError):  # on a dead link Zenoh's goodbye times out
                self._session.close()  # type: ignore[no-untyped-call]

    def publisher(self, key: str) -> Publisher:
        """Declare that this session sends under a key expression, and return the publisher."""
        return Publisher(self._session.declare_publisher(key))

    def ring(self, key: str, depth: int) -> Ring:
        """Subscribe to a key expression; the ring keeps the newest `depth` messages for polling."""
        channel: RingChannel[zenoh.Sample] = RingChannel(depth)
        return Ring(self._session.declare_subscriber(key, channel))

    def mailbox(self, key: str, depth: int, notify: Callable[[], None] | None = None) -> Mailbox:
        """Subscribe to a key expression; the mailbox keeps the newest messages, to wait or poll.

        Args:
            key: key expression.
            depth: number of messages to keep.
            notify: called on Zenoh's thread when a message has come; it must return at once.
        """
        mailbox = Mailbox(depth, notify)
        mailbox.subscriber = self._session.declare_subscriber(
            key, Callback(mailbox.deliver, indirect=False)
        )
        return mailbox

    def desk(self, key: str, depth: int) -> RequestQueue:
        """Declare that this session answers the requests under a key expression.

        The queue keeps the newest `depth` requests, to be polled.
        """
        channel: RingChannel[zenoh.Query] = RingChannel(depth)
        return RequestQueue(self._session.declare_queryable(key, channel))

    def answer(self, key: str, take: Callable[[Request], None]) -> None:
        """Declare that this session answers the requests under a key expression, as they come.

        Args:
            key: key expression.
            take: called on Zenoh's thread with each request; it must return at once. The request
                can be answered later, from any thread.
        """

        def deliver(query: zenoh.Query) -> None:
            request = Request(query)
            if "*" not in request.key:
                take(request)

        self._session.declare_queryable(key, Callback(deliver, indirect=False))

    def send(self, key: str, payload: bytes) -> None:
        """Send one message under a key expression; never wait for a receiver."""
        self._session.put(key, payload)

    def ask(self, key: str, payload: bytes = b"", timeout_s: float = 5.0) -> bytes:
        """Send a request and wait for its answer.

        Raises:
            TooLate: if no answer came in time.
            NoReply: if nobody receives such requests (or nobody who may answer), or the connection
                broke.
            Refused: if the answer is an error.
        """
        return self.question(key, payload, timeout_s).wait()

    def question(self, key: str, payload: bytes = b"", timeout_s: float = 5.0) -> Question:
        """Send a request, and return an object with which to poll or wait for the answer."""
        replies = self._session.get(
            key, payload=payload, timeout=timeout_s, consolidation=zenoh.ConsolidationMode.NONE
        )
        return Question(key, replies)

    def links(self) -> tuple[str, ...]:
        """Return this side's addresses of the connections to courts that are open now.

        A connection that broke and was made again has another address (another port).
        """
        return tuple(sorted(link.src for link in self._session.info.links()))

    def announce(self, key: str) -> None:
        """Announce a key expression to other sessions until this session closes."""
        self._announcements.append(self._session.liveliness().declare_token(key))

    def present(self, key: str, timeout_s: float = 1.0) -> tuple[str, ...]:
        """Return all key expressions that are announced now and match a key expression, sorted."""
        replies = self._session.liveliness().get(key, timeout=timeout_s)
        return tuple(sorted(str(r.ok.key_expr) for r in replies if r.ok is not None))

    def locators(self) -> tuple[str, ...]:
        """Return the addresses on which this court's session listens, with their actual ports."""
        zid = self._session.info.zid()
        found: list[str] = []
        for reply in self._session.get(f"@/{zid}/router"):
            if reply.ok is not None:
                found += json.loads(reply.ok.payload.to_bytes())["locators"]
        return tuple(found)


def open_court(
    listen: Sequence[str], certificate: Pair | None = None, office: bool = False
) -> Session:
    """Open a court's session: the router to which everyone else connects.

    Args:
        listen: addresses to listen on; port 0 chooses a free port (see `Session.locators`).
        certificate: the certificate with which the court proves its name; None: nothing is
            encrypted.
        office: whether an office may assign matches to the court.

    Raises:
        UserError: if it can't listen at one of the addresses; the message says why.
    """
    os.environ.setdefault("ZENOH_RUNTIME", network_config.RUNTIME_POOLS)
    config = partial(network_config.court_config, certificate=certificate, office=office)
    return _listening(listen, config, encrypted=certificate is not None)


def open_studio(listen: Sequence[str]) -> Session:
    """Open a studio's session: the router to which its clients connect.

    Args:
        listen: addresses to listen on; port 0 chooses a free port (see `Session.locators`).

    Raises:
        UserError: if it can't listen at one of the addresses; the message says why.
    """
    return _listening(listen, network_config.studio_config)


def open_desk(listen: Sequence[str]) -> Session:
    """Open the session of an office's desk; argument and errors as in `open_studio`."""
    return _listening(listen, network_config.desk_config)


def _listening(
    listen: Sequence[str],
    config: Callable[[Sequence[str]], network_config.Config],
    *,
    encrypted: bool = False,
) -> Session:
    _allow_files(network_config.MAX_SESSIONS + _OTHER_FILES)
    endpoints = [address.endpoint(one, "tls" if encrypted else "tcp") for one in listen]
    address.check_protocols(endpoints, encrypted=encrypted)
    try:
        return Session(_open(config(endpoints)), endpoints)
    except zenoh.ZError as error:
        raise UserError(address.why_not_listening(endpoints, error)) from None


def open_client(connect: Sequence[str], timeout_s: float = 2.0, authority: str = "") -> Session:
    """Open the session of a controller, referee, spectator or gateway.

    It stays open when the court ends, and connects again by itself.

    Args:
        connect: addresses of a court; the first one that answers is used.
        timeout_s: how long to try.
        authority: certificate (PEM) of a private authority, which is trusted in addition to the
            public ones.

    Raises:
        NotConnected: if there is no connection; the message says why.
        UserError: if an address is wrong.
    """
    endpoints = [address.endpoint(one) for one in connect]
    if (unknown := address.why_not_known(endpoints)) is not None:
        raise NotConnected(unknown)
    if len(endpoints) > 1:  # at first Zenoh tries nothing but the first address
        endpoints.sort(key=lambda one: not address.is_open(one))
    try:
        config = network_config.client_config(endpoints, timeout_s, authority)
        return Session(_open(config), endpoints)
    except zenoh.ZError:
        raise NotConnected(address.why_not_connected(endpoints, authority)) from None


def _allow_files(count: int) -> None:
    """Raise this process's limit of open files (often 1024) to `count`, or as far as allowed."""
    if sys.platform == "win32":  # it has no such limit
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = count if hard == resource.RLIM_INFINITY else min(count, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def _open(config: dict[str, Any]) -> zenoh.Session:
    heap.share()
    zenoh.init_log_from_env_or("off")  # its log is for developers: RUST_LOG=warn shows it
    return zenoh.open(zenoh.Config.from_json5(json.dumps(config)))
