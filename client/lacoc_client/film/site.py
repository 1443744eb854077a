"""Serves the film's page and a record to the browser that draws it, on this machine only."""

import shutil
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlencode

from starlette.applications import Starlette

from lacoc_client.film.look import Look, Quality
from lacoc_client.web.gateway import server
from lacoc_client.web.gateway.files import NOT_BUILT, PageFiles
from lacoc_client.web.gateway.recordings import Recordings
from lacoc_client.web.gateway.site import page_routes, recording_routes
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_PATH = "/film"
_SPLIT = "split"


@dataclass(frozen=True)
class FilmSite:
    """A small web site on this machine with the page /film and a record."""

    base: str
    """Address of the site, such as "http://127.0.0.1:40000"."""
    files: tuple[str, ...]
    """The parts of the record, by the names under which they are served."""
    decided: tuple[int, ...] = ()
    """The points by seat that the organiser of the contest gave instead of the court's."""

    def address(self, look: Look) -> str:
        """Return the address of the page that shows the record, in the look of the film."""
        query = [
            *(("file", name) for name in self.files),
            ("q", "high" if look.quality is Quality.HIGH else "low"),
            ("smooth", "0" if look.quality is Quality.LOW else "1"),
            ("hud", "1" if look.overlay else "0"),
            ("split", "1" if look.view == _SPLIT else "0"),
            ("cam", "auto" if look.view == _SPLIT else look.view),
            ("lang", look.language),
            *(("decided", str(points)) for points in self.decided),
        ]
        return f"{self.base}{_PATH}?{urlencode(query)}"


@contextmanager
def served(paths: Sequence[Path], decided: tuple[int, ...] = ()) -> Iterator[FilmSite]:
    """Serve the film's page and a record until the `with` block ends.

    Args:
        paths: the record's files, in order.
        decided: as in `FilmSite`.

    Raises:
        UserError: if the pages are not built, or a file can't be read.
    """
    files = PageFiles()
    if not files.built:
        raise UserError(NOT_BUILT)
    with Scratch("film") as folder, server.listen(server.LOOPBACK) as opened:
        names = tuple(f"{number}.mcap" for number in range(len(paths)))
        for name, path in zip(names, paths, strict=True):
            try:
                shutil.copyfile(path, folder / name)
            except OSError as error:
                why = error.strerror or str(error)
                raise UserError(say("film.cannot-read", file=str(path), why=why)) from None
        shelf = Recordings(folder, lambda: ())
        routes = page_routes(files, (_PATH,), recording_routes(shelf))
        stopped = threading.Event()
        serving = threading.Thread(
            target=server.serve, args=(Starlette(routes=routes), opened, stopped.is_set)
        )
        serving.start()
        try:
            yield FilmSite(opened.url, names, decided)
        finally:
            stopped.set()
            serving.join()
            shelf.close()
