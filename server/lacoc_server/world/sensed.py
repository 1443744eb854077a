"""A world of one robot that also measures the robot's contact with the floor in each step.

The sensors do not change how the robot moves: `tests/server/test_trial.py` compares the state
hashes with those of a world without sensors.
"""

import mujoco
import numpy as np

from lacoc_arenas.arena import Arena
from lacoc_robots.robot import RobotSpec
from lacoc_server.match.entry import Entry
from lacoc_server.trial.course import Course, practice_field
from lacoc_server.trial.walk import Sensed
from lacoc_server.world.world import SUBSTEPS, World
from lacoc_shared.gait.tables import Gait

_FLOOR = "floor"
_FORCE, _POSITION = (
    1 << int(field)
    for field in (mujoco.mjtConDataField.mjCONDATA_FORCE, mujoco.mjtConDataField.mjCONDATA_POS)
)
_NO_FORCE_N = 1e-300
_NET_FORCE = 3
"""MuJoCo's mode that gives one net force for all contacts of two bodies, at their centre."""


def make_course(robot: RobotSpec, steps: int = SUBSTEPS) -> Course:
    """Compile a robot on the floor of its trials; `steps` as in `SensedWorld`."""
    arena = practice_field()
    world = SensedWorld(arena, Entry(robot, Gait()), steps)
    return Course(world, robot, arena)


class SensedWorld(World):
    """A world of one robot that measures its contact with the floor (`trial.course.SensedPhysics`).

    Args:
        arena: a field of one seat, with the geom "floor".
        entry: the robot, weighed in.
        steps: physics steps in a tick. With fewer than `SUBSTEPS` a trial is quicker, but the robot
            no longer moves exactly as at a court.
    """

    def __init__(self, arena: Arena, entry: Entry, steps: int = SUBSTEPS) -> None:
        self._legs = len(entry.robot.legs)
        self._steps = steps
        self._prefix = f"{arena.seats[0].id}/"
        super().__init__(arena, [entry])
        self._made_of = (arena, entry, steps)
        model, legs = self.model, self._legs
        shanks = [model.body(f"{self._prefix}leg{leg}_2") for leg in range(legs)]
        self._shanks = [body.id for body in shanks]
        self._geoms = [int(body.geomadr[0]) for body in shanks]
        sizes = model.geom_size[self._geoms]
        capsule = model.geom_type[self._geoms] == mujoco.mjtGeom.mjGEOM_CAPSULE
        self._radii_m, self._halves_m = sizes[:, 0], np.where(capsule, sizes[:, 1], 0.0)
        self._back_emf = entry.robot.back_emf
        self._root = model.body(f"{self._prefix}body").id
        self._sensors = np.full((steps, model.nsensordata), np.nan)
        self._torques = np.empty((steps, model.nu))
        self._speeds = np.empty((steps, model.nu))

    @property
    def weight_n(self) -> float:
        """Weight of the robot [N]."""
        return float(-self.model.body_subtreemass[self._root] * self.model.opt.gravity[2])

    def sensed(self) -> Sensed:
        """Return the measurements of the last tick; before the first tick, loads are NaN."""
        data, legs = self.data, self._legs
        feet = self._sensors[:, : 6 * legs].reshape(self._steps, legs, 6)
        load_n, at_w_m = np.abs(feet[:, :, 2]), feet[:, :, 3:]
        whole_n = load_n.sum(axis=0)
        centre_m = np.einsum("slx,sl->lx", at_w_m[:, :, :2], load_n)
        # MuJoCo gives a body's velocity at the robot's centre of mass.
        middle_m, velocity = data.subtree_com[self._root], data.cvel[self._shanks]
        turn_x, turn_y, turn_z, *along = velocity.T
        x_m, y_m, z_m = (at_w_m[-1] - middle_m).T
        x_m_s = along[0] + (turn_y * z_m - turn_z * y_m)
        y_m_s = along[1] + (turn_z * x_m - turn_x * z_m)
        # What a motor loses by its own speed never reaches the joint (`lacoc_robots.model`).
        torques = self._torques - self._back_emf * self._speeds
        upright = np.abs(data.geom_xmat[self._geoms, 8])
        robot_n = np.abs(self._sensors[:, -1])
        return Sensed(
            load_n=load_n.mean(axis=0),
            other_load_n=float(np.maximum(0.0, robot_n - load_n.sum(axis=1)).mean()),
            power_w=float(np.maximum(0.0, torques * self._speeds).sum(axis=1).mean()),
            contact_w_m=centre_m / np.maximum(whole_n, _NO_FORCE_N)[:, None],
            grip_n=load_n[-1],
            slip_m_s=np.hypot(x_m_s, y_m_s) * (load_n[-1] > 0),
            centre_w_m=middle_m[:2].copy(),
            tip_m=data.geom_xpos[self._geoms, 2] - self._halves_m * upright - self._radii_m,
        )

    def _extend(self, spec: mujoco.MjSpec) -> None:
        spec.option.timestep *= SUBSTEPS / self._steps
        shank = _FORCE | _POSITION
        for leg in range(self._legs):
            self._feel(spec, mujoco.mjtObj.mjOBJ_BODY, f"leg{leg}_2", shank)
        self._feel(spec, mujoco.mjtObj.mjOBJ_XBODY, "body", _FORCE)

    def _feel(self, spec: mujoco.MjSpec, kind: mujoco.mjtObj, name: str, fields: int) -> None:
        """Add a sensor of a body's contact with the floor.

        With `mjOBJ_BODY` it senses this body alone. With `mjOBJ_XBODY` it also senses all bodies
        that hang on it.
        """
        spec.add_sensor(
            name=f"floor:{name}",
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=kind,
            objname=self._prefix + name,
            reftype=mujoco.mjtObj.mjOBJ_GEOM,
            refname=_FLOOR,
            intprm=[fields, _NET_FORCE, 1],
        )

    def _advance(self) -> None:
        model, data = self.model, self.data
        for step in range(self._steps):
            mujoco.mj_step(model, data)
            self._sensors[step] = data.sensordata
            self._torques[step] = data.actuator_force
            self._speeds[step] = data.actuator_velocity
