"""Measures the time from a key in a real page to the frame that shows it, against a bare echo.

`python -m benchmarks.page_latency`; needs what tests of the pages need (tests/pages/chromium.py).
`python -m benchmarks.page_latency CHECKOUT` compares the keys with those of another checkout, whose
pages are built, in turns.
"""

import contextlib
import json
import random
import statistics
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from browser import chromium, own_page
from playwright.sync_api import Browser, Page, TimeoutError
from websockets.sync.server import ServerConnection
from websockets.sync.server import serve as serve_websocket

from lacoc_shared.seat import BEAT_S

FRAME_BYTES = 200
"""Length of the echo's messages, about that of a frame of practice."""
_ECHO = """
async ([url, count, bytes]) => {
  const socket = new WebSocket(url);
  socket.binaryType = "arraybuffer";
  await new Promise((open) => { socket.onopen = open; });
  const times = [];
  for (let n = 0; n < count; n++) {
    const begin = performance.now();
    socket.send(new Uint8Array(bytes));
    await new Promise((came) => { socket.onmessage = came; });
    times.push(performance.now() - begin);
    await new Promise((on) => setTimeout(on, 40));
  }
  socket.close();
  return times;
}
"""


def page_latency(keys: int = 100) -> dict[str, float]:
    """Measure keys and echoes in turns.

    Args:
        keys: number of keys that are pressed, and of echoes that are asked for.

    Returns:
        `key_p50_ms`, `key_p95_ms`, `echo_p50_ms`, `over_echo_ms`, and `aim_ms`, the aim for
        `over_echo_ms`: a tick and 10 ms.
    """
    turns = 5
    key_ms: list[float] = []
    echo_ms: list[float] = []
    with chromium() as browser, own_page("practice") as url, _echo() as echo:
        page = _walking(browser, url)
        bare = browser.new_page()
        for _ in range(turns):
            page.bring_to_front()
            key_ms += _press(page, keys // turns)
            bare.bring_to_front()
            echo_ms += bare.evaluate(_ECHO, [echo, keys // turns, FRAME_BYTES])
    key_p50_ms, echo_p50_ms = statistics.median(key_ms), statistics.median(echo_ms)
    return {
        "key_p50_ms": key_p50_ms,
        "key_p95_ms": statistics.quantiles(key_ms, n=20)[-1],
        "echo_p50_ms": echo_p50_ms,
        "over_echo_ms": key_p50_ms - echo_p50_ms,
        "aim_ms": 1000 * BEAT_S + 10,
    }


def compare(other: Path, keys: int = 300) -> dict[str, dict[str, float]]:
    """Measure keys of this checkout and of another one in turns.

    Args:
        other: root of the other checkout.
        keys: number of keys that are pressed in each.

    Returns:
        For `this` and `other`: `key_p50_ms` and `key_p95_ms`.
    """
    turns = 15
    key_ms: dict[str, list[float]] = {"this": [], "other": []}
    with (
        chromium() as browser,
        own_page("practice") as this_url,
        own_page("practice", checkout=other) as other_url,
    ):
        pages = {"this": _walking(browser, this_url), "other": _walking(browser, other_url)}
        for _ in range(turns):
            for side, page in pages.items():
                page.bring_to_front()
                key_ms[side] += _press(page, keys // turns)
    return {
        side: {
            "key_p50_ms": statistics.median(times_ms),
            "key_p95_ms": statistics.quantiles(times_ms, n=20)[-1],
        }
        for side, times_ms in key_ms.items()
    }


def rows(figures: dict[str, Any]) -> list[tuple[str, str, str, str, str]]:
    """Return the rows for the table of `make bench`."""
    return [
        (
            "key in the page to the frame that shows it",
            f"p50 {figures['key_p50_ms']:.1f} ms, p95 {figures['key_p95_ms']:.1f} ms",
            f"bare WebSocket echo p50 {figures['echo_p50_ms']:.2f} ms",
            f"{figures['over_echo_ms']:.1f} ms over",
            f"at most {figures['aim_ms']:.0f} ms over",
        )
    ]


def _walking(browser: Browser, url: str) -> Page:
    """Open the page of practice; return it when its keys work."""
    page = browser.new_page(viewport={"width": 800, "height": 450})
    page.goto(url.replace("/practice", "/practice?q=low"))
    page.wait_for_selector('.phase[data-phase="4"]', timeout=60_000)
    page.locator("canvas").first.click()
    _press(page, 5)  # because the first keys are slow
    return page


def _press(page: Page, count: int) -> list[float]:
    """Press keys; return the time of each as the page measures it [ms]."""
    times_ms: list[float] = []
    for number in range(count):
        shown = page.locator("[data-trip]")
        before = shown.get_attribute("data-trip")
        page.keyboard.press("1234"[number % 4])
        with contextlib.suppress(TimeoutError):  # two keys can take the same time, rounded
            page.wait_for_function(
                "(before) => document.querySelector('[data-trip]').dataset.trip !== before",
                arg=before,
                timeout=1000,
            )
        times_ms.append(float(shown.get_attribute("data-trip") or "nan"))
        page.wait_for_timeout(random.uniform(20, 60))  # so as not to keep in step with the beat
    return times_ms


@contextlib.contextmanager
def _echo() -> Iterator[str]:
    def answer(socket: ServerConnection) -> None:
        for message in socket:
            socket.send(message)

    with serve_websocket(answer, "127.0.0.1", 0, compression=None) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        port = server.socket.getsockname()[1]
        yield f"ws://127.0.0.1:{port}"
        server.shutdown()


if __name__ == "__main__":
    found = compare(Path(sys.argv[1])) if sys.argv[1:] else page_latency()
    json.dump(found, sys.stdout, indent=2)
    print()
