"""Finds a studio, sends it the requests of pages, and receives reports on its searches."""

import asyncio
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import TypeVar

import msgspec

from lacoc_client.play.asking import NoAnswer, NotNow, refusal_of
from lacoc_shared import codec
from lacoc_shared.command import log
from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address
from lacoc_shared.network.session import (
    Mailbox,
    NoReply,
    Question,
    Refused,
    Session,
    TooLate,
    open_client,
)
from lacoc_shared.studio import EVERY_STUDIO, TRIAL_REPLY_MAX_BYTES, Progress, StudioKeys
from lacoc_shared.words import Phrase, say

T = TypeVar("T")

_LOOK_S = 0.5
_OPEN_S = 2.0
_PATIENCE_S = 3.0
_COMING_BACK_S, _AGAIN_S = 0.5, 0.05
_FIRST_POLL_S, _LAST_POLL_S = 0.002, 0.02
_SLOWER = 1.1


class Asker:
    """The connection to a studio; call `start` first and `close` at the end.

    A thread keeps looking for a studio. So a studio that starts later, or starts again, is found.

    Args:
        connect: address of a studio, or of a Zenoh router that leads to a studio.

    Raises:
        UserError: if the address is wrong.
    """

    def __init__(self, connect: str) -> None:
        self._connect = [address.endpoint(connect)]
        address.check_protocols(self._connect, encrypted=False)
        self._session: Session | None = None
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._look, name="studio", daemon=True)
        self.studio: str | None = None
        """Name of the studio that was found; None: none was found."""
        self.why: Phrase | None = None
        """Why no studio was found; None: one was found, or the thread has not looked yet."""
        self.open = 0
        """Number of requests that wait for their answer."""

    def start(self) -> None:
        """Start the thread that looks for a studio."""
        self._thread.start()

    def close(self) -> None:
        """Close the connection to the studio."""
        self._ending.set()
        self._thread.join()

    async def ask(
        self, what: str, message: msgspec.Struct, reply: type[T], timeout_s: float
    ) -> tuple[T, bytes]:
        """Send a request to the studio and wait for the answer.

        Args:
            what: name of the request.
            message: the request.
            reply: type of the answer.
            timeout_s: how long to wait for the answer [s].

        Returns:
            The answer, and its bytes.

        Raises:
            FileRefused: if the studio found mistakes in files.
            NotNow: if there is no studio, or the studio can't do this now.
            NoAnswer: if the studio received the request, but does not answer in time.
            UserError: if the studio refuses the request, and would refuse it again.
        """
        self.open += 1
        try:
            payload = await self._answered(what, codec.encode(message), timeout_s)
        finally:
            self.open -= 1
        try:
            return codec.decode(payload, reply, TRIAL_REPLY_MAX_BYTES), payload
        except codec.BadMessage as error:
            raise UserError(say("design.bad-answer", error=str(error))) from None

    async def progress(self, job: str, tell: Callable[[Progress], None]) -> "Listening":
        """Subscribe to the studio's reports on a search.

        Args:
            job: name of the search.
            tell: called with each report, on another thread, until the subscription is closed.

        Raises:
            NotNow: if there is no studio.
        """
        session, keys = await self._found()
        return Listening(session, keys.progress(job), tell)

    async def _found(self) -> tuple[Session, StudioKeys]:
        """Return the Zenoh session, and the key expressions of the studio.

        Wait a moment if the studio is just starting.
        """
        deadline_s = time.monotonic() + _PATIENCE_S
        while True:
            session, studio = self._session, self.studio
            if session is not None and studio is not None:
                return session, StudioKeys(studio)
            if time.monotonic() >= deadline_s:
                raise NotNow(self.why or say("design.no-studio"))
            await asyncio.sleep(_LAST_POLL_S)

    async def _answered(self, what: str, request: bytes, timeout_s: float) -> bytes:
        """Send a request to the studio, and wait for its answer.

        A studio that has just started can't receive requests for a moment after it is found. So a
        request that nobody received is sent again.
        """
        end_s = time.monotonic() + _COMING_BACK_S
        while True:
            session, keys = await self._found()
            try:
                return await _wait(session.question(keys.request(what), request, timeout_s))
            except TooLate:
                raise NoAnswer(say("design.studio-late")) from None
            except NoReply:
                if time.monotonic() >= end_s:
                    raise NotNow(say("design.studio-lost")) from None
                await asyncio.sleep(_AGAIN_S)
            except Refused as refused:
                raise refusal_of(refused.payload) from None

    def _look(self) -> None:
        """Connect to the network, and keep looking for studios, until `close`."""
        with ExitStack() as stack:
            while not self._ending.is_set():
                began_s = time.monotonic()
                try:
                    if self._session is None:
                        self._session = stack.enter_context(open_client(self._connect, _OPEN_S))
                    self._choose(self._session)
                except UserError as error:
                    self.studio, self.why = None, error.phrase
                except Exception as error:  # Zenoh's own, on a link that breaks: look again
                    self.studio, self.why = None, say("design.no-studio")
                    log.get().warning(str(error))
                self._ending.wait(max(0.0, began_s + _LOOK_S - time.monotonic()))
            self._session = self.studio = None

    def _choose(self, session: Session) -> None:
        names = [key.split("/")[1] for key in session.present(EVERY_STUDIO)]
        self.why = None if names else say("design.no-studio")
        if self.studio not in names:
            self.studio = names[0] if names else None


async def _wait(question: Question) -> bytes:
    """Wait for the answer to a request; raise the same errors as `Question.take`."""
    pause_s = _FIRST_POLL_S
    while (payload := question.take()) is None:
        await asyncio.sleep(pause_s)
        pause_s = min(_LAST_POLL_S, pause_s * _SLOWER)
    return payload


class Listening:
    """A subscription to the reports on one search.

    Args:
        session: the connection.
        key: key expression on which the studio sends the reports.
        tell: called with each report, on another thread.
    """

    def __init__(self, session: Session, key: str, tell: Callable[[Progress], None]) -> None:
        self._tell = tell
        self._mailbox: Mailbox | None = None
        self._mailbox = session.mailbox(key, 1, self._arrived)

    def close(self) -> None:
        """End the subscription to the reports."""
        if self._mailbox is not None:
            self._mailbox.close()

    def _arrived(self) -> None:
        mail = self._mailbox.take() if self._mailbox is not None else None
        if mail is None:
            return
        try:
            self._tell(codec.decode(mail.payload, Progress))
        except codec.BadMessage:
            return
