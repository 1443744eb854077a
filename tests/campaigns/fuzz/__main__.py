"""`make fuzz`: the long run of the fuzz tests. The same seed repeats a run input by input."""

import faulthandler
import hashlib
import resource
import sys
import time
from pathlib import Path

from arguments import arguments
from rich.console import Console
from rich.table import Table
from tests.campaigns.fuzz.campaign import Figures, arm, feed
from tests.campaigns.fuzz.targets import TARGETS, Target

_STUCK_S = 120.0
_MEMORY_BYTES = 4 << 30


def main() -> None:
    """Feed hostile inputs to the targets, print the results, and exit with 1 after a finding."""
    options = arguments(
        __doc__,
        packets=1_000_000,
        files=100_000,
        seed=1,
        only=("", "targets whose name has this"),
        keep=(Path("build/fuzz"), "folder of findings"),
    )
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY_BYTES, _MEMORY_BYTES))  # a blow-up is a crash
    arm()
    done = []
    begin = time.monotonic()
    for target in TARGETS:
        if options.only in target.name:
            count = _share(target, options.packets if target.group == "packets" else options.files)
            done.append(_run(target, count, options.seed, options.keep))
    _print(done, time.monotonic() - begin)
    sys.exit(any(figures.findings for figures in done))


def _share(target: Target, total: int) -> int:
    whole = sum(other.share for other in TARGETS if other.group == target.group)
    return -(-total * target.share // whole)


def _run(target: Target, count: int, seed: int, keep: Path) -> Figures:
    figures = Figures(target.name)
    told_s = time.monotonic()
    for figures in feed(target, count, seed):
        faulthandler.dump_traceback_later(_STUCK_S, exit=True)  # a hang that no signal ends
        if time.monotonic() - told_s > 10:
            told_s = time.monotonic()
            print(f"{target.name}: {figures.inputs} of {count}", file=sys.stderr, flush=True)
    faulthandler.cancel_dump_traceback_later()
    for text, data in figures.findings.items():
        name = f"{target.corpus}-{hashlib.blake2b(data, digest_size=4).hexdigest()}"
        keep.mkdir(parents=True, exist_ok=True)
        (keep / name).write_bytes(data)
        print(f"\n{target.name}, {len(data)} bytes in {keep / name}:\n{text}", file=sys.stderr)
    found = f"{figures.crashes} crashes, {figures.hangs} hangs, {figures.state_changes} changes"
    print(f"{target.name}: {figures.inputs} inputs, {found}", file=sys.stderr, flush=True)
    return figures


def _print(done: list[Figures], took_s: float) -> None:
    columns = ("inputs", "refused", "accepted", "crashes", "hangs", "state changes")
    table = Table("target", *columns, "worst ms", title=f"Fuzzing: {took_s:.0f} s")
    rows = [(f.inputs, f.refused, f.accepted, f.crashes, f.hangs, f.state_changes) for f in done]
    for figures, row in zip(done, rows, strict=True):
        table.add_row(figures.name, *(f"{n:,}" for n in row), f"{figures.worst_s * 1e3:.0f}")
    table.add_row("all", *(f"{sum(column):,}" for column in zip(*rows, strict=True)))
    console = Console(width=110)
    console.print(table)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    console.print(f"Peak memory {peak:.0f} MiB.")


if __name__ == "__main__":
    main()
