"""Sends requests to a court, and turns its refusals into errors."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import msgspec

from lacoc_shared import codec
from lacoc_shared.command import screen
from lacoc_shared.keyspace import EVERY_COURT, KeySpace
from lacoc_shared.messages import PROTOCOL, Refusal
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.network.court_view import MAX_BYTES
from lacoc_shared.network.session import NoReply, NotConnected, Refused, Session, TooLate
from lacoc_shared.words import Phrase, render, say

T = TypeVar("T")

ANSWER_S = 5.0
"""Longest wait for an answer [s]; a healthy court answers within a beat or two."""

_COMING_BACK_S = 0.5
_AGAIN_S = 0.05
_WAIT_AGAIN_S = 0.5


class NoCourt(UserError):
    """No court with the name that was asked for answers."""


class NoAnswer(NoCourt):
    """A court, studio or desk got a request and did not answer; it may still have done it."""


class NotNow(UserError):
    """A court, studio or desk is not there, or refuses for now; it may accept the request later."""


class Patience:
    """How long a command waits for its court; each call of `until` waits as long again.

    Args:
        wait_s: how long; None: do not wait, because a person can try again.
        stopping: returns whether somebody asked the command to end.
    """

    def __init__(self, wait_s: float | None, stopping: Callable[[], bool] = lambda: False) -> None:
        self.wait_s = wait_s
        self._stopping = stopping
        self._told = ""

    def until(self, do: Callable[[], T]) -> T:
        """Call `do`; call it again while no court answers or the court refuses for now.

        Returns:
            What `do` returns when it succeeds.

        Raises:
            UserError: the error of `do`, if waiting can't help or the time is over.
            KeyboardInterrupt: if the command is asked to end.
        """
        end_s = time.monotonic() + (self.wait_s or 0.0)
        while True:
            try:
                return do()
            except (NotConnected, NoCourt, NotNow) as error:
                if self.wait_s is None or time.monotonic() >= end_s:
                    raise
                self._tell(error)
            if self._stopping():
                raise KeyboardInterrupt
            time.sleep(_WAIT_AGAIN_S)

    def _tell(self, error: UserError) -> None:
        if str(error) != self._told:
            self._told = str(error)
            said = say("asking.waits", why=error.phrase, wait_s=self.wait_s)
            screen.note(render(said))


def ask(
    session: Session,
    keys: KeySpace,
    key: str,
    message: msgspec.Struct,
    reply: type[T],
    timeout_s: float = ANSWER_S,
    *,
    repeatable: bool = False,
) -> T:
    """Send a court a request, and decode its answer.

    Args:
        session: the connection.
        keys: the court's key expressions.
        key: key expression of the request.
        message: the request.
        reply: type of the answer.
        timeout_s: how long to wait.
        repeatable: as in `fetch`.

    Raises:
        NoAnswer: if the court was asked and does not answer.
        NoCourt: if there is no such court; the message lists the courts that are there.
        FileRefused: if the court found mistakes in files.
        NotNow: if the court refuses for now; the message is its reason.
        UserError: if the court refuses for good.
    """
    request = codec.encode(message)
    return understand(fetch(session, keys, key, request, timeout_s, repeatable=repeatable), reply)


def fetch(
    session: Session,
    keys: KeySpace,
    key: str,
    payload: bytes = b"",
    timeout_s: float = ANSWER_S,
    *,
    repeatable: bool = True,
) -> bytes:
    """Send a court a request, and return its answer as bytes; it raises the errors of `ask`.

    For a moment after its first frame, a restarted court does not receive requests yet. So the
    request is sent again, as long as it is certain that no court received it.

    Args:
        session: the connection.
        keys: the court's key expressions.
        key: key expression of the request.
        payload: the request.
        timeout_s: how long to wait.
        repeatable: whether the request does no harm if the court gets it twice. Then it is sent
            again even if a court may have received it before the link broke.
    """
    end_s = time.monotonic() + _COMING_BACK_S
    links: tuple[str, ...] = ()
    while True:
        links = links or session.links()
        try:
            return session.ask(key, payload, timeout_s)
        except NoReply as silence:
            # Zenoh drops requests some milliseconds before it reports a broken link.
            time.sleep(_AGAIN_S)
            # Meanwhile it may be connected again, even to the same court, but by another link.
            lost = links and session.links() != links
            is_over = time.monotonic() >= end_s
            if isinstance(silence, TooLate) or (lost and (is_over or not repeatable)):
                raise NoAnswer(no_answer(session, keys.court)) from None
            if is_over:
                raise NoCourt(no_answer(session, keys.court)) from None
        except Refused as refused:
            raise refusal_of(refused.payload) from None


def refusal_of(payload: bytes) -> FileRefused | UserError:
    """Make the error that is raised when a court, a studio or a desk refuses a request.

    Returns:
        `FileRefused` if it lists mistakes in files, `NotNow` if the same request may be accepted
        later, else `UserError`.

    Raises:
        UserError: if the refusal can't be decoded.
    """
    refusal = understand(payload, Refusal)
    if refusal.mistakes:
        return FileRefused(list(refusal.mistakes))
    return (NotNow if refusal.again else UserError)(refusal.why)


def understand(payload: bytes, kind: type[T]) -> T:
    """Decode a message that a court has sent.

    Raises:
        UserError: if it can't be decoded, because the court has another version.
    """
    with understood():
        return codec.decode(payload, kind, MAX_BYTES)


@contextmanager
def understood() -> Iterator[None]:
    """Turn a `BadMessage` that the `with` block raises into a `UserError` with a sentence.

    Raises:
        UserError: in place of `BadMessage`.
    """
    try:
        yield
    except codec.BadMessage as error:
        said = say("court.bad-answer", error=str(error), version=PROTOCOL)
        raise UserError(said) from None


def no_answer(session: Session, court: str) -> Phrase:
    """Return why a court does not answer; if no court has this name, list the courts that run."""
    courts = [key.split("/")[1] for key in session.present(EVERY_COURT)]
    address = ", ".join(session.endpoints)
    if court in courts:
        return say("court.no-answer", court=court, address=address)
    if courts:
        return say("court.no-court", court=court, address=address, courts=courts)
    return say("court.nobody", address=address)
