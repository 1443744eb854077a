"""Metrics of a running process for Prometheus, at their own address.

Each part of the program keeps its numbers as plain values. When Prometheus asks for the metrics (a
scrape), they are read on another thread, without a lock. So a scrape never delays the part that is
measured.
"""

import re
from collections.abc import Callable, Iterable
from typing import Any, Self

from prometheus_client import CollectorRegistry, Info, make_wsgi_app, start_http_server

from lacoc_shared import __version__
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_WHERE = re.compile(r"(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9_.-]+):(?P<port>[0-9]{1,5})")


class Exporter:
    """Answers scrapes at `/metrics`, in Prometheus's text format; used as a context manager.

    Args:
        where: "HOST:PORT"; port 0 chooses a free port.

    Raises:
        UserError: if the address is wrong, or the port can't be opened.
    """

    def __init__(self, where: str) -> None:
        match = _WHERE.fullmatch(where)
        if match is None or int(match["port"]) > 65_535:
            raise UserError(say("command.bad-metrics", where=where))
        self.registry = CollectorRegistry()
        """The registry of Prometheus's library; register collectors here."""
        build = Info("lacoc_build", "Version of LACOC.", registry=self.registry)
        build.info({"version": __version__})
        host = match["host"].strip("[]")
        try:
            self._server, self._thread = start_http_server(int(match["port"]), host, self.registry)
        except OSError as error:
            why = error.strerror or str(error)
            raise UserError(say("command.metrics-fail", where=where, why=why)) from None
        self._server.set_app(_only_metrics(make_wsgi_app(self.registry)))
        self.url = f"http://{match['host']}:{self._server.server_port}/metrics"
        """The address at which a scraper reads the metrics."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


_App = Callable[[dict[str, Any], Callable[..., Any]], Iterable[bytes]]


def _only_metrics(app: _App) -> _App:
    """Make an application answer at /metrics only; that of the library answers at every path."""

    def answer(environ: dict[str, Any], start: Callable[..., Any]) -> Iterable[bytes]:
        if environ.get("PATH_INFO") == "/metrics":
            return app(environ, start)
        start("404 Not Found", [("Content-Type", "text/plain; charset=utf-8")])
        return [b"Metrics are at /metrics.\n"]

    return answer
