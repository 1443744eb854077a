"""Metrics of a running process for Prometheus, at their own address.

Each owner keeps its numbers as plain values. A scrape reads them on its own thread,
without a lock, so it never delays what is measured.
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
        where: "HOST:PORT"; port 0 takes a free one.

    Raises:
        UserError: if this is not such an address, or the port can't be opened.
    """

    def __init__(self, where: str) -> None:
        match = _WHERE.fullmatch(where)
        if match is None or int(match["port"]) > 65_535:
            raise UserError(say("command.bad-metrics", where=where))
        self.registry = CollectorRegistry()
        """Register collectors here."""
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
        """Address for a scraper."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


_App = Callable[[dict[str, Any], Callable[..., Any]], Iterable[bytes]]


def _only_metrics(app: _App) -> _App:
    """Let an application of the library answer at /metrics alone; it would answer everywhere."""

    def answer(environ: dict[str, Any], start: Callable[..., Any]) -> Iterable[bytes]:
        if environ.get("PATH_INFO") == "/metrics":
            return app(environ, start)
        start("404 Not Found", [("Content-Type", "text/plain; charset=utf-8")])
        return [b"Metrics are at /metrics.\n"]

    return answer
