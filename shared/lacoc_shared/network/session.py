"""The one door to Zenoh: courts and clients talk in bytes here, with typed errors.

A court polls: its subscribers and queryables are rings that are emptied once a beat,
so no thread but the court's own ever runs its code and the order is its own. A client
may wait: its mailboxes are filled by Zenoh's receiving thread. Nothing else in the
project imports zenoh.
"""

import atexit
import json
import os
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple, Self

import zenoh
from zenoh.handlers import Callback, RingChannel

from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address, heap
from lacoc_shared.network import config as network_config
from lacoc_shared.network.access_rules import Credentials, Protection

_OTHER_FILES = 200
"""That a court's process opens besides one for each session: records, modules, Zenoh's own."""


class NotConnected(UserError):
    """There is no connection now; there may be one later."""


class NoReply(Exception):
    """Nobody answered: no such court, not allowed to ask, or too late."""


class TooLate(NoReply):
    """Somebody was asked and did not answer in time: it may be done all the same."""


class Refused(Exception):
    """The answer was an error; `payload` is what it says."""

    def __init__(self, payload: bytes) -> None:
        super().__init__(f"refused with {len(payload)} bytes")
        self.payload = payload


class Publisher:
    """Sends bytes under one key expression; a receiver too slow to take them misses some."""

    def __init__(self, publisher: zenoh.Publisher) -> None:
        self._publisher = publisher

    def put(self, payload: bytes) -> None:
        """Send; never waits for a receiver."""
        self._publisher.put(payload)


class Ring:
    """The newest messages of a subscription, polled by its owner."""

    def __init__(self, subscriber: "zenoh.Subscriber[zenoh.Handler[zenoh.Sample]]") -> None:
        self._subscriber = subscriber

    def take(self) -> bytes | None:
        """The oldest message that waits, or None; never blocks."""
        sample = self._subscriber.try_recv()
        return None if sample is None else sample.payload.to_bytes()


class Mail(NamedTuple):
    """A message and when it arrived on this machine."""

    payload: bytes
    arrived_s: float
    """`time.monotonic()`."""


class Mailbox:
    """The newest messages of a subscription, filled while its one reader does other things."""

    def __init__(self, depth: int, notify: Callable[[], None] | None = None) -> None:
        self._mails: deque[Mail] = deque(maxlen=depth)
        self._arrived = threading.Event()
        self._notify = notify

    def deliver(self, sample: zenoh.Sample) -> None:
        """Take a message in; runs on Zenoh's thread."""
        self._mails.append(Mail(sample.payload.to_bytes(), time.monotonic()))
        self._arrived.set()
        if self._notify is not None:
            self._notify()

    def take(self) -> Mail | None:
        """The oldest message that waits, or None."""
        return self._mails.popleft() if self._mails else None

    def wait(self, timeout_s: float) -> bool:
        """Wait until a message is there; False if none came in time."""
        self._arrived.clear()
        return bool(self._mails) or self._arrived.wait(timeout_s)


class Question:
    """A request that was sent, and its answer."""

    def __init__(self, key: str, replies: "zenoh.Handler[zenoh.Reply]") -> None:
        self._key = key
        self._replies = replies

    def take(self) -> bytes | None:
        """The answer, or None while there is none; never blocks.

        Raises:
            NoReply: see `Session.ask`.
            Refused: if the answer is an error.
        """
        try:
            reply = self._replies.try_recv()
        except zenoh.ZError:  # none will come
            raise NoReply(self._key) from None
        return None if reply is None else self._read(reply)

    def wait(self) -> bytes:
        """Wait for the answer; raises as `take`."""
        for reply in self._replies:
            return self._read(reply)
        raise NoReply(self._key)

    def _read(self, reply: zenoh.Reply) -> bytes:
        if reply.ok is not None:
            return reply.ok.payload.to_bytes()
        assert reply.err is not None
        error = reply.err.payload.to_bytes()
        if error == b"Timeout":  # Zenoh's own word
            raise TooLate(self._key)
        raise Refused(error)


class Request:
    """A request that waits for its answer; without one the asker sees `NoReply`."""

    def __init__(self, query: zenoh.Query) -> None:
        self._query = query
        self.key = str(query.key_expr)
        payload = query.payload
        self.payload = b"" if payload is None else payload.to_bytes()

    def reply(self, payload: bytes) -> None:
        """Answer."""
        with self._query as query:
            query.reply(self.key, payload)

    def refuse(self, payload: bytes) -> None:
        """Answer with an error."""
        with self._query as query:
            query.reply_err(payload)


class Desk:
    """Where requests under one key expression wait, polled by its owner."""

    def __init__(self, queryable: "zenoh.Queryable[zenoh.Handler[zenoh.Query]]") -> None:
        self._queryable = queryable

    def take(self) -> Request | None:
        """The oldest request that waits, or None; never blocks."""
        while (query := self._queryable.try_recv()) is not None:
            request = Request(query)
            if "*" not in request.key:  # a request is for one seat, one decision
                return request
        return None


class Session:
    """A connection to the network; made by `open_court` or `open_client`, closed by `with`."""

    def __init__(self, session: zenoh.Session, endpoints: Sequence[str]) -> None:
        self._session = session
        self.endpoints = tuple(endpoints)
        """The complete addresses it was opened with."""
        self._announcements: list[zenoh.LivelinessToken] = []
        # Zenoh's threads must be gone before the interpreter is: also when a program ends by an
        # exception somewhere that no `with` surrounds.
        atexit.register(self.close)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection and all that was declared with it.

        Takes ten seconds where somebody's cable was pulled a moment ago.
        """
        atexit.unregister(self.close)
        if not self._session.is_closed():
            with suppress(zenoh.ZError):  # it waits in vain to say goodbye on a dead link
                self._session.close()  # type: ignore[no-untyped-call]

    def publisher(self, key: str) -> Publisher:
        """Declare that this session sends under a key expression."""
        return Publisher(self._session.declare_publisher(key))

    def ring(self, key: str, depth: int) -> Ring:
        """Subscribe; the owner polls, and the newest `depth` messages wait for it."""
        channel: RingChannel[zenoh.Sample] = RingChannel(depth)
        return Ring(self._session.declare_subscriber(key, channel))

    def mailbox(self, key: str, depth: int, notify: Callable[[], None] | None = None) -> Mailbox:
        """Subscribe; the owner may wait, and the newest `depth` messages wait for it.

        Args:
            key: key expression.
            depth: how many messages wait.
            notify: called on Zenoh's thread when a message has come; it must return at once.
        """
        mailbox = Mailbox(depth, notify)
        self._session.declare_subscriber(key, Callback(mailbox.deliver, indirect=False))
        return mailbox

    def desk(self, key: str, depth: int) -> Desk:
        """Declare that this session answers requests; the newest `depth` wait to be polled."""
        channel: RingChannel[zenoh.Query] = RingChannel(depth)
        return Desk(self._session.declare_queryable(key, channel))

    def ask(self, key: str, payload: bytes = b"", timeout_s: float = 5.0) -> bytes:
        """Send a request and wait for its answer.

        Raises:
            TooLate: if no answer came in time.
            NoReply: if nobody was asked (or is allowed to answer), or the link broke.
            Refused: if the answer is an error.
        """
        return self.question(key, payload, timeout_s).wait()

    def question(self, key: str, payload: bytes = b"", timeout_s: float = 5.0) -> Question:
        """Send a request; the asker looks for its answer, or waits, when it likes."""
        replies = self._session.get(
            key, payload=payload, timeout=timeout_s, consolidation=zenoh.ConsolidationMode.NONE
        )
        return Question(key, replies)

    def routers(self) -> tuple[str, ...]:
        """Identities of the courts' sessions that this one is connected to now."""
        return tuple(sorted(map(str, self._session.info.routers_zid())))

    def announce(self, key: str) -> None:
        """Let others see that this session is alive, until it closes."""
        self._announcements.append(self._session.liveliness().declare_token(key))

    def present(self, key: str, timeout_s: float = 1.0) -> tuple[str, ...]:
        """Key expressions of all live announcements under a key expression, sorted."""
        replies = self._session.liveliness().get(key, timeout=timeout_s)
        return tuple(sorted(str(r.ok.key_expr) for r in replies if r.ok is not None))

    def locators(self) -> tuple[str, ...]:
        """Addresses that a court's session listens on, with the ports it really got."""
        zid = self._session.info.zid()
        found: list[str] = []
        for reply in self._session.get(f"@/{zid}/router"):
            if reply.ok is not None:
                found += json.loads(reply.ok.payload.to_bytes())["locators"]
        return tuple(found)


def open_court(listen: Sequence[str], protection: Protection | None = None) -> Session:
    """Open a court's session: the router that everyone else connects to.

    Args:
        listen: addresses to listen on; port 0 takes a free one (see `Session.locators`).
        protection: the court's keys and users; None: anybody may connect, nothing is encrypted.

    Raises:
        UserError: if one of them can't be listened on; the message says why.
    """
    os.environ.setdefault("ZENOH_RUNTIME", network_config.RUNTIME_POOLS)
    _allow_files(network_config.MAX_SESSIONS + _OTHER_FILES)
    endpoints = [address.endpoint(one, "tls" if protection else "tcp") for one in listen]
    address.check_protocols(endpoints, keys=protection is not None)
    try:
        with _user_file(protection) as users:
            config = network_config.court_config(endpoints, protection, users)
            return Session(_open(config), endpoints)
    except zenoh.ZError as error:
        raise UserError(address.why_not_listening(endpoints, error)) from None


def open_client(
    connect: Sequence[str], timeout_s: float = 2.0, credentials: Credentials | None = None
) -> Session:
    """Open the session of a controller, referee, spectator or gateway.

    It stays open when the court goes away, and connects again by itself.

    Args:
        connect: addresses of a court; the first that answers is taken.
        timeout_s: how long to try.
        credentials: for a court with keys.

    Raises:
        NotConnected: if there is no connection; the message says why.
        UserError: if an address is none, or needs keys that are not there.
    """
    endpoints = [address.endpoint(one, "tls" if credentials else "tcp") for one in connect]
    address.check_protocols(endpoints, keys=credentials is not None)
    if (unknown := address.why_not_known(endpoints)) is not None:
        raise NotConnected(unknown)
    try:
        config = network_config.client_config(endpoints, timeout_s, credentials)
        return Session(_open(config), endpoints)
    except zenoh.ZError:
        ca = credentials.ca if credentials else ""
        raise NotConnected(address.why_not_connected(endpoints, ca)) from None


@contextmanager
def _user_file(protection: Protection | None) -> Iterator[Path | None]:
    """The passwords as a file, for as long as Zenoh needs to read it."""
    if protection is None:
        yield None
        return
    with tempfile.TemporaryDirectory(prefix="lacoc-") as folder:  # its owner's alone
        users = Path(folder, "users")
        lines = [f"{user}:{password}\n" for user, password in protection.passwords.items()]
        with open(users, "x", opener=lambda name, flags: os.open(name, flags, 0o600)) as file:
            file.writelines(lines)
        yield users


def _allow_files(count: int) -> None:
    """Let this process open so many files, as far as it may: often the limit is 1024."""
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = count if hard == resource.RLIM_INFINITY else min(count, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


_WITHOUT_PASSWORDS = ",zenoh::api::session=info"
"""At debug it writes down the whole configuration it was opened with."""


def _open(config: dict[str, Any]) -> zenoh.Session:
    heap.share()
    words = os.environ.get("RUST_LOG", "")
    if words and not words.endswith(_WITHOUT_PASSWORDS):
        os.environ["RUST_LOG"] = words + _WITHOUT_PASSWORDS
    zenoh.init_log_from_env_or("off")  # its words are for developers: RUST_LOG=warn shows them
    return zenoh.open(zenoh.Config.from_json5(json.dumps(config)))
