"""Tests of the scene: everything that a page needs to draw the model, and nothing else."""

import math

import mujoco
import numpy as np
import pytest
from stage import entry

from lacoc_arenas import arena as arenas
from lacoc_server.world.scene import make_scene
from lacoc_server.world.world import World
from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.messages import MARKER_STATES, Scene
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export.kinematics import ForwardKinematics

ROBOTS = ("hexapod", "long-legs", "quadruped", "octopod")


def turned_about(it: World, seed: int) -> None:
    """Give every robot a random pose and random joint angles."""
    rng = np.random.default_rng(seed)
    for robot in it.robots:
        at = robot.root_qpos
        quat = rng.normal(size=4)
        it.data.qpos[at : at + 3] = rng.uniform(-1.2, 1.2, 3)
        it.data.qpos[at + 3 : at + 7] = quat / np.linalg.norm(quat)
        it.data.qpos[robot.joint_qpos] = rng.uniform(-2.6, 2.6, len(robot.joint_qpos))
    mujoco.mj_kinematics(it.model, it.data)


@pytest.mark.parametrize("left", ROBOTS)
@pytest.mark.parametrize("right", ["hexapod", "quadruped"])
def test_forward_kinematics_from_scene_and_frame(left: str, right: str) -> None:
    """Scene and frame together give every body's pose as MuJoCo has it, within 1e-6 m."""
    entries = [entry(left), entry(right)]
    it = World(arenas.load("flag-strike"), entries)
    scene = decode(encode(it.scene), Scene)
    kinematics = ForwardKinematics(scene, [e.robot.joints for e in entries])
    for seed in range(10):
        turned_about(it, seed)
        pos_w, quat_w = kinematics.poses(it.poses())
        assert np.abs(pos_w - it.data.xpos).max() < 1e-6
        same = np.abs((quat_w * it.data.xquat).sum(-1))  # q and -q are the same rotation
        assert np.abs(same - 1).max() < 1e-6


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_every_marker_has_a_shape_for_each_of_its_states(arena: str) -> None:
    """The scene has a shape for every state of every marker."""
    ground = arenas.load(arena)
    scene = World(ground, [entry()] * 2).scene
    drawn = {(g.marker, g.state) for g in scene.geoms if g.marker >= 0}
    for index, marker in enumerate(ground.game.markers):
        states = {"disc": 3, "corner": 3, "flag": 4}[marker.kind]
        assert {state for m, state in drawn if m == index} == set(range(states))
    assert all(-1 <= g.state < len(MARKER_STATES) for g in scene.geoms)


def test_what_cannot_be_seen_is_left_out() -> None:
    """Invisible shapes (probes of flags, planes of walls) are not in the scene."""
    it = World(arenas.load("flag-strike"), [entry()] * 2)
    hidden = int((it.whole.geom_rgba[:, 3] == 0).sum())
    assert hidden == 4 + 20
    assert len(it.scene.geoms) == it.whole.ngeom - hidden


def test_whose_colour() -> None:
    """Rules 1: the two front legs (0 and 5) have another colour; the rest has the seat's colour."""
    it = World(arenas.load("othello"), [entry()] * 2)
    for seat, name in enumerate(("left", "right")):
        mine = [g for g in it.scene.geoms if it.scene.bodies[g.body].name.startswith(name)]
        accent = [g for g in mine if g.seat < 0]
        assert {g.seat for g in mine} == {seat, -1}
        names = {it.scene.bodies[g.body].name.split("/")[1].split("_")[0] for g in accent}
        assert names == {"leg0", "leg5"}
    assert all(g.seat == -1 for g in it.scene.geoms if g.body == 0)


def test_the_hash_is_of_what_is_drawn() -> None:
    """The hash of a scene has 8 bytes, and differs if other robots are drawn."""
    ground = arenas.load("othello")
    worlds = [World(ground, e) for e in ([], [entry()] * 2, [entry("quadruped"), entry()])]
    hashes = {it.scene_hash for it in worlds}
    assert len(hashes) == 3
    assert all(len(h) == 8 for h in hashes)
    assert worlds[1].scene_hash == message_hash(encode(worlds[1].scene))
    assert World(ground, [entry()] * 2).scene_hash == worlds[1].scene_hash


@pytest.mark.parametrize("kind", ["slide", "offset", "hinge", "robot's", "two", "hill"])
def test_what_pages_cannot_draw_is_said(kind: str) -> None:
    """A field with a joint or shape that pages can't draw is refused with this reason."""
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="gate")
    if kind == "hill":
        spec.worldbody.add_geom(
            name="hill", type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname="h", rgba=[1, 1, 1, 1]
        )
        spec.add_hfield(name="h", size=[1, 1, 1, 1], nrow=2, ncol=2, userdata=[0.0, 0, 0, 1])
    elif kind == "slide":
        body.add_joint(name="rail", type=mujoco.mjtJoint.mjJNT_SLIDE)
    elif kind == "offset":
        body.add_joint(name="solo/j0", pos=[0.1, 0, 0])
    elif kind == "two":
        body.add_joint(name="solo/j0")
        body.add_joint(name="solo/j1", axis=[1, 0, 0])
    else:  # the frame has no angle for a hinge of the field
        body.add_joint(name="hinge/j0" if kind == "robot's" else "hinge")
    body.add_geom(size=[0.1, 0.1, 0.1])
    with pytest.raises(UserError, match="pages can't draw"):
        make_scene(spec.compile(), arenas.load("practice").game, ["solo"])


def test_a_robot_starts_where_its_arena_says() -> None:
    """A robot starts where its arena says, and faces the other robot's side of the field."""
    ground = arenas.load("othello")
    it = World(ground, [entry()] * 2)
    for seat, sign in ((0, 1.0), (1, -1.0)):
        x_m, y_m, _, qw, _, _, qz = np.frombuffer(it.poses(), "<f4")[25 * seat :][:7]
        place = ground.game.starts[seat][0]
        assert (x_m, y_m) == pytest.approx(place[:2])
        yaw = 2 * math.atan2(qz, qw)
        assert -math.sin(yaw) == pytest.approx(sign, abs=1e-6)  # +y of the body along +-x
