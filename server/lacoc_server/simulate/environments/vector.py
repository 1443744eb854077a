"""Steps many environments of one agent each at the same time, on all cores."""

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from lacoc_arenas.learned.arguments import short, whole
from lacoc_arenas.learned.senses import Numbers
from lacoc_server.simulate.environments.court import AgentCourt
from lacoc_server.simulate.environments.opening import known_options
from lacoc_server.simulate.environments.painter import Painter
from lacoc_server.simulate.environments.single import LacocEnv
from lacoc_server.simulate.environments.walk import WalkEnv
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class RowEnvironment(Protocol):
    """What `Rows` needs of each of its environments, which have one agent each."""

    OPTIONS: tuple[str, ...]
    """Names of the options of `reset`."""
    observation_space: Any
    action_space: Any
    metadata: dict[str, Any]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Numbers, dict[str, Any]]:
        """Begin an episode."""

    def step(self, action: Any) -> tuple[Numbers, float, bool, bool, dict[str, Any]]:
        """Let the beats of a step pass."""

    def observe(self) -> Numbers:
        """Return what the learner sees now."""

    def check(self, action: Any) -> None:
        """Check that an episode has begun, and that the action space has an action."""

    def draw(self, painter: Painter) -> npt.NDArray[np.uint8] | None:
        """Return a picture."""


OneRow = TypeVar("OneRow", bound=RowEnvironment)


class Rows(VectorEnv[Numbers, Any, npt.NDArray[Any]], Generic[OneRow]):
    """Several environments of the same arguments, called rows.

    A row whose episode is over begins the next one in the next step (`AutoresetMode.NEXT_STEP`).

    In a step each thread takes the next row that no thread has taken yet. MuJoCo lets the other
    threads run while it computes. Only one thread at a time runs Python.

    Args:
        rows: the environments.
        render_mode: "rgb_array", or None.
        threads: number of threads that step the rows; 0: one for each core.

    Raises:
        UserError: if one of these is wrong.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (the library's own form)
        "render_modes": ["rgb_array"],
        "render_fps": 50,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(self, rows: Sequence[OneRow], render_mode: str | None, threads: int) -> None:
        self.num_envs = num_envs = len(rows)
        self.render_mode = render_mode
        self.rows = list(rows)
        """The environments."""
        self.metadata = {**type(self).metadata, "render_fps": rows[0].metadata["render_fps"]}
        self.single_observation_space = self.rows[0].observation_space
        self.single_action_space = self.rows[0].action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._over = np.zeros(num_envs, bool)
        # The thread that calls `step` is one of them.
        used = whole("threads", threads, 0) or os.cpu_count() or 1
        self._others = min(used, num_envs) - 1
        self._threads = self._start_threads()
        self._painter = Painter(render_mode)  # its camera fits all rows: they have the same model

    def _start_threads(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(max(1, self._others), "environment-rows")

    def __getstate__(self) -> dict[str, Any]:
        return {name: one for name, one in vars(self).items() if name != "_threads"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._threads = self._start_threads()

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Numbers, dict[str, Any]]:
        """Begin an episode in each row.

        Args:
            seed: a number: row i gets the seed `seed + i`. A list: a seed for each row.
            options: as in a single environment, for all rows. With "reset_mask", an array
                (num_envs,) of truth values, only the rows with True begin an episode.

        Returns:
            What the learners see, as an array (num_envs, size); and the openings.

        Raises:
            UserError: if an option does not fit, or there is not a seed for each row.
        """
        given = dict(known_options(options, (*self.rows[0].OPTIONS, "reset_mask")))
        chosen = self._mask(given.pop("reset_mask", None))
        seeds = self._seeds(seed)
        infos: dict[str, Any] = {}
        for index in np.flatnonzero(chosen).tolist():
            _, info = self.rows[index].reset(seed=seeds[index], options=given)
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
            the infos of all rows, in the form of Gymnasium's vector environments.

        Raises:
            UserError: if no episode has begun, or a row has no action or one that the action space
                lacks; then no row has changed. Also if a bot fails.
        """
        if not hasattr(actions, "__len__") or len(actions) != self.num_envs:
            rows = self.num_envs
            raise UserError(say("environment.row-actions", found=short(actions), rows=rows))
        for row, action in zip(self.rows, actions, strict=True):
            row.check(action)
        size = self.single_observation_space.shape or (0,)
        seen = np.empty((self.num_envs, *size), np.float32)
        rewards = np.zeros(self.num_envs)
        ended, stopped = np.zeros(self.num_envs, bool), np.zeros(self.num_envs, bool)
        told: list[dict[str, Any]] = [{}] * self.num_envs
        untaken = iter(range(self.num_envs))  # all threads take from it

        def step_rows() -> None:
            for index in untaken:
                if self._over[index]:
                    seen[index], told[index] = self.rows[index].reset()
                else:
                    result = self.rows[index].step(actions[index])
                    seen[index], rewards[index], ended[index], stopped[index], told[index] = result

        others = [self._threads.submit(step_rows) for _ in range(self._others)]
        try:
            step_rows()
        finally:
            wait(others)
        for other in others:
            other.result()
        infos: dict[str, Any] = {}
        for index, info in enumerate(told):
            if info:
                infos = self._add_info(infos, info, index)
        self._over = ended | stopped
        return seen, rewards, ended, stopped, infos

    def _mask(self, given: Any) -> npt.NDArray[np.bool_]:
        """Return which rows begin an episode; all if no mask is given."""
        rows = self.num_envs
        if given is None:
            return np.ones(rows, bool)
        try:
            mask = np.asarray(given, bool)
        except ValueError:
            mask = np.empty(0, bool)
        if mask.shape != (rows,):
            raise UserError(say("environment.reset-mask", found=short(given), rows=rows))
        return mask

    def _seeds(self, given: Any) -> list[int | None]:
        """Return a seed for each row."""
        rows = self.num_envs
        if given is None:
            return [None] * rows
        try:
            if isinstance(given, Iterable):
                seeds = [None if one is None else whole("seed", one, 0) for one in given]
            else:
                first = whole("seed", given, 0)
                super().reset(seed=first)
                seeds = [first + row for row in range(rows)]
        except UserError:
            seeds = []
        if len(seeds) != rows:
            raise UserError(say("environment.seeds", found=short(given), rows=rows))
        return seeds

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """Return a picture of each row; None without a render mode."""
        if self.render_mode is None:
            return None
        pictures = []
        for row in self.rows:
            picture = row.draw(self._painter)
            assert picture is not None
            pictures.append(picture)
        return tuple(pictures)

    def close_extras(self, **kwargs: Any) -> None:
        """Free the camera that draws the pictures, and end the threads."""
        self._painter.close()
        self._threads.shutdown()


class LacocVectorEnv(Rows[LacocEnv]):
    """Many matches against a bot at once; each row is a `LacocEnv`.

    Args:
        num_envs: number of rows.
        arena: as in `LacocEnv`.
        opponent: as in `LacocEnv`.
        render_mode: "rgb_array", or None.
        threads: number of threads that step the rows; 0: one for each core.
        settings: as in `LacocEnv`.
        robots: as in `LacocEnv`.
        restart: as in `LacocEnv`.
        beats: as in `LacocEnv`.

    Raises:
        UserError: if one of these is wrong.
        FileRefused: if a robot or gait file has mistakes.
    """

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
        count = whole("num_envs", num_envs, 1)
        court = AgentCourt(arena, settings, robots, "keys", restart, beats)
        rows = [LacocEnv(opponent=opponent, court=court) for _ in range(count)]
        super().__init__(rows, render_mode, threads)


class WalkVectorEnv(Rows[WalkEnv]):
    """Many robots that walk at once, each on its own floor; each row is a `WalkEnv`.

    Args:
        num_envs: number of rows.
        render_mode: "rgb_array", or None.
        threads: number of threads that step the rows; 0: one for each core.
        arguments: those of `WalkEnv`.

    Raises:
        UserError: if one of these is wrong.
        FileRefused: if the robot or gait file has mistakes.
    """

    def __init__(
        self,
        num_envs: int = 2,
        render_mode: str | None = None,
        threads: int = 0,
        **arguments: Any,
    ) -> None:
        rows = [WalkEnv(**arguments) for _ in range(whole("num_envs", num_envs, 1))]
        super().__init__(rows, render_mode, threads)
