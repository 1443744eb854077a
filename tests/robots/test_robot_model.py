"""The compiled model has the numbers of the robot file."""

import itertools
import math
from collections.abc import Callable

import mujoco as mj
import numpy as np
import pytest

from lacoc_robots.library import find_robot, installed_robots
from lacoc_robots.model import (
    FLOOR_CONAFFINITY,
    FLOOR_CONTYPE,
    STEPS_PER_TICK,
    TIMESTEP_S,
    accent_colour,
    collision_bits,
    export_mjcf,
)
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_shared.seat import BEAT_S

Compile = Callable[..., mj.MjModel]
SAMPLES = ("hexapod", "long-legs", "octopod", "quadruped")


def sample(name: str) -> RobotSpec:
    return read_robot(find_robot(name)[1], name)


def pose(model: mj.MjModel, robot: RobotSpec, posture: tuple[float, ...]) -> mj.MjData:
    data = mj.MjData(model)
    for joint, angle in enumerate(posture):
        data.qpos[model.joint(f"r0_j{joint}").qposadr[0]] = angle
    mj.mj_forward(model, data)
    return data


def test_official_options(hexapod: RobotSpec, compile_world: Compile) -> None:
    """A tick has ten steps of 2 ms, and the solver has the options of docs/facts.md 2."""
    option = compile_world(hexapod).opt
    assert pytest.approx(BEAT_S) == TIMESTEP_S * STEPS_PER_TICK
    assert option.timestep == TIMESTEP_S
    assert option.integrator == mj.mjtIntegrator.mjINT_IMPLICITFAST
    assert option.solver == mj.mjtSolver.mjSOL_NEWTON
    assert option.cone == mj.mjtCone.mjCONE_ELLIPTIC
    assert option.jacobian == mj.mjtJacobian.mjJAC_SPARSE
    assert (option.impratio, option.iterations, option.ls_iterations) == (1.0, 100, 50)


@pytest.mark.parametrize("degree", [True, False])
def test_joints_and_servos(hexapod: RobotSpec, compile_world: Compile, degree: bool) -> None:
    """Joints and servos have the file's values, whether the world uses degrees or radians."""
    model = compile_world(hexapod, degree=degree)
    assert (model.njnt, model.nu) == (19, 18)
    for joint in range(18):
        hinge, servo = model.joint(f"r0_j{joint}"), model.actuator(f"r0_a{joint}")
        assert servo.id == joint
        assert servo.trnid[0] == hinge.id
        assert hinge.range == pytest.approx([-math.radians(150), math.radians(150)])
        assert servo.ctrlrange == pytest.approx(hinge.range)
        assert (servo.gainprm[0], -servo.biasprm[1]) == (20.0, 20.0)
        assert list(servo.forcerange) == [-2.0, 2.0]
        dof = hinge.dofadr[0]
        assert model.dof_damping[dof] - servo.biasprm[2] == pytest.approx(0.5 + 0.02)
        assert model.dof_armature[dof] == 0.002
        assert list(hinge.pos) == [0, 0, 0]  # a hinge goes through its body's origin


@pytest.mark.parametrize("name", SAMPLES)
def test_masses(name: str, compile_world: Compile) -> None:
    """A model has one body and three links for each leg, with the masses of the robot file."""
    robot = sample(name)
    model = compile_world(robot)
    assert model.body_mass.sum() == pytest.approx(robot.mass_kg)
    assert model.body("r0_body").mass[0] == pytest.approx(robot.body_mass_kg)
    for index, leg in enumerate(robot.legs):
        links = [model.body(f"r0_leg{index}_{level}").mass[0] for level in range(3)]
        assert links == pytest.approx(leg.masses_kg)
    assert model.nbody == 2 + robot.joints


@pytest.mark.parametrize("name", SAMPLES)
def test_kinematics_agree(name: str, compile_world: Compile) -> None:
    """Our forward kinematics and the compiled model agree on where each hinge and link is."""
    robot = sample(name)
    model = compile_world(robot)
    posture = tuple(math.radians(angle) for angle in itertools.islice(itertools.cycle(
        (31.0, -47.0, 12.0, -3.0, 66.0, 25.0, -70.0)), robot.joints))  # fmt: skip
    data = pose(model, robot, posture)
    origin = data.body("r0_body").xpos
    assert list(origin) == [0, 0, robot.start_z_m]
    capsules = iter(robot.capsules(posture))
    for index, points in enumerate(robot.points(posture)):
        for level in range(3):
            link = model.body(f"r0_leg{index}_{level}")
            np.testing.assert_allclose(data.xpos[link.id] - origin, points[level], atol=1e-12)
            capsule = next(capsules)
            middle = np.add(capsule.start, capsule.end) / 2
            geom = link.geomadr[0]
            np.testing.assert_allclose(data.geom_xpos[geom] - origin, middle, atol=1e-12)
            half_m = math.dist(capsule.start, capsule.end) / 2
            assert list(model.geom_size[geom, :2]) == pytest.approx([capsule.radius_m, half_m])


def test_feet_touch_the_floor_at_angle_zero(hexapod: RobotSpec, compile_world: Compile) -> None:
    """In the compiled model, with every angle 0, all six feet touch the floor at x = ±0.135 m."""
    model = compile_world(hexapod)
    data = pose(model, hexapod, (0.0,) * 18)
    for leg in range(6):
        geom = model.body(f"r0_leg{leg}_2").geomadr[0]
        assert data.geom_xpos[geom][2] - 0.020 - 0.015 == pytest.approx(0.0, abs=1e-12)
        assert abs(data.geom_xpos[geom][0]) == pytest.approx(0.135)


def test_collisions(hexapod: RobotSpec) -> None:
    """A robot collides with the floor and with other robots, but not with itself (rules 1)."""
    bits = [(FLOOR_CONTYPE, FLOOR_CONAFFINITY), *(collision_bits(seat, 15) for seat in range(15))]
    for (i, one), (j, other) in itertools.product(enumerate(bits), repeat=2):
        collide = bool(one[0] & other[1] or other[0] & one[1])
        assert collide == (i != j)
    with pytest.raises(ValueError, match="seat 2 of 2"):
        collision_bits(2, 2)


def test_two_robots_in_a_world(hexapod: RobotSpec, compile_world: Compile) -> None:
    """Two robots in a world have different names; servos are sorted by seat, then by joint."""
    model = compile_world(hexapod, sample("octopod"))
    names = [model.actuator(i).name for i in range(model.nu)]
    assert names == [f"r0_a{j}" for j in range(18)] + [f"r1_a{j}" for j in range(24)]
    for seat in (0, 1):
        assert model.joint(f"r{seat}_root").type[0] == mj.mjtJoint.mjJNT_FREE


def test_accent_legs_look_different(hexapod: RobotSpec, compile_world: Compile) -> None:
    """The two front legs have another colour than the rest (workshop 3-1, rules 1)."""
    model = compile_world(hexapod)
    rgba = {i: tuple(model.geom_rgba[model.body(f"r0_leg{i}_1").geomadr[0]]) for i in range(6)}
    assert rgba[0] == rgba[5] != rgba[1] == rgba[2] == rgba[3] == rgba[4]


@pytest.mark.parametrize("colour", [(0, 0, 0), (1, 1, 1), (0.2, 0.4, 0.9), (1, 0.6, 0)])
def test_accent_of_any_colour(colour: tuple[float, float, float]) -> None:
    """The accent colour differs visibly from any team's colour."""
    accent = accent_colour((*colour, 1.0))
    assert math.dist(accent[:3], colour) > 0.4
    assert accent[3] == 1.0


def test_friction_is_the_robots(hexapod_text: str, compile_world: Compile) -> None:
    """In a contact the robot file's friction is used, whatever friction the floor has."""
    slippery = read_robot(hexapod_text.replace("friction = 1.0", "friction = 0.3"), "robot.toml")
    model = compile_world(slippery)
    data = mj.MjData(model)
    mj.mj_step(model, data, nstep=100)
    assert {contact.friction[0] for contact in data.contact} == {0.3}


@pytest.mark.parametrize("name", SAMPLES)
def test_export_opens_and_stands(name: str) -> None:
    """MuJoCo opens the exported MJCF, and the robot stands in its keyframe "stand"."""
    robot = sample(name)
    model = mj.MjModel.from_xml_string(export_mjcf(robot))
    data = mj.MjData(model)
    mj.mj_resetDataKeyframe(model, data, model.key("stand").id)
    assert data.qpos[2] == pytest.approx(robot.start_z_m)
    mj.mj_step(model, data, nstep=1000)
    assert not data.warning.number.any()
    assert data.body("body").xmat[8] > 0.999  # upright
    assert data.body("body").xpos[2] > robot.size_m[2] / 2 + 0.01  # the belly is off the floor
    assert abs(data.qvel).max() < 0.01
    for joint, angle in enumerate(robot.start_posture):
        assert data.joint(f"j{joint}").qpos[0] == pytest.approx(angle, abs=math.radians(4))


@pytest.mark.slow
@pytest.mark.parametrize("kv", ["0.0", "5.0"])
@pytest.mark.parametrize("kp", ["1.0", "200.0"])
@pytest.mark.parametrize("ang_min_deg_s", ["1", "240"])
def test_no_warnings_at_the_limits(
    ang_min_deg_s: str, kp: str, kv: str, hexapod_text: str, compile_world: Compile
) -> None:
    """Random commands cause no MuJoCo warning, even at the limits of mass, AngMin, kp and kv."""
    text = hexapod_text.replace("kp = 20.0", f"kp = {kp}").replace("kv = 0.5", f"kv = {kv}")
    text = text.replace("damping = 0.02", "damping = 0.0").replace("= 0.125", "= 0.210")
    text = text.replace("ang_min_deg_s = 120", f"ang_min_deg_s = {ang_min_deg_s}")
    text = text.replace("[0.055, 0.055, 0.055]", "[0.005, 0.005, 0.005]")
    robot = read_robot(text, "robot.toml")
    assert robot.mass_kg == pytest.approx(0.3)
    model = compile_world(robot)
    data = pose(model, robot, robot.start_posture)
    random = np.random.default_rng(7)
    for _ in range(100):
        data.ctrl[:] = random.uniform(-2.6, 2.6, 18)
        mj.mj_step(model, data, nstep=50)
    assert not data.warning.number.any()
    assert data.time == pytest.approx(10.0)


@pytest.mark.parametrize("kv", [0.0, 0.1, 0.5])
def test_a_motor_has_a_highest_speed(kv: float, hexapod_text: str, compile_world: Compile) -> None:
    """A stiff servo on a light leg turns no faster than three times AngMin (rules 1)."""
    text = hexapod_text.replace("kp = 20.0", "kp = 200.0").replace("kv = 0.5", f"kv = {kv}")
    text = text.replace("damping = 0.02", "damping = 0.0").replace("= 0.125", "= 0.9")
    text = text.replace("[0.055, 0.055, 0.055]", "[0.005, 0.005, 0.005]")
    robot = read_robot(text, "robot.toml")
    model = compile_world(robot)
    model.opt.gravity[:] = 0
    data = pose(model, robot, (0.0,) * 18)
    data.qpos[2] = 1.0
    data.ctrl[12] = math.radians(150)  # the whole angle at once, as no drive commands it
    fastest_rad_s = 0.0
    for _ in range(400):
        mj.mj_step(model, data)
        fastest_rad_s = max(fastest_rad_s, abs(data.joint("r0_j12").qvel[0]))
    assert robot.no_load_rad_s == pytest.approx(3 * math.radians(120))
    assert 0.9 * robot.no_load_rad_s < fastest_rad_s < 1.01 * robot.no_load_rad_s
    assert data.joint("r0_j12").qpos[0] == pytest.approx(math.radians(150), abs=0.1)


def test_a_servo_is_the_files_within_its_torque(hexapod: RobotSpec, compile_world: Compile) -> None:
    """A servo follows kp, kv and damping up to its largest torque, which falls with speed."""
    model = compile_world(hexapod)
    data = pose(model, hexapod, (0.0,) * 18)
    dof = model.joint("r0_j12").dofadr[0]
    for error_rad, speed_rad_s, expected_n_m in (
        (0.05, 1.0, 20 * 0.05 - (0.5 + 0.02) * 1.0),
        (0.05, -1.0, 20 * 0.05 + (0.5 + 0.02) * 1.0),
        (2.0, 0.0, 2.0),
        (2.0, math.radians(180), 2.0 * (1 - 180 / 360) - 0.02 * math.radians(180)),
    ):
        data.ctrl[12], data.qvel[dof] = error_rad, speed_rad_s
        mj.mj_forward(model, data)
        torque_n_m = data.qfrc_actuator[dof] + data.qfrc_passive[dof]
        assert torque_n_m == pytest.approx(expected_n_m)


def test_the_samples_are_installed() -> None:
    """All sample robots that the tests above use are installed."""
    assert set(SAMPLES) <= set(installed_robots())
