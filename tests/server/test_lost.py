"""Tests in which contestants' processes or connections are lost, and watchers freeze.

Rules 3: a robot whose controller is not heard for a second stands, and keeps its seat.
Times are counted in beats of the court, so that a busy machine does not change the result.
"""

import os
import signal
import subprocess
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path

import pytest
from hall import Hall
from ports import free_port
from real_cable import pull_a_real_cable
from slow_link import SlowLink
from waiting import LIMIT_S

from lacoc_client.play.asking import NoAnswer, ask
from lacoc_client.play.controller import Controller, Hold
from lacoc_shared.decisions import Adjust, Declare, Halt, Start
from lacoc_shared.inputs import SilentSeat
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import DecisionReply, DecisionRequest
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase, SeatFlag
from lacoc_shared.words import render

pytestmark = pytest.mark.slow

LINK_S = 3.0
"""Zenoh may close a connection after this long without a message [s]."""
WATCHED_BEATS = 600
"""12 s. A frozen watcher could stop the court's traffic for ten seconds (docs/facts.md 5)."""
WAITED_MS = 2000.0
"""A court that waits for a frozen watcher is at least this late [ms]; a busy one is not."""


@pytest.fixture
def hall(tmp_path: Path) -> Iterator[Hall]:
    with ExitStack() as stack:
        yield Hall(tmp_path, stack)


@pytest.mark.long
def test_a_killed_controller_is_taken_back_in_any_phase(hall: Hall) -> None:
    """From LOBBY to FINISHED, only the seat's own token takes back a killed controller's seat."""
    secrets = hall.plan.secrets
    with open_client([hall.court.address()]) as session:

        def lose_and_guess(bot: subprocess.Popen[bytes]) -> None:
            """Kill the left seat's program; check that no wrong token takes its seat."""
            hall.loses(bot.kill)
            for token in (secrets.seat("main", "right"), secrets.referee("main"), "guess", ""):
                thief = Controller(session, "main", "left", token, "Thieves")
                with pytest.raises(UserError, match="not valid for the left seat"):
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
    """The robot of a frozen controller (SIGSTOP) stands, and walks again after SIGCONT.

    The record has the silence at the same beat as the event.
    """
    bot = hall.bot("left")
    hall.bot("right")
    hall.play()
    hall.walks()
    hall.loses(lambda: os.kill(bot.pid, signal.SIGSTOP))
    hall.walks(1)
    assert hall.left.key == 0
    os.kill(bot.pid, signal.SIGCONT)
    hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
    hall.walks()
    record = Record.read(next((hall.folder / "recordings").glob("*.live.mcap")))
    silences = [one for one in hall.silences() if one.seat == 0]
    assert silences  # on a busy machine it may fall silent more than once
    assert all(SilentSeat(0) in record.inputs[one.beat] for one in silences)


@pytest.mark.parametrize("answer_s", [1.0, pytest.param(10.0, marks=pytest.mark.long)])
def test_a_decision_is_not_done_twice_when_its_answer_is_missing(
    hall: Hall, answer_s: float
) -> None:
    """Without an answer in time, the client gets an error; the decision is made at most once."""
    hall.bot("left")
    hall.bot("right")
    hall.play()
    keys, decision = KeySpace("main"), Adjust(seat="left", points=3)
    token = hall.plan.secrets.referee("main")
    request = DecisionRequest(token=token, by="Kubota", reason="a test", decision=decision)
    os.kill(hall.process.pid, signal.SIGSTOP)
    try:
        with pytest.raises(NoAnswer):
            ask(hall.session, keys, keys.decision("adjust"), request, DecisionReply, answer_s)
    finally:
        os.kill(hall.process.pid, signal.SIGCONT)
    hall.walks()
    hall.walks(1)
    if answer_s < LINK_S:  # the request waited in the court's process
        hall.until(lambda: done(hall) > 0)
    assert done(hall) == 1 if answer_s < LINK_S else done(hall) <= 1


def done(hall: Hall) -> int:
    """Count the decisions that gave three points."""
    return sum("+3" in render(event.said) for event in hall.view.events)


def test_a_pulled_cable(hall: Hall) -> None:
    """If a link goes silent, or is cut, the robot stands; the controller comes back by itself."""
    with SlowLink(hall.court.address()) as link:
        hall.bot("left", link.address)
        hall.bot("right")
        hall.play()
        hall.walks()
        hall.loses(link.stall)
        hall.walks(1)
        link.flow()
        hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
        hall.walks()
        hall.loses(link.cut)
        link.mend()
        hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
        hall.walks()


@pytest.mark.long
def test_loss_and_jitter_make_no_seat_silent(hall: Hall) -> None:
    """On a link with delay, jitter and loss, keys take effect and the seat is never silent.

    On a busy machine any seat may fall silent, so one of three quiet times is enough.
    """
    with SlowLink(hall.court.address(), delay_s=0.05, jitter_s=0.04, loss=0.03) as link:
        hall.bot("left", link.address)
        hall.bot("right")
        hall.play()
        assert any(_walks_unbroken(hall) for _ in range(3))


def _walks_unbroken(hall: Hall) -> bool:
    """Return whether the left robot walks for six keys without a silence of its seat."""
    before = len(hall.silences())
    for _ in range(6):
        hall.walks()
    return all(one.seat != 0 for one in hall.silences()[before:])


@pytest.mark.long
def test_a_real_cable(tmp_path: Path) -> None:
    """When a virtual cable goes down and up, the robot stands and walks again.

    The match runs in a process with its own network: a new cable in this process would interrupt
    the page loads of other tests' browsers.
    """
    with ProcessPoolExecutor(1, get_context("spawn")) as apart:
        if not apart.submit(pull_a_real_cable, tmp_path).result():
            pytest.skip("this user may not make network namespaces")


def frames_of(hall: Hall) -> int:
    """Return how many frames a spectator receives in 600 beats."""
    first, frames = hall.frame.beat, 0
    while hall.frame.beat < first + WATCHED_BEATS:
        frames += hall.view.wait_frame(LIMIT_S) is not None
    return frames


@pytest.mark.long
def test_frozen_watchers_hurt_nobody(hall: Hall) -> None:
    """Frozen watchers (spectator, gateway, referee) delay neither the court nor other clients."""
    hall.bot("left")
    hall.bot("right")
    where = ("--connect", hall.court.address(), "--court", "main")
    watchers = [
        hall.lacoc("watch", "--json", "--hz", "50", *where),
        hall.lacoc("web", *where, "--listen", f"127.0.0.1:{free_port()}"),
        hall.lacoc(
            "referee", "log", "--follow", "--token", hall.plan.secrets.referee("main"), *where
        ),
    ]
    hall.play()
    hall.walks()
    before, late_ms = frames_of(hall), hall.health.worst_late_ms
    silences = hall.silences()  # a busy machine may have been slow at the start
    for process in watchers:
        assert process.poll() is None
        os.kill(process.pid, signal.SIGSTOP)
    frames = frames_of(hall)
    for process in watchers:
        os.kill(process.pid, signal.SIGCONT)
    hall.walks()
    hall.walks(1)
    # On a busy machine the spectator may receive fewer; the court drops none of its frames.
    assert frames >= 0.5 * before
    assert hall.health.worst_late_ms <= late_ms + WAITED_MS
    assert hall.silences() == silences
    assert all(process.poll() is None for process in watchers)
