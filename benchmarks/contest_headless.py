"""Plays a contest of bots without a network in several ways; compares standings and times.

    python -m benchmarks.contest_headless --teams 20 --seconds 5

Every team meets every other one in both seats. The contest is played by processes of this machine
and by a Dask cluster of as many workers, in turns; then by one process, and by a cluster whose
workers are killed on the way. Then it is run again: once with nothing changed, and once with
another entry for one team.
"""

import multiprocessing
import os
import random
import statistics
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import dask
from arguments import arguments
from distributed import LocalCluster
from small_contest import enter

from benchmarks.figures import finish
from lacoc_arenas import arena as arenas
from lacoc_robots.library import installed_robots, robot_folder
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless.cluster import Cluster
from lacoc_server.contest.headless.play import GameEngine, play_contest
from lacoc_server.contest.headless.pool import Pool
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import note_plans
from lacoc_server.contest.kept.store import FactStore
from lacoc_shared.command import screen

_DASK_MOST = 1.05
"""Longest time with Dask, as a multiple of the time with the processes of this machine."""
_AGAIN_MOST_S = 2.0
_SETTINGS = Path(__file__).parents[1] / "examples" / "dask.yaml"
_STAGE = """
[contest]
name = "Headless"
recordings = "{records}"

[court.main]
arena = "othello"

[stage.all]
format = "round-robin"
games = 2
settings = {{ match = {{ duration_s = {seconds} }} }}
"""

Engines = AbstractContextManager[GameEngine]


def main() -> None:
    """Play, print, and exit with 1 if an aim is missed."""
    options = arguments(
        __doc__,
        teams=20,
        seconds=5.0,
        rounds=(3, "of pool and cluster in turns"),
        kills=20,
    )
    cores = os.cpu_count() or 1
    with tempfile.TemporaryDirectory() as root, _cluster(cores) as address:
        folder = Path(root)
        games = options.teams * (options.teams - 1)
        tables: dict[str, object] = {}
        found: dict[str, Any] = {"games": games}
        took_s: dict[str, list[float]] = {"pool": [], "dask": [], "one": []}
        for way in (*("pool", "dask") * options.rounds, "one"):
            name = f"{way}-{len(took_s[way])}"
            engine = (
                Cluster(address, screen.warn)
                if way == "dask"
                else Pool(1 if way == "one" else cores)
            )
            file = _contest(
                folder / name, options.teams, options.seconds, folder / f"{name}-records"
            )
            played, seconds, tables[name] = _play(file, engine)
            took_s[way].append(seconds)
            assert played == games
        found |= {f"{way}_s": took for way, took in took_s.items()}
        ratios = [there / here for there, here in zip(took_s["dask"], took_s["pool"], strict=True)]
        found["dask"] = round(statistics.median(ratios), 3)
        # A LocalCluster removes a worker that is not there 15 s after it was killed, even if it was
        # there in between and was killed again. 'dask worker' does not do that.
        dask.config.set({"distributed.deploy.lost-worker-timeout": "1h"})
        with LocalCluster(cores, threads_per_worker=1, dashboard_address=None) as cluster:
            file = _contest(folder / "kill", options.teams, options.seconds, folder / "k-records")
            stop = threading.Event()
            killer = threading.Thread(target=_kill, args=(cluster, options.kills, stop))
            killer.start()
            found["played_with_kills"], _, tables["kill"] = _play(
                file, Cluster(cluster.scheduler_address, screen.warn)
            )
            stop.set()
            killer.join()
        again = folder / "pool-0" / "contest.toml"
        found["played_again"], found["again_s"], _ = _play(again, Pool(cores))
        other = _contest(
            folder / "other",
            options.teams,
            options.seconds,
            folder / "pool-0-records",
            changed=True,
        )
        found["played_changed"], _, _ = _play(other, Pool(cores))
    found["same"] = len({repr(one) for one in tables.values()}) == 1
    right = found["same"] and found["played_again"] == 0 and found["again_s"] < _AGAIN_MOST_S
    right = right and found["played_changed"] == 2 * (options.teams - 1)
    finish(found, right and found["dask"] < _DASK_MOST and found["played_with_kills"] == games)


def _contest(
    folder: Path, teams: int, seconds: float, records: Path, changed: bool = False
) -> Path:
    """Make a contest of bots; with `changed`, the first team has another bot."""
    bots, robots = [*arenas.load("othello").bots], installed_robots()
    entries = {
        f"Team {number + 1:02d}": (
            bots[(number + (changed and number == 0)) % len(bots)],
            robot_folder(robots[number // len(bots) % len(robots)]),
        )
        for number in range(teams)
    }
    return enter(folder, _STAGE.format(records=records, seconds=seconds), entries)


def _play(file: Path, engine: Engines) -> tuple[int, float, object]:
    """Play a contest; return how many games were played, the time [s], and the standings."""
    where = ContestFolder(file)
    with FactStore(where.facts) as store, engine as opened:
        note_plans(store, where.plans)
        begun_s = time.monotonic()
        played = play_contest(where, store, opened, "planner", lambda _: None, lambda _: None)
        took_s = round(time.monotonic() - begun_s, 2)
    return played, took_s, [view.tables for view in organiser.sheet(file).stages]


@contextmanager
def _cluster(workers: int) -> Iterator[str]:
    """Run a cluster whose scheduler has a process of its own, as in docs/cluster.md."""
    spawn = multiprocessing.get_context("spawn")
    ours, theirs = spawn.Pipe()
    process = spawn.Process(target=_serve, args=(workers, theirs))
    process.start()
    try:
        yield ours.recv()
    finally:
        ours.send("end")
        process.join()


def _serve(workers: int, pipe: Connection) -> None:
    dask.config.update(dask.config.config, dask.config.collect([str(_SETTINGS)], env={}))
    with LocalCluster(workers, threads_per_worker=1, dashboard_address=None) as cluster:
        pipe.send(cluster.scheduler_address)
        pipe.recv()


def _kill(cluster: LocalCluster, kills: int, stop: threading.Event) -> None:
    """Kill workers of a cluster at random moments; their nannies start others."""
    rng = random.Random(0)
    for _ in range(kills):
        if stop.wait(rng.uniform(0.5, 3.0)):
            return
        nannies = [one for one in cluster.workers.values() if one.process and one.process.pid]
        if nannies:
            nanny = rng.choice(nannies)
            os.kill(nanny.process.pid, 9)


if __name__ == "__main__":
    main()
