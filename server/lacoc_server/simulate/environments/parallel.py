"""Both seats of a match as agents of a PettingZoo environment."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from pettingzoo import ParallelEnv

from lacoc_arenas.learned.arguments import table, whole
from lacoc_arenas.learned.senses import Numbers, Senses
from lacoc_server.simulate.environments.court import Actions, AgentCourt, lead
from lacoc_server.simulate.environments.opening import known_options
from lacoc_server.simulate.environments.painter import Painter
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class LacocParallelEnv(ParallelEnv[str, Numbers, Any]):
    """A match of two seats; both see, act and are rewarded at the same time.

    The reward of a step is the growth of the agent's lead in it [points]. So an agent's rewards in
    an episode add up to its final lead minus its first lead. In each step the rewards of both
    agents add up to zero.

    Args:
        arena: name or folder of the arena.
        render_mode: "rgb_array", or None.
        settings: entries that replace those of the arena file.
        robots: the robot of each seat; see `AgentCourt`.
        actions: "keys" or "angles"; see `AgentCourt`.
        restart: with keys, whether [x] is one more action.
        beats: beats of 20 ms in a step.

    Raises:
        UserError: if one of these is wrong.
        FileRefused: if a robot or gait file has mistakes.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (the library's own form)
        "name": "lacoc_othello_v0",
        "render_modes": ["rgb_array"],
        "render_fps": 50,
    }

    def __init__(
        self,
        arena: str = "othello",
        render_mode: str | None = None,
        settings: dict[str, Any] | None = None,
        robots: str | tuple[str, ...] = "hexapod",
        actions: Actions = "keys",
        restart: bool = False,
        beats: int = 1,
    ) -> None:
        self.court = AgentCourt(arena, settings, robots, actions, restart, beats)
        self.metadata = {
            **type(self).metadata,
            "name": f"lacoc_{self.court.arena.name.replace('-', '_')}_v0",
            "render_fps": 50 / self.court.beats,
        }
        self.render_mode = render_mode
        self.possible_agents = list(self.court.seats)
        self.agents: list[str] = []
        self._episode = self.court.episode()
        self._senses = Senses(self._episode.match.sheet())
        self._painter = Painter(render_mode)
        self.observation_spaces = {
            agent: self.court.observation_space(self._senses, seat)
            for seat, agent in enumerate(self.possible_agents)
        }
        self.action_spaces = {
            agent: self.court.action_space(seat) for seat, agent in enumerate(self.possible_agents)
        }
        self._chance = np.random.default_rng()
        self._leads: list[int] = [0, 0]

    @property
    def names(self) -> tuple[str, ...]:
        """The meaning of each number that an agent sees."""
        return self._senses.names

    def observation_space(self, agent: str) -> "spaces.Space[Numbers]":
        """Return the space of what an agent sees; it is the same object each time."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> "spaces.Space[Any]":
        """Return the space of what an agent can do; it is the same object each time."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Numbers], dict[str, dict[str, Any]]]:
        """Begin an episode.

        Args:
            seed: chooses the opening of this episode and of those after it; None: the earlier
                seed goes on. Without any seed the openings are drawn by chance.
            options: "place" and "late_ticks" replace what the seed would choose.

        Returns:
            What each agent sees, and the opening as each agent's info.

        Raises:
            UserError: if the seed is not a whole number, or an option does not fit.
        """
        given = known_options(options, ("place", "late_ticks"))
        if seed is not None:
            self._chance = np.random.default_rng(whole("seed", seed, 0))
        opening = self.court.draw(self._chance, given)
        frame = self._episode.begin(opening)
        self.agents = list(self.possible_agents)
        self._leads = [lead(frame, 0), lead(frame, 1)]
        info = {"place": opening.place, "late_ticks": opening.late_ticks}
        return self._seen(), {agent: dict(info) for agent in self.agents}

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[
        dict[str, Numbers],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Let the beats of a step pass.

        Args:
            actions: the action of each agent. An agent that is missing, or whose action is None,
                keeps its key, or goes on to the angles that it chose last.

        Returns:
            What each agent sees; rewards; whether the match is over; whether physics stopped; and
            at the end, for each agent, the scores and whether it won. After the end all these are
            empty.

        Raises:
            UserError: if no episode has begun, if there is no such agent, or the action space does
                not have an action.
        """
        episode, court = self._episode, self.court
        if not self.agents:
            episode.require_begun()
            return {}, {}, {}, {}, {}
        actions = table("actions", actions, f'{{"{self.agents[0]}": 0}}')
        if not actions.keys() <= self.action_spaces.keys():
            found, agents = list(map(str, actions)), self.possible_agents
            raise UserError(say("environment.agents", found=found, agents=agents))
        keys = [
            None if (action := actions.get(agent)) is None else court.act(episode, seat, action)
            for seat, agent in enumerate(self.possible_agents)
        ]
        episode.pass_beats(keys, court.beats)
        left, right = episode.frame.seats
        now = left.score - right.score
        gain = float(now - self._leads[0])
        self._leads = [now, -now]
        first, second = self.agents
        infos: dict[str, dict[str, Any]] = {first: {}, second: {}}
        ended = stopped = False
        if not episode.is_on:
            ended, stopped = episode.ended, episode.stopped
            infos = {agent: episode.outcome(seat) for seat, agent in enumerate(self.agents)}
            self.agents = []
        return (
            self._seen(),
            {first: gain, second: -gain},
            {first: ended, second: ended},
            {first: stopped, second: stopped},
            infos,
        )

    def save(self) -> bytes:
        """Return the state of the environment as bytes, without the openings still to be drawn.

        Raises:
            UserError: if no episode has begun.
        """
        return self._episode.save(bool(self.agents))

    def load(self, saved: bytes) -> None:
        """Go on from saved bytes, of this environment or of one with the same arguments.

        Raises:
            UserError: if they are not of a `LacocParallelEnv` with this arena, these settings,
                robots and this kind of actions; the environment is then unchanged.
        """
        is_on = self._episode.load(saved, bool)
        frame = self._episode.frame
        self._leads = [lead(frame, 0), lead(frame, 1)]
        self.agents = list(self.possible_agents) if is_on else []

    def observe(self, agent: str) -> Numbers:
        """Return what an agent sees now, such as after `load`."""
        return self._senses.see(self._episode.frame, self.possible_agents.index(agent))

    def write_record(self, file: str | Path) -> None:
        """Write the record of the episode so far; see `Episode.write_record`."""
        self._episode.write_record(Path(file))

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return a picture, an array (height, width, 3); None without a render mode."""
        match = self._episode.match
        return self._painter.draw(match.physics, match.game, self._episode.frame.markers)

    def close(self) -> None:
        """Free the camera that draws the pictures."""
        self._painter.close()

    def _seen(self) -> dict[str, Numbers]:
        left, right = self.possible_agents
        frame, senses = self._episode.frame, self._senses
        return {left: senses.see(frame, 0), right: senses.see(frame, 1)}
