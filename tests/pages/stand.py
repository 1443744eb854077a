"""Serves and reads the stand, a test page that shows only the scene of a match."""

import base64
import functools
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from playwright.sync_api import Page

_PIXELS = """async (png) => {
  const image = await createImageBitmap(await (await fetch("data:image/png;base64," + png)).blob());
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  let text = "";
  for (let at = 0; at < data.length; at += 8192)
    text += String.fromCharCode(...data.subarray(at, at + 8192));
  return [image.width, image.height, btoa(text)];
}"""


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: Any) -> None:
        """Log nothing."""


class _Server(ThreadingHTTPServer):
    request_queue_size = 128  # a page asks for more files at once than the usual 5


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder on a free port of this machine, and give the server's address."""
    server = _Server(("127.0.0.1", 0), functools.partial(_Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


class Stand:
    """The stand, open in a page of the browser.

    Args:
        page: an open page.
        address: where the stand is served.
    """

    def __init__(self, page: Page, address: str) -> None:
        self.page = page
        self._address = address

    def open(self, match: str, frames: int = 3, **options: object) -> None:
        """Show a match, and wait until more than `frames` pictures are drawn (0: do not wait)."""
        words = "&".join(f"{name}={value}" for name, value in options.items())
        self.page.goto(f"{self._address}/index.html?match={match}&{words}")
        self.page.wait_for_selector("body[data-ready]")
        if frames:
            self.page.wait_for_function(f"window.__lacoc?.view?.drawnFrames > {frames}")

    def view(self, what: str) -> Any:
        """Return a value of the scene's test hook, such as `view("marker(3)")`."""
        return self.page.evaluate(f"window.__lacoc.view.{what}")

    def seek(self, beat: float) -> None:
        """Show one beat and stop there; wait until it is drawn."""
        self.page.evaluate("(beat) => stand.seek(beat)", beat)
        self.page.wait_for_function("(beat) => __lacoc.view.drawnBeat === beat", arg=beat)

    def next_frames(self, count: int = 2) -> None:
        """Wait until more than `count` further pictures have been drawn."""
        now = self.view("drawnFrames")
        self.page.wait_for_function(f"__lacoc.view.drawnFrames > {now + count}")

    def pixels(self) -> npt.NDArray[np.uint8]:
        """Return the page's picture: an array (height, width, 3) of red, green and blue."""
        return pixels_of(self.page, self.page)

    def pixel(self, x_m: float, y_m: float, z_m: float = 0.003) -> npt.NDArray[np.uint8]:
        """Return the picture's colour at a point of the world: the median of 3 x 3 pixels."""
        left, top = self.view(f"screen({x_m}, {y_m}, {z_m})")
        picture = self.pixels()[round(top) - 1 : round(top) + 2, round(left) - 1 : round(left) + 2]
        return np.median(picture.reshape(-1, 3), axis=0).astype(np.uint8)


def pixels_of(page: Page, reader: Page) -> npt.NDArray[np.uint8]:
    """Return a page's picture, an array (height, width, 3); the page `reader` decodes it."""
    png = base64.b64encode(page.screenshot()).decode()
    width, height, text = reader.evaluate(_PIXELS, png)
    flat = np.frombuffer(base64.b64decode(text), np.uint8)
    return flat.reshape(height, width, 4)[..., :3]


def share_of(picture: npt.NDArray[np.uint8], colour: str, near: int = 60) -> float:
    """Return the share of pixels that differ by less than `near` from a colour "#rrggbb"."""
    wanted = np.array([int(colour[at : at + 2], 16) for at in (1, 3, 5)])
    far = np.abs(picture.astype(int) - wanted).max(axis=-1)
    return float((far < near).mean())
