"""Forward kinematics agrees with MuJoCo's, and Pos-data has the right angles."""

import math

import mujoco
import numpy as np
import pytest

from lacoc_arenas.arena import load
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import weigh_in
from lacoc_server.world.world import World
from lacoc_shared.messages import Scene, SceneBody, SentFile
from lacoc_shared.record.export.kinematics import (
    ForwardKinematics,
    euler_zyx,
    multiply,
    rotate,
    split_poses,
)

_XML = """
<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="post" pos="1 2 0" euler="0 0 0.4"><geom size=".01"/></body>
    {robots}
  </worldbody>
</mujoco>
"""
_ROBOT = """
<body name="{seat}/body" pos="0 0 1"><freejoint/><geom size=".05"/>
  <body name="{seat}/a" pos=".05 .06 .01" euler="0 0 -2.1"><geom size=".01"/>
    <joint name="{seat}/j0" axis="0 0 1"/>
    <body name="{seat}/b" pos=".07 0 0" euler=".3 0 0"><geom size=".01"/>
      <joint name="{seat}/j2" axis="0 -1 0"/>
      <body name="{seat}/c" pos=".07 .01 0"><geom size=".01"/></body>
    </body>
  </body>
  <body name="{seat}/d" pos="-.05 .06 .01"><geom size=".01"/>
    <joint name="{seat}/j1" axis="1 1 0"/>
  </body>
</body>
"""
JOINTS = (3, 3)


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    """Give a MuJoCo model of a post and two robots with three hinges each."""
    robots = "".join(_ROBOT.format(seat=seat) for seat in ("left", "right"))
    return mujoco.MjModel.from_xml_string(_XML.format(robots=robots))


@pytest.fixture(scope="module")
def scene(model: mujoco.MjModel) -> Scene:
    """Give the bodies of the model as a scene without geoms."""
    bodies = []
    for index in range(model.nbody):
        joint = model.body_jntadr[index]
        hinge = joint >= 0 and model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
        name = model.body(index).name
        bodies.append(
            SceneBody(
                name=name,
                parent=int(model.body_parentid[index]) if index else -1,
                pos=tuple(model.body_pos[index].tolist()),
                quat=tuple(model.body_quat[index].tolist()),
                seat=("left/body", "right/body").index(name) if name.endswith("/body") else -1,
                joint=int(model.joint(joint).name[-1]) if hinge else -1,
                axis=tuple(model.jnt_axis[joint].tolist()) if hinge else (0.0, 0.0, 1.0),
            )
        )
    return Scene(bodies=tuple(bodies), geoms=())


def test_bodies_are_where_mujoco_has_them(model: mujoco.MjModel, scene: Scene) -> None:
    """Bodies are where MuJoCo has them (1e-6 m), for one frame at a time and for many at once."""
    random = np.random.default_rng(7)
    kinematics = ForwardKinematics(scene, JOINTS)
    data = mujoco.MjData(model)
    frames, expected = [], []
    for _ in range(50):
        numbers = []
        for seat in ("left", "right"):
            quat = random.normal(size=4)
            angles = random.uniform(-2.6, 2.6, 3)
            root = np.float32([*random.uniform(-1, 1, 3), *(quat / np.linalg.norm(quat))])
            numbers += [root, np.float32(angles)]
            start = model.jnt_qposadr[model.body(f"{seat}/body").jntadr[0]]
            data.qpos[start : start + 7] = root
            for joint in range(3):
                data.joint(f"{seat}/j{joint}").qpos = np.float32(angles[joint])
        mujoco.mj_kinematics(model, data)
        frames.append(np.concatenate(numbers))
        expected.append((data.xpos.copy(), data.xquat.copy()))
    for numbers, (pos, quat) in zip(frames, expected, strict=True):
        found_pos, found_quat = kinematics.poses(numbers.astype("<f4").tobytes())
        assert np.abs(found_pos - pos).max() < 1e-6
        assert np.abs(np.abs(np.sum(found_quat * quat, axis=-1)) - 1).max() < 1e-9
    all_pos, all_quat = kinematics.poses(np.array(frames))
    assert all_pos.shape == (50, model.nbody, 3)
    assert np.abs(all_pos - np.array([pos for pos, _ in expected])).max() < 1e-6
    assert all_quat.shape == (50, model.nbody, 4)


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_frames_of_a_court_show_its_robots(arena: str) -> None:
    """A court's scene and frames give the place of every body, for both games.

    The two robots have different numbers of joints, so each seat's angles have their own offset.
    """
    names = ("quadruped", "hexapod")
    entries = [weigh_in(SentFile(*find_robot(name)), *sample_gait_files(name)) for name in names]
    world = World(load(arena), entries)
    joints = [entry.robot.joints for entry in entries]
    kinematics = ForwardKinematics(world.scene, joints)
    random = np.random.default_rng(3)
    for _ in range(5):
        for seat in ("left", "right"):
            pose = world.data.joint(f"{seat}/root").qpos
            pose[:] = random.normal(size=7)
            pose[3:] /= np.linalg.norm(pose[3:])
        for joint in range(world.model.njnt):
            if world.model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
                world.data.joint(joint).qpos = random.uniform(-2.6, 2.6)
        mujoco.mj_kinematics(world.model, world.data)
        pos_w, _ = kinematics.poses(world.poses())
        assert np.abs(pos_w - world.data.xpos).max() < 1e-6


def test_which_bodies_move(model: mujoco.MjModel, scene: Scene) -> None:
    """Only the robots' bodies can move; every other body keeps its place."""
    kinematics = ForwardKinematics(scene, JOINTS)
    assert [scene.bodies[index].name for index in kinematics.moving] == [
        f"{seat}/{part}" for seat in ("left", "right") for part in ("body", "a", "b", "c", "d")
    ]
    pos_w, quat_w = kinematics.poses(kinematics.rest)
    assert pos_w[1].tolist() == [1.0, 2.0, 0.0]
    assert quat_w[1] == pytest.approx([math.cos(0.2), 0, 0, math.sin(0.2)])


def test_a_scene_without_robots_needs_no_poses(scene: Scene) -> None:
    """In a scene without robots, as before READY, bodies get their places from empty poses."""
    still = Scene(bodies=scene.bodies[:2], geoms=())
    pos_w, _ = ForwardKinematics(still, ()).poses(b"")
    assert pos_w.tolist() == [[0, 0, 0], [1, 2, 0]]


def test_poses_of_other_robots_are_refused() -> None:
    """Poses with a wrong number of floats are refused; the message gives the right number."""
    left, right = split_poses(np.arange(20, dtype="<f4").tobytes(), (2, 4))
    assert left.tolist() == list(range(9))
    assert right.tolist() == list(range(9, 20))
    with pytest.raises(ValueError, match=r"poses of 20 numbers, .* \[3, 4\] joints have 21"):
        split_poses(np.arange(20, dtype="<f4").tobytes(), (3, 4))


def _about(axis: int, degrees: float) -> np.ndarray:
    half = math.radians(degrees) / 2
    quat = np.array([math.cos(half), 0.0, 0.0, 0.0])
    quat[1 + axis] = math.sin(half)
    return quat


@pytest.mark.parametrize(
    ("turns", "roll_pitch_yaw", "forward"),
    [
        ([], (0, 0, 0), (0, 1, 0)),
        ([(2, 90)], (0, 0, 90), (-1, 0, 0)),
        ([(2, -90)], (0, 0, -90), (1, 0, 0)),
        ([(2, 180)], (0, 0, 180), (0, -1, 0)),
        ([(0, 90)], (90, 0, 0), (0, 0, 1)),
        ([(1, 30)], (0, 30, 0), (0, 1, 0)),
        ([(1, 90)], (0, 90, 0), (0, 1, 0)),
        ([(0, 20), (1, -30), (2, 40)], (20, -30, 40), None),
        ([(0, -170), (1, 80), (2, -100)], (-170, 80, -100), None),
    ],
)
def test_euler_angles(
    turns: list[tuple[int, float]],
    roll_pitch_yaw: tuple[float, float, float],
    forward: tuple[float, float, float] | None,
) -> None:
    """Angles are Euler ZYX, and yaw is 0 if the robot faces the field's +y (docs/rules.md 2)."""
    quat = np.array([1.0, 0, 0, 0])
    for axis, degrees in turns:  # roll first; each rotation is about an axis of the world
        quat = multiply(_about(axis, degrees), quat)
    assert np.degrees(euler_zyx(quat)) == pytest.approx(roll_pitch_yaw, abs=1e-6)
    if forward is not None:
        assert rotate(quat, np.array([0.0, 1.0, 0.0])) == pytest.approx(forward, abs=1e-12)
