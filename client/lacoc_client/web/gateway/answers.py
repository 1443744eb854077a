"""Sends a page the answers to its requests: at once, later, or from another thread."""

import asyncio
import time
from collections.abc import Callable, Coroutine
from typing import Any

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

TOO_MUCH = say("gateway.too-much")

_AT_ONCE = 8
_LOGGED_HZ, _LOGGED_BURST = 1.0, 10


class Answers:
    """Sends a page the replies and refusals; used from the event loop only.

    Args:
        viewer: the page.
        log: logs a refusal.
    """

    def __init__(self, viewer: Viewer, log: Callable[[str, str], None]) -> None:
        self._viewer = viewer
        self._log = log
        self._logged = Allowance(_LOGGED_HZ, _LOGGED_BURST)
        self._tasks: set[asyncio.Task[None]] = set()

    def reply(self, to: int, value: Any) -> None:
        """Send the reply to the request with the number `to`."""
        self._viewer.send(wire.reply(to, value))

    def refuse(self, to: int, error: UserError | FileRefused) -> None:
        """Tell the page that its request with the number `to` was refused, and why."""
        self._viewer.send(wire.refusal(to, error))
        # The sentences contain no token. A page gets one refusal a second into the log, on average.
        if self._logged.take(1, time.monotonic()):
            self._log(f"Refused: {error}", "refused")

    def later(self, to: int, work: Coroutine[Any, Any, Any]) -> None:
        """Send a page the result of a coroutine as the reply, when the coroutine is done.

        The page's next requests do not wait for it.

        Raises:
            UserError: if too many requests are open already.
        """
        if len(self._tasks) >= _AT_ONCE:
            work.close()
            raise UserError(TOO_MUCH)
        task = asyncio.get_running_loop().create_task(self._answer(to, work))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _answer(self, to: int, work: Coroutine[Any, Any, Any]) -> None:
        try:
            self.reply(to, await work)
        except (UserError, FileRefused) as error:
            self.refuse(to, error)
        except Exception:  # a bug, but the page must get an answer
            self.refuse(to, UserError(wire.FAULT))
            raise

    def from_thread(self, to: int) -> Callable[[Any, UserError | FileRefused | None], None]:
        """Make a function that sends the answer to a request; any thread may call this function."""
        loop = asyncio.get_running_loop()

        def answer(value: Any, error: UserError | FileRefused | None) -> None:
            if error is None:
                in_loop(loop, lambda: self.reply(to, value))
            else:
                in_loop(loop, lambda: self.refuse(to, error))

        return answer

    def stop(self) -> None:
        """Cancel the page's requests that are not answered yet, because the page has gone."""
        for task in self._tasks:
            task.cancel()


def in_future(
    future: "asyncio.Future[Any]", value: Any, error: UserError | FileRefused | None
) -> None:
    """Set the result of a future, or its error if there is one; any thread may call this."""

    def settle() -> None:
        if future.done():
            return
        if error is None:
            future.set_result(value)
        else:
            future.set_exception(error)

    in_loop(future.get_loop(), settle)


def in_loop(loop: asyncio.AbstractEventLoop, do: Callable[[], None]) -> None:
    """Call a function on the event loop's thread; if the loop has ended, do nothing."""
    try:
        loop.call_soon_threadsafe(do)
    except RuntimeError:
        return
