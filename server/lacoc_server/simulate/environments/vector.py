"""Many environments against a bot at once; physics runs on all cores (`mujoco.batch`)."""

from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache, partial
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from lacoc_arenas.arena import Arena
from lacoc_arenas.learned.senses import Numbers
from lacoc_server.match.entry import Entry
from lacoc_server.match.physics import Fault, Physics
from lacoc_server.simulate.environments.court import Court
from lacoc_server.simulate.environments.drawn import Drawn
from lacoc_server.simulate.environments.single import LacocEnv
from lacoc_server.world.batch import WorldBatch
from lacoc_server.world.world import World
from lacoc_shared.gait.tables import Posture
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_Angles = list[Posture]


class LacocVectorEnv(VectorEnv[Numbers, Any, npt.NDArray[Any]]):
    """Several environments, called rows; each gives the bits that a single `LacocEnv` would give.

    A row whose episode is over begins the next one in the next step (`AutoresetMode.NEXT_STEP`).

    The rows lie in two halves. While the physics of one half runs, rules, bots and observations of
    the other are computed.

    Args:
        num_envs: number of rows.
        arena: as in `LacocEnv`.
        opponent: as in `LacocEnv`.
        render_mode: "rgb_array", or None.
        threads: number of threads that step physics; 0: one for each core.
        settings: as in `LacocEnv`.
        robots: as in `LacocEnv`.
        restart: as in `LacocEnv`.
        beats: as in `LacocEnv`.

    Raises:
        UserError: if one of these is wrong.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (the library's own form)
        "render_modes": ["rgb_array"],
        "render_fps": 50,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 2,
        arena: str = "othello",
        opponent: str = "straight",
        render_mode: str | None = None,
        threads: int = 0,
        settings: dict[str, Any] | None = None,
        robots: str = "hexapod",
        restart: bool = False,
        beats: int = 1,
    ) -> None:
        if num_envs < 1:
            raise UserError(say("environment.rows", found=num_envs))
        self.num_envs = num_envs
        self.render_mode = render_mode
        court = Court(arena, settings, robots, "keys", restart, beats)
        self.metadata = {**type(self).metadata, "render_fps": 50 / beats}
        self._court, self._beats = court, beats
        middle = (num_envs + 1) // 2
        self._halves = [
            _Half(court, opponent, rows, threads)
            for rows in (range(middle), range(middle, num_envs))
            if rows
        ]
        self.rows = [row for half in self._halves for row in half.rows]
        """The environments."""
        self.single_observation_space = self.rows[0].observation_space
        self.single_action_space = self.rows[0].action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._over = np.zeros(num_envs, bool)
        self._physics = ThreadPoolExecutor(1, "environment-physics")
        self._drawn = Drawn(render_mode)  # its camera fits all rows: they have the same model

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Numbers, dict[str, Any]]:
        """Begin an episode in each row.

        Args:
            seed: a number: row i gets the seed `seed + i`. A list: a seed for each row.
            options: as in `LacocEnv`, for all rows. With "reset_mask", an array (num_envs,) of
                truth values, only the rows with True begin an episode.

        Returns:
            What the learners see, as an array (num_envs, size); and the openings.

        Raises:
            UserError: if an option does not fit.
        """
        seeds: list[int | None]
        if seed is None or isinstance(seed, int | np.integer):
            super().reset(seed=seed)
            seeds = [None if seed is None else int(seed) + row for row in range(self.num_envs)]
        else:
            seeds = list(seed)
        chosen = np.ones(self.num_envs, bool)
        if options and "reset_mask" in options:
            chosen = np.asarray(options["reset_mask"], bool)
        if chosen.shape != (self.num_envs,):
            raise UserError(say("environment.options", found=str(options)[:200]))
        infos: dict[str, Any] = {}
        for index in np.flatnonzero(chosen).tolist():
            _, info = self.rows[index].reset(seed=seeds[index], options=options)
            infos = self._add_info(infos, info, index)
        self._over[chosen] = False
        return np.stack([row.observe() for row in self.rows]), infos

    def step(
        self, actions: Any
    ) -> tuple[Numbers, npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], dict[str, Any]]:
        """Let the beats of a step pass in each row; rows whose episode is over begin a new one.

        Args:
            actions: (num_envs,) an action for each row.

        Returns:
            What the learners see, rewards, whether each match is over, whether physics stopped, and
            what `LacocEnv` tells of each row.

        Raises:
            UserError: if there is not an action for each row; then no row has changed.
        """
        if len(actions) != self.num_envs:
            found, rows = len(actions), self.num_envs
            raise UserError(say("environment.row-actions", found=found, rows=rows))
        for action in actions:
            self._court.digit(0, action)
        size = self.single_observation_space.shape or (0,)
        seen = np.empty((self.num_envs, *size), np.float32)
        rewards = np.zeros(self.num_envs)
        ended, stopped = np.zeros(self.num_envs, bool), np.zeros(self.num_envs, bool)
        infos: dict[str, Any] = {}
        begun = self._over.copy()
        for index in np.flatnonzero(begun).tolist():
            seen[index], info = self.rows[index].reset()
            infos = self._add_info(infos, info, index)
        going = [half.going(begun) for half in self._halves]
        flying: list[Future[list[Fault | None]] | None] = [None] * len(going)
        for beat in range(self._beats):
            for number, half in enumerate(self._halves):
                if beat:
                    half.close(flying[number])
                flying[number] = half.open(
                    self._physics,
                    [row for row in going[number] if half.is_on(row)],
                    actions if beat == 0 else None,
                )
        for number, half in enumerate(self._halves):
            half.close(flying[number])
            for index in going[number]:
                result = self.rows[index].close_step()
                seen[index], rewards[index], ended[index], stopped[index], info = result
                if info:
                    infos = self._add_info(infos, info, index)
        self._over = ended | stopped
        return seen, rewards, ended, stopped, infos

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """Return a picture of each row; None without a render mode."""
        if self.render_mode is None:
            return None
        pictures = []
        for row in self.rows:
            match = row.episode.match
            picture = self._drawn.draw(match.physics, match.game, row.episode.frame.markers)
            assert picture is not None
            pictures.append(picture)
        return tuple(pictures)

    def close_extras(self, **kwargs: Any) -> None:
        """Free what draws pictures, and the thread that steps physics."""
        self._drawn.close()
        self._physics.shutdown()


class _Half:
    """Rows whose physics is one batch.

    Args:
        court: the game.
        opponent: name of the bot.
        indices: indices of the rows.
        threads: number of threads that step the batch.
    """

    def __init__(self, court: Court, opponent: str, indices: range, threads: int) -> None:
        self._first = indices.start
        self._court = court
        self._batch = WorldBatch(World(court.arena, court.entries), len(indices), threads)
        self._open: list[int] = []
        # No match steps the empty field or these worlds, so all rows can share them.
        self._empty, self._worlds = cache(_empty_field), cache(self._world)
        self.rows = [
            LacocEnv(
                opponent=opponent,
                court=court,
                make_physics=partial(self._make, row),
            )
            for row in range(len(indices))
        ]

    def going(self, begun: npt.NDArray[np.bool_]) -> list[int]:
        """Return the indices of this half's rows that did not begin an episode in this step."""
        return [i for i in range(self._first, self._first + len(self.rows)) if not begun[i]]

    def is_on(self, index: int) -> bool:
        """Return whether the match of a row is in play."""
        return self.rows[index - self._first].episode.is_on

    def open(
        self, threads: ThreadPoolExecutor, indices: Sequence[int], actions: Any
    ) -> "Future[list[Fault | None]] | None":
        """Let the first half of a beat pass in some rows, and let a thread step their physics."""
        self._open = [index - self._first for index in indices]
        if not indices:
            return None
        angles: list[_Angles] = []
        for index, row in zip(indices, self._open, strict=True):
            commanded = self.rows[row].open_beat(None if actions is None else actions[index])
            assert commanded is not None, "a match in play has a tick in each beat"
            angles.append(commanded)
        return threads.submit(self._batch.step, self._open, angles)

    def close(self, stepped: "Future[list[Fault | None]] | None") -> None:
        """Let the second half of the beat pass in the rows that `open` was called with."""
        if stepped is None:
            return
        for row, fault in zip(self._open, stepped.result(), strict=True):
            self.rows[row].episode.close_beat(fault)

    def _make(self, row: int, arena: Arena, entries: Sequence[Entry]) -> Physics:
        """Make the physics of a row's match: the empty field, or its row of the batch."""
        return self._batch.row(row, *self._worlds(arena)) if entries else self._empty(arena)

    def _world(self, arena: Arena) -> tuple[World, bytes]:
        """Return a world of the robots, and the state in which it begins."""
        world = World(arena, self._court.entries)
        return world, world.save()


def _empty_field(arena: Arena) -> World:
    return World(arena, ())
