"""Measures a gateway with hundreds of spectators: its cost, their frames, the court's beats.

    python -m benchmarks.gateway [--pages 300] [--seconds 10] [--rounds 3]

A court with two hexapods that stand in READY, the gateway, and all spectators together run in three
processes. The kernel counts the processor time of each (Linux only).
"""

import argparse
import json
import statistics
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from processes import LACOC, Opened, ask, read_line, started, used_s
from processes import court as open_court

from lacoc_client.play.controller import Controller
from lacoc_client.play.spectator import Spectator
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.seat import Phase

_SETTLE_S = 1.0


def gateway(
    pages: int = 300, hz: float = 25.0, seconds: float = 10.0, rounds: int = 3
) -> dict[str, Any]:
    """Measure a gateway and a court in turns: rounds without pages, and rounds with many pages.

    Returns:
        Processor time of the gateway [% of a core] and of a beat of the court [us], without and
        with the pages; and the pages' frames a second.
    """
    alone_us, watched_us, gateway_cpu, idle_cpu = [], [], [], []
    slowest_hz, median_hz, frame_bytes = [], [], []
    with (
        tempfile.TemporaryDirectory() as folder,
        open_court("othello", Path(folder)) as court,
        _standing(court) as session,
        started(
            LACOC, "web", "--json", "--connect", court.address, "--viewers", str(pages + 10)
        ) as web,
    ):
        url = read_line(web)["url"]
        view = Spectator(session, court.name)
        for _ in range(rounds):
            time.sleep(_SETTLE_S)
            alone, idle = _cost(court.process, web, view, seconds)
            alone_us.append(alone)
            idle_cpu.append(idle)
            with started("tests.processes.crowd", url, str(pages), str(hz)) as crowd:
                read_line(crowd)
                time.sleep(_SETTLE_S)
                ask(crowd, "count")
                watched, busy = _cost(court.process, web, view, seconds)
                counted = ask(crowd, "count")
            watched_us.append(watched)
            gateway_cpu.append(busy)
            rates = [frames / counted["seconds"] for frames, _ in counted["counts"]]
            slowest_hz.append(min(rates))
            median_hz.append(statistics.median(rates))
            frame_bytes += [size / frames for frames, size in counted["counts"][:1]]
    return {
        "pages": pages,
        "hz": hz,
        "gateway_cpu_percent": statistics.median(gateway_cpu),
        "gateway_idle_percent": statistics.median(idle_cpu),
        "slowest_hz": statistics.median(slowest_hz),
        "median_hz": statistics.median(median_hz),
        "bytes_a_frame": statistics.median(frame_bytes),
        "beat_alone_us": statistics.median(alone_us),
        "beat_watched_us": statistics.median(watched_us),
        "ratio": statistics.median(
            watched / alone for watched, alone in zip(watched_us, alone_us, strict=True)
        ),
    }


def rows(figures: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    """Yield the rows for the table of `make bench`."""
    crowd = f"{figures['pages']} spectators at {figures['hz']:.0f} Hz"
    yield (
        f"gateway's processor time, {crowd}",
        f"{figures['gateway_cpu_percent']:.1f} % of a core",
        f"without them {figures['gateway_idle_percent']:.1f} %",
        "",
        "at most 15 %",
    )
    yield (
        "the slowest of them gets",
        f"{figures['slowest_hz']:.1f} frames/s of {figures['bytes_a_frame']:.0f} bytes",
        f"their median {figures['median_hz']:.1f}",
        "",
        "at least 24",
    )
    yield (
        "court's processor time a beat, with them",
        f"{figures['beat_watched_us']:.0f} us",
        f"without them {figures['beat_alone_us']:.0f} us",
        f"{figures['ratio']:.3f}",
        "at most 1.10",
    )


@contextmanager
def _standing(court: Opened) -> Iterator[Session]:
    """Put a robot into each seat; give the session with the court when both stand."""
    with open_client([court.address]) as session:
        for seat, token in court.tokens.items():
            controller = Controller(session, court.name, seat, token, seat)
            controller.join()
            controller.ready()
        while (frame := controller.wait_frame(1.0)) is None or frame.phase != Phase.READY:
            pass
        yield session


def _cost(
    court: subprocess.Popen[str], web: subprocess.Popen[str], view: Spectator, seconds: float
) -> tuple[float, float]:
    """Return the processor time of the court for a beat [us] and of the gateway [% of a core]."""
    beat, court_s, web_s, at_s = _beat(view), used_s(court), used_s(web), time.monotonic()
    time.sleep(seconds)
    beats, passed_s = _beat(view) - beat, time.monotonic() - at_s
    return (used_s(court) - court_s) / beats * 1e6, (used_s(web) - web_s) / passed_s * 100


def _beat(view: Spectator) -> int:
    view.poll()
    while (frame := view.wait_frame(1.0)) is None:
        pass
    return frame.beat


def main() -> None:
    """Run the benchmark and print its results."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gateway")
    parser.add_argument("--pages", type=int, default=300)
    parser.add_argument("--hz", type=float, default=25.0)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each measurement")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", action="store_true", help="print JSON for a program to read")
    options = vars(parser.parse_args())
    as_json = options.pop("json")
    figures = gateway(**options)
    if as_json:
        print(json.dumps(figures))
    else:
        for row in rows(figures):
            print("  ".join(cell for cell in row if cell))


if __name__ == "__main__":
    main()
