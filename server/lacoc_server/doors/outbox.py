"""Sends what a court publishes, on a separate thread: a crowd never makes a beat longer.

Sending to a thousand sessions takes longer than a beat's own work. The thread only sends what the
court has already recorded. It decides nothing, and the match never waits for it.
"""

import threading
from queue import SimpleQueue

from lacoc_shared.network.session import Publisher


class Outbox:
    """Sends messages in the order of the court's calls; close it before the network session."""

    def __init__(self) -> None:
        self._waiting: SimpleQueue[tuple[Publisher, bytes] | None] = SimpleQueue()
        self._newest: dict[Publisher, bytes] = {}
        self._thread = threading.Thread(target=self._run, name="outbox", daemon=True)
        self._thread.start()

    def send(self, publisher: Publisher, payload: bytes) -> None:
        """Send a message; newer messages do not replace it."""
        self._waiting.put((publisher, payload))

    def send_newest(self, publisher: Publisher, payload: bytes) -> None:
        """Send a message, unless a newer one of the same publisher comes while it still waits."""
        self._newest[publisher] = payload
        self._waiting.put((publisher, payload))

    def close(self) -> None:
        """Send the waiting messages, then end."""
        self._waiting.put(None)
        self._thread.join()

    def _run(self) -> None:
        while (item := self._waiting.get()) is not None:
            publisher, payload = item
            if self._newest.get(publisher, payload) is payload:
                publisher.put(payload)
