"""Computes medians and percentiles of measurements, and prints the results of benchmarks."""

import json
import sys
from collections.abc import Mapping, Sequence
from statistics import median, quantiles
from typing import Any, NamedTuple, NoReturn


class Row(NamedTuple):
    """A row of the table that `make bench` prints."""

    what: str
    measured: str
    baseline: str = ""
    """What the figure is compared with; it was measured in the same run."""
    ratio: str = ""
    aim: str = ""


def percentile(values: Sequence[float], percent: int) -> float:
    """Return a percentile: the value that `percent` % of the values do not exceed."""
    return quantiles(values, n=100)[percent - 1] if len(values) > 1 else values[0]


def spread(values: Sequence[float], name: str) -> dict[str, float]:
    """Return median and 95th percentile, under names such as "key_p50_ms" for "key_{}_ms"."""
    return {
        name.format("p50"): median(values),
        name.format("p95"): percentile(values, 95),
    }


def medians(rounds: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Return the median of each figure over several rounds."""
    return {name: median(one[name] for one in rounds) for name in rounds[0]}


def finish(found: Mapping[str, Any], held: bool = True) -> NoReturn:
    """Print what was found as JSON, and exit with 0 if the aims were held, else with 1."""
    print(json.dumps(found, indent=1, ensure_ascii=False))
    sys.exit(not held)
