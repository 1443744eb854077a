"""One seat of a match as a Gymnasium environment; a bot has the other seat."""

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

from lacoc_arenas import brains
from lacoc_arenas.bot import Brain, Key
from lacoc_arenas.learned.senses import Numbers, Senses
from lacoc_server.simulate.environments.court import Actions, AgentCourt, lead
from lacoc_server.simulate.environments.opening import Opening, known_options
from lacoc_server.simulate.environments.painter import Painter
from lacoc_shared.codec import decode, encode
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class LacocEnv(gymnasium.Env[Numbers, Any]):
    """A match against a bot. The seed of an episode chooses the learner's seat too.

    Spaces and rewards are those of one agent of `LacocParallelEnv`.

    Args:
        arena: name or folder of the arena.
        opponent: a bot, as in `lacoc simulate`. Its keys may depend on nothing but the frames that
            it has seen; else `load` does not go on bit for bit.
        render_mode: "rgb_array", or None.
        settings: entries that replace those of the arena file.
        robots: the robot of both seats.
        actions: "keys"; a bot presses keys, so angles are for `LacocParallelEnv` and `WalkEnv`.
        restart: whether [x] is one more action.
        beats: beats of 20 ms in a step.
        court: game and robots, if several environments share them; `arena`, `settings`, `robots`,
            `restart` and `beats` are then not used.

    Raises:
        UserError: if one of these is wrong.
        FileRefused: if a robot or gait file has mistakes.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (the library's own form)
        "render_modes": ["rgb_array"],
        "render_fps": 50,
    }

    OPTIONS = ("place", "late_ticks", "seat")
    """Names of the options of `reset`."""

    def __init__(
        self,
        arena: str = "othello",
        opponent: str = "straight",
        render_mode: str | None = None,
        settings: dict[str, Any] | None = None,
        robots: str = "hexapod",
        actions: Actions = "keys",
        restart: bool = False,
        beats: int = 1,
        court: AgentCourt | None = None,
    ) -> None:
        if actions != "keys":
            raise UserError(say("environment.bot-keys"))
        self.court = court or AgentCourt(arena, settings, robots, actions, restart, beats)
        self.metadata = {**type(self).metadata, "render_fps": 50 / self.court.beats}
        self.render_mode = render_mode
        self.episode = self.court.episode()
        self._sheet = self.episode.match.sheet()
        self._senses = Senses(self._sheet)
        self._opponent = opponent
        self._bot = brains.find(self.court.arena, opponent)
        self._painter = Painter(render_mode)
        self.observation_space = self.court.observation_space(self._senses, 0)
        self.action_space = self.court.action_space(0)
        self._brain: Brain
        self._lead = 0
        self._shown: list[bytes] = []
        """Frames that the bot saw in this episode."""

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the bot and its brain, because these may not be picklable."""
        return {name: one for name, one in vars(self).items() if name not in ("_bot", "_brain")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Find the bot again, and show all frames to a new brain.

        Raises:
            UserError: if the bot is not installed any more, or presses other keys (see `load`).
        """
        self.__dict__.update(state)
        self._bot = brains.find(self.court.arena, self._opponent)
        if self.episode.has_begun:
            self._show(self._shown)

    @property
    def names(self) -> tuple[str, ...]:
        """The meaning of each number that the learner sees."""
        return self._senses.names

    @property
    def digits(self) -> tuple[int, ...]:
        """The digit of each action; 10 is [x]."""
        return self.court.digits[0]

    @property
    def seat(self) -> int:
        """Index of the learner's seat."""
        return self.episode.opening.seat

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Numbers, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: chooses the opening of this episode and of those after it; None: the earlier
                seed goes on. Without any seed the openings are drawn by chance.
            options: "place", "late_ticks" and "seat" replace what the seed would choose.

        Returns:
            What the learner sees, and the opening.

        Raises:
            UserError: if an option does not fit.
        """
        given = known_options(options, self.OPTIONS)
        super().reset(seed=seed)
        opening = self.court.draw(self.np_random, given)
        self._begin(opening)
        info = {
            "place": opening.place,
            "late_ticks": opening.late_ticks,
            "seat": self.court.seats[opening.seat],
        }
        return self.observe(), info

    def step(self, action: Any) -> tuple[Numbers, float, bool, bool, dict[str, Any]]:
        """Let the beats of a step pass.

        Args:
            action: the learner's action; None: it keeps its key.

        Returns:
            What the learner sees, the reward, whether the match is over, whether physics stopped,
            and at the end the scores and whether the learner won.

        Raises:
            UserError: if no episode has begun, if it is over, or the action space does not have the
                action.
        """
        self.episode.require_begun()
        if not self.episode.is_on:
            raise UserError(say("environment.over"))
        for beat in range(self.court.beats):
            self._pass_beat(action if beat == 0 else None)
            if not self.episode.is_on:
                break
        episode, seat = self.episode, self.seat
        now = lead(episode.frame, seat)
        gain, self._lead = float(now - self._lead), now
        ended, stopped = episode.ended, episode.stopped
        info = episode.outcome(seat) if ended or stopped else {}
        return self.observe(), gain, ended, stopped, info

    def observe(self) -> Numbers:
        """Return what the learner sees now, such as after `load`."""
        return self._senses.see(self.episode.frame, self.seat)

    def save(self) -> bytes:
        """Return the state of the environment as bytes, without the openings still to be drawn.

        A bot may remember what it saw. So the frames that it saw are saved, and the bytes grow with
        the episode: some 270 bytes a beat.

        Raises:
            UserError: if no episode has begun.
        """
        return self.episode.save(self._shown)

    def load(self, saved: bytes) -> None:
        """Go on from saved bytes, of this environment or of one with the same arguments.

        A new brain of the bot sees all frames again, so this takes longer late in an episode.

        Raises:
            UserError: if they are not of a `LacocEnv` with this arena, these settings and robots;
                the environment is then unchanged. Also if the new brain presses other keys than
                the bot did: then the bot would play another match.
        """
        shown = self.episode.load(saved, list[bytes])
        self._lead = lead(self.episode.frame, self.seat)
        self._show(shown)

    def write_record(self, file: str | Path) -> None:
        """Write the record of the episode so far; see `Episode.write_record`."""
        self.episode.write_record(Path(file))

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return a picture, an array (height, width, 3); None without a render mode."""
        return self.draw(self._painter)

    def draw(self, painter: Painter) -> npt.NDArray[np.uint8] | None:
        """Return the picture of the present frame, drawn by `painter`."""
        match = self.episode.match
        return painter.draw(match.physics, match.game, self.episode.frame.markers)

    def check(self, action: Any) -> None:
        """Check that an episode has begun (it may be over), and that the space has this action.

        Raises:
            UserError: if no episode has begun, or there is no such action.
        """
        self.episode.require_begun()
        self.court.digit(0, action)

    def close(self) -> None:
        """Free the camera that draws the pictures."""
        self._painter.close()

    def _begin(self, opening: Opening) -> None:
        """Begin an episode with an opening."""
        self.episode.begin(opening)
        self._lead = lead(self.episode.frame, self.seat)
        self._show([])

    def _pass_beat(self, action: Any) -> None:
        """Let one beat pass.

        Args:
            action: the learner's action; None: it keeps its key.
        """
        episode, seat = self.episode, self.seat
        other = 1 - seat
        keys: list[Key | None] = [None, None]
        if action is not None:
            keys[seat] = self.court.act(episode, seat, action)
        if episode.match.ticks > episode.late_ticks[other]:
            self._shown.append(encode(episode.frame))
            keys[other] = self._brain(episode.frame)
        episode.pass_beats(keys)

    def _show(self, shown: list[bytes]) -> None:
        """Make a new brain for the bot, and show it the frames that the bot saw.

        Raises:
            UserError: if the new brain does not press the keys that the bot pressed in the episode.
        """
        other = 1 - self.seat
        self._brain, self._shown = self._bot(self._sheet, other), shown
        pressed, again = self.episode.pressed(other), {}
        for encoded in shown:
            frame = decode(encoded, Frame)
            if (key := self._brain(frame)) is not None:
                again[frame.beat + 1] = key
        if again != pressed:
            raise UserError(say("environment.bot-differs", bot=self._opponent))
