"""Sends requests to an office on another machine, and reads its answers."""

from contextlib import ExitStack
from typing import Self, TypeVar

from lacoc_server.contest.standby.messages import AnyAnswer, AnyAsk, Lacks
from lacoc_server.contest.standby.sealing import REQUEST, BadSeal, Sealing
from lacoc_shared import codec
from lacoc_shared.codec import encode
from lacoc_shared.keyspace import DESK
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import is_open
from lacoc_shared.network.session import NoReply, NotConnected, Refused, Session, open_client
from lacoc_shared.words import Phrase, say

T = TypeVar("T")

_ANSWER_S = 2.0
_MAX_BYTES = 1 << 20


class NotThere(Exception):
    """No office answers at this address now."""


class OtherToken(UserError):
    """An office answers, but its token is not this machine's, so its answers can't be decrypted."""


class LacksIt(Exception):
    """The other machine does not have what was asked for, or no longer has it."""

    def __init__(self, why: Phrase) -> None:
        super().__init__(why.code)
        self.why = why


class Other:
    """Asks an office at another machine, and waits for its answers; used as a context manager.

    Args:
        address: its address.
        sealing: encrypts what is sent.
    """

    def __init__(self, address: str, sealing: Sealing) -> None:
        self.address = address
        self._sealing = sealing
        self._session: Session | None = None
        self._opened = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._opened.close()

    def ask(self, request: AnyAsk, kind: type[T]) -> T:
        """Send a request, and return the answer.

        Args:
            request: the question.
            kind: the kind of answer.

        Raises:
            NotThere: if nobody answers.
            OtherToken: if the other machine's token is not this machine's.
            LacksIt: if the other machine does not have what was asked for.
        """
        sealed = self._sealing.seal(encode(request), REQUEST)
        try:
            answered = self._connected().ask(DESK, sealed, _ANSWER_S)
            answer = self._sealing.open(codec.decode(answered, bytes, _MAX_BYTES), sealed)
            found: AnyAnswer = codec.decode(answer, AnyAnswer, _MAX_BYTES)  # type: ignore[arg-type]
        except (Refused, BadSeal, codec.BadMessage):
            raise OtherToken(say("standby.other-token", at=self.address)) from None
        except (NoReply, NotConnected):
            raise NotThere from None
        return self.read(found, kind)

    def read(self, answer: AnyAnswer, kind: type[T]) -> T:
        """Return an answer if it is of the expected kind; else raise the errors of `ask`."""
        if isinstance(answer, Lacks):
            raise LacksIt(answer.why)
        if not isinstance(answer, kind):
            raise OtherToken(say("standby.other-token", at=self.address))
        return answer

    def _connected(self) -> Session:
        """Return the network session to the other machine; open it if it is not open yet.

        Once it was open, it connects again by itself.

        Raises:
            NotThere: if nothing listens at the address.
        """
        if self._session is None:
            if not is_open(self.address):
                raise NotThere
            self._session = self._opened.enter_context(open_client([self.address]))
        return self._session
