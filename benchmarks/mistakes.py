"""Counts how often a known mistake of a table is named, pointed at and repaired.

python -m benchmarks.mistakes chance --tables 200   # a mistake by chance in each of five good gaits
python -m benchmarks.mistakes beginners             # twenty tables of beginners
"""

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context

from arguments import arguments
from mistaken_tables import KINDS, Mistaken, Outcome, beginners, mistaken, repaired

from benchmarks.figures import finish

_AIM = 0.8


def main() -> None:
    """Count, print, and exit with 1 if an aim is missed."""
    options = arguments(__doc__, ("chance", "beginners"), tables=200)
    tell: Callable[[int], Outcome] = _by_chance
    count = options.tables
    if options.what == "beginners":
        tell, count = _of_beginners, len(_beginners())
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        found = list(pool.map(tell, range(count)))
    kinds = {
        kind: _counts([one for one in found if one.kind == kind])
        for kind in dict.fromkeys(one.kind for one in found)
    }
    missed = [
        (index, one.robot, one.kind, *one.said)
        for index, one in enumerate(found)
        if not (one.named and one.pointed and (one.back or not one.lost))
    ]
    all_ = _counts(found)
    held = min(all_["named"], all_["pointed"]) >= _AIM * count
    held = held and all_["repaired"] >= _AIM * all_["slowed"]
    finish({**all_, "kinds": kinds, "missed": missed}, held)


def _counts(found: list[Outcome]) -> dict[str, int]:
    lost = [one for one in found if one.lost]
    return {
        "tables": len(found),
        "named": sum(one.named for one in found),
        "pointed": sum(one.pointed for one in found),
        "slowed": len(lost),
        "repaired": sum(one.back for one in lost),
    }


def _by_chance(seed: int) -> Outcome:
    table = mistaken(seed)
    return repaired(table, KINDS[table.kind][1])


@cache
def _beginners() -> tuple[tuple[Mistaken, tuple[str, ...]], ...]:
    return tuple(beginners())


def _of_beginners(index: int) -> Outcome:
    return repaired(*_beginners()[index])


if __name__ == "__main__":
    main()
