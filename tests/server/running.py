"""A court in a process of its own, and clients that wait for what it does."""

import subprocess
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lacoc_process import ALONE, Running
from ports import free_port
from waiting import LIMIT_S

from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_shared.contest.file import load
from lacoc_shared.decisions import Decision, Start
from lacoc_shared.messages import Frame
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.seat import Phase
from lacoc_shared.words import render


def write_contest(path: Path) -> Path:
    """Write a contest file of one court, whose port stays the same when the court restarts."""
    path.write_text(f"""
[court.main]
arena = "othello"
listen = ["tcp/127.0.0.1:{free_port()}"]
settings.match.countdown_s = 0.2
""")
    return path


@contextmanager
def served(
    contest: Path,
    folder: Path,
    *words: str,
    before: Sequence[str] = (),
    office: bool = False,
) -> Iterator[subprocess.Popen[str]]:
    """Run a court until the block ends, and give its process once it is open.

    Args:
        contest: the contest file.
        folder: the folder for the court's records.
        words: more words for the command line of `lacoc serve`.
        before: words of a command that runs another one; the court's command line follows them.
        office: whether the court waits for an office; else it is started alone, with the tokens and
            entries of the contest file.
    """
    how = ["serve", "--contest", str(contest)] if office else [ALONE, str(contest)]
    serve = [*how, "--json", "--recordings", str(folder), *words]
    with Running(*serve, before=before) as court:
        assert court.opened["kind"] == "open"
        yield court.process


def until(clients: Iterable[Controller | Spectator], true: Callable[[], bool]) -> None:
    """Let clients receive and send until a condition is true; fail after `LIMIT_S`."""
    clients = list(clients)
    end_s = time.monotonic() + LIMIT_S
    while not true():
        assert time.monotonic() < end_s, "it did not come true"
        for client in clients:
            client.wait_frame(0.02)


def frame(controller: Controller) -> Frame:
    """Return the newest frame; wait for the first one if there is none."""
    until([controller], lambda: controller.view.frame is not None)
    assert controller.view.frame is not None
    return controller.view.frame


def phase(controller: Controller) -> int:
    return frame(controller).phase


class Party:
    """A court's contestants, joined and ready, and its referee, in one network session."""

    def __init__(self, session: Session, contest: Path) -> None:
        plan = load(contest)
        name, _ = plan.court()
        self.session = session
        self.controllers = [
            Controller(session, name, seat, plan.secrets.seat(name, seat), f"Team {seat}")
            for seat in ("left", "right")
        ]
        for controller in self.controllers:
            controller.join(LIMIT_S)
            controller.ready()
        self.left = self.controllers[0]
        self.referee = RefereeClient(session, name, plan.secrets.referee(name))

    @property
    def view(self) -> Spectator:
        """Return what the left contestant's client has received."""
        return self.left.view

    @property
    def frame(self) -> Frame:
        """Return the newest frame; wait for the first one if there is none."""
        return frame(self.left)

    @property
    def phase(self) -> int:
        return phase(self.left)

    @property
    def trouble(self) -> str:
        """Return the court's trouble with its record's disk; empty if there is none."""
        trouble = None if self.view.health is None else self.view.health.record_trouble
        return render(trouble) if trouble else ""

    def until(self, true: Callable[[], bool]) -> None:
        """Let all contestants receive and send until a condition is true."""
        until(self.controllers, true)

    def reach(self, phase: Phase) -> None:
        """Wait for a phase."""
        self.until(lambda: self.phase == phase)

    def decide(self, decision: Decision, then: Phase | None = None) -> None:
        """Send a decision of the referee, and wait for the phase `then` if it is given."""
        self.referee.decide(decision, "a test", "Kubota")
        if then is not None:
            self.reach(then)

    def play(self) -> None:
        """Wait for READY, start the match, and wait for PLAYING."""
        self.reach(Phase.READY)
        self.decide(Start(), Phase.PLAYING)


@contextmanager
def party(contest: Path) -> Iterator[Party]:
    """Join all contestants at a contest's running court, say ready for each, and give the party."""
    _, court = load(contest).court()
    with open_client([court.address()]) as session:
        yield Party(session, contest)
