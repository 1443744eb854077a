"""Numbers of a running process for Prometheus, at an address of their own.

Whoever has the numbers keeps them as plain values; a scrape reads them on a thread of
its own, and no lock is shared with what is measured.
"""

import re
from typing import Self

from prometheus_client import CollectorRegistry, start_http_server

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_WHERE = re.compile(r"(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9_.-]+):(?P<port>[0-9]{1,5})")


class Exporter:
    """Answers scrapes at `/metrics`, in Prometheus's text format; used as a context manager.

    Args:
        where: "HOST:PORT"; port 0 takes a free one.

    Raises:
        UserError: if it is no such address, or can't be listened on.
    """

    def __init__(self, where: str) -> None:
        match = _WHERE.fullmatch(where)
        if match is None or int(match["port"]) > 65_535:
            raise UserError(say("command.bad-metrics", where=where))
        self.registry = CollectorRegistry()
        """Takes the collectors of what is to be seen."""
        host = match["host"].strip("[]")
        try:
            self._server, self._thread = start_http_server(int(match["port"]), host, self.registry)
        except OSError as error:
            why = error.strerror or str(error)
            raise UserError(say("command.metrics-fail", where=where, why=why)) from None
        self.url = f"http://{match['host']}:{self._server.server_port}/metrics"
        """Where a scraper finds them."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
