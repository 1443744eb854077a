"""Contestants that are lost, and watchers that freeze: real processes, real cables.

Rules 3: a robot whose controller is not heard for a second stands, and its seat stays its own.
What is counted is counted in beats of the court, so that a busy machine changes no verdict.
"""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from running import WAIT_S, free_port, served, until, write_contest
from slow_link import SlowLink

from lacoc_client.controller import Controller, Hold
from lacoc_client.referee import RefereeClient
from lacoc_client.spectator import Spectator
from lacoc_shared.contest import Contest, load
from lacoc_shared.decisions import Declare, Halt, Resume, Start
from lacoc_shared.inputs import SilentSeat
from lacoc_shared.messages import Frame, Health, SeatFrame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S, Phase, SeatFlag
from lacoc_shared.session import open_client

pytestmark = pytest.mark.slow

LATE_BEATS = 10
"""A court that was held up takes five beats at once; a beat or two are on their way."""
WATCHED_BEATS = 600
"""Longer than the ten seconds after which a connection that says nothing is given up."""
WAITED_MS = 2000.0
"""A court that waits for a frozen watcher is this late; a busy machine is not."""


class Hall:
    """A court, someone who watches it, and a referee; contestants come as processes."""

    def __init__(self, folder: Path, stack: ExitStack, host: str = "127.0.0.1") -> None:
        self.folder = folder
        self._stack = stack
        self.contest = write_contest(folder / "contest.toml")
        self.contest.write_text(
            self.contest.read_text().replace("127.0.0.1", host).replace("= 0.2", "= 2.0")
        )
        self.plan: Contest = load(self.contest)
        name, self.court = self.plan.court()
        self.process = stack.enter_context(served(self.contest, folder / "recordings"))
        session = stack.enter_context(open_client([self.court.address()]))
        self.view = Spectator(session, name)
        self.referee = RefereeClient(session, name, self.court.referee.token)

    def lacoc(self, *words: str, before: tuple[str, ...] = ()) -> subprocess.Popen[bytes]:
        """Start a command; it ends with the test."""
        process = subprocess.Popen(
            [*before, sys.executable, "-m", "lacoc_shared", *words],
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
        """A contestant's program, which presses a key every half second."""
        (self.folder / "walker.py").write_text(
            "from lacoc_arenas.bot import Key\nfrom lacoc_shared.gait import Level\n"
            "def bot(sheet, seat):\n"
            "    return lambda f: Key(Level.LOCOMOTION, 2 + f.clock_ticks // 25 % 2)\n"
        )
        where = ("--connect", connect or self.court.address(), "--court", "main")
        token = self.court.seat[seat].token
        words = ("bot", "walker.py", *where, "--seat", seat, "--token", token, "--name", seat)
        return self.lacoc(*words, before=before)

    def until(self, true: Callable[[], bool]) -> None:
        """Watch until something is true."""
        until([self.view], true)

    def phase(self, phase: Phase) -> None:
        self.until(lambda: self.view.frame is not None and self.view.frame.phase == phase)

    def play(self) -> None:
        """Start the match, or go on with it."""
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
        """Wait for a new key of a seat that takes effect."""
        before = self.frame.seats[seat].applied_seq
        self.until(lambda: self.frame.seats[seat].applied_seq > before)

    def stands_after(self, lose: Callable[[], object]) -> int:
        """Lose the left seat; how many beats later it is shown that it stands.

        Frames show the seat grey in the beat in which it stands, and health says the same.
        """
        self.view.poll()
        lost = self.frame.beat
        lose()
        self.until(lambda: bool(self.left.flags & SeatFlag.SILENT))
        assert self.left.key == 0
        told = self.frame.beat
        self.until(lambda: (self.health.seats[0].heard_ms or 0) > 1000)
        assert self.health.beat - lost <= 2 * BEATS_PER_S
        silences = [e for e in self.view.events if e.kind == "silent" and e.beat >= lost]
        assert [event.seat for event in silences] == [0]
        return min(told, silences[0].beat) - lost

    @property
    def health(self) -> Health:
        self.until(lambda: self.view.health is not None)
        assert self.view.health is not None
        return self.view.health


def _end(process: subprocess.Popen[bytes]) -> None:
    process.send_signal(signal.SIGCONT)
    process.kill()
    process.wait(WAIT_S)


@pytest.fixture
def hall(tmp_path: Path) -> Iterator[Hall]:
    with ExitStack() as stack:
        yield Hall(tmp_path, stack)


def test_a_killed_controller_is_taken_back_in_any_phase(hall: Hall) -> None:
    """By its own token, from another process; by no other token."""
    with open_client([hall.court.address()]) as session:

        def lose_and_guess(bot: subprocess.Popen[bytes]) -> None:
            """Kill the left seat's program; others try to take the seat."""
            assert hall.stands_after(bot.kill) <= BEATS_PER_S + LATE_BEATS
            for token in (hall.court.seat["right"].token, hall.court.referee.token, "guess", ""):
                thief = Controller(session, "main", "left", token, "Thieves")
                with pytest.raises(UserError, match="does not open seat left"):
                    thief.join()
                assert thief.hold is Hold.NOT_JOINED
            assert hall.view.sheet.seats[0].team == "left"
            assert hall.left.flags & SeatFlag.SILENT

        def take_back() -> subprocess.Popen[bytes]:
            hall.view.poll()
            bot = hall.bot("left")
            hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
            return bot

        bot = hall.bot("left")
        hall.until(lambda: hall.view.sheet.seats[0].team == "left")
        hall.phase(Phase.LOBBY)
        hall.until(lambda: hall.health.seats[0].commands_hz > 5)
        lose_and_guess(bot)

        bot = take_back()
        hall.bot("right")
        hall.phase(Phase.READY)
        lose_and_guess(bot)

        bot = take_back()
        hall.phase(Phase.READY)
        hall.referee.decide(Start(), "", "Kubota")
        hall.phase(Phase.COUNTDOWN)
        lose_and_guess(bot)

        bot = take_back()
        hall.phase(Phase.PLAYING)
        hall.walks()
        lose_and_guess(bot)

        bot = take_back()
        hall.walks()
        hall.referee.decide(Halt(), "", "Kubota")
        hall.phase(Phase.HALTED)
        lose_and_guess(bot)

        bot = take_back()
        hall.referee.decide(Declare("draw"), "a test", "Kubota")
        hall.phase(Phase.FINISHED)
        lose_and_guess(bot)
        take_back()
        hall.phase(Phase.FINISHED)


def test_a_frozen_controller_stands_and_goes_on(hall: Hall) -> None:
    """SIGSTOP: its connection stays, and it says nothing. The record has the same beat."""
    bot = hall.bot("left")
    hall.bot("right")
    hall.play()
    hall.walks()
    waited = hall.stands_after(lambda: os.kill(bot.pid, signal.SIGSTOP))
    assert waited <= BEATS_PER_S + LATE_BEATS
    hall.walks(1)
    assert hall.left.key == 0
    os.kill(bot.pid, signal.SIGCONT)
    hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
    hall.walks()
    told = next(event for event in hall.view.events if event.kind == "silent")
    record = Record.read(next((hall.folder / "recordings").glob("*.live.mcap")))
    assert SilentSeat(0) in record.inputs[told.beat]


def test_a_pulled_cable(hall: Hall) -> None:
    """Nothing comes through and nobody is told; in again, and also after the link was given up."""
    with SlowLink(hall.court.address()) as link:
        hall.bot("left", link.address)
        hall.bot("right")
        hall.play()
        hall.walks()
        assert hall.stands_after(link.stall) <= BEATS_PER_S + LATE_BEATS
        hall.walks(1)
        link.flow()
        hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
        hall.walks()
        assert hall.stands_after(link.cut) <= BEATS_PER_S + LATE_BEATS
        link.mend()
        hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
        hall.walks()


def test_loss_and_jitter_make_nobody_silent(hall: Hall) -> None:
    """A bad link drives all the same: late, and never taken for lost."""
    with SlowLink(hall.court.address(), delay_s=0.05, jitter_s=0.04, loss=0.03) as link:
        hall.bot("left", link.address)
        hall.bot("right")
        hall.play()
        for _ in range(6):
            hall.walks()
        assert not any(event.kind == "silent" for event in hall.view.events)


@contextmanager
def cable() -> Iterator[tuple[str, tuple[str, ...], Callable[[str], None]]]:
    """Another machine's network, a cable to it: our address, how to run there, up or down."""
    name = f"lacoc{os.getpid()}"
    near, far = f"a{name}"[:15], f"b{name}"[:15]
    net = f"10.213.{os.getpid() % 250}."

    def ip(*words: str) -> None:
        subprocess.run(["ip", *words], check=True, capture_output=True)

    try:
        ip("netns", "add", name)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this user may not make network namespaces")
    try:
        ip("link", "add", near, "type", "veth", "peer", "name", far, "netns", name)
        ip("address", "add", f"{net}1/24", "dev", near)
        ip("link", "set", near, "up")
        ip("-n", name, "address", "add", f"{net}2/24", "dev", far)
        ip("-n", name, "link", "set", far, "up")
        inside = ("ip", "netns", "exec", name)
        yield f"{net}1", inside, lambda state: ip("link", "set", near, state)
    finally:
        subprocess.run(["ip", "netns", "delete", name], check=False, capture_output=True)


def test_a_real_cable(tmp_path: Path) -> None:
    """The kernel's own link goes down, and comes up again."""
    with cable() as (host, there, cable_is), ExitStack() as stack:
        hall = Hall(tmp_path, stack, host)
        hall.bot("left", before=there)
        hall.bot("right")
        hall.play()
        hall.walks()
        assert hall.stands_after(lambda: cable_is("down")) <= BEATS_PER_S + LATE_BEATS
        hall.walks(1)
        cable_is("up")
        hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
        hall.walks()


def frames_of(hall: Hall) -> int:
    """How many frames of so many beats a spectator gets."""
    first, frames = hall.frame.beat, 0
    while hall.frame.beat < first + WATCHED_BEATS:
        frames += hall.view.wait_frame(WAIT_S) is not None
    return frames


def test_frozen_watchers_hurt_nobody(hall: Hall) -> None:
    """A spectator, a gateway and a referee's program stop; the court and others go on as before."""
    hall.bot("left")
    hall.bot("right")
    where = ("--contest", str(hall.contest), "--court", "main")
    watchers = [
        hall.lacoc("watch", "--json", "--hz", "50", *where),
        hall.lacoc("web", "--contest", str(hall.contest), "--listen", f"127.0.0.1:{free_port()}"),
        hall.lacoc("referee", "log", "--follow", *where),
    ]
    hall.play()
    hall.walks()
    before, late_ms = frames_of(hall), hall.health.worst_late_ms
    for process in watchers:
        assert process.poll() is None
        os.kill(process.pid, signal.SIGSTOP)
    frames = frames_of(hall)
    for process in watchers:
        os.kill(process.pid, signal.SIGCONT)
    hall.walks()
    hall.walks(1)
    # A busy machine has it look at fewer; the court drops for the frozen ones alone.
    assert frames >= 0.5 * before
    assert hall.health.worst_late_ms <= late_ms + WAITED_MS
    assert not any(event.kind == "silent" for event in hall.view.events)
    assert all(process.poll() is None for process in watchers)
