"""Tests of contests that are played by a Dask cluster: real workers, of which some are killed."""

import os
import signal
from pathlib import Path

import pytest
from benchmarks.contest_played import enter
from distributed import LocalCluster

from lacoc_server.contest import organiser
from lacoc_server.contest.headless.cluster import Cluster
from lacoc_server.contest.headless.pool import Pool
from lacoc_shared.mistakes import UserError


@pytest.mark.long
@pytest.mark.slow
def test_a_cluster_gives_the_same_tables(tmp_path: Path) -> None:
    """A cluster, one of whose workers is killed, gives the same standings as local processes."""
    here = enter(tmp_path / "here")
    sheet, games = organiser.play_headless(here, "planner", Pool(2), lambda done, there: None)
    there = enter(tmp_path / "there")
    with LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster:
        killed: list[int] = []

        def progress(done: int, of: int) -> None:
            if done and not killed:
                nanny = next(iter(cluster.workers.values()))
                os.kill(nanny.process.pid, signal.SIGKILL)
                killed.append(nanny.process.pid)

        engine = Cluster(cluster.scheduler_address)
        other, played = organiser.play_headless(there, "planner", engine, progress)
    assert killed
    assert played == games
    tables = [view.tables for view in sheet.stages]
    assert [view.tables for view in other.stages] == tables


def test_a_cluster_that_does_not_answer_is_refused(tmp_path: Path) -> None:
    """If no cluster answers at the address, the error names the command that starts one."""
    with pytest.raises(UserError, match="dask scheduler"):
        Cluster("tcp://127.0.0.1:1")
