"""One robot that learns to walk: by joint angles, step by step, or by a whole table at once."""

import math
from typing import Any, Literal

import gymnasium
import msgspec
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from lacoc_arenas.learned.arguments import short, whole
from lacoc_arenas.learned.senses import Numbers
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate.environments.court import shares
from lacoc_server.simulate.environments.episode import saved_bytes
from lacoc_server.simulate.environments.painter import Painter
from lacoc_server.simulate.environments.steered import Steered
from lacoc_server.trial.course import CYCLES, SETTLE_TICKS, practice_field
from lacoc_server.trial.figures import measure
from lacoc_server.trial.walk import Press
from lacoc_server.world.sensed import make_course
from lacoc_server.world.world import World
from lacoc_shared.codec import decode, encode, pack_states
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import say

_FORWARD = 2
"""The key with which a table is tried; it walks forward in the sample gaits."""
_MOST_TURN_RAD = math.radians(15)
"""Largest angle by which a seed turns each joint of the first posture."""
_SECONDS = 20.0
"""Default length of an episode [s]."""
_POSTURES = 4
"""Default number of postures of a table, as in the sample gaits."""
_FORWARD_WEIGHT, _CTRL_WEIGHT, _HEALTHY_REWARD = 20.0, 0.5, 1.0
"""Default weights in the reward, chosen for the sample gait's speed of 0.06 m/s."""
_HEALTHY_UP = 0.5
"""A robot is falling if its `_up` is less than this: its body is tilted by 60 degrees or more."""
_WALL_M = 1.0
"""An episode is cut when the robot's middle is this near to a wall of the floor [m]."""
_UNUSED: dict[str, dict[str, Any]] = {
    "angles": {"postures": _POSTURES},
    "table": {
        "seconds": _SECONDS,
        "beats": 1,
        "forward_reward_weight": _FORWARD_WEIGHT,
        "ctrl_cost_weight": _CTRL_WEIGHT,
        "healthy_reward": _HEALTHY_REWARD,
        "terminate_when_unhealthy": True,
    },
}
"""For each kind of actions, the arguments that have no effect with it, and their defaults."""
_NUMBERS = (int, float, np.integer, np.floating)
_FIGURES = ("speed_m_s", "lateral_m_s", "drift_rad_s", "upright", "slip_m_s", "belly_share")
"""Figures of a trial that are the observation after a table was tried."""
_BODY = {
    "ahead_m": 20.0,
    "left_m": 20.0,
    "z_m": 20.0,
    "forward_ahead": 1.0,
    "forward_left": 1.0,
    "up": 1.0,
    "speed_ahead_m_s": 100.0,
    "speed_left_m_s": 100.0,
    "speed_up_m_s": 100.0,
}
"""Numbers of the body in the observation of a walk by angles, with their bounds."""


class _SavedWalk(msgspec.Struct, frozen=True, array_like=True):
    model: str
    world: bytes
    target: Posture
    angles: Posture
    steps: int
    over: bool
    begun: tuple[float, ...]
    """Position and quaternion of the body, and joint angles, as the episode began."""
    seen: tuple[float, ...]


class WalkEnv(gymnasium.Env[Numbers, Numbers]):
    """A robot on an open floor.

    With actions "angles" a step is 20 ms times `beats`. An action is one number for each joint, by
    joint id: -1 is the lowest angle of the joint's range, 1 the highest. Commanded angles move to
    these at the robot's own speed (AngMin). An episode ends when the robot falls: its body is
    tilted by 60 degrees or more. After `seconds` it is cut, and when the robot comes near the end
    of the floor, 9 m from its start.

    The reward is that of Gymnasium's robots. It has three parts, which `infos` has too:
    "reward_forward" is the mean speed of the step [m/s], in the direction that the robot faced when
    the episode began, times a weight; "reward_survive" is paid for each step in which the robot is
    not falling; "reward_ctrl" is the mean square of how much the action changes the commanded
    angles, in halves of the joints' ranges, times a negative weight. `names` lists what is seen. Of
    the body it is how far its middle is ahead and to the left of its start, its height, the parts
    of its forward direction ahead and to the left, how upright it is (1 upright, -1 on its back),
    and its velocity. Then come joint angles and commanded angles.

    With actions "table" an action is the table of key 2: a row for each posture, a number for each
    joint. An episode is one step, a trial as `lacoc trial` has it, and the reward is the speed
    forward [m/s]; 0 if the body ever tilted by 90 degrees. What is seen are figures of the trial:
    speed ahead and to the left [m/s], turning to the left [rad/s], smallest uprightness, slip of
    the feet [m/s], and the share of ticks in which the belly carries weight.

    Args:
        robot: an installed robot, or a robot file with its gait beside it.
        actions: "angles" or "table".
        seconds: with angles, length of an episode [s].
        beats: with angles, beats of 20 ms in a step.
        postures: number of postures of a table.
        render_mode: "rgb_array", or None.
        forward_reward_weight: with angles, weight of the speed in the reward.
        ctrl_cost_weight: with angles, weight of how far joints are asked to move.
        healthy_reward: with angles, reward of a step in which the robot is not falling.
        terminate_when_unhealthy: with angles, whether an episode ends when the robot falls.

    Raises:
        UserError: if one of these is wrong.
        FileRefused: if the robot or gait file has mistakes.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (the library's own form)
        "render_modes": ["rgb_array"],
        "render_fps": 50,
    }

    OPTIONS = ()
    """Names of the options of `reset`: there are none."""

    def __init__(
        self,
        robot: str = "hexapod",
        actions: Literal["angles", "table"] = "angles",
        seconds: float = _SECONDS,
        beats: int = 1,
        postures: int = _POSTURES,
        render_mode: str | None = None,
        forward_reward_weight: float = _FORWARD_WEIGHT,
        ctrl_cost_weight: float = _CTRL_WEIGHT,
        healthy_reward: float = _HEALTHY_REWARD,
        terminate_when_unhealthy: bool = True,
    ) -> None:
        if actions not in ("angles", "table"):
            raise UserError(say("environment.walk-actions", found=str(actions)[:40]))
        weights = {
            "forward_reward_weight": forward_reward_weight,
            "ctrl_cost_weight": ctrl_cost_weight,
            "healthy_reward": healthy_reward,
        }
        given = {
            "seconds": seconds,
            "beats": beats,
            "postures": postures,
            **weights,
            "terminate_when_unhealthy": terminate_when_unhealthy,
        }
        for name, usual in _UNUSED[actions].items():
            if given[name] != usual:
                raise UserError(say("environment.unused", name=name, actions=actions))
        beats, postures = whole("beats", beats, 1), whole("postures", postures, 1, 100)
        if not isinstance(seconds, _NUMBERS) or not 0 < seconds <= 3600:
            raise UserError(say("environment.seconds", found=short(seconds)))
        self._weights = {name: _weight(name, value) for name, value in weights.items()}
        self._ends_unhealthy = terminate_when_unhealthy
        self.render_mode = render_mode
        self.metadata = {**type(self).metadata, "render_fps": 50 / beats}
        entry = weigh_in(SentFile(*find_robot(robot)), *sample_gait_files(robot))
        self._entry, self._spec = entry, entry.robot
        self._tables = actions == "table"
        self._beats = beats
        self._most_steps = math.ceil(seconds * BEATS_PER_S / beats)
        self._arena = practice_field()
        self._most_m = min(self._arena.game.size_m) / 2 - _WALL_M
        self._world = World(self._arena, [entry])
        self._course = make_course(self._spec) if self._tables else None
        self._begin = self._world.save()
        limits = np.radians(np.array(self._spec.ranges_deg))
        self._middle = (limits[:, 0] + limits[:, 1]) / 2
        self._half = (limits[:, 1] - limits[:, 0]) / 2
        self._painter = Painter(render_mode)
        joints = self._spec.joints
        shape = (postures, joints) if self._tables else (joints,)
        self._shape = shape
        self.action_space = spaces.Box(-1.0, 1.0, shape, np.float32)
        high = dict.fromkeys(_FIGURES, 10.0)
        if not self._tables:
            angles = [f"{what} {j} [rad]" for what in ("angle", "commanded") for j in range(joints)]
            high = {**_BODY, **dict.fromkeys(angles, np.pi)}
        self.names = tuple(high)
        """The meaning of each number of the observation."""
        top = np.array(list(high.values()), np.float32)
        self.observation_space = spaces.Box(-top, top, dtype=np.float32)
        self._has_begun = False
        self._start()

    def _start(self) -> None:
        self._world.load(self._begin)
        self._drive = Steered(self._entry)
        self._state = self._drive.begin(Level.LOCOMOTION)
        self._steps, self._over = 0, False
        self._from = self._world.pose()
        self._seen = np.zeros(len(_FIGURES), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Numbers, dict[str, Any]]:
        """Begin an episode; if actions are angles, the robot has settled in its first posture.

        Args:
            seed: chooses the first posture of this episode and of those after it, near the robot's
                start posture. A table is tried in the same way with all seeds.
            options: not used.

        Returns:
            What is seen (zeros if actions are tables), and an empty dict.
        """
        super().reset(seed=seed)
        self._has_begun = True
        self._start()
        if self._tables:
            return self._seen.copy(), {}
        turned = self.np_random.uniform(-_MOST_TURN_RAD, _MOST_TURN_RAD, self._spec.joints)
        low, high = self._middle - self._half, self._middle + self._half
        first = np.clip(np.array(self._spec.start_posture) + turned, low, high)
        self._drive.target = tuple(first.tolist())
        for _ in range(SETTLE_TICKS):
            self._tick()
        self._from = self._world.pose()
        return self.observe(), {}

    def step(self, action: Any) -> tuple[Numbers, float, bool, bool, dict[str, Any]]:
        """Let the beats of a step pass; if actions are tables, try one with key 2 (forward).

        Returns:
            What is seen; the reward; whether the episode ends because the robot falls (with a table
            always True); whether time is up, the floor ends or physics stopped; and the parts of
            the reward, or all measures of a table's trial.

        Raises:
            UserError: if no episode has begun, if it is over, or the action space does not have the
                action.
        """
        self._require_begun()
        if self._over:
            raise UserError(say("environment.over"))
        target = self._middle + self._half * shares(action, self._shape)
        if self._tables:
            return self._try(target)
        asked = (target - np.array(self._state.angles)) / self._half
        self._drive.target = tuple(target.tolist())
        before = self._ahead_m()
        for _ in range(self._beats):
            stopped = not self._tick()
            if stopped:
                break
        self._steps += 1
        pose = self._world.pose()
        is_healthy = _up(pose) > _HEALTHY_UP
        fell = not is_healthy and self._ends_unhealthy
        is_at_wall = bool(np.abs(pose[:2]).max() > self._most_m)
        cut = stopped or is_at_wall or self._steps >= self._most_steps
        self._over = fell or cut
        speed_m_s = (self._ahead_m() - before) * BEATS_PER_S / self._beats
        weights = self._weights
        parts = {
            "reward_forward": weights["forward_reward_weight"] * speed_m_s,
            "reward_ctrl": -weights["ctrl_cost_weight"] * float(np.mean(asked**2)),
            "reward_survive": weights["healthy_reward"] * is_healthy,
        }
        return self.observe(), sum(parts.values()), fell, cut, {**parts, "speed_m_s": speed_m_s}

    def observe(self) -> Numbers:
        """Return what is seen now, such as after `load`.

        Raises:
            UserError: if no episode has begun.
        """
        self._require_begun()
        if self._tables:
            return self._seen.copy()
        pose = self._world.pose()
        _, _, z, qw, qx, qy, qz = pose[:7].tolist()
        forward = 2 * (qx * qy - qw * qz), 1 - 2 * (qx * qx + qz * qz)
        ahead, left = self._way(pose[:2] - self._from[:2])
        speed = self._world.velocity(0)
        seen = (ahead, left, z, *self._way(np.array(forward)), _up(pose), *self._way(speed[:2]))
        return np.concatenate([seen, speed[2:], pose[7:], self._state.angles]).astype(np.float32)

    def save(self) -> bytes:
        """Return the state of the environment as bytes, without first postures still to be drawn.

        Raises:
            UserError: if no episode has begun.
        """
        self._require_begun()
        return encode(
            _SavedWalk(
                self._world.model_hash,
                self._world.save(),
                self._drive.target,
                self._state.angles,
                self._steps,
                self._over,
                tuple(self._from.tolist()),
                tuple(self._seen.tolist()),
            )
        )

    def load(self, saved: bytes) -> None:
        """Go on from saved bytes, of this environment or of one with the same arguments.

        Raises:
            UserError: if they are not of a `WalkEnv` with this robot; the environment is then as it
                was.
        """
        try:
            was = decode(saved_bytes(saved), _SavedWalk, 1 << 20)
            if was.model != self._world.model_hash:
                raise ValueError("another robot was saved")
            self._world.load(was.world)
        except ValueError as error:
            raise UserError(say("environment.other-save", error=str(error)[:200])) from None
        self._has_begun = True
        self._drive.target = was.target
        self._state = msgspec.structs.replace(self._state, angles=was.angles)
        self._steps, self._over = was.steps, was.over
        self._from, self._seen = np.array(was.begun), np.array(was.seen, np.float32)

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return a picture, an array (height, width, 3); None without a render mode."""
        return self.draw(self._painter)

    def draw(self, painter: Painter) -> npt.NDArray[np.uint8] | None:
        """Return the picture of the present state, drawn by `painter`."""
        game = self._arena.game
        return painter.draw(self._world, game, pack_states((0,) * len(game.markers)))

    def check(self, action: Any) -> None:
        """Check that an episode has begun, and that the action space has an action.

        Raises:
            UserError: if no episode has begun, or the action does not fit.
        """
        self._require_begun()
        shares(action, self._shape)

    def close(self) -> None:
        """Free the camera that draws the pictures."""
        self._painter.close()

    def _require_begun(self) -> None:
        if not self._has_begun:
            raise UserError(say("environment.not-begun"))

    def _tick(self) -> bool:
        """Let a tick pass; return False if MuJoCo reported a fault in it."""
        state = self._drive.tick(self._state)
        if self._world.step([state.angles]) is not None:
            return False
        self._state = state
        return True

    def _way(self, vector: Any) -> tuple[float, float]:
        """Split a vector of the world frame by the robot's heading at the start: ahead, left."""
        _, _, _, qw, qx, qy, qz = self._from[:7].tolist()
        x, y = 2 * (qx * qy - qw * qz), 1 - 2 * (qx * qx + qz * qz)
        length = math.hypot(x, y)
        x, y = x / length, y / length
        return float(vector[0] * x + vector[1] * y), float(vector[1] * x - vector[0] * y)

    def _ahead_m(self) -> float:
        return self._way(self._world.pose()[:2] - self._from[:2])[0]

    def _try(
        self, target: npt.NDArray[np.float64]
    ) -> tuple[Numbers, float, bool, bool, dict[str, Any]]:
        rows = tuple(tuple(row) for row in target.tolist())
        stand = (self._spec.start_posture,)
        gait = Gait(None, LocomotionTable((stand, stand, rows)))
        press = Press(SETTLE_TICKS, Level.LOCOMOTION, _FORWARD)
        assert self._course is not None
        figures = measure(self._course.walk(gait, [press], cycles=CYCLES))
        self._over = True
        self._seen = np.clip(
            np.array(
                [
                    figures.speed_mm_s / 1000,
                    figures.lateral_mm_s / 1000,
                    math.radians(figures.drift_deg_s),
                    figures.upright,
                    figures.slip_mm_s / 1000,
                    figures.belly_share,
                ],
                np.float32,
            ),
            self.observation_space.low,
            self.observation_space.high,
        )
        reward = figures.speed_mm_s / 1000 if figures.upright > 0 else 0.0
        return self._seen.copy(), reward, True, False, {"figures": msgspec.to_builtins(figures)}


def _weight(name: str, given: Any) -> float:
    """Return a weight of the reward.

    Raises:
        UserError: if the weight is not a number, or is negative.
    """
    if not isinstance(given, _NUMBERS) or not 0 <= given < math.inf:
        raise UserError(say("environment.weight", name=name, found=short(given)))
    return float(given)


def _up(pose: npt.NDArray[np.float64]) -> float:
    """Return how upright a robot is: 1 upright, -1 on its back."""
    return float(1 - 2 * (pose[4] ** 2 + pose[5] ** 2))
