"""Robots, spaces, actions and rewards, for all environments of a game."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from operator import index
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_arenas.bot import Key
from lacoc_arenas.learned.arguments import short, table, whole
from lacoc_arenas.learned.network import press
from lacoc_arenas.learned.senses import BODY, CLOCK, SEAT, Senses
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate.environments.episode import Begun, Episode
from lacoc_server.simulate.environments.opening import Opening, draw, with_options
from lacoc_server.simulate.headless import seated
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import RESTART_KEY
from lacoc_shared.words import say

Actions = Literal["keys", "angles"]
Angles = npt.NDArray[np.float64]

_FAR_M = 20.0
"""Bound of positions in the observation spaces [m]; the fields of LACOC are smaller."""
_MOST = 1e4
"""Bound of points in the observation spaces."""


class AgentCourt:
    """A game with its robots, and the observation and action space of each agent.

    Args:
        arena: name or folder of the arena.
        settings: entries that replace those of the arena file, such as
            {"match": {"duration_s": 60}}.
        robots: for each seat an installed robot, or a robot file with its gait beside it; a single
            name is for all seats.
        actions: "keys": an action is the key of level B that is held; "angles": the joint angles to
            move to.
        restart: with keys, whether [x] is one more action, the last.
        beats: beats of 20 ms in a step.

    Raises:
        UserError: if an argument is wrong, or the arena lacks two seats, level B, a referee or end.
        FileRefused: if a robot or gait file has mistakes.
    """

    def __init__(
        self,
        arena: str,
        settings: dict[str, Any] | None = None,
        robots: str | Sequence[str] = "hexapod",
        actions: Actions = "keys",
        restart: bool = False,
        beats: int = 1,
    ) -> None:
        if actions not in ("keys", "angles"):
            raise UserError(say("environment.actions", found=str(actions)[:40]))
        if restart and actions == "angles":
            raise UserError(say("environment.restart"))
        own = _plain(table("settings", settings, '{"match": {"duration_s": 60}}'))
        loaded = arenas.load(arena, own)
        self._check(loaded)
        names = _names(robots, loaded)
        self.arena = loaded
        self.seats = tuple(seat.id for seat in loaded.seats)
        joins = [
            seated(loaded, seat, "straight", name, team=self.seats[seat]).join
            for seat, name in enumerate(names)
        ]
        levels = loaded.match.open_levels
        self.entries = [
            weigh_in(one.robot, one.postures, one.locomotion, levels=levels) for one in joins
        ]
        self.begun = Begun(loaded, joins, actions == "angles")
        self.actions = actions
        self.beats = whole("beats", beats, 1)
        self.digits = tuple(
            (*entry.gait.keys(Level.LOCOMOTION), *((RESTART_KEY,) if restart else ()))
            for entry in self.entries
        )
        """For each seat, the digit of the key that each action presses."""

    @staticmethod
    def _check(arena: Arena) -> None:
        if len(arena.seats) != 2:
            raise UserError(say("environment.two-seats", arena=arena.name))
        if Level.LOCOMOTION not in arena.match.open_levels:
            raise UserError(say("environment.level", arena=arena.name))
        if arena.match.start != "referee" or not arena.match.duration_s:
            raise UserError(say("environment.no-end", arena=arena.name))

    def episode(self) -> Episode:
        """Return a new episode that has not begun; its match already has a sheet.

        Raises:
            UserError: if a robot does not stay on its start place, or MuJoCo reports a fault.
            FileRefused: if a file has mistakes.
        """
        return Episode(self.begun)

    def draw(self, chance: np.random.Generator, options: dict[str, Any]) -> Opening:
        """Draw an opening; entries of `options` replace what was drawn.

        Raises:
            UserError: if one of these options does not fit.
        """
        return with_options(draw(self.arena, chance), options, self.arena)

    def action_space(self, seat: int) -> "spaces.Space[Any]":
        """Return the action space of a seat."""
        if self.actions == "keys":
            return spaces.Discrete(len(self.digits[seat]))
        joints = self.entries[seat].robot.joints
        return spaces.Box(-1.0, 1.0, (joints,), np.float32)

    def observation_space(self, senses: Senses, seat: int) -> spaces.Box:
        """Return the observation space of a seat; `Senses` has the order of the numbers."""
        game, order = self.arena.game, [seat, *(s for s in range(len(self.seats)) if s != seat)]
        body = {"x_m": _FAR_M, "y_m": _FAR_M, "z_m": _FAR_M}
        duration_s = self.arena.match.duration_s
        high: list[float] = []
        for one in order:
            high += [body.get(name, 1.0) for name in BODY]
            high += [np.pi] * self.entries[one].robot.joints
        locked_s = max(duration_s, self.arena.match.restart_freeze_s)
        numbers = {"key": 9.0, "posture": 1000.0, "locked_s": locked_s}
        for _ in order:
            high += [numbers.get(name, _MOST) for name in SEAT]
        high += [duration_s for _ in CLOCK]
        high += [1.0] * len(game.markers)
        top = np.array(high, np.float32)
        assert top.size == senses.size
        return spaces.Box(-top, top, dtype=np.float32)

    @cached_property
    def _ranges_rad(self) -> list[tuple[Angles, Angles]]:
        """For each seat, the middle of each joint's range and half its width [rad]."""
        found = []
        for entry in self.entries:
            limits = np.radians(np.array(entry.robot.ranges_deg))
            found.append(((limits[:, 0] + limits[:, 1]) / 2, (limits[:, 1] - limits[:, 0]) / 2))
        return found

    def digit(self, seat: int, action: Any) -> int:
        """Return the digit of the key that an action presses.

        Raises:
            UserError: if there is no such action.
        """
        digits: tuple[int, ...] = self.digits[seat]
        try:
            number = index(action)
        except TypeError:
            number = -1
        if not 0 <= number < len(digits):
            raise UserError(say("environment.key", found=short(action), last=len(digits) - 1))
        return digits[number]

    def act(self, episode: Episode, seat: int, action: Any) -> Key | None:
        """Return the key to press for an action, or None (`press`); for angles, steer the robot.

        Raises:
            UserError: if the action space does not have the action.
        """
        if self.actions == "keys":
            return press(episode.frame, seat, self.digit(seat, action))
        middle, half = self._ranges_rad[seat]
        share = shares(action, middle.shape)
        episode.steer(seat, tuple((middle + half * share).tolist()))
        return None


def shares(action: Any, shape: tuple[int, ...]) -> Angles:
    """Return an action as an array of this shape, with each number limited to -1 to 1.

    Args:
        action: the action that was given.
        shape: (joints,) for angles; (postures, joints) for a table.

    Raises:
        UserError: if the action has another shape, or a number in it is not finite.
    """
    try:
        share = np.asarray(action, np.float64)
    except (TypeError, ValueError):
        share = np.empty(0)
    if share.shape != shape or not np.isfinite(share).all():
        found, (*postures, joints) = short(action), shape
        if share.shape == shape:
            at = tuple(np.argwhere(~np.isfinite(share))[0].tolist())
            found = f"action{list(at)} = {share[at]}"
        if postures:
            raise UserError(
                say("environment.no-table", found=found, postures=postures[0], joints=joints)
            )
        raise UserError(say("environment.no-angles", found=found, joints=joints))
    return np.clip(share, -1.0, 1.0)


def lead(frame: Frame, seat: int) -> int:
    """Return by how many points a seat leads the best other seat; negative if it is behind."""
    others = [one.score for index, one in enumerate(frame.seats) if index != seat]
    return frame.seats[seat].score - max(others, default=0)


def _plain(value: Any) -> Any:
    """Return settings with Python's numbers and lists in place of numpy's numbers and arrays."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return {name: _plain(one) for name, one in value.items()}
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value


def _names(robots: Any, arena: Arena) -> list[str]:
    """Return the name of each seat's robot.

    Raises:
        UserError: if there is not one name for each seat.
    """
    seats = len(arena.seats)
    names = [robots] * seats if isinstance(robots, str) else robots
    fits = isinstance(names, list | tuple) and len(names) == seats
    if not (fits and all(isinstance(name, str) for name in names)):
        raise UserError(
            say("environment.robots", found=short(robots), arena=arena.name, seats=seats)
        )
    return list(names)
