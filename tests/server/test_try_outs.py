"""Tests of try-outs: in the lobby a player's robot walks alone, beside the beats of its court."""

import math
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np
import pytest
from stage import FORWARD, LEFT, RIGHT, TURN_LEFT, B, join, setup

from lacoc_arenas import arena as arenas
from lacoc_server.court.try_outs import EVERY_TICKS, TryOuts
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.inputs import Input, ReadySeat
from lacoc_shared.messages import Refusal, TriedKey, TryOutReply, TryOutRequest
from lacoc_shared.seat import BEATS_PER_S, Phase
from lacoc_shared.words import say

JOINED = [join(LEFT), join(RIGHT)]


def lobby(*inputs: Input) -> Match:
    """Return a match of Robot-Othello after a beat with these inputs."""
    match = Match(setup("othello"), World)
    match.beat(inputs)
    return match


def request(
    *keys: TriedKey, first: int = 0, until: int = 2 * BEATS_PER_S, drawn: bool = False
) -> TryOutRequest:
    return TryOutRequest(
        session=1, seq=1, drawn=drawn, first=first, until=until, keys=keys, mac=b""
    )


@pytest.fixture
def try_outs() -> Iterator[TryOuts]:
    with ThreadPoolExecutor(1) as aside:
        yield TryOuts(aside.submit)


def told(try_outs: TryOuts, seat: int, asked: TryOutRequest) -> TryOutReply:
    """Ask, and wait for the pictures."""
    later = try_outs(seat, asked)
    assert not isinstance(later, Refusal)
    found = None
    while found is None:
        found = later()
    assert isinstance(found, TryOutReply)
    return found


def centres(reply: TryOutReply) -> list[tuple[float, float]]:
    """Return where the robot's centre is in each picture [m]."""
    return [tuple(np.frombuffer(poses, "<f4")[:2]) for poses in reply.poses]


@pytest.mark.parametrize("seat", [pytest.param(LEFT, marks=pytest.mark.long), RIGHT])
def test_the_robot_stands_alone_where_its_match_begins(try_outs: TryOuts, seat: int) -> None:
    """Without keys the robot stands at its start place, in its colours, and no other is there."""
    try_outs.hold(lobby(*JOINED))
    reply = told(try_outs, seat, request(drawn=True))
    start = arenas.load("othello").game.starts[seat][0]
    assert centres(reply)[0] == pytest.approx(start[:2], abs=1e-6)
    assert math.dist(centres(reply)[0], centres(reply)[-1]) < 0.01
    assert len(reply.poses) == 1 + 2 * BEATS_PER_S // EVERY_TICKS
    assert reply.drawn is not None
    assert {body.seat for body in reply.drawn.bodies} == {-1, seat}
    assert {geom.seat for geom in reply.drawn.geoms} <= {-1, seat}
    assert reply.scene == message_hash(encode(reply.drawn))
    assert told(try_outs, seat, request()).drawn is None


def test_it_walks_by_the_keys(try_outs: TryOuts) -> None:
    """The robot walks by its keys, and the same keys give the same walk however they are asked."""
    try_outs.hold(lobby(*JOINED))
    keys = (TriedKey(25, B, FORWARD), TriedKey(100, B, TURN_LEFT))
    forward = told(try_outs, LEFT, request(keys[0], until=150))
    way = centres(forward)
    assert math.dist(way[12], way[-1]) > 0.03
    turning = told(try_outs, LEFT, request(*keys, first=100, until=200))
    assert turning.poses[0] == forward.poses[50]
    assert turning.poses[10] != forward.poses[60]
    again = told(try_outs, LEFT, request(*keys, until=150))
    assert again.poses[:51] == forward.poses[:51]
    assert again.poses[50:] == turning.poses[:26]
    with ThreadPoolExecutor(1) as aside:
        other = TryOuts(aside.submit)
        other.hold(lobby(*JOINED))
        assert told(other, LEFT, request(*keys, first=100, until=200)).poses == turning.poses


@pytest.mark.parametrize(
    ("inputs", "key", "code"),
    [
        ([join(RIGHT)], FORWARD, "refused.try-out-over"),
        ([*JOINED, ReadySeat(LEFT, True), ReadySeat(RIGHT, True)], FORWARD, "refused.try-out-over"),
        (JOINED, 9, "key.no-such-key"),
    ],
    ids=["nobody in the seat", "after the lobby", "no such key"],
)
def test_what_is_refused(try_outs: TryOuts, inputs: list[Input], key: int, code: str) -> None:
    """Only who sits in the lobby tries keys, and only those that the match would take."""
    try_outs.hold(lobby(*inputs))
    assert try_outs(LEFT, request(TriedKey(0, B, key))) == Refusal(say(code))


def test_the_match_is_not_touched(try_outs: TryOuts) -> None:
    """A try-out changes nothing of the match: neither its state nor its next beats."""
    match, other = lobby(*JOINED), lobby(*JOINED)
    try_outs.hold(match)
    told(try_outs, LEFT, request(TriedKey(0, B, FORWARD)))
    assert match.save() == other.save()
    assert match.beat() == other.beat()
    assert match.phase is Phase.LOBBY


def test_an_error_is_told_and_forgotten(try_outs: TryOuts, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the field can't be built, the player is told, and no beat fails."""

    def broken(*_: object) -> None:
        raise ArithmeticError("no floor")

    monkeypatch.setattr("lacoc_server.court.try_outs.World", broken)
    asked: list[Future[object]] = []

    def aside(walk: Callable[[], object]) -> Future[object]:
        asked.append(Future())
        asked[-1].set_result(walk())
        return asked[-1]

    failing = TryOuts(aside)  # type: ignore[arg-type]
    failing.hold(lobby(*JOINED))
    later = failing(LEFT, request())
    assert not isinstance(later, Refusal)
    refused = later()
    assert isinstance(refused, Refusal)
    assert "no floor" in str(refused.why.values["why"])
