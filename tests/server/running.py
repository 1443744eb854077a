"""A contest's court as a process, and controllers that wait for what it does."""

import json
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lacoc_client.controller import Controller
from lacoc_client.spectator import Spectator
from lacoc_shared.contest import load
from lacoc_shared.messages import Frame
from lacoc_shared.session import Session

WAIT_S = 30.0


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def write_contest(path: Path) -> Path:
    """A contest of one court, at a port that stays."""
    path.write_text(f"""
[court.main]
arena = "othello"
listen = ["tcp/127.0.0.1:{free_port()}"]
settings.match.countdown_s = 0.2
seat.left.token = "the token of left"
seat.right.token = "the token of right"
referee.token = "the token of the referee"
""")
    return path


@contextmanager
def served(
    contest: Path, folder: Path, *words: str, before: Sequence[str] = ()
) -> Iterator[subprocess.Popen[str]]:
    """A court's process that has opened.

    Args:
        contest: its contest file.
        folder: of its records.
        words: further words for `lacoc serve`.
        before: a command that runs it.
    """
    serve = ["serve", "--json", "--contest", str(contest), "--recordings", str(folder), *words]
    process = subprocess.Popen(
        [*before, sys.executable, "-m", "lacoc_shared", *serve], stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        assert json.loads(process.stdout.readline())["kind"] == "open"
        yield process
    finally:
        process.terminate()
        process.communicate(timeout=WAIT_S)


def seated(session: Session, contest: Path) -> list[Controller]:
    """Controllers of all seats, joined and ready."""
    name, court = load(contest).court()
    controllers = [
        Controller(session, name, seat, holder.token, f"Team {seat}")
        for seat, holder in court.seat.items()
    ]
    for controller in controllers:
        controller.join()
        controller.ready()
    return controllers


def until(clients: Iterable[Controller | Spectator], true: Callable[[], bool]) -> None:
    """Let clients do their work until something is true."""
    clients = list(clients)
    end_s = time.monotonic() + WAIT_S
    while not true():
        assert time.monotonic() < end_s, "it did not come true"
        for client in clients:
            client.wait_frame(0.02)


def frame(controller: Controller) -> Frame:
    """The newest frame; waits for the first."""
    until([controller], lambda: controller.view.frame is not None)
    assert controller.view.frame is not None
    return controller.view.frame


def phase(controller: Controller) -> int:
    return frame(controller).phase
