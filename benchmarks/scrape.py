"""`python -m benchmarks.scrape`: does a scrape of its metrics disturb a court?

A court in a process of its own plays practice with one controller. Quiet rounds take turns with
rounds of ten scrapes a second (Prometheus makes one in 15 s). The court's own histogram gives the
time of a beat's work in each round.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from typing import Any, NamedTuple

from prometheus_client.parser import text_string_to_metric_families

from lacoc_client.play.controller import Controller
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import Phase

_COURT = ("serve", "--json", "--arena", "practice", "--listen", "tcp/127.0.0.1:0")
_METRICS = ("--metrics", "127.0.0.1:0")
_ROUND_S = 3.0
_SCRAPES_HZ = 10


class _Seen(NamedTuple):
    beats: float
    work_s: float
    slow: float


def scrape(rounds: int) -> dict[str, Any]:
    """Measure a court's beats in turns: quiet rounds, and rounds in which its metrics are scraped.

    Returns:
        The time of a beat's work [ms] and the slow beats, for quiet and for scraped rounds; the
        ratios; and the time that a scrape takes [ms].
    """
    quiet: list[_Seen] = []
    scraped: list[_Seen] = []
    took_s: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "lacoc_shared", *_COURT, *_METRICS, "--recordings", folder]
        process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None
        opened = json.loads(process.stdout.readline())
        url = opened["metrics"]
        try:
            (seat, token), *_ = opened["tokens"].items()
            with open_client(opened["locators"]) as session:
                controller = Controller(session, opened["court"], seat, token, "Benchmark")
                controller.join()
                controller.ready()
                while (frame := controller.wait_frame(1.0)) is None or frame.phase != Phase.PLAYING:
                    pass
                for _ in range(rounds):
                    quiet.append(_round(controller, url, None))
                    scraped.append(_round(controller, url, took_s))
        finally:
            process.terminate()
            process.communicate()
    quiet_ms, scraped_ms = (
        [1000 * one.work_s / one.beats for one in of] for of in (quiet, scraped)
    )
    ratios = [after / before for before, after in zip(quiet_ms, scraped_ms, strict=True)]
    return {
        "quiet_ms": statistics.median(quiet_ms),
        "scraped_ms": statistics.median(scraped_ms),
        "ratio": statistics.median(ratios),
        "ratios": ratios,
        "slow_quiet": sum(one.slow for one in quiet),
        "slow_scraped": sum(one.slow for one in scraped),
        "scrape_ms": statistics.median(took_s) * 1000,
        "scrapes": len(took_s),
    }


def _round(controller: Controller, url: str, took_s: list[float] | None) -> _Seen:
    before = _seen(url)
    end_s = time.monotonic() + _ROUND_S
    while (now_s := time.monotonic()) < end_s:
        if took_s is not None:
            _seen(url)
            took_s.append(time.monotonic() - now_s)
        next_s = now_s + 1 / _SCRAPES_HZ
        while (left_s := next_s - time.monotonic()) > 0:
            controller.wait_frame(left_s)
    after = _seen(url)
    return _Seen(*(new - old for old, new in zip(before, after, strict=True)))


def _seen(url: str) -> _Seen:
    with urllib.request.urlopen(url, timeout=10) as reply:
        text = reply.read().decode()
    values = {
        sample.name: sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }
    duration = "lacoc_beat_duration_seconds"
    return _Seen(
        values[f"{duration}_count"], values[f"{duration}_sum"], values["lacoc_slow_beats_total"]
    )


def main() -> None:
    """Run the benchmark and print its results."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scrape", description=__doc__)
    parser.add_argument("--rounds", type=int, default=7, help="of each kind")
    found = scrape(parser.parse_args().rounds)
    print(json.dumps(found, indent=2))


if __name__ == "__main__":
    main()
