"""Measures the time from a key to the frame that shows it, against a bare Zenoh echo."""

import random
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

from processes import court, read_line, started

from benchmarks.echo import PING, PONG
from lacoc_client.play.controller import Controller
from lacoc_shared.network.session import Mailbox, Publisher, open_client
from lacoc_shared.seat import BEAT_S, Phase


def latency(rounds: int) -> dict[str, Any]:
    """Press keys at a court in a process of its own, and wait for the frame that shows each.

    Keys and echoes take turns. `over_echo_ms` is the median time of a key less that of an echo. On
    average 10 ms of it are the wait for the next beat; the rest is the court's own time.

    Returns:
        Times of keys and echoes [ms].
    """
    keys_ms, echoes_ms = [], []
    chance = random.Random(1)  # presses must not keep in step with the beats
    with (
        tempfile.TemporaryDirectory() as folder,
        court("practice", Path(folder)) as opened,
        started("benchmarks.echo") as echo,
    ):
        (seat, token), *_ = opened.tokens.items()
        with (
            open_client([opened.address]) as session,
            open_client(read_line(echo)["locators"]) as echo_session,
        ):
            controller = Controller(session, opened.name, seat, token, "Benchmark")
            controller.join()
            controller.ready()
            while (frame := controller.wait_frame(1.0)) is None or frame.phase != Phase.PLAYING:
                pass
            ping, pong = echo_session.publisher(PING), echo_session.mailbox(PONG, 16)
            for number in range(rounds):
                _idle(controller, chance.uniform(0.02, 0.06))
                keys_ms.append(_key_ms(controller, 1 + number % 3))
                echoes_ms.append(_echo_ms(ping, pong))
            controller.leave()
    return {
        "key_p50_ms": statistics.median(keys_ms),
        "key_p95_ms": statistics.quantiles(keys_ms, n=20)[-1],
        "echo_p50_ms": statistics.median(echoes_ms),
        "echo_p95_ms": statistics.quantiles(echoes_ms, n=20)[-1],
        "over_echo_ms": statistics.median(keys_ms) - statistics.median(echoes_ms),
        "mean_wait_for_beat_ms": BEAT_S / 2 * 1000,
    }


def _idle(controller: Controller, seconds: float) -> None:
    end_s = time.monotonic() + seconds
    while (left_s := end_s - time.monotonic()) > 0:
        controller.wait_frame(left_s)


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
