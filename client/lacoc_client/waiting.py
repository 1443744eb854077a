"""Commands that run as services wait for their court: it may be started after them, or again."""

import time
from collections.abc import Callable
from typing import TypeVar

from lacoc_client.asking import NoCourt, NotNow
from lacoc_shared.command import screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import NotConnected

T = TypeVar("T")

_AGAIN_S = 0.5


class Patience:
    """How long a command waits for its court; the time begins anew when the court was there.

    Args:
        wait_s: how long; None: not at all, as is right for a person.
        stopping: says whether somebody asked the command to end.
    """

    def __init__(self, wait_s: float | None, stopping: Callable[[], bool] = lambda: False) -> None:
        self.wait_s = wait_s
        self._stopping = stopping
        self._told = ""

    def until(self, do: Callable[[], T]) -> T:
        """Do what needs a court, again and again while there is none, or it says "not now".

        Raises:
            UserError: as `do`, for good or when the time is over.
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
            time.sleep(_AGAIN_S)

    def _tell(self, error: UserError) -> None:
        if str(error) != self._told:
            self._told = str(error)
            screen.note(f"{error} This waits for it, up to {self.wait_s:g} s.")
