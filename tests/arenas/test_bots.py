"""Bots of both games on a field where robots glide: a fast ladder without physics."""

import math
import random
import struct

import pytest

from lacoc_arenas import arena
from lacoc_arenas.bot import Brain, Key
from lacoc_arenas.game import RobotView
from lacoc_shared.codec import pack_states
from lacoc_shared.messages import Frame, SeatFrame, Sheet, SheetSeat
from lacoc_shared.seat import Phase

TICK_S = 0.02
SPEED_M_S, TURN_RAD_S = 0.057, math.radians(18)
LEGS = ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")
STRIKE_M = 0.14
"""How far the legs of a gliding robot reach."""


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
) -> Frame:
    """A frame of PLAYING with robots at (x, y, heading)."""
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
                posture=0,
                locked_ticks=locked,
                applied_seq=0,
                applied_beat=0,
                refused_seq=0,
                refused_why=0,
            )
            for key, score in zip(keys, scores, strict=False)
        ),
        markers=pack_states(board),
        poses=packed,
        scene=bytes(8),
        digest=bytes(8),
    )


def glide(ground: arena.Arena, names: tuple[str, str], seed: int) -> tuple[int, ...]:
    """Play a match of gliding robots, which pass through one another; returns the scores."""
    game, sheet = ground.game, make_sheet(ground)
    chance = random.Random(seed)
    brains: list[Brain] = [ground.bots[name](sheet, seat) for seat, name in enumerate(names)]
    poses = [
        [p.x_m, p.y_m, p.heading_rad + chance.uniform(-0.3, 0.3)]
        for p in (places[0] for places in game.starts)
    ]
    paces = [chance.uniform(0.95, 1.05) for _ in poses]
    state, keys, ticks = game.start(), [Key(1, 0), Key(1, 0)], 0
    limits = [size / 2 - 0.15 for size in game.size_m]
    while ticks < ground.match.duration_s / TICK_S and not game.over(state):
        frame = make_frame(
            [(p[0], p[1], p[2]) for p in poses],
            keys,
            ticks=ticks,
            board=game.board(state),
            scores=game.score(state),
        )
        for seat, brain in enumerate(brains):
            keys[seat] = brain(frame) or keys[seat]
            pose, key = poses[seat], keys[seat].key
            pose[2] += {1: 1, 3: -1}.get(key, 0) * TURN_RAD_S * paces[seat] * TICK_S
            step_m = SPEED_M_S * paces[seat] * TICK_S if key == 2 else 0.0
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
def test_ladder(name: str, weak: str, strong: str) -> None:
    """The stronger bot beats the weaker in most pairs of matches with seats swapped."""
    ground = arena.load(name)
    wins = losses = 0
    for seed in range(3):
        for seats in ((strong, weak), (weak, strong)):
            scores = glide(ground, seats, seed)
            own, other = scores[seats.index(strong)], scores[seats.index(weak)]
            print(name, seats, scores)
            wins += own > other
            losses += own < other
    assert wins > losses
    assert wins >= 4
