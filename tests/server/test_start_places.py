"""Tests that before play a robot stays at its start place or is put back there (rules 4)."""

import math

from stage import LEFT, QUICK, RIGHT, Script, Stage, decide, join

from lacoc_server.match.match import MOST_STRAYS
from lacoc_shared import decisions as d
from lacoc_shared.inputs import LeaveSeat, ReadySeat
from lacoc_shared.messages import Event
from lacoc_shared.seat import Phase
from lacoc_shared.words import render


def straying(*ticks: int, by_m: float = 0.06, seat: int = LEFT) -> Stage:
    """Make a match whose script puts a robot `by_m` from its start in some ticks of physics."""
    x_m, y_m = start(Stage("flag-strike"), seat)
    poses = {tick: {seat: (x_m, y_m + by_m)} for tick in ticks}
    return Stage("flag-strike", QUICK, script=Script(poses=poses))


def start(stage: Stage, seat: int = LEFT) -> tuple[float, float]:
    return stage.match.game.starts[seat][0][:2]


def from_start_m(stage: Stage, seat: int = LEFT) -> float:
    return stage.match.staging.from_start_m(seat)


def strayed(stage: Stage) -> list[Event]:
    return [event for event in stage.events if event.kind == "strayed"]


def test_a_robot_that_leaves_its_start_place_is_put_back() -> None:
    """A robot that leaves its start place in READY is put back in the next beat, with an event."""
    stage = straying(3).to_ready()
    stage.run(2)
    assert from_start_m(stage) > 0.05
    (event,) = strayed(stage)
    assert (event.seat, event.beat) == (LEFT, stage.frame.beat)
    assert (
        render(event.said)
        == "The robot of Ants moved 0.06 m away from its start place. The robot is put back."
    )
    assert math.isclose(event.data["distance_m"], 0.06, abs_tol=1e-6)
    stage.beat()
    assert from_start_m(stage) < 1e-6
    stage.run(10)
    assert len(strayed(stage)) == 1
    assert stage.phase is Phase.READY
    assert stage.match.legality()["start"] is None


def test_a_robot_that_moves_little_is_not_put_back() -> None:
    """A robot that moves by less than 0.05 m in READY is not put back."""
    stage = straying(3, by_m=0.049, seat=RIGHT).to_ready()
    stage.run(10)
    assert strayed(stage) == []
    assert 0.048 < from_start_m(stage, RIGHT) < 0.05


def test_a_robot_that_leaves_three_times_is_not_ready() -> None:
    """If a robot leaves its place three times, its team is not ready any more.

    When the team says ready again, the count begins again at one.
    """
    assert MOST_STRAYS == 3
    stage = straying(3, 6, 9).to_ready()
    stage.run(9)
    assert [event.data["times"] for event in strayed(stage)] == [1, 2, 3]
    words = "The robot of Ants left its start place 3 times. Ants is not ready any more."
    assert render(strayed(stage)[-1].said) == words
    stage.beat()
    assert stage.phase is Phase.LOBBY
    assert [why.code for why in stage.match.missing()] == ["why.not-ready"]
    stage.beat(ReadySeat(LEFT, True))
    stage.run(4)
    assert stage.phase is Phase.READY
    assert [event.data["times"] for event in strayed(stage)] == [1, 2, 3, 1]


def test_play_begins_with_each_robot_at_its_place() -> None:
    """If the referee starts while a robot is away, the robot begins play at its start place."""
    stage = straying(3).to_ready()
    stage.run(2)
    assert len(strayed(stage)) == 1
    stage.beat(decide(d.Start()))
    stage.until(Phase.PLAYING)
    assert from_start_m(stage) < 1e-6


def test_a_team_may_leave_or_change_its_robot_before_it_is_put_back() -> None:
    """READY ends if a team leaves, or joins with another robot, before its robot is put back.

    The match is then in the lobby, and its frames have no robots.
    """
    for item in (LeaveSeat(LEFT), join(LEFT, robot="octopod")):
        stage = straying(3).to_ready()
        stage.run(2)
        assert len(strayed(stage)) == 1
        stage.beat(item)
        assert stage.phase is Phase.LOBBY
        assert stage.frame.poses == b""


def test_no_robot_is_put_back_in_play() -> None:
    """In PLAYING a robot that is away from its start is not put back."""
    stage = straying(3).to_playing()
    stage.run(10)
    assert from_start_m(stage) > 0.05
    assert strayed(stage) == []
