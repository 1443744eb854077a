"""Tests of fairness: a match turned by 180 degrees, with its seats swapped, is the same match."""

from collections.abc import Sequence

import numpy as np
import pytest
from stage import FORWARD, LEFT, QUICK, RIGHT, TURN_LEFT, TURN_RIGHT, Script, Stage, X, key

from lacoc_shared.inputs import Input
from lacoc_shared.seat import Phase

Keys = dict[int, tuple[int, int]]
"""The keys of a match: tick -> (seat, digit)."""


def swapped(keys: Keys) -> Keys:
    return {tick: (1 - seat, digit) for tick, (seat, digit) in keys.items()}


def inputs(keys: Keys, tick: int) -> list[Input]:
    if tick not in keys:
        return []
    seat, digit = keys[tick]
    return [key(seat, digit, seq=tick)]


def robots(stage: Stage) -> np.ndarray:
    """Return both robots' poses and joint angles as MuJoCo's float64, in the shape (2, 25)."""
    world = stage.match.physics
    return world.data.qpos[world._pose_qpos].reshape(2, 25).copy()


def turned(poses: np.ndarray) -> np.ndarray:
    """Return both robots' poses with the field turned by 180 degrees and the seats swapped."""
    out = poses[::-1].copy()
    out[:, :2] *= -1
    w, x, y, z = out[:, 3:7].T.copy()
    out[:, 3:7] = np.stack([-z, -y, x, w], axis=1)  # half a turn about z, times the pose
    return out


def distance(one: np.ndarray, other: np.ndarray) -> float:
    """Return the largest difference of any number; quaternions q and -q count as equal."""
    sign = np.sign((one[:, 3:7] * other[:, 3:7]).sum(1, keepdims=True))
    other = other.copy()
    other[:, 3:7] *= sign
    return float(np.abs(one - other).max())


COLLIDING: Keys = {
    2: (LEFT, FORWARD),
    3: (RIGHT, FORWARD),
    1500: (LEFT, TURN_LEFT),
    1700: (RIGHT, TURN_RIGHT),
    1900: (LEFT, FORWARD),
    2050: (RIGHT, FORWARD),
    3000: (LEFT, TURN_RIGHT),
    3300: (LEFT, FORWARD),
    3900: (RIGHT, TURN_LEFT),
    4300: (RIGHT, FORWARD),
    4900: (RIGHT, X),
    5000: (LEFT, X),
    5300: (LEFT, FORWARD),
    5301: (RIGHT, TURN_LEFT),
    5900: (RIGHT, FORWARD),
    6800: (LEFT, TURN_RIGHT),
    7100: (LEFT, FORWARD),
    7500: (RIGHT, TURN_RIGHT),
    7900: (RIGHT, FORWARD),
}
"""Keys with which robots push each other, scrape along walls, and go back to their starts.

Contact multiplies rounding errors. Robots that stay entangled for a minute would part from
their turned path by more than the bound of the test.
"""


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("arena", ["flag-strike", "othello"])
def test_the_physics_gives_the_turned_path(arena: str) -> None:
    """If the field is turned and the seats swapped, poses differ by less than 1e-6 (m, rad).

    This holds also when the robots collide. Claims and scores are swapped between the seats.
    """
    one, other = (Stage.real(arena, QUICK).to_playing() for _ in range(2))
    mirrored = swapped(COLLIDING)
    worst, contacts = 0.0, 0
    while one.match.ticks < 9000:
        tick = one.match.ticks + 1
        one.beat(*inputs(COLLIDING, tick))
        other.beat(*inputs(mirrored, tick))
        worst = max(worst, distance(turned(robots(one)), robots(other)))
        contacts += tick % 10 == 0 and _touching(one)
    assert contacts > 50
    assert worst < 1e-6
    assert claims(other) == [(1 - seat, *rest) for seat, *rest in _turned_claims(one)]
    assert other.scores == one.scores[::-1]


def _touching(stage: Stage) -> int:
    """Return whether the robots touch each other."""
    world = stage.match.physics
    body = world.model.geom_bodyid
    root = world.model.body_rootid
    pairs = {frozenset(root[body[list(c.geom)]].tolist()) for c in world.data.contact}
    return any(len(pair) == 2 and 0 not in pair for pair in pairs)


def claims(stage: Stage) -> list[tuple[int, str, str, tuple[str, ...], int]]:
    """Return the game's claims (seat, kind, marker, further markers, tick), sorted."""
    return sorted(
        (e.seat, e.kind, e.data["marker"], tuple(sorted(e.data["also"])), e.clock_ticks)
        for e in stage.events
        if "marker" in e.data
    )


def _opposite(stage: Stage) -> dict[str, str]:
    """Return for each marker the name of its partner on the other side of the field."""
    markers = stage.match.game.markers
    at = {(round(m.x_m, 6) + 0.0, round(m.y_m, 6) + 0.0): m.name for m in markers}
    return {m.name: at[round(-m.x_m, 6) + 0.0, round(-m.y_m, 6) + 0.0] for m in markers}


def _turned_claims(stage: Stage) -> list[tuple[int, str, str, tuple[str, ...], int]]:
    other = _opposite(stage)
    return sorted(
        (
            (seat, kind, other[marker], tuple(sorted(other[name] for name in also)), tick)
            for seat, kind, marker, also, tick in claims(stage)
        ),
        key=lambda claim: (1 - claim[0], *claim[1:]),
    )


def wander(arena: str, seed: int) -> Script:
    """Return a script of two robots that walk straight; in Flag-Strike they also touch flags."""
    rng = np.random.default_rng(seed)
    script = Script()
    at = np.array([[-0.6, 0.0], [0.6, 0.0]])
    goal = at.copy()
    half = 0.9
    for tick in range(1, 1500):
        for seat in (LEFT, RIGHT):
            if np.linalg.norm(goal[seat] - at[seat]) < 0.02:
                goal[seat] = rng.uniform(-half, half, 2)
            step = goal[seat] - at[seat]
            at[seat] += 0.02 * step / max(np.linalg.norm(step), 1e-9)
        script.poses[tick] = {seat: (float(at[seat][0]), float(at[seat][1])) for seat in (0, 1)}
        if arena == "flag-strike" and tick % 50 == 0:
            touching = [set(rng.integers(4, 24, 2).tolist()) for _ in range(2)]
            script.touches[tick] = {s: tuple(sorted(touching[s])) for s in (0, 1)}
    return script


def turned_script(stage: Stage, script: Script) -> Script:
    markers = [marker.name for marker in stage.match.game.markers]
    other = _opposite(stage)
    flip = [markers.index(other[name]) for name in markers]

    def sides(values: dict[int, Sequence[int]]) -> dict[int, tuple[int, ...]]:
        return {1 - seat: tuple(sorted(flip[m] for m in ms)) for seat, ms in values.items()}

    return Script(
        poses={t: {1 - s: (-x, -y) for s, (x, y) in p.items()} for t, p in script.poses.items()},
        touches={tick: sides(touch) for tick, touch in script.touches.items()},
    )


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
@pytest.mark.parametrize("seed", range(6))
def test_the_rules_give_exactly_the_turned_match(arena: str, seed: int) -> None:
    """Rules 4: if a match is turned by 180 degrees, the rules give each seat what the other had.

    Each robot takes the other robot's turned path. Claims, scores and the winner must be swapped.
    """
    script = wander(arena, seed)
    half_minute = {"match": {"duration_s": 30.0, "countdown_s": 0.02}}
    one = Stage(arena, half_minute, script=script)
    other = Stage(arena, half_minute, script=turned_script(one, script))
    pressed: Keys = {300: (LEFT, X), 1100: (RIGHT, X)}
    # Until a digit comes, a robot that was put back scores nothing.
    pressed |= {560: (LEFT, FORWARD), 1360: (RIGHT, FORWARD)}
    mirrored = swapped(pressed)
    for stage, keys in ((one, pressed), (other, mirrored)):
        stage.to_playing()
        while stage.phase is not Phase.FINISHED:
            stage.beat(*inputs(keys, stage.match.ticks + 1))
    assert len(claims(one)) > 1
    assert claims(other) == [(1 - seat, *rest) for seat, *rest in _turned_claims(one)]
    assert other.scores == one.scores[::-1]
    sides = {"left": "right", "right": "left", "draw": "draw"}
    assert other.match.winner() == sides[one.match.winner()]
    assert other.match.ticks == one.match.ticks
