"""A court that is killed and started again (rules 4, design.md "Record")."""

import os
import signal
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
from running import WAIT_S, frame, phase, seated, served, until, write_contest

from lacoc_arenas import arena as arenas
from lacoc_client.controller import Controller
from lacoc_client.referee import RefereeClient
from lacoc_client.spectator import Spectator
from lacoc_server.recovery import unfinished
from lacoc_server.replay import Verdict, verify
from lacoc_shared.contest import load
from lacoc_shared.decisions import Decision, Declare, Halt, Next, Official, Resume, Start
from lacoc_shared.gait import Level
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.session import open_client

pytestmark = pytest.mark.slow


@pytest.fixture
def contest(tmp_path: Path) -> Path:
    return write_contest(tmp_path / "contest.toml")


def test_a_killed_court_goes_on(contest: Path, tmp_path: Path) -> None:
    """Kill -9 in PLAYING: the match comes back HALTED with seats, clock and robots, and goes on."""
    folder = tmp_path / "recordings"
    name, court = load(contest).court()
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        session = stack.enter_context(open_client([court.address()]))
        controllers = seated(session, contest)
        left = controllers[0]
        until(controllers, lambda: phase(left) == Phase.READY)
        referee = RefereeClient(session, name, court.referee.token)
        referee.decide(Start(), "", "Kubota")
        until(controllers, lambda: phase(left) == Phase.PLAYING)
        for controller in controllers:
            controller.press(Level.LOCOMOTION, 2)
        until(controllers, lambda: frame(left).clock_ticks > 60)
        os.kill(first.pid, signal.SIGKILL)
        first.wait()
        for controller in controllers:
            controller.poll(time.monotonic())
        seen = frame(left)
        applied = [seat.applied_seq for seat in seen.seats]

        stack.enter_context(served(contest, folder))
        until(controllers, lambda: phase(left) == Phase.HALTED)
        after = frame(left)
        assert after.clock_ticks >= seen.clock_ticks
        assert [seat.applied_seq for seat in after.seats] == applied
        if after.clock_ticks == seen.clock_ticks:  # else the last frame died with the court
            assert (after.poses, after.digest) == (seen.poses, seen.digest)
        until(controllers, lambda: sum("is back" in e.text for e in left.view.events) == 2)
        referee.decide(Resume(), "", "Kubota")
        until(controllers, lambda: phase(left) == Phase.PLAYING)
        seq = left.press(Level.LOCOMOTION, 1)
        until(controllers, lambda: frame(left).seats[0].applied_seq == seq)
    end_s = time.monotonic() + WAIT_S
    while not (packed := list(folder.glob("*main-001.mcap"))):
        assert time.monotonic() < end_s, "the record was not packed"
        time.sleep(0.05)
    *_, verdict = verify(Record.read(packed[0]))
    assert isinstance(verdict, Verdict)
    assert verdict.text == "same"


def test_settings_that_were_changed_count_from_the_next_match(
    contest: Path, tmp_path: Path
) -> None:
    """The match that goes on is the one that was begun; the file's word is for those after it."""
    folder = tmp_path / "recordings"
    name, court = load(contest).court()
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        session = stack.enter_context(open_client([court.address()]))
        controllers = seated(session, contest)
        left = controllers[0]
        until(controllers, lambda: phase(left) == Phase.READY)
        usual_s = left.view.sheet.duration_s
        os.kill(first.pid, signal.SIGKILL)
        first.wait()
        text = contest.read_text()
        contest.write_text(
            text.replace("settings.match.", "settings.match.duration_s = 75.0\nsettings.match.", 1)
        )
        stack.enter_context(served(contest, folder))
        referee = RefereeClient(session, name, court.referee.token)

        def decide(decision: Decision, then: Phase) -> None:
            referee.decide(decision, "a test", "Kubota")
            until(controllers, lambda: phase(left) == then)

        until(controllers, lambda: left.view.health and not left.view.health.decisions["start"])
        assert left.view.sheet.duration_s == usual_s != 75.0
        decide(Start(), Phase.PLAYING)
        decide(Halt(), Phase.HALTED)
        decide(Declare("draw"), Phase.FINISHED)
        decide(Official(), Phase.OFFICIAL)
        decide(Next(), Phase.LOBBY)
        until(controllers, lambda: left.view.sheet.match == 2)
        assert left.view.sheet.duration_s == 75.0


def test_how_well_it_was_held_outlives_the_kill(contest: Path, tmp_path: Path) -> None:
    """Issue 4: what was measured before the kill counts; the referee is told "replay advised"."""
    folder = tmp_path / "recordings"
    contest.write_text(
        "health.resumptions = 0\n"
        + contest.read_text().replace(
            "settings.match.", "settings.match.duration_s = 4\nsettings.match.", 1
        )
    )
    name, court = load(contest).court()
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        session = stack.enter_context(open_client([court.address()]))
        controllers = seated(session, contest)
        left = controllers[0]
        until(controllers, lambda: phase(left) == Phase.READY)
        referee = RefereeClient(session, name, court.referee.token)
        referee.decide(Start(), "", "Kubota")
        until(controllers, lambda: played(left) > 100)
        before = left.view.health
        os.kill(first.pid, signal.SIGKILL)
        first.wait()

        stack.enter_context(served(contest, folder))
        until(controllers, lambda: phase(left) == Phase.HALTED)
        until(controllers, lambda: left.view.health is not before)
        assert played(left) > 50  # what the last second measured died with the court
        referee.decide(Resume(), "", "Kubota")
        until(controllers, lambda: any(e.kind == "advice" for e in left.view.events))
        assert phase(left) == Phase.FINISHED
        told = next(event.text for event in left.view.events if event.kind == "advice")
        assert "the court was started again 1 times, at most 0 may be" in told
    end_s = time.monotonic() + WAIT_S
    while not (packed := list(folder.glob("*main-001.mcap"))):
        assert time.monotonic() < end_s, "the record was not packed"
        time.sleep(0.05)
    record = Record.read(packed[0])
    assert record.health is not None
    assert record.health.resumptions == 1
    assert record.health.played_beats > 150
    assert all(seat.expected >= 20 for seat in record.health.seats)
    *_, verdict = verify(record)
    assert isinstance(verdict, Verdict)
    assert verdict.text == "same"


def played(controller: Controller) -> int:
    """Beats that the court has measured."""
    health = controller.view.health
    return health.verdict.played_beats if health and health.verdict else 0


def test_a_court_that_just_came_back_can_be_asked(contest: Path, tmp_path: Path) -> None:
    """Its first frame comes before the way to its desks is known: the client asks again."""
    folder = tmp_path / "recordings"
    name, court = load(contest).court()
    with ExitStack() as stack:
        process = stack.enter_context(served(contest, folder))
        session = stack.enter_context(open_client([court.address()]))
        view = Spectator(session, name)
        referee = RefereeClient(session, name, court.referee.token)
        for _ in range(3):
            process.kill()
            process.wait()
            while view.wait_frame(0.2) is not None:
                pass
            process = stack.enter_context(served(contest, folder))
            assert view.wait_frame(WAIT_S) is not None
            referee.enter()


def test_a_running_court_is_not_taken_over(contest: Path, tmp_path: Path) -> None:
    """The record of a court that lives was not left behind."""
    folder = tmp_path / "recordings"
    with served(contest, folder) as process:
        assert unfinished(folder, "main", arenas.load("othello")) is None
        process.kill()
        process.wait()
        left = unfinished(folder, "main", arenas.load("othello"))
    assert left is not None
    assert left.match.phase in (Phase.CREATED, Phase.LOBBY)  # killed before or after beat 0
    assert left.inputs == []


def test_no_record_nothing_left(tmp_path: Path) -> None:
    """A folder that is empty, or not there yet, has no match to go on with."""
    assert unfinished(tmp_path, "main", arenas.load("othello")) is None
    assert unfinished(tmp_path / "none", "main", arenas.load("othello")) is None
