"""The MuJoCo model of a robot, built in code; docs/facts.md 2 explains its settings."""

import math
from collections.abc import Sequence
from typing import Any

import mujoco as mj

from lacoc_robots.leg import LegSpec
from lacoc_robots.robot import RobotSpec
from lacoc_shared.gait.tables import JOINTS_PER_LEG

MODEL_VERSION = 2
"""Version of the models.

It increases when the model of a robot or the solver changes, because robots then walk differently
and older records give other results. Version 1 had a dense Jacobian, and motors without a highest
speed.
"""

TIMESTEP_S = 0.002
STEPS_PER_TICK = 10
"""Physics steps in a tick of 20 ms."""

FLOOR_CONTYPE = 1
"""Collision bit of floor and walls."""
FLOOR_CONAFFINITY = 0xFFFE
"""Collision mask of floor and walls: they collide with the bits of all robots."""
MOST_SEATS = 15
"""Most robots in a world: each robot needs a collision bit of its own, and so many bits are
left."""

# `MjData.warning` counts warnings. Without this handler MuJoCo also writes MUJOCO_LOG.TXT into
# the current folder.
mj.set_mju_user_warning(lambda text: None)

_SOLREF = (0.01, 1.0)  # contact time constant [s] and damping ratio
_SHORTEST_CAPSULE_M = 1e-6  # below this length a capsule is built as a sphere
_TORSION_AND_ROLL = (0.005, 0.0001)  # MuJoCo's defaults; unused with condim 3


def set_options(parent: mj.MjSpec) -> None:
    """Set the options of MuJoCo's solver that every match has, so that it is the same anywhere."""
    parent.option.timestep = TIMESTEP_S
    parent.option.integrator = mj.mjtIntegrator.mjINT_IMPLICITFAST
    parent.option.solver = mj.mjtSolver.mjSOL_NEWTON
    parent.option.cone = mj.mjtCone.mjCONE_ELLIPTIC  # pyramids favour some headings
    parent.option.impratio = 1.0
    # Less work than dense. "Auto" would choose by the number of joints, which changes the path.
    parent.option.jacobian = mj.mjtJacobian.mjJAC_SPARSE


def collision_bits(seat: int, seats: int) -> tuple[int, int]:
    """Return contype and conaffinity of a robot, so that it collides with everything but itself.

    Raises:
        ValueError: if there is no such seat, or there are too many seats.
    """
    if not 0 <= seat < seats <= MOST_SEATS:
        raise ValueError(f"seat {seat} of {seats}: expected 0 to {MOST_SEATS - 1} of {MOST_SEATS}")
    others = sum(2 << other for other in range(seats) if other != seat)
    return 2 << seat, FLOOR_CONTYPE | others


def accent_colour(rgba: Sequence[float]) -> list[float]:
    """Return the colour of the legs that show where the front is (`accent` in the robot file).

    It is a mixture in equal parts with white, or with black if the robot's colour is bright.
    """
    red, green, blue, alpha = rgba
    toward = 1.0 if 0.299 * red + 0.587 * green + 0.114 * blue < 0.6 else 0.0
    return [(red + toward) / 2, (green + toward) / 2, (blue + toward) / 2, alpha]


def add_robot(
    parent: mj.MjSpec,
    robot: RobotSpec,
    prefix: str,
    seat: int,
    seats: int,
    rgba: Sequence[float],
) -> None:
    """Add a robot on a free joint, at the world's origin and its start height.

    The robot has the bodies `body` and `leg{leg}_{level}`, the free joint `root`, the hinges
    `j{id}`, and the position servos `a{id}` in the order of their ids; all names begin with
    the prefix. The model itself orders the joints leg by leg, not by id: find a joint by its
    name.

    Args:
        parent: the world; not compiled yet.
        robot: the robot to build.
        prefix: put before every name, such as "r0_".
        seat: index of the robot's seat.
        seats: number of seats in this world.
        rgba: colour; the accent legs get a shade of it.

    Raises:
        ValueError: if there is no such seat, or too many seats.
    """
    contype, conaffinity = collision_bits(seat, seats)
    body = parent.worldbody.add_body(name=f"{prefix}body", pos=[0, 0, robot.start_z_m])
    body.add_freejoint(name=f"{prefix}root")
    skin = {
        "contype": contype,
        "conaffinity": conaffinity,
        "condim": 3,
        "priority": 1,  # the robot's friction counts, whatever the floor's friction is
        "friction": [robot.friction, *_TORSION_AND_ROLL],
        "solref": _SOLREF,
    }
    body.add_geom(
        type=mj.mjtGeom.mjGEOM_BOX,
        size=[side / 2 for side in robot.size_m],
        mass=robot.body_mass_kg,
        rgba=list(rgba),
        **skin,
    )
    # `parent.compiler` decides the unit of joint ranges.
    unit = math.degrees if parent.compiler.degree else float
    for index, leg in enumerate(robot.legs):
        hinge = {
            "type": mj.mjtJoint.mjJNT_HINGE,
            "limited": True,
            "range": [unit(angle) for angle in leg.range_rad],
            "armature": robot.armature,
            # Back-EMF also acts while the servo pushes with its full torque. So it belongs to the
            # joint, not to the servo, whose torque is limited to `torque_n_m`.
            "damping": robot.damping + robot.back_emf,
        }
        colour = accent_colour(rgba) if leg.accent else list(rgba)
        names = [
            (f"{prefix}leg{index}_{level}", f"{prefix}j{index + len(robot.legs) * level}")
            for level in range(JOINTS_PER_LEG)
        ]
        _add_leg(body, leg, names, hinge, {**skin, "rgba": colour})
    for joint, (low, high) in enumerate(robot.ranges_rad):
        servo = parent.add_actuator(
            name=f"{prefix}a{joint}",
            target=f"{prefix}j{joint}",
            trntype=mj.mjtTrn.mjTRN_JOINT,
            ctrllimited=True,
            ctrlrange=[low, high],
            forcelimited=True,
            forcerange=[-robot.torque_n_m, robot.torque_n_m],
        )
        servo.set_to_position(kp=robot.kp, kv=max(0.0, robot.kv - robot.back_emf))


def on_floor(robot: RobotSpec) -> mj.MjSpec:
    """Put a robot alone on a floor under a light; the names of its parts have no prefix."""
    world = mj.MjSpec()
    world.modelname = robot.name
    set_options(world)
    world.worldbody.add_light(
        pos=[0, 0, 3], dir=[0, 0, -1], type=mj.mjtLightType.mjLIGHT_DIRECTIONAL
    )
    world.worldbody.add_geom(
        name="floor",
        type=mj.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 0.05],
        rgba=[0.8, 0.85, 0.8, 1],
        contype=FLOOR_CONTYPE,
        conaffinity=FLOOR_CONAFFINITY,
    )
    add_robot(world, robot, "", 0, 1, (0.2, 0.4, 0.9, 1.0))
    return world


def export_mjcf(robot: RobotSpec) -> str:
    """Return a robot as plain MJCF, on a floor under a light, with the keyframe "stand".

    The keyframe is the start posture at the start height, held by the servos.
    """
    world = on_floor(robot)
    model = world.compile()
    qpos = model.qpos0.copy()
    for joint, angle in enumerate(robot.start_posture):
        qpos[model.joint(f"j{joint}").qposadr[0]] = angle
    world.add_key(name="stand", qpos=qpos, ctrl=robot.start_posture)
    world.compile()
    return str(world.to_xml())


def _add_leg(
    body: mj.MjsBody,
    leg: LegSpec,
    names: list[tuple[str, str]],
    hinge: dict[str, Any],
    skin: dict[str, Any],
) -> None:
    """Add a chain of three links; every hinge goes through the origin of its link's frame.

    At angle 0 a link's frame has x outward and z up. So a hinge along -y lifts the link, and
    the root's hinge along z or -z swings it forward (rules 1).

    Args:
        body: the robot's body.
        leg: the leg to build.
        names: names of each link and its hinge.
        hinge: attributes of all hinges.
        skin: attributes of all shapes.
    """
    axes = ([0, 0, leg.side], [0, -1, 0], [0, -1, 0])
    places = (leg.position_m, [leg.lengths_m[0], 0, 0], [leg.lengths_m[1], 0, 0])
    along = ([1, 0, 0], [1, 0, 0], [0, 0, -1])
    half_turn = leg.outward_rad / 2
    link = body
    for level, (link_name, hinge_name) in enumerate(names):
        link = link.add_body(name=link_name, pos=places[level])
        if level == 0:
            link.quat = [math.cos(half_turn), 0, 0, math.sin(half_turn)]
        link.add_joint(name=hinge_name, axis=axes[level], **hinge)
        # As long as the link, with round ends (`LegSpec.capsules`); the workshop's root link is a
        # sphere.
        radius = leg.radius_m
        near, far = (0.0 if level == 0 else radius), leg.lengths_m[level] - radius
        ends = [x * near for x in along[level]] + [x * far for x in along[level]]
        shape: dict[str, Any] = {"type": mj.mjtGeom.mjGEOM_CAPSULE, "fromto": ends}
        if far - near < _SHORTEST_CAPSULE_M:
            shape = {"type": mj.mjtGeom.mjGEOM_SPHERE, "pos": ends[:3]}
        link.add_geom(size=[radius, 0, 0], mass=leg.masses_kg[level], **shape, **skin)
