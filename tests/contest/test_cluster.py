"""Tests of contests that are played by a Dask cluster: real workers, of which some are killed."""

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest
from distributed import LocalCluster
from small_contest import CONTEST, SWISS, enter
from waiting import until

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless import cluster as cluster_module
from lacoc_server.contest.headless.cluster import Cluster
from lacoc_server.contest.headless.pool import Pool
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_a_cluster_gives_the_same_tables(played: Path, tmp_path: Path) -> None:
    """A cluster, one of whose workers is killed, gives the same standings as this process alone."""
    sheet = organiser.sheet(played / "contest.toml")
    there = enter(tmp_path / "there")
    with LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster:
        killed: list[int] = []

        def progress(done: int, of: int) -> None:
            if done and not killed:
                nanny = next(iter(cluster.workers.values()))
                os.kill(nanny.process.pid, signal.SIGKILL)
                killed.append(nanny.process.pid)

        engine = Cluster(cluster.scheduler_address, pytest.fail)
        other, games = organiser.play_headless(there, "planner", engine, progress)
    assert killed
    assert games == len([*(played / "records").iterdir()])
    tables = [view.tables for view in sheet.stages]
    assert [view.tables for view in other.stages] == tables


@pytest.mark.long
@pytest.mark.slow
def test_a_cluster_without_workers_is_told_and_its_loss_ends_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Games wait while there is no worker, and this is told; without a scheduler the run ends."""
    monkeypatch.setattr(cluster_module, "_LOOK_S", 0.2)
    file = enter(tmp_path, CONTEST + SWISS)
    where = tmp_path / "scheduler.json"
    command = ["-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
    command += ["--no-dashboard", "--scheduler-file", str(where)]
    with subprocess.Popen([sys.executable, *command], stderr=subprocess.DEVNULL) as scheduler:
        told: list[str] = []

        def tell(what: Phrase) -> None:
            told.append(what.code)
            scheduler.kill()

        try:
            until(lambda: where.exists() and where.read_text().rstrip().endswith("}"))
            address = json.loads(where.read_text())["address"]
            with pytest.raises(UserError, match="does not answer any more"):
                organiser.play_headless(file, "planner", Cluster(address, tell), lambda *_: None)
        finally:
            scheduler.kill()  # else a failure would wait for it for ever
    assert told == ["cluster.no-worker"]
    played = organiser.play_headless(file, "planner", Pool(2), lambda *_: None)[1]
    assert played == 4


def test_what_is_no_cluster_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """If no scheduler answers, or the address is wrong, the error says what to do."""
    monkeypatch.setattr(cluster_module, "_CONNECT_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        for port in (1, silent.getsockname()[1]):
            with pytest.raises(UserError, match="dask scheduler"):
                Cluster(f"tcp://127.0.0.1:{port}", pytest.fail)
    with pytest.raises(UserError, match="Write it as in tcp://"):
        Cluster("tcp://127.0.0.1", pytest.fail)
