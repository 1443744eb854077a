"""Measures how fast the pages' scene is drawn in software, and how many bytes a player loads.

`python -m benchmarks.pages`; needs what the tests of the pages need (tests/pages/chromium.py).
`python -m benchmarks.pages --other CHECKOUT` draws in turns with another checkout's pages.
"""

import contextlib
import gzip
import os
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from arguments import arguments
from bot_matches import ARENAS
from chromium import WEB, build_pages, build_stand, chromium
from match_file import match_file
from playwright.sync_api import Browser, Response
from processes import children_s
from stand import Stand, served

from benchmarks.figures import Row, finish, medians

SIZE = {"width": 800, "height": 450}
MEASURE_S = 8.0
_STEADY = 200
"""Pictures before the measurement, because compiling makes the first ones slow."""


def pages() -> dict[str, Any]:
    """Measure the drawing of both arenas, and what /play loads.

    Returns:
        For each arena, drawn at 800 x 450: `fps`, `p95_ms`, `pixel_ratio` (low quality draws fewer
        pixels on a slow machine) and `cpu_ms` (processor time of the whole browser for a picture).
        For /play: `js_gzip_bytes` and `css_gzip_bytes`. For the machine: `cores`, and `load`, its
        load average at the beginning.
    """
    found: dict[str, Any] = {"cores": os.cpu_count(), "load": round(os.getloadavg()[0], 2)}
    with (
        tempfile.TemporaryDirectory() as name,
        chromium() as browser,
    ):
        folder = Path(name)
        build_stand(folder)
        with served(folder) as address:
            for arena in ARENAS:
                (folder / f"{arena}.bin").write_bytes(match_file(arena, 20.0))
                found[arena] = _drawing(browser, address, arena)
        found |= _loading(browser)
    return found


def compare(other: Path, rounds: int = 5) -> dict[str, Any]:
    """Measure the drawing of this checkout and of another one in turns.

    Args:
        other: root of the other checkout; both checkouts draw the same matches.
        rounds: how often each checkout is measured.

    Returns:
        For each arena: the medians for this and the other checkout, and in `ratio` the values of
        `fps` and `cpu_ms` of this checkout divided by those of the other. For the machine: `cores`,
        and `load`, its load average at the end.
    """
    found: dict[str, Any] = {}
    with (
        tempfile.TemporaryDirectory() as name,
        chromium() as browser,
        contextlib.ExitStack() as stack,
    ):
        addresses = {}
        for side, web in (("this", WEB), ("other", other / "client" / "web")):
            folder = Path(name) / side
            build_stand(folder, web)
            addresses[side] = stack.enter_context(served(folder))
        for arena in ARENAS:
            match = match_file(arena, 20.0)
            for side in addresses:
                (Path(name) / side / f"{arena}.bin").write_bytes(match)
            drawn = [
                {side: _drawing(browser, address, arena) for side, address in addresses.items()}
                for _ in range(rounds)
            ]
            sides = {side: medians([one[side] for one in drawn]) for side in addresses}
            ratio = {
                what: median(one["this"][what] / one["other"][what] for one in drawn)
                for what in ("fps", "cpu_ms")
            }
            found[arena] = {**sides, "ratio": ratio}
    return found | {"cores": os.cpu_count(), "load": round(os.getloadavg()[0], 2)}


def rows(figures: dict[str, Any]) -> list[Row]:
    """Return the rows for the table of `make bench`."""
    drawn = [
        Row(
            f"pictures at q=low, 800 x 450, software GL, {arena}",
            f"{figures[arena]['fps']:.0f} a second, p95 {figures[arena]['p95_ms']:.0f} ms",
            f"load {figures['load']} on {figures['cores']} cores",
            f"{figures[arena]['pixel_ratio']:.2f} pixels a side",
            "50 a second",
        )
        for arena in ARENAS
    ]
    size = f"{figures['js_gzip_bytes'] / 1000:.0f} kB"
    return [*drawn, Row("JavaScript that a player loads, gzipped", size, aim="200 kB")]


def _drawing(browser: Browser, address: str, arena: str) -> dict[str, float]:
    page = browser.new_page(viewport=SIZE)
    stand = Stand(page, address)
    stand.open(f"{arena}.bin", frames=_STEADY, q="low", beat=60)
    frames, cpu_s, begin_s = stand.view("drawnFrames"), children_s(), time.perf_counter()
    page.wait_for_timeout(1000 * MEASURE_S)
    drawn, passed_s = stand.view("drawnFrames") - frames, time.perf_counter() - begin_s
    figures = {
        "fps": drawn / passed_s,
        "p95_ms": stand.view("frameMsP95"),
        "pixel_ratio": stand.view("ratio"),
        "cpu_ms": 1000 * (children_s() - cpu_s) / drawn,
    }
    page.close()
    return figures


def _loading(browser: Browser) -> dict[str, int]:
    """Return the gzipped sizes of the scripts and styles that /play loads before it can draw."""
    loaded: dict[str, bytes] = {}

    def note(response: Response) -> None:
        with contextlib.suppress(Exception):  # a response that the page left before it was whole
            loaded[response.url.partition("?")[0]] = response.body()

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for child in build_pages().iterdir():
            (folder / child.name).symlink_to(child)
        (folder / "play").symlink_to(folder / "index.html")
        with served(folder) as address:
            page = browser.new_page(viewport=SIZE)
            page.on("response", note)
            # A file without an ending has no type, so this gives it one, as a gateway does.
            html = (folder / "index.html").read_text()
            page.route("**/play", lambda route: route.fulfill(body=html, content_type="text/html"))
            page.goto(f"{address}/play")
            page.wait_for_function(
                "performance.getEntriesByType('resource').some("
                "(entry) => entry.name.includes('/stage-'))"
            )
            page.wait_for_load_state("networkidle")
            page.close()
    sizes = {
        kind: sum(
            len(gzip.compress(body, 6)) for url, body in loaded.items() if url.endswith(f".{kind}")
        )
        for kind in ("js", "css")
    }
    return {"js_gzip_bytes": sizes["js"], "css_gzip_bytes": sizes["css"]}


if __name__ == "__main__":
    other = arguments(__doc__, other=(Path, "root of another checkout")).other
    finish(compare(other) if other else pages())
