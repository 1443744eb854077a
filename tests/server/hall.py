"""A running court for tests in which a contestant's process or connection is lost."""

import signal
import subprocess
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from lacoc_process import started
from running import served, until, write_contest
from waiting import LIMIT_S

from lacoc_client.play.asking import fetch
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_shared.contest.file import ContestFile, load
from lacoc_shared.decisions import Resume, Start
from lacoc_shared.messages import Event, Frame, Health, SeatFrame
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import BEATS_PER_S, Phase, SeatFlag

LATE_BEATS = 10
"""Most beats by which a silence may be noticed later than a second after the loss.

A court that is late makes up to five beats at once, and a frame travels for one or two beats.
"""


class Hall:
    """A running court, a spectator, a referee, and contestants in their own processes."""

    def __init__(self, folder: Path, stack: ExitStack, host: str = "127.0.0.1") -> None:
        self.folder = folder
        self._stack = stack
        self.contest = write_contest(folder / "contest.toml")
        self.contest.write_text(
            self.contest.read_text().replace("127.0.0.1", host).replace("= 0.2", "= 2.0")
        )
        self.plan: ContestFile = load(self.contest)
        name, self.court = self.plan.court()
        self.process = stack.enter_context(served(self.contest, folder / "recordings"))
        self.session = stack.enter_context(open_client([self.court.address()]))
        self.view = Spectator(self.session, name)
        self.referee = RefereeClient(self.session, name, self.plan.secrets.referee(name))

    def lacoc(self, *words: str, before: tuple[str, ...] = ()) -> subprocess.Popen[bytes]:
        """Start a `lacoc` command in a process that is killed when the test ends."""
        process = started(
            *words,
            before=before,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            cwd=self.folder,
        )
        self._stack.callback(_end, process)
        return process

    def bot(
        self, seat: str, connect: str = "", before: tuple[str, ...] = ()
    ) -> subprocess.Popen[bytes]:
        """Start a bot in a seat; it presses keys 2 and 3 in turn, each for 0.5 s of the clock."""
        (self.folder / "walker.py").write_text(
            "from lacoc_arenas.bot import Key\nfrom lacoc_shared.gait.tables import Level\n"
            "def bot(sheet, seat):\n"
            "    return lambda f: Key(Level.LOCOMOTION, 2 + f.clock_ticks // 25 % 2)\n"
        )
        where = ("--connect", connect or self.court.address(), "--court", "main")
        token = self.plan.secrets.seat("main", seat)
        words = ("bot", "walker.py", *where, "--token", token, "--name", seat)
        return self.lacoc(*words, before=before)

    def until(self, true: Callable[[], bool]) -> None:
        """Receive frames until a condition is true."""
        until([self.view], true)

    def phase(self, phase: Phase) -> None:
        """Wait until the match is in a phase."""
        self.until(lambda: self.view.frame is not None and self.view.frame.phase == phase)

    def play(self) -> None:
        """Wait for READY or HALTED; start or resume the match, and wait for PLAYING."""
        self.until(lambda: self.frame.phase in (Phase.READY, Phase.HALTED))
        halted = self.frame.phase == Phase.HALTED
        self.referee.decide(Resume() if halted else Start(), "", "Kubota")
        self.phase(Phase.PLAYING)

    @property
    def frame(self) -> Frame:
        self.until(lambda: self.view.frame is not None)
        assert self.view.frame is not None
        return self.view.frame

    @property
    def left(self) -> SeatFrame:
        return self.frame.seats[0]

    def walks(self, seat: int = 0) -> None:
        """Wait until a new key of a seat takes effect."""
        before = self.frame.seats[seat].applied_seq
        self.until(lambda: self.frame.seats[seat].applied_seq > before)

    def silences(self) -> list[Event]:
        """Return the events of seats that fell silent."""
        return [event for event in self.view.events if event.kind == "silent"]

    def loses(self, lose: Callable[[], object]) -> None:
        """Call `lose`; check that the left seat, and no other, falls silent in time (rules 3).

        In time means at most a second and `LATE_BEATS` after the loss. The frame that first shows
        the silence must have key 0, so the robot stands. Within 2 s of the loss, a health message
        must say that nothing was heard for more than a second.
        """
        before = len(self.silences())
        lose()
        # The court answers after the loss, so the loss is not later than the newest frame.
        fetch(self.session, self.view.keys, self.view.keys.sheet)
        self.view.poll()
        lost = self.frame.beat
        self.until(lambda: bool(self.left.flags & SeatFlag.SILENT))
        assert self.left.key == 0
        shown = self.frame.beat
        self.until(lambda: (self.health.seats[0].heard_ms or 0) > 1000)
        assert self.health.beat - lost <= 2 * BEATS_PER_S
        self.until(lambda: len(self.silences()) > before)
        (silence,) = self.silences()[before:]
        assert silence.seat == 0
        assert min(shown, silence.beat) - lost <= BEATS_PER_S + LATE_BEATS

    @property
    def health(self) -> Health:
        self.until(lambda: self.view.health is not None)
        assert self.view.health is not None
        return self.view.health


def _end(process: subprocess.Popen[bytes]) -> None:
    process.send_signal(signal.SIGCONT)
    process.kill()
    process.wait(LIMIT_S)
