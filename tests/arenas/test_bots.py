"""Tests of the bots, most of them with robots that glide without physics."""

import math
import random
import struct
from typing import Any

import pytest

from lacoc_arenas import arena
from lacoc_arenas.bot import Brain, Key
from lacoc_arenas.game import RobotView
from lacoc_arenas.steering import (
    FORWARD,
    RESTART,
    STAND,
    TURN_LEFT,
    TURN_RIGHT,
    Eyes,
    Pilot,
)
from lacoc_shared.codec import pack_states
from lacoc_shared.messages import Frame, SeatFrame, Sheet, SheetSeat
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import BEATS_PER_S, RESTART_KEY, Phase

TICK_S = 0.02
POSTURE_TICKS = 18
"""Ticks that a gliding robot takes for each of the four postures of a key."""
SPEED_M_S, TURN_RAD_S = 0.057, math.radians(20)
LEGS = ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")
STRIKE_M = 0.14
"""Distance that the legs of a gliding robot reach [m]."""


def make_sheet(ground: arena.Arena) -> Sheet:
    return Sheet(
        protocol=1,
        version="",
        court="main",
        match=1,
        arena=ground.name,
        title=ground.title,
        duration_s=ground.match.duration_s,
        levels=tuple(ground.match.open_levels),
        settings=ground.settings,
        seats=tuple(
            SheetSeat(
                id=seat.id,
                colour=seat.colour,
                pattern=seat.pattern,
                legs=LEGS,
                keys=((0, 1, 2, 3, 4, 5, 6, 7, 8), (0, 1, 2, 3)),
                postures=(1, 4, 4, 4),
            )
            for seat in ground.seats
        ),
        markers=ground.game.markers,
        scene=bytes(8),
    )


def make_frame(
    poses: list[tuple[float, float, float]],
    keys: list[Key],
    *,
    ticks: int = 0,
    board: tuple[int, ...] = (),
    scores: tuple[int, ...] = (0, 0),
    locked: int = 0,
    upside_down: bool = False,
    postures: tuple[int, ...] = (0, 0),
) -> Frame:
    """Return a frame of the phase PLAYING with robots at (x, y, heading) [m, m, rad]."""
    packed = b""
    for x, y, heading in poses:
        half = (heading - math.pi / 2) / 2
        turn = (math.cos(half), 0.0, 0.0, math.sin(half))
        lying = (0.0, math.cos(half), math.sin(half), 0.0)
        packed += struct.pack("<7f", x, y, 0.07, *(lying if upside_down else turn))
        packed += bytes(4 * 3 * len(LEGS))
    return Frame(
        match=1,
        beat=ticks,
        phase=Phase.PLAYING,
        countdown_beats=0,
        clock_ticks=ticks,
        seats=tuple(
            SeatFrame(
                flags=3,
                score=score,
                level=key.level,
                key=key.key,
                posture=posture,
                locked_ticks=locked,
                applied_seq=0,
                applied_beat=0,
                refused_seq=0,
                refused_why=0,
            )
            for key, score, posture in zip(keys, scores, postures, strict=False)
        ),
        markers=pack_states(board),
        poses=packed,
        scene=bytes(8),
        digest=bytes(8),
    )


def glide(ground: arena.Arena, names: tuple[str, str], seed: int) -> tuple[int, ...]:
    """Play a match of robots that glide and pass through one another; return the scores."""
    game, sheet = ground.game, make_sheet(ground)
    chance = random.Random(seed)
    brains: list[Brain] = [ground.bots[name](sheet, seat) for seat, name in enumerate(names)]
    poses = [
        [p.x_m, p.y_m, p.heading_rad + chance.uniform(-0.3, 0.3)]
        for p in (places[0] for places in game.starts)
    ]
    paces = [chance.uniform(0.95, 1.05) for _ in poses]
    state, keys, ticks = game.start(), [STAND, STAND], 0
    since = [0, 0]  # the tick at which each robot's present key was pressed
    limits = [size / 2 - 0.15 for size in game.size_m]
    while ticks < ground.match.duration_s / TICK_S and not game.over(state):
        frame = make_frame(
            [(p[0], p[1], p[2]) for p in poses],
            keys,
            ticks=ticks,
            board=game.board(state),
            scores=game.score(state),
            postures=tuple(
                (ticks - pressed) // POSTURE_TICKS % 4 if key != STAND else 0
                for key, pressed in zip(keys, since, strict=True)
            ),
        )
        for seat, brain in enumerate(brains):
            key = brain(frame)
            if key is not None:
                keys[seat], since[seat] = key, ticks
            pose, digit = poses[seat], keys[seat].key
            if digit == RESTART_KEY:
                start = game.starts[seat][0]
                pose[:] = [start.x_m, start.y_m, start.heading_rad]
                keys[seat] = STAND
            pose[2] += {1: 1, 3: -1}.get(digit, 0) * TURN_RAD_S * paces[seat] * TICK_S
            step_m = SPEED_M_S * paces[seat] * TICK_S if digit == 2 else 0.0
            for axis, part in enumerate((math.cos(pose[2]), math.sin(pose[2]))):
                limit = limits[axis]
                pose[axis] = min(limit, max(-limit, pose[axis] + step_m * part))
        seen = tuple(
            RobotView(
                p[0],
                p[1],
                0.07,
                1.0,
                0.0,
                0.0,
                0.0,
                touched=tuple(
                    index
                    for index, marker in enumerate(game.markers)
                    if marker.kind == "flag"
                    and abs(p[0] - marker.x_m) < STRIKE_M
                    and math.hypot(p[0] - marker.x_m, p[1] - marker.y_m) < STRIKE_M
                ),
            )
            for p in poses
        )
        state, _ = game.step(state, seen, TICK_S)
        ticks += 1
    return game.score(state)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["othello", "flag-strike"])
@pytest.mark.parametrize(("weak", "strong"), [("straight", "nearest"), ("nearest", "planner")])
@pytest.mark.long
def test_ladder(name: str, weak: str, strong: str) -> None:
    """Of six matches, three from each seat, the stronger bot wins at least four."""
    ground = arena.load(name)
    wins = 0
    for seed in range(3):
        for seats in ((strong, weak), (weak, strong)):
            scores = glide(ground, seats, seed)
            own, other = scores[seats.index(strong)], scores[seats.index(weak)]
            wins += own > other
    assert wins >= 4


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("name", ["flag-strike", "othello"])
@pytest.mark.parametrize(("weak", "strong"), [("straight", "nearest"), ("nearest", "planner")])
def test_ladder_with_physics(name: str, weak: str, strong: str) -> None:
    """The stronger bot also wins with physics, where walking hexapods hinder each other."""
    simulate = pytest.importorskip("lacoc_server.simulate")
    ground = arena.load(name, {"match": {"duration_s": 100.0}})
    setup = Setup(court="main", match=1, arena=name, settings=ground.settings, limits={})
    players = [simulate.player(ground, seat, bot) for seat, bot in enumerate((strong, weak))]
    result = simulate.simulate(setup, players)
    assert result.computed == "left"
    assert result.scores[0] > result.scores[1]


# Steering


SHEET = make_sheet(arena.load("othello"))
AWAY = (0.8, -0.8, math.pi)
"""A pose (x, y, heading) for the other robot, out of the way."""


def pilot() -> Pilot:
    return Pilot(SHEET, 0, (2.04, 2.04))


def key_for(
    target_m: tuple[float, float] | None,
    here: tuple[float, float, float] = (0.0, 0.0, 0.0),
    other: tuple[float, float, float] = AWAY,
) -> Key | None:
    """Return the first key that a bot's `Pilot` presses for a robot that stands at `here`."""
    frame = make_frame([here, other], [STAND, STAND])
    return pilot().toward(frame, Eyes(SHEET).poses(frame), target_m)


@pytest.mark.parametrize("heading", [-3.0, -1.0, 0.0, 0.5, 2.0, 3.1])
def test_eyes_read_poses(heading: float) -> None:
    """`Eyes` reads the robots' poses from a frame; a heading is the direction of a body's +y."""
    frame = make_frame([(0.1, -0.2, heading), AWAY], [STAND, STAND])
    pose, other = Eyes(SHEET).poses(frame)
    assert (pose.x_m, pose.y_m, pose.up) == pytest.approx((0.1, -0.2, 1.0))
    assert math.isclose(math.remainder(pose.heading_rad - heading, math.tau), 0, abs_tol=1e-6)
    assert (other.x_m, other.y_m) == pytest.approx(AWAY[:2])


@pytest.mark.parametrize(
    ("target_m", "key"),
    [
        ((0.5, 0.0), FORWARD),
        ((0.5, 0.1), FORWARD),
        ((0.0, 0.5), TURN_LEFT),
        ((-0.5, 0.1), TURN_LEFT),
        ((-0.5, -0.1), TURN_RIGHT),
        ((0.0, -0.5), TURN_RIGHT),
        (None, None),
    ],
)
def test_turn_to_a_point_then_walk(target_m: tuple[float, float] | None, key: Key | None) -> None:
    """A bot's `Pilot` turns the shorter way to a target and walks; without one it stands."""
    assert key_for(target_m) == key


@pytest.mark.parametrize(
    ("other", "here", "key"),
    [
        ((0.3, 0.0, math.pi), (0.0, 0.0, 0.0), TURN_RIGHT),
        ((0.3, 0.0, math.pi), (0.0, -0.79, 0.0), FORWARD),
        ((0.3, -0.79, math.pi), (0.0, -0.79, 0.0), TURN_LEFT),
        ((-0.3, 0.0, math.pi), (0.0, 0.0, 0.0), FORWARD),
    ],
)
def test_pass_the_other_robot(
    other: tuple[float, float, float], here: tuple[float, float, float], key: Key
) -> None:
    """A bot's `Pilot` passes another robot on the right, or on the left if a wall is there."""
    assert key_for((0.9, here[1]), here, other) == key


def fly(
    brain: Pilot, frames: list[Frame], target_m: tuple[float, float] | None = (0.9, 0.0)
) -> list[Key | None]:
    eyes = Eyes(SHEET)
    return [brain.toward(frame, eyes.poses(frame), target_m) for frame in frames]


def frames(
    ticks: int, key: Key, here: tuple[float, float, float] = (0.0, 0.0, 0.0), **more: Any
) -> list[Frame]:
    other = more.pop("other", AWAY)
    return [make_frame([here, other], [key, STAND], ticks=tick, **more) for tick in range(ticks)]


def test_key_is_left_at_the_end_of_its_sequence() -> None:
    """A bot's `Pilot` changes the key only when the sequence is back at the first posture."""
    turned_away = (0.0, 0.0, math.pi / 2)
    seen = [
        make_frame([turned_away, AWAY], [FORWARD, STAND], ticks=tick, postures=(posture, 0))
        for tick, posture in enumerate((1, 2, 3, 3, 0, 0))
    ]
    assert fly(pilot(), seen) == [None, None, None, None, TURN_RIGHT, None]


def test_restart_when_it_lies_on_its_back() -> None:
    """When a robot lies on its back, its bot's `Pilot` presses [x] after two seconds."""
    keys = fly(pilot(), frames(2 * BEATS_PER_S + 1, STAND, upside_down=True))
    assert RESTART not in keys[:-1]
    assert keys[-1] == RESTART


def test_restart_when_tangled() -> None:
    """A bot's `Pilot` presses [x] when two robots have been closer than 0.36 m for 8 s."""
    keys = fly(pilot(), frames(8 * BEATS_PER_S + 1, FORWARD, other=(0.3, 0.0, math.pi)))
    assert keys.index(RESTART) == 8 * BEATS_PER_S


def test_no_key_while_keys_are_refused() -> None:
    """A bot's `Pilot` presses nothing while keys are refused after [x] (rules 3)."""
    assert fly(pilot(), frames(10, STAND, locked=100)) == [None] * 10


def test_stuck_at_a_wall() -> None:
    """A bot's `Pilot` turns a robot that has walked for a while without moving."""
    at_wall = (0.9, 0.5, 0.0)
    stuck = [
        make_frame([at_wall, AWAY], [FORWARD, STAND], ticks=tick, postures=(tick // 18 % 4, 0))
        for tick in range(6 * BEATS_PER_S)
    ]
    keys = [key for key in fly(pilot(), stuck, (1.0, 0.5)) if key is not None]
    assert keys[0] == TURN_RIGHT or keys[0] == TURN_LEFT


def test_straight_walks_on() -> None:
    """The bot `straight` presses "forward" when its robot stands and keys are accepted."""
    brain = arena.load("othello").bots["straight"](SHEET, 0)
    assert brain(frames(1, STAND)[0]) == FORWARD
    assert brain(frames(1, FORWARD)[0]) is None
    assert brain(frames(1, STAND, locked=5)[0]) is None


def test_walk_shows_every_key() -> None:
    """The practice bot `walk` presses the keys 1, 2 and 3 of level B one after another."""
    ground = arena.load("practice")
    brain = ground.bots["walk"](make_sheet(ground), 0)
    pressed, key = [], STAND
    for ticks in range(0, 16 * BEATS_PER_S, 50):
        new = brain(make_frame([(0.0, 0.0, 0.0)], [key], ticks=ticks))
        if new is not None:
            pressed.append(new)
            key = new
    assert pressed == [TURN_LEFT, FORWARD, TURN_RIGHT]


@pytest.mark.parametrize("name", ["othello", "flag-strike", "practice"])
def test_bots_are_pure(name: str) -> None:
    """Two brains of a bot give the same keys for the same frames."""
    ground = arena.load(name)
    sheet = make_sheet(ground)
    poses = [(p.x_m, p.y_m, p.heading_rad) for p in (places[0] for places in ground.game.starts)]
    board = ground.game.board(ground.game.start())
    seen = [
        make_frame(poses, [STAND] * len(poses), ticks=ticks, board=board) for ticks in range(30)
    ]
    for factory in ground.bots.values():
        first, second = factory(sheet, 0), factory(sheet, 0)
        assert [first(frame) for frame in seen] == [second(frame) for frame in seen]


def test_planner_leaves_the_corner_that_would_lose() -> None:
    """A planner that is behind avoids the corner that ends the match (workshop 5-2 rule 4)."""
    ground = arena.load("flag-strike")
    sheet = make_sheet(ground)
    game = ground.game
    state = game.start()
    for corner in (0, 1, 2):
        state = game.set(state, corner, 1)
    for flag in range(4, 24):
        state = game.set(state, flag, 3)
    for scores, key in (((15, 0), TURN_LEFT), ((15, 40), None)):
        frame = make_frame(
            [(0.5, 0.5, 0.0), (-0.5, 0.0, 0.0)],
            [STAND, STAND],
            board=game.board(state),
            scores=scores,
        )
        assert ground.bots["planner"](sheet, 0)(frame) == key
