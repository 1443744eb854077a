"""Tests of the outlook: what would happen if play went on after a halt."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from stage import FORWARD, LEFT, QUICK, RIGHT, Stage, key

from lacoc_server.court.outlooks import Outlooks
from lacoc_server.match.match import Match
from lacoc_server.match.outlook import look_ahead
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.inputs import SilentSeat
from lacoc_shared.messages import Outlook, OutlookRequest, Refusal
from lacoc_shared.seat import BEATS_PER_S, Phase


def copy(stage: Stage) -> Match:
    """Return a match of its own that goes on from the stage's."""
    found = Match(stage.match.setup, World)
    found.load(stage.match.save())
    return found


def outlook(stage: Stage, decision: d.Decision | None = None, seconds: float = 4.0) -> Outlook:
    found = look_ahead(copy(stage), decision, seconds)
    assert isinstance(found, Outlook)
    return found


def walk(beats: int) -> bytes:
    """Return Flag-Strike in a halt after both robots walked towards each other, saved."""
    stage = Stage.real("flag-strike", QUICK).to_playing()
    stage.beat()
    stage.beat(key(LEFT, FORWARD), key(RIGHT, FORWARD))
    stage.run(beats)
    stage.decide(d.Halt())
    return stage.match.save()


@pytest.fixture(scope="module")
def walking() -> bytes:
    """Return a match in which both robots are on their way to a flag."""
    return walk(250)


@pytest.fixture(scope="module")
def struck() -> bytes:
    """Return a match in which both robots have struck a flag."""
    return walk(350)


def begun(saved: bytes) -> Stage:
    stage = Stage.real("flag-strike", QUICK)
    stage.match.load(saved)
    return stage


def place(match: Match) -> list[float]:
    """Return where the left robot is [m]."""
    return np.frombuffer(match.physics.poses(), np.float32)[:2].tolist()


def test_it_is_what_happens_if_nobody_does_anything(walking: bytes) -> None:
    """Without another key or decision, the match goes as the outlook said, event by event."""
    stage = begun(walking)
    said = outlook(stage)
    end = stage.match.ticks + 4 * BEATS_PER_S
    stage.decide(d.Resume())
    while stage.match.ticks < end:
        stage.beat()
    went = [event for event in stage.events if event.kind not in ("decision", "phase")]
    assert [event.kind for event in went] == ["strike", "strike"]
    assert list(said.events) == went
    assert (said.scores, said.seconds) == (stage.scores, 4.0)
    assert said.phase == Phase.PLAYING


def test_robots_go_on_with_their_last_keys(walking: bytes) -> None:
    """In an outlook the robots walk on; a robot whose seat is silent stands."""
    stage = begun(walking)
    at = place(stage.match)
    look_ahead(on := copy(stage), None, 2.0)
    assert math.dist(at, place(on)) > 0.05
    stage.beat(SilentSeat(LEFT))
    look_ahead(still := copy(stage), None, 2.0)
    assert math.dist(at, place(still)) < 0.04


def test_a_decision_counts_before_play_goes_on(struck: bytes) -> None:
    """The scores before and after are those with the decision."""
    stage = begun(struck)
    (number, *_) = [n for n in range(1, stage.match.next_number) if stage.match.history.knows(n)]
    dry = stage.decide(d.TakeBack(number, dry_run=True))
    with_it, without = outlook(stage, d.TakeBack(number)), outlook(stage)
    assert with_it.before == dry.scores != without.before
    assert outlook(stage, d.Adjust("left", 7)).scores[LEFT] == without.scores[LEFT] + 7


def test_the_match_stays_as_it_is(struck: bytes) -> None:
    """After an outlook, the match has the same bytes as before."""
    stage = begun(struck)
    before = stage.match.save()
    outlook(stage, d.Restart("left"))
    assert stage.match.save() == before


def test_it_ends_with_the_match(struck: bytes) -> None:
    """An outlook is no longer than what is left of the match."""
    stage = begun(struck)
    left = stage.match.duration_ticks - stage.match.clock_ticks
    stage.decide(d.Clock(3.0 - left / BEATS_PER_S))
    said = outlook(stage, seconds=30.0)
    assert said.seconds == 3.0
    assert said.phase == Phase.FINISHED
    assert [event.kind for event in said.events][-1] in ("phase", "result")


@pytest.mark.parametrize("phase", [Phase.LOBBY, Phase.READY, Phase.PLAYING, Phase.OFFICIAL])
def test_it_needs_a_halt(phase: Phase) -> None:
    """Where play cannot be resumed, the refusal is that of a resume."""
    stage = Stage.real("othello", QUICK).to(phase)
    refused = look_ahead(copy(stage), None, 4.0)
    assert isinstance(refused, Refusal)
    assert refused == stage.decide(d.Resume())


def test_a_decision_that_the_match_refuses(walking: bytes) -> None:
    """An event that can't be taken back is refused as in the match."""
    refused = look_ahead(copy(begun(walking)), d.TakeBack(9999), 4.0)
    assert isinstance(refused, Refusal)
    assert "9999" in str(refused.why.values)


def test_a_game_whose_rules_fail_stops_no_beat(walking: bytes) -> None:
    """If the copy fails, the referee is told so, and the court goes on."""
    stage = begun(walking)
    with ThreadPoolExecutor(1) as aside:
        outlooks = Outlooks(aside.submit)
        outlooks.hold(stage.match)
        stage.match.save = lambda: b"broken"  # type: ignore[method-assign,assignment,misc]
        answer = outlooks(OutlookRequest(token="x"))
        while (seen := answer()) is None:
            pass
    assert isinstance(seen, Refusal)
    assert seen.why.code == "refused.outlook"
