"""Tests that a killed court goes on with its match when it is started again."""

import subprocess
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
from other_arithmetic import OTHER_ARITHMETIC
from running import party, served, write_contest
from verdicts import verdict
from waiting import LIMIT_S, until

from lacoc_arenas import arena as arenas
from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_server.journal.recovery import unfinished
from lacoc_server.journal.verdict import VerdictKind
from lacoc_shared.contest.file import load
from lacoc_shared.decisions import Declare, Halt, Next, Official, Resume, Start
from lacoc_shared.gait.tables import Level
from lacoc_shared.network.session import open_client
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import render

pytestmark = pytest.mark.slow


@pytest.fixture
def contest(tmp_path: Path) -> Path:
    return write_contest(tmp_path / "contest.toml")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "recordings"


def test_a_killed_court_goes_on(contest: Path, folder: Path) -> None:
    """A court killed in PLAYING comes back HALTED with its seats, clock and robots, and goes on."""
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        those = stack.enter_context(party(contest))
        those.play()
        for controller in those.controllers:
            controller.press(Level.LOCOMOTION, 2)
        those.until(lambda: those.frame.clock_ticks > 60)
        kill(first)
        for controller in those.controllers:
            controller.poll(time.monotonic())
        seen = those.frame
        applied = [seat.applied_seq for seat in seen.seats]

        stack.enter_context(served(contest, folder))
        those.reach(Phase.HALTED)
        after = those.frame
        assert after.clock_ticks >= seen.clock_ticks
        assert [seat.applied_seq for seat in after.seats] == applied
        if after.clock_ticks == seen.clock_ticks:  # else a frame was lost
            assert (after.poses, after.digest) == (seen.poses, seen.digest)
        those.until(
            lambda: sum("is back" in render(event.said) for event in those.view.events) == 2
        )
        those.decide(Resume(), Phase.PLAYING)
        seq = those.left.press(Level.LOCOMOTION, 1)
        those.until(lambda: those.frame.seats[0].applied_seq == seq)
    assert verdict(packed(folder)).kind is VerdictKind.SAME


@pytest.mark.usefixtures("has_other_arithmetic")
@pytest.mark.long
def test_a_killed_court_goes_on_with_another_arithmetic(contest: Path, folder: Path) -> None:
    """A killed match goes on with another arithmetic; an event says that the arithmetic changed.

    The parts of the record before and after the kill both verify.
    """
    elsewhere = ["env", *(f"{name}={value}" for name, value in OTHER_ARITHMETIC.items())]
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        those = stack.enter_context(party(contest))
        those.play()
        for controller in those.controllers:
            controller.press(Level.LOCOMOTION, 2)
        those.until(lambda: those.frame.clock_ticks > 60)
        kill(first)
        seen = those.frame
        stack.enter_context(served(contest, folder, before=elsewhere))
        those.reach(Phase.HALTED)
        if those.frame.clock_ticks == seen.clock_ticks:
            assert (those.frame.poses, those.frame.digest) == (seen.poses, seen.digest)
        words = "the court was started again on another computer, whose results differ slightly"
        those.until(lambda: any(words in render(event.said) for event in those.view.events))
        those.decide(Resume(), Phase.PLAYING)
        began = those.frame.clock_ticks
        those.until(lambda: those.frame.clock_ticks > began + 30)
    record = packed(folder)
    made_by = [header.arithmetic["functions"] for header in record.headers]
    assert len(set(made_by)) == 2
    found = verdict(record)
    assert found.kind is VerdictKind.OTHER_ARITHMETIC, render(found.said)


def test_changed_settings_count_from_the_next_match(contest: Path, folder: Path) -> None:
    """A resumed match keeps its settings; a changed contest file applies to the next match."""
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        those = stack.enter_context(party(contest))
        those.reach(Phase.READY)
        usual_s = those.view.sheet.duration_s
        kill(first)
        lasts(contest, 75)
        stack.enter_context(served(contest, folder))
        those.until(lambda: those.view.health and not those.view.health.decisions["start"])
        assert those.view.sheet.duration_s == usual_s != 75
        those.decide(Start(), Phase.PLAYING)
        those.decide(Halt(), Phase.HALTED)
        those.decide(Declare("draw"), Phase.FINISHED)
        those.decide(Official(), Phase.OFFICIAL)
        those.decide(Next(), Phase.LOBBY)
        those.until(lambda: those.view.sheet.match == 2)
        assert those.view.sheet.duration_s == 75


@pytest.mark.long
def test_the_health_verdict_outlives_a_kill(contest: Path, folder: Path) -> None:
    """The health verdict counts the time before a kill; many restarts make it advise a rematch."""
    lasts(contest, 4)
    contest.write_text("health.resumptions = 0\n" + contest.read_text())
    with ExitStack() as stack:
        first = stack.enter_context(served(contest, folder))
        those = stack.enter_context(party(contest))
        those.play()
        those.until(lambda: played(those.left) > 100)
        before = those.view.health
        kill(first)

        stack.enter_context(served(contest, folder))
        those.reach(Phase.HALTED)
        those.until(lambda: those.view.health is not before)
        assert played(those.left) > 50  # the measurements of the last second are lost
        those.decide(Resume())
        those.until(lambda: any(event.kind == "advice" for event in those.view.events))
        assert those.phase == Phase.FINISHED
        told = next(render(event.said) for event in those.view.events if event.kind == "advice")
        assert "the court was restarted 1 time during the match (at most 0 are allowed)" in told
    record = packed(folder)
    assert record.health is not None
    assert record.health.resumptions == 1
    assert record.health.played_beats > 150
    assert all(seat.expected >= 20 for seat in record.health.seats)
    assert verdict(record).kind is VerdictKind.SAME


def kill(court: subprocess.Popen[str]) -> None:
    court.kill()
    court.wait()


def lasts(contest: Path, seconds: int) -> None:
    """Change how long the contest's matches last."""
    setting = f"settings.match.duration_s = {seconds}\nsettings.match."
    contest.write_text(contest.read_text().replace("settings.match.", setting, 1))


def packed(folder: Path) -> Record:
    """Wait until the first match's record is packed; return it."""
    until(lambda: list(folder.glob("*main-001.mcap")))
    return Record.read(next(folder.glob("*main-001.mcap")))


def played(controller: Controller) -> int:
    """Return how many beats of PLAYING the newest health message counts."""
    health = controller.view.health
    return health.verdict.played_beats if health and health.verdict else 0


def test_a_court_that_just_came_back_can_be_asked(contest: Path, folder: Path) -> None:
    """A request right after a restarted court's first frame succeeds, because clients repeat it."""
    plan = load(contest)
    name, court = plan.court()
    with ExitStack() as stack:
        process = stack.enter_context(served(contest, folder))
        session = stack.enter_context(open_client([court.address()]))
        view = Spectator(session, name)
        referee = RefereeClient(session, name, plan.secrets.referee(name))
        for _ in range(3):
            kill(process)
            while view.wait_frame(0.2) is not None:
                pass
            process = stack.enter_context(served(contest, folder))
            assert view.wait_frame(LIMIT_S) is not None
            referee.enter()


def test_a_running_court_is_not_taken_over(contest: Path, folder: Path) -> None:
    """Another court can't resume the match of a running court; after a kill it can."""
    with served(contest, folder) as process:
        assert unfinished(folder, "main", arenas.load("othello")) is None
        kill(process)
        left = unfinished(folder, "main", arenas.load("othello"))
    assert left is not None
    assert left.match.phase in (Phase.CREATED, Phase.LOBBY)  # killed before or after beat 0
    assert left.inputs == []


def test_no_record_nothing_left(tmp_path: Path) -> None:
    """An empty or missing folder has no match to go on with."""
    assert unfinished(tmp_path, "main", arenas.load("othello")) is None
    assert unfinished(tmp_path / "none", "main", arenas.load("othello")) is None
