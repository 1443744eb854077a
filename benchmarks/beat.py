"""Times the court's whole beat, and a whole headless match, against bare `mj_step`.

`make bench` prints them; `python -m benchmarks.beat --rounds 3` prints them alone.
"""

import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from arguments import arguments
from bot_matches import ARENAS, setup_of

from benchmarks.bare import BarePath, keys_at, started
from benchmarks.figures import Row, finish
from lacoc_arenas import arena as arenas
from lacoc_server.match.match import Match
from lacoc_server.simulate import player, simulate
from lacoc_server.world.world import World
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEAT_S

ROUND_TICKS = 250


def beat(arena: str, rounds: int) -> dict[str, Any]:
    """Time a court's beat against MuJoCo alone with the same movements, in interleaved rounds.

    A beat is drive, physics, rules, frame, encoding and record, as the court does it.

    Returns:
        The median times of a beat and of its bare physics [us]; the median ratio of a beat to its
        bare physics; and the time of a beat outside `mj_step` in the quickest round [us].
    """
    ours, bare_us, ratios, own_us = [], [], [], []
    with tempfile.TemporaryDirectory() as folder:
        journal = started(arena, Path(folder))
        world = journal.match.physics
        assert isinstance(world, World)
        bare = BarePath(world)
        for _ in range(rounds):
            controls: list[npt.NDArray[np.float64]] = []
            took_s = 0.0
            with _clocked_steps() as steps_s:
                for _ in range(ROUND_TICKS):
                    keys = keys_at(journal.match.ticks)
                    begin = time.perf_counter()
                    journal.beat(keys)
                    took_s += time.perf_counter() - begin
                    controls.append(world.data.ctrl.copy())
            bare_s = bare.run(controls)
            ours.append(took_s / ROUND_TICKS * 1e6)
            bare_us.append(bare_s / ROUND_TICKS * 1e6)
            ratios.append(took_s / bare_s)
            own_us.append((took_s - sum(steps_s)) / ROUND_TICKS * 1e6)
        assert bare.is_where(world), "bare physics took another path"
        journal.close()
    return {
        "beat_us": statistics.median(ours),
        "bare_us": statistics.median(bare_us),
        "ratio": statistics.median(ratios),
        "own_us": min(own_us),
    }


@contextmanager
def _clocked_steps() -> Iterator[list[float]]:
    """Give a list that receives the time of each call of `mj_step` [s]."""
    took_s: list[float] = []
    step = mujoco.mj_step

    def clocked(*arguments: Any, **options: Any) -> None:
        begin = time.perf_counter()
        step(*arguments, **options)
        took_s.append(time.perf_counter() - begin)

    mujoco.mj_step = clocked
    try:
        yield took_s
    finally:
        mujoco.mj_step = step


def whole_match(arena: str, rounds: int) -> dict[str, Any]:
    """Time a headless match with its record against MuJoCo alone with the same movements.

    Returns:
        The median times of the match and of bare physics [s]; their ratio, bare to match; how
        many times faster than real time the match was; and the size of its record [bytes], also
        for each second of the match.
    """
    match_s, bare_s, shares, sizes = [], [], [], []
    loaded, setup = arenas.load(arena), setup_of(arena)
    for _ in range(rounds):
        players = [player(loaded, seat, "straight") for seat in (0, 1)]
        with tempfile.TemporaryDirectory() as folder:
            begin = time.perf_counter()
            result = simulate(setup, players, Path(folder))
            match_s.append(time.perf_counter() - begin)
            path = Path(folder) / f"{setup.match_id}.mcap"
            sizes.append(path.stat().st_size)
            bare_s.append(_bare_path_s(Record.read(path)))
        shares.append(bare_s[-1] / match_s[-1])
    return {
        "match_s": statistics.median(match_s),
        "bare_s": statistics.median(bare_s),
        "share": statistics.median(shares),
        "times_real_time": result.clock_s / statistics.median(match_s),
        "record_bytes": int(statistics.median(sizes)),
        "bytes_per_s": statistics.median(sizes) / (result.beats * BEAT_S),
    }


def _bare_path_s(record: Record) -> float:
    """Return how long MuJoCo alone takes for the movements of a record [s]."""
    match = Match(record.header.setup, World)
    controls: list[npt.NDArray[np.float64]] = []
    bare: BarePath | None = None
    for number in range(record.last_beat + 1):
        beat = match.beat(record.inputs.get(number, ()))
        if not beat.ticked:
            continue
        assert isinstance(match.physics, World)
        if bare is None:
            bare = BarePath(match.physics)
        else:
            controls.append(match.physics.data.ctrl.copy())
    assert bare is not None
    assert isinstance(match.physics, World)
    took_s = bare.run(controls)
    assert bare.is_where(match.physics), "bare physics took another path"
    return took_s


def beats(rounds: int) -> dict[str, dict[str, Any]]:
    """Return for each arena the figures of `beat` and of `whole_match`, and the size of a frame."""
    return {
        arena: {
            **beat(arena, rounds),
            **whole_match(arena, max(1, rounds // 4)),
            "frame_bytes": len(started(arena, None).beat()[1]),
        }
        for arena in ARENAS
    }


def rows(found: dict[str, dict[str, Any]]) -> Iterator[Row]:
    """Yield the rows for the table of `make bench`."""
    for arena, one in found.items():
        yield Row(
            f"court's whole beat, {arena}",
            f"{one['beat_us']:.0f} us",
            f"bare mj_step {one['bare_us']:.0f} us",
            f"{one['ratio']:.3f}",
            "at most 1.10",
        )
        yield Row(f"its own part, {arena}", f"{one['own_us']:.1f} us")
        yield Row(
            f"headless match with record, {arena}",
            f"{one['match_s']:.2f} s, {one['times_real_time']:.0f} x real time",
            f"bare mj_step {one['bare_s']:.2f} s",
            f"{one['share']:.3f} of its speed",
            "0.88",
        )
        yield Row(
            f"bytes, {arena}",
            f"a frame {one['frame_bytes']}, a record {one['record_bytes']:,}",
            aim="320; 1,500,000",
        )


if __name__ == "__main__":
    finish(beats(arguments(__doc__, rounds=11).rounds))
