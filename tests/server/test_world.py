"""Tests of the world: equal bits, touch without force, and no silent reset."""

import math
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from stage import FORWARD, LEFT, QUICK, RIGHT, TURN_LEFT, B, Stage, X, entry, key

from lacoc_arenas import arena as arenas
from lacoc_arenas.game import Place
from lacoc_server.match.drive import Drive
from lacoc_server.match.entry import Entry
from lacoc_server.match.physics import Fault
from lacoc_server.world.models import compile_models
from lacoc_server.world.robot import Robot
from lacoc_server.world.world import STATE, SUBSTEPS, World
from lacoc_shared import decisions as d
from lacoc_shared.gait.tables import Posture
from lacoc_shared.seat import NOBODY, Phase
from lacoc_shared.words import Phrase, say

HEXAPOD = entry()
LONG = pytest.mark.long
KEYS = {0: (FORWARD, FORWARD), 150: (TURN_LEFT, FORWARD), 220: (FORWARD, FORWARD)}


def commands(
    ticks: int, keys: dict[int, tuple[int, int]] = KEYS, entries: Sequence[Entry] = (HEXAPOD,) * 2
) -> Iterator[list[Posture]]:
    """Yield the commanded angles of both seats, tick by tick."""
    drives = [
        Drive(e.gait, e.robot.start_posture, e.robot.ang_min_rad_s, e.robot.advance, 0, True)
        for e in entries
    ]
    states = [it.begin(B) for it in drives]
    for tick in range(ticks):
        if tick in keys:
            states = [
                it.press(s, B, k) for it, s, k in zip(drives, states, keys[tick], strict=True)
            ]
        states = [it.tick(state) for it, state in zip(drives, states, strict=True)]
        yield [state.angles for state in states]


def world(arena: str = "flag-strike", robot: str = "hexapod") -> World:
    return World(arenas.load(arena), [entry(robot)] * 2)


def run(it: World, ticks: int) -> bytes:
    for angles in commands(ticks):
        assert it.step(angles) is None
    return it.digest


# Equal bits.


def test_the_same_bits_in_the_same_and_in_a_new_process() -> None:
    """The same commanded angles give the same digest, also in a new process (docs/facts.md 1)."""
    digest = run(world(), 100)
    assert run(world(), 100) == digest
    code = "import sys; sys.path.append(sys.argv[1]); import test_world as t; "
    code += "print(t.run(t.world(), 100).hex(), t.world().model_hash)"
    done = subprocess.run(
        [sys.executable, "-c", code, str(Path(__file__).parent)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == [digest.hex(), world().model_hash]


def test_the_digest_tells_every_difference_and_never_forgets_it() -> None:
    """If one angle differs in its last bit, the digests differ from that tick to the end."""
    one, other = world(), world()
    for tick, angles in enumerate(commands(20)):
        one.step(angles)
        if tick == 5:
            angles = [angles[LEFT], tuple(np.nextafter(angles[RIGHT], 9.0))]
        other.step(angles)
        assert (one.digest == other.digest) is (tick < 5)
    other.load(one.digest + other.save()[8:])
    assert other.digest == one.digest


def test_save_and_load_at_any_tick() -> None:
    """A world that loads a saved state goes on with equal bits (docs/facts.md 1)."""
    it = world()
    saved, digests, poses = [], [], []
    angles = list(commands(120))
    for commanded in angles:
        saved.append(it.save())
        it.step(commanded)
        it.touched()
        digests.append(it.digest)
        poses.append(it.poses())
    other = world()
    for tick in (119, 60, 0, 1, 37, 118):
        other.load(saved[tick])
        for later in range(tick, min(tick + 30, 120)):
            other.step(angles[later])
            assert (other.digest, other.poses()) == (digests[later], poses[later])


def test_a_state_of_another_model_is_refused() -> None:
    """A saved state is refused by a world with another model."""
    with pytest.raises(ValueError, match="this model has"):
        world().load(world(robot="quadruped").save())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arena", "robot"),
    [
        ("flag-strike", "hexapod"),
        pytest.param("othello", "hexapod", marks=LONG),
        pytest.param("practice", "octopod", marks=LONG),
        pytest.param("flag-strike", "long-legs", marks=LONG),
    ],
)
def test_a_path_has_the_bits_of_the_whole_model(arena: str, robot: str) -> None:
    """Rules 6: what is only drawn or touched, and how contacts are found, changes no bit.

    MuJoCo alone steps the whole model. The robots get into each other's legs, along a wall too, and
    are thrown at each other from far away.
    """
    ground = arenas.load(arena)
    it = World(ground, [entry(robot)] * len(ground.seats))
    whole = mujoco.MjData(it.whole)
    assert it.whole.ngeom > it.model.ngeom
    wall_m = ground.game.size_m[0] / 2 - 0.1
    rng = np.random.default_rng(1)
    contacts, met, stepped = set(), set(), set()
    kinds = it._nearness.models._asdict()
    for x_m, y_m, thrown_m_s in ((0.0, 0.12, 0.0), (wall_m, 0.12, 0.0), (0.3, 0.6, 1.0)):
        for seat in range(len(ground.seats)):
            side = 1 - 2 * seat
            it.place(seat, Place(x_m, -y_m * side, math.pi / 2 * side))
            it.data.qvel[it.robots[seat].root_dof + 1] = thrown_m_s * side
        it.load(it.digest + _state_of(it.model, it.data))
        mujoco.mj_setState(it.whole, whole, np.frombuffer(it.save()[8:]), STATE)
        for tick in range(250):
            if tick % 10 == 0:
                turns = rng.uniform(-0.6, 0.6, (len(it.robots), it.robots[0].entry.robot.joints))
                angles = [
                    tuple((np.array(own.entry.robot.start_posture) + turn).tolist())
                    for own, turn in zip(it.robots, turns, strict=True)
                ]
            assert it.step(angles) is None
            stepped |= {kind for kind, model in kinds.items() if model is it._nearness.model()}
            it.touched()
            whole.ctrl[:] = it.data.ctrl
            mujoco.mj_step(it.whole, whole, nstep=SUBSTEPS)
            assert _state_of(it.whole, whole) == it.save()[8:], tick
            met |= {it.whole.geom(geom).name for geom in whole.contact.geom.ravel().tolist()}
            bodies = it.whole.geom_bodyid[whole.contact.geom]
            contacts |= {tuple(pair) for pair in (it.whole.body_rootid[bodies] > 0).tolist()}
    assert "wall:east" in met
    if len(ground.seats) > 1:
        assert (True, True) in contacts, "no robot met the other one"
        assert stepped == {"stepped", "clear", "apart"}
    else:
        assert stepped == {"apart"}


def _state_of(model: Any, data: Any) -> bytes:
    state = np.empty(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, data, state, STATE)
    return state.tobytes()


def test_geoms_that_a_pair_names_stay() -> None:
    """A field may let two geoms collide by their names; then MuJoCo steps all of its geoms."""
    spec = mujoco.MjSpec()
    ball = spec.worldbody.add_body(pos=[0, 0, 0.2])
    ball.add_freejoint()
    ball.add_geom(name="ball", size=[0.1, 0, 0], mass=1.0, contype=0, conaffinity=0)
    spec.worldbody.add_geom(name="pad", size=[0.1, 0, 0], mass=0, contype=0, conaffinity=0)
    assert compile_models(spec.copy()).stepped.ngeom == 1
    spec.add_pair(geomname1="ball", geomname2="pad")
    models = compile_models(spec)
    assert (models.stepped.ngeom, models.touching) == (2, None)
    data = mujoco.MjData(models.stepped)
    mujoco.mj_step(models.stepped, data, nstep=50)
    assert data.ncon == 1


def test_the_model_is_compiled_before_the_match() -> None:
    """The model is compiled before play, and never during it."""
    built: list[Phase] = []

    def make(arena: arenas.Arena, entries: Sequence[Entry]) -> World:
        built.append(stage.match.phase if built else Phase.CREATED)
        return World(arena, entries)

    stage = Stage("othello", QUICK, make)
    stage.to(Phase.PLAYING)
    stage.beat(key(LEFT, X))
    stage.decide(d.Restart("right"))
    stage.decide(d.Halt())
    stage.decide(d.Resume())
    stage.run(20)
    assert built == [Phase.CREATED, Phase.LOBBY]


# Start places.


@pytest.mark.parametrize("seat", [LEFT, RIGHT])
def test_place(seat: int) -> None:
    """`place` puts a robot in its start posture, at rest, and does not move the other robot."""
    it = world()
    run(it, 40)
    before = it.data.qpos.copy(), it.data.qvel.copy()
    it.place(seat, Place(0.1, -0.7, math.radians(30)))
    mine, other = it.robots[seat], it.robots[1 - seat]
    x_m, y_m, z_m, qw, _, _, qz = it.data.qpos[mine.root_qpos : mine.root_qpos + 7]
    assert (x_m, y_m, z_m) == (0.1, -0.7, HEXAPOD.robot.start_z_m)
    assert 2 * math.atan2(qz, qw) == pytest.approx(math.radians(30 - 90))  # forward is +y
    assert tuple(it.data.qpos[mine.joint_qpos]) == HEXAPOD.robot.start_posture
    at = mine.root_dof
    assert not it.data.qvel[at : at + 6].any()
    assert not it.data.qvel[mine.joint_dofs].any()
    at = other.root_qpos
    assert (it.data.qpos[at : at + 7] == before[0][at : at + 7]).all()
    assert (it.data.qvel[other.joint_dofs] == before[1][other.joint_dofs]).all()


def test_a_place_is_a_part_of_the_state() -> None:
    """A robot's new place belongs to the saved state and is kept when a fault is undone."""
    it, other = world(), world()
    it.place(LEFT, Place(0.3, 0.3, 0.0))
    other.load(it.save())
    assert other.poses() == it.poses()
    it.data.qvel[3] = math.nan
    assert it.step(next(commands(1))) is not None
    assert other.poses() == it.poses()


# Faults.


def _spoil(name: str, value: float, seat: int, offset: int) -> Callable[[World], None]:
    def spoil(it: World) -> None:
        robot = it.robots[seat]
        start = robot.root_qpos if name == "qpos" else robot.root_dof
        getattr(it.data, name)[start + offset] = value

    return spoil


@pytest.mark.parametrize("seat", [LEFT, RIGHT])
@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("qpos", math.nan, say("fault.position")),
        ("qpos", 1e11, say("fault.position")),
        ("qvel", math.nan, say("fault.velocity")),
        ("qvel", -1e11, say("fault.velocity")),
        ("qvel", math.inf, say("fault.velocity")),
    ],
)
@pytest.mark.parametrize("offset", [pytest.param(0, marks=LONG), 8, pytest.param(23, marks=LONG)])
def test_mujocos_silent_reset_is_caught(
    name: str, value: float, why: Phrase, seat: int, offset: int
) -> None:
    """A bad number in a state is a fault of its robot, and the tick is undone (docs/facts.md 3)."""
    it, twin = world(), world()
    run(it, 20)
    run(twin, 20)
    before = it.save(), it.poses()
    _spoil(name, value, seat, offset)(it)
    fault = it.step(next(commands(1)))
    assert fault is not None
    assert fault.seat == seat
    assert fault.why == why
    assert (it.save(), it.poses()) == before
    for angles in commands(10):  # afterwards the path is that of a world without the fault
        assert it.step(angles) is None
        twin.step(angles)
    assert it.digest == twin.digest


@pytest.mark.parametrize("seat", [LEFT, RIGHT])
def test_a_command_that_is_no_number(seat: int) -> None:
    """A commanded angle of NaN is a fault; MuJoCo alone would replace it silently."""
    it = world()
    run(it, 5)
    before = it.save()
    angles = next(commands(1))
    angles[seat] = (*angles[seat][:7], math.nan, *angles[seat][8:])
    fault = it.step(angles)
    assert fault == Fault(seat, say("fault.control"))
    assert it.save() == before


def test_a_fault_of_no_seat() -> None:
    """A warning of MuJoCo that concerns no robot is a fault without a seat."""
    it = world()
    it.data.warning.number[int(mujoco.mjtWarning.mjWARN_CONTACTFULL)] += 1
    assert it.step(next(commands(1))) == Fault(NOBODY, say("fault.contacts"))
    assert it.step(next(commands(1))) is None


def test_a_fault_leaves_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A fault writes no file, such as MuJoCo's own log."""
    monkeypatch.chdir(tmp_path)
    it = world()
    it.data.qvel[0] = math.nan
    assert it.step(next(commands(1))) is not None
    assert list(tmp_path.iterdir()) == []


# Touch.

POLE_M, REACH_M = 0.01, 0.25


def gaps_m(it: World, seat: int, poles: Sequence[tuple[float, float]]) -> np.ndarray:
    """Return the horizontal gap from each pole to a robot's nearest leg or (upright) body [m].

    A negative gap is an overlap. Gaps are true if all parts of the robot are lower than the poles.
    """
    robot = it.robots[seat]
    at = robot.root_qpos
    here, (w, *v) = it.data.qpos[at : at + 3], it.data.qpos[at + 3 : at + 7]

    def turned(points: Sequence[Sequence[float]]) -> np.ndarray:
        twice = 2 * np.cross(v, points)
        return (here + points + w * twice + np.cross(v, twice))[:, None, :2]

    shapes = robot.entry.robot.capsules(tuple(it.data.qpos[robot.joint_qpos]))
    a, b = turned([shape.start for shape in shapes]), turned([shape.end for shape in shapes])
    from_a, along = np.array(poles) - a, b - a
    length2 = np.maximum((along**2).sum(-1), 1e-12)
    part = np.clip((from_a * along).sum(-1) / length2, 0, 1)
    far = np.linalg.norm(from_a - part[..., None] * along, axis=-1)
    legs = (far - np.array([[shape.radius_m] for shape in shapes])).min(0)
    yaw = 2 * math.atan2(v[2], w)
    axes = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    half = np.array(robot.entry.robot.size_m[:2]) / 2
    local = np.abs((np.array(poles) - here[:2]) @ axes.T)
    body = np.linalg.norm(np.maximum(local - half, 0.0), axis=-1)
    return np.minimum(legs, body) - POLE_M


def test_touch_is_where_the_shapes_meet() -> None:
    """Rules 6: a robot touches exactly the flags whose poles its shape overlaps."""
    it = world()
    flags = arenas.load("flag-strike").game.markers[4:]
    poles = [(flag.x_m, flag.y_m) for flag in flags]
    rng = np.random.default_rng(1)
    it.place(RIGHT, Place(0.9, 0.9, 0.0))
    seen, near = [0, 0], 0
    for _ in range(400):
        x_m, y_m = poles[rng.integers(len(poles))] + rng.uniform(-0.15, 0.15, 2)
        it.place(LEFT, Place(x_m, y_m, rng.uniform(0, math.tau)))
        touched = it.touched()[LEFT]
        for index, gap in enumerate(gaps_m(it, LEFT, poles).tolist(), start=4):
            if abs(gap) > 1e-5:
                assert (index in touched) is (gap < 0), (index, gap)
                seen[gap < 0] += 1
                near += abs(gap) < 2e-3
    assert min(seen) > 100
    assert near > 3


@pytest.mark.parametrize("seat", [LEFT, RIGHT])
def test_touching_and_just_not_touching(seat: int) -> None:
    """Touch begins within 0.05 mm of the place where a robot's shape meets the pole."""
    it = world()
    flag = arenas.load("flag-strike").game.markers[22]
    it.place(1 - seat, Place(-0.9, -0.9, 0.0))

    def at(x_m: float) -> Sequence[tuple[int, ...]]:
        it.place(seat, Place(x_m, flag.y_m, math.pi / 2))
        return it.touched()

    low, high = flag.x_m - 0.3, flag.x_m  # from clear of the pole to over it
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (low, middle) if at(middle)[seat] else (middle, high)
    at(low)
    assert gaps_m(it, seat, [(flag.x_m, flag.y_m)])[0] == pytest.approx(0.0, abs=1e-6)
    assert at(low - 5e-5) == [(), ()]
    assert at(low + 5e-5)[seat] == (22,)
    assert at(low + 5e-5)[1 - seat] == ()


def test_both_touching() -> None:
    """A flag that both robots touch in a tick is reported for both."""
    it = world()
    flag = arenas.load("flag-strike").game.markers[22]
    seen = []
    for far_m in np.linspace(0.3, 0.05, 100):
        it.place(LEFT, Place(flag.x_m - far_m, flag.y_m, math.pi / 2))
        it.place(RIGHT, Place(flag.x_m + far_m, flag.y_m, -math.pi / 2))
        seen.append(tuple(it.touched()))
    assert set(seen) == {((), ()), ((22,), (22,))}


def test_a_robot_on_its_back_touches_with_its_legs() -> None:
    """Rules 6: any part of a robot can touch a flag, however the robot lies."""
    it = world()
    markers = arenas.load("flag-strike").game.markers
    flag = markers[22]
    it.place(RIGHT, Place(-0.9, -0.9, 0.0))
    at = it.robots[LEFT].root_qpos
    rng = np.random.default_rng(2)
    seen = [0, 0]
    for _ in range(300):
        turn = rng.normal(size=4)
        it.place(LEFT, Place(flag.x_m + rng.uniform(-0.2, 0.2), flag.y_m + 0.09, 0.0))
        it.data.qpos[at + 2] = 0.13
        it.data.qpos[at + 3 : at + 7] = turn / np.linalg.norm(turn)
        if math.dist(it.data.qpos[at : at + 2], (flag.x_m, flag.y_m)) < 0.1:
            continue  # the body may touch, and `gaps_m` is right only for an upright body
        (gap,) = gaps_m(it, LEFT, [(flag.x_m, flag.y_m)]).tolist()
        if abs(gap) > 1e-5 and _lower_than_a_pole(it):
            assert (22 in it.touched()[LEFT]) is (gap < 0)
            seen[gap < 0] += 1
    assert min(seen) > 10


def _lower_than_a_pole(it: World) -> bool:
    mujoco.mj_kinematics(it.model, it.data)
    geoms = it.robots[LEFT].geoms
    heights = it.data.geom_xpos[geoms, 2]
    reach = it.model.geom_rbound[geoms]
    return bool((heights + reach).max() < REACH_M and (heights - reach).min() > -0.05)


class AllPairs:
    """What robots touch by MuJoCo's distance of each part from each pole, in the whole model."""

    def __init__(self, it: World) -> None:
        self.it, self.model, self.data = it, it.whole, mujoco.MjData(it.whole)
        seats = ("left", "right")
        self.geoms = [
            Robot.find(it.whole, own.entry, seat).geoms.tolist()
            for own, seat in zip(it.robots, seats, strict=True)
        ]
        self.probes = {
            marker: it.whole.geom(f"probe:{info.name}").id
            for marker, info in enumerate(arenas.load("flag-strike").game.markers)
            if info.kind == "flag"
        }

    def touched(self, gap_m: float = 0.0) -> list[tuple[int, ...]]:
        self.data.qpos[:] = self.it.data.qpos
        mujoco.mj_kinematics(self.model, self.data)
        room_m = 1e-3 + abs(gap_m)
        return [
            tuple(
                marker
                for marker, probe in self.probes.items()
                if any(
                    mujoco.mj_geomDistance(self.model, self.data, geom, probe, room_m, None)
                    <= gap_m
                    for geom in own
                )
            )
            for own in self.geoms
        ]


@pytest.mark.parametrize("robot", ["hexapod", "long-legs", "quadruped", "octopod"])
def test_touch_is_what_mujoco_says_of_each_pair(robot: str) -> None:
    """`touched` finds the same flags as MuJoCo's distance of each part from each pole.

    Robots are in random poses, also over the top of a pole and on their backs. From each pose they
    move on a little, so that what was near before is used again.
    """
    it = world(robot=robot)
    pairs = AllPairs(it)
    markers = arenas.load("flag-strike").game.markers
    rng = np.random.default_rng(3)
    touching = 0
    for _ in range(150):
        for own in it.robots:
            at = own.root_qpos
            flag = markers[rng.choice(list(pairs.probes))]
            turn = rng.normal(size=4) * (1.0, 0.3, 0.3, 1.0)
            it.data.qpos[at : at + 2] = rng.normal((flag.x_m, flag.y_m), 0.12)
            it.data.qpos[at + 2] = rng.uniform(0.0, 0.35)
            it.data.qpos[at + 3 : at + 7] = turn / np.linalg.norm(turn)
            low, high = np.array(own.entry.robot.ranges_rad).T
            it.data.qpos[own.joint_qpos] = rng.uniform(low, high)
        for gap_m in (0.0, 0.02, -0.005, 0.0):
            found = it.touched(gap_m)
            assert list(found) == pairs.touched(gap_m)
            touching += sum(map(len, found))
            for own in it.robots:
                at = own.root_qpos
                it.data.qpos[at : at + 2] += rng.normal(0.0, 0.005, 2)
                turn = it.data.qpos[at + 3 : at + 7] + rng.normal(0.0, 0.03, 4)
                it.data.qpos[at + 3 : at + 7] = turn / np.linalg.norm(turn)
                it.data.qpos[own.joint_qpos] += rng.normal(0.0, 0.2, len(own.joint_qpos))
    assert touching > 200


def test_touch_costs_no_bit() -> None:
    """Asking what a robot touches does not change its path; each answer is right."""
    asked, quiet = world(), world()
    pairs = AllPairs(asked)
    for it in (asked, quiet):
        it.place(LEFT, Place(-0.3, 0.0, 0.0))
    touched = set()
    for angles in commands(150):
        asked.step(angles)
        found = asked.touched()
        assert list(found) == pairs.touched()
        touched.update(found[LEFT])
        quiet.step(angles)
        assert asked.digest == quiet.digest
        assert asked.save() == quiet.save()
    assert touched


def test_the_empty_field() -> None:
    """A world without robots has no poses and no touches."""
    it = World(arenas.load("flag-strike"), [])
    assert it.poses() == b""
    assert list(it.touched()) == []
    assert it.scene.bodies[0].parent == -1
