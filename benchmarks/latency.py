"""The time from a key to the frame that shows it, against a bare echo in the same run.

    python -m benchmarks.latency program          # a program at a court; a Zenoh echo
    python -m benchmarks.latency page             # a page in a browser; a WebSocket echo
    python -m benchmarks.latency page --other CHECKOUT

With `--other`, pages of this and of another checkout, which are built, take turns. Pages need what
their tests need (tests/pages/chromium.py). About 10 ms of each key's time are the wait for a beat.
"""

import contextlib
import random
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import zenoh
from arguments import arguments
from chromium import chromium
from court_process import CourtProcess
from own_page import THIS, OwnPage
from playwright.sync_api import Browser, Page, TimeoutError
from processes import read_line, started
from websockets.sync.server import ServerConnection
from websockets.sync.server import serve as serve_websocket

from benchmarks.figures import Row, finish, spread
from lacoc_client.play.controller import Controller
from lacoc_shared.network.session import Mailbox, Publisher, open_client
from lacoc_shared.seat import BEAT_S, Phase

TURNS = 5
AIM_MS = 1000 * BEAT_S + 10
"""Most by which the time of a key on a page may exceed that of the echo [ms]."""
_PING, _PONG = "lacoc/echo/ping", "lacoc/echo/pong"
_FRAME_BYTES = 280
_ZENOH = """{
  mode: "router",
  listen: { endpoints: ["tcp/127.0.0.1:0"] },
  scouting: { multicast: { enabled: false }, gossip: { enabled: false } },
  adminspace: { enabled: true },
  transport: { shared_memory: { enabled: false } },
}"""
_PAGE_BYTES = 200
"""Length of the WebSocket echo's messages, about that of a frame of practice."""
_WEBSOCKET = """
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


def of_program(keys: int) -> dict[str, float]:
    """Press keys at a court in a process of its own, and echo, in turns.

    Returns:
        Times of keys and echoes, and the median time of a key less that of an echo [ms].
    """
    keys_ms, echoes_ms = [], []
    chance = random.Random(1)  # presses must not keep in step with the beats
    with (
        tempfile.TemporaryDirectory() as folder,
        CourtProcess(Path(folder), "--arena", "practice", fresh=True) as court,
        started("benchmarks.latency", "--echo") as echo,
    ):
        (seat, token), *_ = court.tokens.items()
        with (
            open_client([court.address]) as session,
            open_client(read_line(echo)["locators"]) as echo_session,
        ):
            controller = Controller(session, court.name, seat, token, "Benchmark")
            controller.join()
            controller.ready()
            while (frame := controller.wait_frame(1.0)) is None or frame.phase != Phase.PLAYING:
                pass
            ping, pong = echo_session.publisher(_PING), echo_session.mailbox(_PONG, 16)
            for number in range(keys):
                end_s = time.monotonic() + chance.uniform(0.02, 0.06)
                while (left_s := end_s - time.monotonic()) > 0:
                    controller.wait_frame(left_s)
                keys_ms.append(_key_ms(controller, 1 + number % 3))
                echoes_ms.append(_echo_ms(ping, pong))
            controller.leave()
    return _told(keys_ms, echoes_ms)


def of_page(keys: int) -> dict[str, float]:
    """Press keys in a page, and echo, in turns; return what `of_program` returns."""
    keys_ms: list[float] = []
    echoes_ms: list[float] = []
    with _practice(THIS) as command, chromium() as browser, _websocket_echo() as echo:
        page = _walking(browser, command)
        bare = browser.new_page()
        for _ in range(TURNS):
            page.bring_to_front()
            keys_ms += _press(page, keys // TURNS)
            bare.bring_to_front()
            echoes_ms += bare.evaluate(_WEBSOCKET, [echo, keys // TURNS, _PAGE_BYTES])
    return _told(keys_ms, echoes_ms)


def of_two_pages(keys: int, other: Path) -> dict[str, dict[str, float]]:
    """Press keys in pages of this checkout and of another one, in turns."""
    keys_ms: dict[str, list[float]] = {"this": [], "other": []}
    with _practice(THIS) as this, _practice(other) as that, chromium() as browser:
        pages = {"this": _walking(browser, this), "other": _walking(browser, that)}
        for _ in range(3 * TURNS):
            for side, page in pages.items():
                page.bring_to_front()
                keys_ms[side] += _press(page, keys // TURNS)
    return {side: spread(times_ms, "key_{}_ms") for side, times_ms in keys_ms.items()}


def rows(program: dict[str, float], page: dict[str, float]) -> list[Row]:
    """Return the rows for the table of `make bench`."""
    return [
        Row(
            what,
            f"p50 {figures['key_p50_ms']:.1f} ms, p95 {figures['key_p95_ms']:.1f} ms",
            f"bare {echo} echo p50 {figures['echo_p50_ms']:.2f} ms, "
            f"p95 {figures['echo_p95_ms']:.2f} ms",
            f"{figures['over_echo_ms']:.1f} ms over",
            aim,
        )
        for what, figures, echo, aim in (
            ("key to the frame that shows it", program, "Zenoh", "0-20 ms wait for a beat"),
            ("key in the page to that frame", page, "WebSocket", f"at most {AIM_MS:.0f} ms over"),
        )
    ]


def _told(keys_ms: list[float], echoes_ms: list[float]) -> dict[str, float]:
    over_ms = statistics.median(keys_ms) - statistics.median(echoes_ms)
    return {
        **spread(keys_ms, "key_{}_ms"),
        **spread(echoes_ms, "echo_{}_ms"),
        "over_echo_ms": over_ms,
    }


def _key_ms(controller: Controller, digit: int) -> float:
    begin = time.perf_counter()
    seq = controller.press(1, digit)
    while True:
        frame = controller.wait_frame(1.0)
        if frame is not None and frame.seats[0].applied_seq >= seq:
            return (time.perf_counter() - begin) * 1000


def _echo_ms(ping: Publisher, pong: Mailbox) -> float:
    begin = time.perf_counter()
    ping.put(bytes(48))
    while pong.take() is None:
        pong.wait(1.0)
    return (time.perf_counter() - begin) * 1000


@contextlib.contextmanager
def _practice(checkout: Path) -> Iterator[OwnPage]:
    with (
        tempfile.TemporaryDirectory() as folder,
        OwnPage(Path(folder), "practice", checkout=checkout) as command,
    ):
        yield command


def _walking(browser: Browser, command: OwnPage) -> Page:
    """Open the page of practice; return it when its keys work."""
    page = browser.new_page(viewport={"width": 800, "height": 450})
    page.goto(command.link.replace("/practice", "/practice?q=low"))
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
def _websocket_echo() -> Iterator[str]:
    def answer(socket: ServerConnection) -> None:
        for message in socket:
            socket.send(message)

    with serve_websocket(answer, "127.0.0.1", 0, compression=None) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        port = server.socket.getsockname()[1]
        yield f"ws://127.0.0.1:{port}"
        server.shutdown()


def _zenoh_echo() -> None:
    """Answer every ping until the input ends, by plain Zenoh: no access rules, one callback."""
    with zenoh.open(zenoh.Config.from_json5(_ZENOH)) as session:
        pong = session.declare_publisher(_PONG)

        def answer(_: zenoh.Sample) -> None:
            pong.put(bytes(_FRAME_BYTES))

        session.declare_subscriber(_PING, zenoh.handlers.Callback(answer, indirect=False))
        for reply in session.get(f"@/{session.info.zid()}/router"):
            if reply.ok is not None:
                print(reply.ok.payload.to_string(), flush=True)
        sys.stdin.read()


def main() -> None:
    """Run the benchmark and print its results."""
    if sys.argv[1:] == ["--echo"]:
        _zenoh_echo()
        return
    options = arguments(__doc__, ("program", "page"), keys=100, other=Path)
    found: dict[str, Any]
    if options.what == "program":
        found = of_program(options.keys)
    elif options.other:
        found = of_two_pages(options.keys, options.other)
    else:
        found = of_page(options.keys)
    finish(found, found.get("over_echo_ms", 0.0) <= AIM_MS)


if __name__ == "__main__":
    main()
