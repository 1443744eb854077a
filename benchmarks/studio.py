"""How long a trial takes: bare, for one student, for a whole class, and on the page of /design.

python -m benchmarks.studio class --students 30 --seconds 60
python -m benchmarks.studio page --cells 100 --trials 20

- `class`: at a studio, for one student alone, and for a class whose students try another gait every
  10 s.
- `page`: from a key in a cell to the robot's new posture, beside the time of one picture, because a
  machine without a graphics card draws slowly; from Try to the figures; and a scripted beginner,
  who makes a first gait from a new table, in whose postures the robot stands. Each number costs her
  1.5 s and each reading of a result 3 s, besides what the page itself takes.

Both time the same trial in this process, without page and network.
"""

import os
import random
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

from arguments import arguments
from chromium import chromium
from lacoc_process import Running
from own_page import THIS, OwnPage
from playwright.sync_api import Page
from sample_walks import course_of, entry_of

from benchmarks.figures import finish, percentile, spread
from lacoc_server.studio.answers import answer
from lacoc_shared.codec import encode
from lacoc_shared.gait.tables import LocomotionTable, Posture
from lacoc_shared.gait.text import write_gait
from lacoc_shared.messages import PROTOCOL, SentFile
from lacoc_shared.network.session import Question, open_client
from lacoc_shared.studio import GaitFiles, StudioKeys, TrialRequest

_ROBOT = "hexapod"
_NOISE_RAD = 0.05
_LIMIT_S = 60.0
_LOOK_S = 0.002
_EVERY_S = 10.0
_ALONE_AIM_S, _CLASS_AIM_S = 1.0, 2.0
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


@dataclass
class Student:
    """A student who asks for trials."""

    due_s: float
    """When to ask for the next trial [s]."""
    asked_s: float = 0.0
    """When the last trial was asked for [s]."""
    question: Question | None = None
    """The trial that has not been answered yet."""
    took_s: list[float] = field(default_factory=list)
    """How long each answered trial took [s]."""


def in_class(number: int, seconds: float, jobs: int) -> tuple[dict[str, Any], bool]:
    """Time trials at a studio; return the figures, and whether the aims were held.

    Args:
        number: number of students.
        seconds: how long they try.
        jobs: processes of the studio.
    """
    rng = random.Random(1)
    words = ("studio", "--json", "--jobs", str(jobs), "--listen", "tcp/127.0.0.1:0")
    with Running(*words, fresh=True) as studio:
        opened = studio.opened
        key = StudioKeys(opened["studio"]).request("trial")
        with open_client(opened["locators"]) as session:
            for _ in range(2 * jobs):  # every process compiles its floor once
                session.ask(key, _request(rng), _LIMIT_S)
            alone_s = []
            for _ in range(20):
                begin_s = time.perf_counter()
                session.ask(key, _request(rng), _LIMIT_S)
                alone_s.append(time.perf_counter() - begin_s)
            begin_s = time.perf_counter()
            students = [Student(begin_s + _EVERY_S * index / number) for index in range(number)]
            while time.perf_counter() < begin_s + seconds:
                for student in students:
                    now_s = time.perf_counter()
                    if student.question is None and now_s >= student.due_s:
                        student.question = session.question(key, _request(rng), _LIMIT_S)
                        student.asked_s, student.due_s = now_s, student.due_s + _EVERY_S
                    elif student.question is not None and student.question.take() is not None:
                        student.took_s.append(time.perf_counter() - student.asked_s)
                        student.question = None
                time.sleep(_LOOK_S)
    together_s = [took for student in students for took in student.took_s]
    found = {
        "trials": len(together_s),
        **spread(alone_s, "alone_{}_s"),
        **spread(together_s, "class_{}_s"),
    }
    held = found["alone_p95_s"] <= _ALONE_AIM_S and found["class_p95_s"] <= _CLASS_AIM_S
    return found, held


def on_page(cells: int, trials: int) -> tuple[dict[str, Any], bool]:
    """Time the page of `lacoc design`; return the figures, and whether the aims were held.

    Args:
        cells: how many numbers are typed.
        trials: how often Try is pressed.
    """
    with (
        tempfile.TemporaryDirectory() as folder,
        OwnPage(Path(folder), "design", checkout=THIS) as command,
        chromium() as browser,
    ):
        url = command.link
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        _opened(page, url)
        cells_ms = _cells_ms(page, cells)
        tries_s = _tries_s(page, trials)
        frame_ms = median(page.evaluate(_FRAMES, 60))  # while the trial is shown
        _opened(page, url)
        beginner_s, actions, figures = _beginner(page)
    found = {
        **spread(cells_ms, "cell_{}_ms"),
        "picture_ms": frame_ms,
        **spread(tries_s, "try_{}_s"),
        "beginner_s": beginner_s,
        "beginner_actions": actions,
        "beginner_mm": figures["speed_mm_s"] * figures["seconds"],
        "beginner_upright": figures["upright"],
    }
    return found, (
        percentile(cells_ms, 95) - frame_ms <= _CELL_AIM_MS
        and percentile(tries_s, 95) <= _TRY_AIM_S
        and beginner_s <= _BEGINNER_AIM_S
    )


def _request(rng: random.Random) -> bytes:
    """Make a request for a trial of the sample gait with random changes."""
    entry = entry_of(_ROBOT)
    assert entry.gait.locomotion is not None

    def changed(posture: Posture) -> Posture:
        return tuple(angle + rng.uniform(-_NOISE_RAD, _NOISE_RAD) for angle in posture)

    sequences = tuple(
        tuple(changed(posture) for posture in sequence)
        for sequence in entry.gait.locomotion.sequences
    )
    sent = SentFile("LocoTra-data.txt", write_gait(LocomotionTable(sequences), entry.robot.labels))
    return encode(TrialRequest(protocol=PROTOCOL, files=GaitFiles(locomotion=sent)))


def bare_s() -> float:
    """Return the median time of a trial in this process, on a floor that is already compiled."""
    course = course_of(_ROBOT)
    times, rng = [], random.Random(1)
    for _ in range(10):
        request = _request(rng)
        begin_s = time.perf_counter()
        assert answer("trial", request, lambda _: course).right
        times.append(time.perf_counter() - begin_s)
    return median(times)


def _opened(page: Page, url: str) -> None:
    page.goto(url)
    page.wait_for_selector("#gait-grid td", timeout=1000 * _LIMIT_S)
    page.wait_for_selector(".try:not([disabled])", timeout=1000 * _LIMIT_S)


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
    page.wait_for_selector(".result .tiles", timeout=1000 * _LIMIT_S)
    thinks_s += _A_RESULT_S
    figures = page.evaluate("window.__studio.showing.shown.value.trial.reply.figures")
    return time.perf_counter() - begin_s + thinks_s, actions, figures


def main() -> None:
    """Measure, print, and exit with 1 if the aims are missed."""
    options = arguments(
        __doc__,
        ("class", "page"),
        students=30,
        seconds=60.0,
        jobs=os.cpu_count() or 1,
        cells=100,
        trials=20,
    )
    bare = {"bare_trial_s": bare_s()}
    if options.what == "class":
        found, held = in_class(options.students, options.seconds, options.jobs)
    else:
        found, held = on_page(options.cells, options.trials)
    finish(bare | found, held)


if __name__ == "__main__":
    main()
