"""Plays a bot: it holds a seat with a controller and sends the same messages as a person."""

import time

from lacoc_arenas import brains
from lacoc_arenas.arena import Arena
from lacoc_arenas.bot import Brain, Key
from lacoc_client.play.controller import Controller, Hold
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import Phase, SeatFlag

_ASK_AGAIN_S = 1.0


class BotPlayer:
    """Plays for a bot: says ready and presses the keys that the bot returns, match after match.

    Args:
        controller: holds the seat.
        arena: the game, with its own bots.
        name: name of the bot; see `brains.find`.

    Raises:
        UserError: if there is no such bot.
    """

    def __init__(self, controller: Controller, arena: Arena, name: str) -> None:
        self._controller = controller
        self._factory = brains.find(arena, name)
        self._brain: Brain | None = None
        self._match = 0
        self._pressed: tuple[int, Key] | None = None
        self._asked_s = -_ASK_AGAIN_S

    def see(self, frame: Frame) -> None:
        """React to a new frame: say ready, or press the key that the bot returns.

        While the seat is not held, do nothing.
        """
        controller = self._controller
        if controller.hold is not Hold.HELD:
            return
        seat = frame.seats[controller.index]
        if frame.phase == Phase.LOBBY and not seat.flags & SeatFlag.READY:
            self._say_ready()
        if frame.phase != Phase.PLAYING:
            return
        if self._brain is None or frame.match != self._match:
            self._brain = self._factory(controller.view.sheet, controller.index)
            self._match, self._pressed = frame.match, None
        key = self._brain(frame)
        if key is None or self._is_on_its_way(key, max(seat.applied_seq, seat.refused_seq)):
            return
        self._pressed = controller.press(int(key.level), key.key), key

    def _is_on_its_way(self, key: Key, answered_seq: int) -> bool:
        """Return whether the bot pressed this key last, and the court has not reacted to it yet."""
        return (
            self._pressed is not None
            and self._pressed[1] == key
            and self._pressed[0] > answered_seq
        )

    def _say_ready(self) -> None:
        now_s = time.monotonic()
        if now_s - self._asked_s < _ASK_AGAIN_S:
            return
        self._asked_s = now_s
        try:
            self._controller.ready()
        except UserError:  # the phase changed, or the court is away: frames will tell
            return
