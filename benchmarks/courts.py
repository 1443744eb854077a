"""How late beats are: of many courts on one machine, and with a crowd that watches.

    python -m benchmarks.courts --courts 20 --seconds 120 --rounds 1
    python -m benchmarks.courts --pages 300
    python -m benchmarks.courts --direct 1000
    python -m benchmarks.courts --scrapes 10

Each court has a process of its own and is in PLAYING; one process holds all seats and presses keys.
Rounds without and with the crowd take turns; by default there is no crowd at all. The crowd
is any number of pages through one gateway, which watch the courts in turns, of direct spectators of
the first court, and of scrapes of its metrics a second (Prometheus makes one in 15 s). It runs in
its own processes on the last core, where it disturbs the courts least (Linux only).

The time of a beat is its whole work on the wall clock. A slow beat starts more than 20 ms late; a
sleeper, which wakes 50 times a second and does nothing else, shows how late the machine is by
itself. A beat is missed if it was due and a court never ran it.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from arguments import arguments
from lacoc_process import Running
from processes import ask, read_line, started, used_s

from benchmarks.figures import Row, finish, medians, percentile
from lacoc_server.court.pace import Pace
from lacoc_shared.seat import BEATS_PER_S, Phase

MOST_SLOW = 0.001
"""Largest share of slow beats, after the share of the sleeper's slow beats was subtracted."""
MOST_RATIO = 1.2
"""Most by which a crowd may make the 99th percentile of beats longer."""
HUNDREDS = 300
"""With more direct spectators than this, the ratio has no aim: only no beat may be missed."""
PAGES_HZ = 25.0
_SETTLE_S = 2.0


class _Courts:
    """The courts, their gateway and the sleeper."""

    def __init__(self, number: int, viewers: int, stack: ExitStack) -> None:
        self.names = [f"court-{one}" for one in range(1, number + 1)]
        self.processes = [
            stack.enter_context(started("tests.processes.measured_court", name))
            for name in self.names
        ]
        self.opened = [read_line(process) for process in self.processes]
        ask(stack.enter_context(started("benchmarks.players")), json.dumps(self.opened))
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), "contest.toml")
        file.write_text("".join(map(_entry, self.opened)))
        words = ("--contest", str(file), "--viewers", str(viewers + 1))
        web = stack.enter_context(Running("web", "--json", *words, fresh=True))
        self.gateway, self.url = web.process, web.opened["url"]
        self.sleeper = stack.enter_context(started("benchmarks.courts", "--sleep"))
        read_line(self.sleeper)

    def measured(self, seconds: float) -> dict[str, float]:
        """Measure the beats for a time."""
        time.sleep(_SETTLE_S)
        begins_s = [ask(court, "count")["at_s"] for court in self.processes]
        slept = ask(self.sleeper, "count")
        cpu_s, web_s = sum(map(used_s, self.processes)), used_s(self.gateway)
        time.sleep(seconds)
        told = [ask(court, "count") for court in self.processes]
        sleeper = ask(self.sleeper, "count")
        cpu_s, web_s = sum(map(used_s, self.processes)) - cpu_s, used_s(self.gateway) - web_s
        assert all(one["phase"] == Phase.PLAYING for one in told), told
        wall_ms = sorted(1000 * took_s for one in told for took_s in one["wall_s"])
        missed = 0
        for begin_s, one in zip(begins_s, told, strict=True):
            due = int((one["at_s"] - begin_s) * BEATS_PER_S)
            missed += max(0, due - len(one["wall_s"]) - 1)  # one beat may be due just now
        bare_slow = sleeper["slow_beats"] - slept["slow_beats"]
        return {
            "beats": len(wall_ms),
            "missed": missed,
            "slow_beats": sum(one["slow_beats"] for one in told),
            "bare_slow_share": bare_slow / (sleeper["beats"] - slept["beats"]),
            "p50_ms": statistics.median(wall_ms),
            "p99_ms": percentile(wall_ms, 99),
            "cpu_ms": 1000 * cpu_s / len(wall_ms),
            "gateway_percent": 100 * web_s / seconds,
        }


def courts(
    courts: int = 1,
    pages: int = 0,
    direct: int = 0,
    scrapes: int = 0,
    seconds: float = 10.0,
    rounds: int = 7,
) -> dict[str, Any]:
    """Measure courts' beats in turns: rounds without a crowd, and rounds with it.

    Args:
        courts: number of courts.
        pages: number of spectators through the gateway.
        direct: number of spectators with a session of their own with the first court.
        scrapes: how many times a second the first court's metrics are scraped.
        seconds: length of a round.
        rounds: number of rounds of each kind.

    Returns:
        The figures without and with the crowd (`alone`, `crowd`; medians of the rounds' figures:
        times of a beat, processor time of a beat and of the gateway); the ratios of the 99th
        percentile and of the processor time; the share of slow beats of the rounds without a crowd,
        less the sleeper's; all missed beats; and what the crowd got.
    """
    alone, crowded = [], []
    got: list[dict[str, Any]] = []
    scraped: list[float] = []
    with ExitStack() as stack:
        those = _Courts(courts, pages, stack)
        first = those.opened[0]
        kinds = [
            ("pages", those.url, pages, ",".join(those.names)),
            ("direct", first["address"], direct, first["name"]),
            ("scrapes", first["metrics"], scrapes, ""),
        ]
        for _ in range(rounds):
            alone.append(those.measured(seconds))
            if not pages + direct + scrapes:
                continue
            with ExitStack() as round_:
                crowd = [round_.enter_context(_on_last_core(*one)) for one in kinds if one[2]]
                for one in crowd:
                    ask(one, "count")
                crowded.append(those.measured(seconds))
                counted = [ask(one, "count") for one in crowd]
            if scrapes:
                times, took_us = counted.pop()["counts"][0]
                scraped.append(took_us / times / 1000)
            got += counted
        for process in those.processes:
            process.communicate("stop\n", timeout=60)
    beats = sum(one["beats"] for one in alone)
    bare = statistics.mean(one["bare_slow_share"] for one in alone)
    found: dict[str, Any] = {
        "courts": courts,
        "cores": len(os.sched_getaffinity(0)),
        "load": os.getloadavg()[0],
        "alone": medians(alone),
        "slow_share": sum(one["slow_beats"] for one in alone) / beats - bare,
        "missed": sum(one["missed"] for one in (*alone, *crowded)),
    }
    if crowded:
        pairs = list(zip(alone, crowded, strict=True))
        found |= {
            "crowd": medians(crowded),
            "ratio": statistics.median(b["p99_ms"] / a["p99_ms"] for a, b in pairs),
            "cpu_ratio": statistics.median(b["cpu_ms"] / a["cpu_ms"] for a, b in pairs),
        }
    if scraped:
        found["scrape_ms"] = statistics.median(scraped)
    if got:
        rates = [frames / one["seconds"] for one in got for frames, _ in one["counts"]]
        sizes = [size / frames for one in got for frames, size in one["counts"][:1]]
        found |= {
            "slowest_hz": min(rates),
            "median_hz": statistics.median(rates),
            "bytes_a_frame": statistics.median(sizes),
        }
    return found


def rows(figures: dict[str, Any], pages: int) -> list[Row]:
    """Return the rows of a crowd of pages for the table of `make bench`."""
    alone, crowd = figures["alone"], figures["crowd"]
    return [
        Row(
            f"gateway's processor time, {pages} spectators at {PAGES_HZ:.0f} Hz",
            f"{crowd['gateway_percent']:.1f} % of a core",
            f"without them {alone['gateway_percent']:.1f} %",
            aim="at most 15 %",
        ),
        Row(
            "the slowest of them gets",
            f"{figures['slowest_hz']:.1f} frames/s of {figures['bytes_a_frame']:.0f} bytes",
            f"their median {figures['median_hz']:.1f}",
            aim="at least 24",
        ),
        Row(
            "court's processor time a beat, with them",
            f"{1000 * crowd['cpu_ms']:.0f} us",
            f"without them {1000 * alone['cpu_ms']:.0f} us",
            f"{figures['cpu_ratio']:.3f}",
            "at most 1.10",
        ),
    ]


def _entry(opened: dict[str, Any]) -> str:
    """Return a court's part of the contest file."""
    return f'[court.{opened["name"]}]\narena = "othello"\nlisten = ["{opened["address"]}"]\n'


@contextmanager
def _on_last_core(
    what: str, address: str, number: int, names: str
) -> Iterator[subprocess.Popen[str]]:
    """Run a crowd's process on the last core; yield it when the whole crowd is connected."""
    words: Sequence[str] = ("--address", address, "--number", str(number), "--courts", names)
    with started("tests.processes.crowd", what, *words, "--hz", str(PAGES_HZ)) as process:
        os.sched_setaffinity(process.pid, sorted(os.sched_getaffinity(0))[-1:])
        read_line(process)
        yield process


def _sleep() -> None:
    """Sleep from beat to beat as a court does; for each input line print beats and slow beats."""
    pace, beats = Pace(time.monotonic()), 0
    os.set_blocking(sys.stdin.fileno(), False)
    print("{}", flush=True)
    while True:
        time.sleep(pace.wait_s(time.monotonic()))
        pace.begin(time.monotonic())
        beats += 1
        if sys.stdin.readline():
            print(json.dumps({"beats": beats, "slow_beats": pace.slow_beats}), flush=True)


def main() -> None:
    """Run the benchmark and print its results."""
    if sys.argv[1:] == ["--sleep"]:
        _sleep()
    options = arguments(
        __doc__,
        courts=1,
        pages=(0, "spectators through a gateway"),
        direct=(0, "spectators of the first court itself"),
        scrapes=(0, "of its metrics a second"),
        seconds=(10.0, "of each round"),
        rounds=7,
    )
    found = courts(**vars(options))
    held = found["slow_share"] < MOST_SLOW and not found["missed"]
    crowd_held = found.get("ratio", 0.0) <= MOST_RATIO or options.direct > HUNDREDS
    finish(found, held and crowd_held)


if __name__ == "__main__":
    main()
