"""`make bench`: measures beats, matches, gateway and pages against baselines of the same run."""

import json
import sys
from typing import Any

from arguments import arguments
from rich.console import Console
from rich.table import Table

from benchmarks import beat, courts, latency, pages
from benchmarks.figures import Row

_PAGES = 300


def main() -> None:
    """Run the benchmarks and print their results."""
    options = arguments(
        __doc__,
        rounds=(11, "interleaved rounds of each ratio"),
        json=(False, "print JSON for a program to read"),
    )
    rounds = options.rounds
    found: dict[str, Any] = {"beats": beat.beats(rounds)}
    rows: list[Row] = [*beat.rows(found["beats"])]
    if sys.platform == "linux":  # these read counters of the Linux kernel
        found["courts"] = courts.courts(pages=_PAGES, rounds=max(1, rounds // 4))
        found["pages"] = pages.pages()
        rows += [*courts.rows(found["courts"], _PAGES), *pages.rows(found["pages"])]
    keys = found["program"], found["page"] = (
        latency.of_program(rounds * 20),
        latency.of_page(rounds * 10),
    )
    rows += latency.rows(*keys)
    if options.json:
        json.dump(found, sys.stdout)
        return
    table = Table("what", "measured", "baseline in the same run", "ratio", "aim")
    for row in rows:
        table.add_row(*row)
    Console().print(table)


if __name__ == "__main__":
    main()
