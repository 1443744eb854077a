"""`make bench`: what beats, matches, the gateway and the pages cost, as ratios of one run."""

import argparse
import json
import sys

from rich.console import Console
from rich.table import Table

from benchmarks.beat import beat, whole_match
from benchmarks.gateway import gateway
from benchmarks.gateway import rows as gateway_rows
from benchmarks.latency import latency
from benchmarks.page_latency import page_latency
from benchmarks.page_latency import rows as page_latency_rows
from benchmarks.pages import pages
from benchmarks.pages import rows as pages_rows
from benchmarks.paths import started

ARENAS = ("othello", "flag-strike")


def main() -> None:
    """Run the benchmark and print its results."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--rounds", type=int, default=11, help="interleaved rounds of each ratio")
    parser.add_argument("--json", action="store_true", help="print JSON for a program to read")
    options = parser.parse_args()
    console = Console()
    table = Table("what", "measured", "baseline in the same run", "ratio", "aim")
    found: dict[str, object] = {}
    for arena in ARENAS:
        figures = found[f"beat {arena}"] = beat(arena, options.rounds)
        table.add_row(
            f"court's whole beat, {arena}",
            f"{figures['beat_us']:.0f} us",
            f"bare mj_step {figures['bare_us']:.0f} us",
            f"{figures['ratio']:.3f}",
            "at most 1.10",
        )
        table.add_row(f"its own part, {arena}", f"{figures['own_us']:.1f} us", "", "", "")
    for arena in ARENAS:
        figures = found[f"match {arena}"] = whole_match(arena, max(1, options.rounds // 4))
        table.add_row(
            f"headless match with record, {arena}",
            f"{figures['match_s']:.2f} s, {figures['times_real_time']:.0f} x real time",
            f"bare mj_step {figures['bare_s']:.2f} s",
            f"{figures['share']:.3f} of its speed",
            "0.88",
        )
        frame = started(arena, None).beat()[1]
        found[f"frame {arena}"] = len(frame)
        table.add_row(
            f"bytes, {arena}",
            f"a frame {len(frame)}, a record {figures['record_bytes']:,}",
            "",
            "",
            "320; 1,500,000",
        )
    figures = found["latency"] = latency(options.rounds * 20)
    table.add_row(
        "key to the frame that shows it",
        f"p50 {figures['key_p50_ms']:.1f} ms, p95 {figures['key_p95_ms']:.1f} ms",
        f"bare Zenoh echo p50 {figures['echo_p50_ms']:.2f} ms, p95 {figures['echo_p95_ms']:.2f} ms",
        f"{figures['over_echo_ms']:.1f} ms over",
        "a wait of 0-20 ms for the beat is in it",
    )
    if sys.platform == "linux":  # these read counters of the Linux kernel
        figures = found["gateway"] = gateway(rounds=max(1, options.rounds // 4))
        for row in gateway_rows(figures):
            table.add_row(*row)
        figures = found["pages"] = pages()
        for row in pages_rows(figures):
            table.add_row(*row)
    figures = found["page latency"] = page_latency(options.rounds * 10)
    for row in page_latency_rows(figures):
        table.add_row(*row)
    if options.json:
        json.dump(found, sys.stdout)
    else:
        console.print(table)


if __name__ == "__main__":
    main()
