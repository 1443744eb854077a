"""How soon the page of `lacoc design` shows a number and a trial, and how long a beginner needs.

    python -m benchmarks.design_page --cells 100 --trials 20

- From a key in a cell to the robot's new posture, in the page; beside it the time of one picture,
  because a machine without a graphics card draws slowly.
- From Try to the figures; beside it the same trial in one process without page and network.
- A scripted beginner makes a first gait from a new table, in whose postures the robot stands. Each
  number costs 1.5 s and each reading of a result 3 s, besides what the page itself takes.
"""

import argparse
import random
import sys
import time
from statistics import median, quantiles
from typing import Any

from browser import chromium, own_page
from playwright.sync_api import Page

from benchmarks.studio import bare_s

_TIMEOUT_MS = 60_000
_CELL_AIM_MS, _TRY_AIM_S, _BEGINNER_AIM_S = 50.0, 1.0, 240.0
_A_CELL_S, _A_RESULT_S = 1.5, 3.0
_OWN = {
    1: {0: 0, 3: 0, 12: 40, 14: 40, 16: 40},
    2: {2: 0, 5: 0, 12: 40, 14: 40, 16: 40},
}
"""The beginner's numbers: lift three legs, then let the other three push (phases 2 and 3)."""

_WATCH = """
tip => {
  // Each key's time, and when the posture after it was set.
  const state = (window.__times = { key: 0, at: [], frames: [] });
  addEventListener("keydown", (event) => { state.key = event.timeStamp; }, true);
  const where = () => JSON.stringify(window.__lacoc.view.bodyPos(tip));
  let last = where();
  const look = () => {
    const now = where();
    if (now !== last) {
      state.at.push(performance.now() - state.key);
      last = now;
    }
    setTimeout(look);
  };
  look();
}
"""
_FRAMES = """
async (count) => {
  const times = [];
  let before = await new Promise(requestAnimationFrame);
  for (let n = 0; n < count; n++) {
    const now = await new Promise(requestAnimationFrame);
    times.push(now - before);
    before = now;
  }
  return times;
}
"""


def _opened(page: Page, url: str) -> None:
    page.goto(url)
    page.wait_for_selector("#gait-grid td", timeout=_TIMEOUT_MS)
    page.wait_for_selector(".try:not([disabled])", timeout=_TIMEOUT_MS)


def _cells_ms(page: Page, count: int) -> list[float]:
    """Type numbers into a cell; return the time from each to the robot's new posture [ms]."""
    page.click("#cell-1-0")
    page.evaluate(_WATCH, "solo/leg0_1")
    for number in range(count):
        # One digit: the posture follows while the number is being typed.
        page.keyboard.press("123456789"[number % 9])
        page.wait_for_function("count => window.__times.at.length > count", arg=number)
        page.keyboard.press("Escape")
        page.wait_for_timeout(random.uniform(50, 150))
        page.evaluate("count => { window.__times.at.length = count + 1; }", number)
    times: list[float] = page.evaluate("window.__times.at")
    return times


def _tries_s(page: Page, count: int) -> list[float]:
    """Let the robot walk with several tables; return the time until the figures of each [s]."""
    times = []
    for number in range(count + 1):
        page.click("#cell-1-0")
        page.keyboard.type(str(number + 1))
        page.keyboard.press("Enter")
        before = page.locator(".trials > li").count()
        begin_s = time.perf_counter()
        page.keyboard.press("Control+Enter")
        page.wait_for_function(
            "before => document.querySelectorAll('.trials > li').length > before", arg=before
        )
        times.append(time.perf_counter() - begin_s)
    return times[1:]  # the first one also compiles the floor


def _beginner(page: Page) -> tuple[float, int, dict[str, Any]]:
    """Make a first gait; return how long that took [s], the number of actions, and its figures."""
    begin_s, actions, thinks_s = time.perf_counter(), 0, 0.0
    for selector in (".bar .name", "dialog >> text=New table"):
        page.click(selector)
        actions += 1
    for row, cells in _OWN.items():
        for col, angle in cells.items():
            page.click(f"#cell-{row}-{col}")
            page.keyboard.type(str(angle))
            page.keyboard.press("Enter")
            actions += 2
            thinks_s += _A_CELL_S
    for selector in (".strip >> text=Tools", "text=Make the other half", ".try"):
        page.click(selector)
        actions += 1
    page.wait_for_selector(".result .tiles", timeout=_TIMEOUT_MS)
    thinks_s += _A_RESULT_S
    figures = page.evaluate("window.__studio.showing.shown.value.trial.reply.figures")
    return time.perf_counter() - begin_s + thinks_s, actions, figures


def main() -> None:
    """Measure, print, and exit with 1 if an aim is missed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.design_page", description=__doc__)
    parser.add_argument("--cells", type=int, default=100)
    parser.add_argument("--trials", type=int, default=20)
    options = parser.parse_args()
    bare = bare_s(random.Random(1))
    with chromium() as browser, own_page("design") as url:
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        _opened(page, url)
        cells_ms = _cells_ms(page, options.cells)
        tries_s = _tries_s(page, options.trials)
        frame_ms = median(page.evaluate(_FRAMES, 60))  # while the trial is shown
        _opened(page, url)
        beginner_s, actions, figures = _beginner(page)
    cell_ms, try_s = quantiles(cells_ms, n=20)[-1], quantiles(tries_s, n=20)[-1]
    print(
        f"key in a cell to posture   p50 {median(cells_ms):.0f} ms, p95 {cell_ms:.0f} ms; "
        f"one picture {frame_ms:.0f} ms"
    )
    print(
        f"Try to figures             p50 {median(tries_s):.2f} s, p95 {try_s:.2f} s; "
        f"{median(tries_s) / bare:.1f} of the bare trial's {bare:.2f} s"
    )
    print(
        f"a beginner's first gait    {beginner_s:.0f} s, {actions} actions, "
        f"{figures['speed_mm_s'] * figures['seconds']:.0f} mm in {figures['cycles']} cycles, "
        f"upright {figures['upright']:.2f}"
    )
    sys.exit(
        cell_ms - frame_ms > _CELL_AIM_MS or try_s > _TRY_AIM_S or beginner_s > _BEGINNER_AIM_S
    )


if __name__ == "__main__":
    main()
