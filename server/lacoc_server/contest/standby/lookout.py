"""Looks on all known machines for an office with a later generation; ends earlier offices there."""

import threading
from contextlib import ExitStack
from typing import Self

from lacoc_server.contest.standby.messages import KnockAsk, OfficeThere
from lacoc_server.contest.standby.other import LacksIt, NotThere, Other, OtherToken
from lacoc_server.contest.standby.sealing import Sealing
from lacoc_server.contest.standby.tenure import Tenure
from lacoc_shared.command import log
from lacoc_shared.mistakes import UserError

_PAUSE_S = 0.5


class Lookout:
    """Asks all known machines again and again whether a later office runs there, on a thread.

    Used as a context manager. On entry each machine is asked once. So an office that is started
    again does nothing before it has looked for a later one.

    Args:
        tenure: this machine's time as the office; it ends if a later office answers.
        sealing: encrypts what is sent.

    Raises:
        UserError: if the known machines can't be read.
    """

    def __init__(self, tenure: Tenure, sealing: Sealing) -> None:
        self._tenure = tenure
        self._sealing = sealing
        self._others: dict[str, Other] = {}
        self._opened = ExitStack()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="lookout", daemon=True)

    def __enter__(self) -> Self:
        self._look()
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        self._thread.join()
        self._opened.close()

    def _run(self) -> None:
        while not self._ending.wait(_PAUSE_S):
            try:
                self._look()
            except UserError:  # the disk fails: the office itself says so
                log.get().exception("The lookout failed.")

    def _look(self) -> None:
        for address in self._tenure.known:
            if address not in self._others:
                other = self._opened.enter_context(Other(address, self._sealing))
                self._others[address] = other
            try:
                asked = KnockAsk(generation=self._tenure.generation)
                self._tenure.hear(self._others[address].ask(asked, OfficeThere).generation)
            except (NotThere, OtherToken, LacksIt):
                continue
