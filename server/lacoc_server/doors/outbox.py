"""What a court publishes, sent by a thread of its own: a crowd never makes a beat longer.

Sending to a thousand sessions takes longer than a beat's own work. The thread only sends what
the court has made and recorded; it decides nothing and the match never waits for it.
"""

import threading
from queue import SimpleQueue

from lacoc_shared.network.session import Publisher


class Outbox:
    """Sends in the order of the court; closed before the session is."""

    def __init__(self) -> None:
        self._waiting: SimpleQueue[tuple[Publisher, bytes] | None] = SimpleQueue()
        self._newest: dict[Publisher, bytes] = {}
        self._thread = threading.Thread(target=self._run, name="outbox", daemon=True)
        self._thread.start()

    def send(self, publisher: Publisher, payload: bytes) -> None:
        """Send what must arrive."""
        self._waiting.put((publisher, payload))

    def send_newest(self, publisher: Publisher, payload: bytes) -> None:
        """Send what a newer one replaces: if it still waits then, it is left out."""
        self._newest[publisher] = payload
        self._waiting.put((publisher, payload))

    def close(self) -> None:
        """Send what waits, then end."""
        self._waiting.put(None)
        self._thread.join()

    def _run(self) -> None:
        while (item := self._waiting.get()) is not None:
            publisher, payload = item
            if self._newest.get(publisher, payload) is payload:
                publisher.put(payload)
