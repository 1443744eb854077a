"""Plays a seat of a fork from a key script (`gait.key_script` describes its form)."""

from collections.abc import Callable

import msgspec

from lacoc_arenas.bot import Key
from lacoc_server.match.match import Match
from lacoc_server.simulate.forks.line import Press
from lacoc_shared.gait.key_script import ARROWS, KeyScript
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEAT_S, RESTART_KEY
from lacoc_shared.words import say


class Script(msgspec.Struct, frozen=True):
    """A file with a key script."""

    file: str
    """Path of the file, as it was given."""
    lines: tuple[str, ...]


def of_script(file: Script, seat: int) -> Callable[[], Press]:
    """Return a function that makes a new player of a fork's seat: it presses a script's keys.

    The first time in the script counts from the fork's first beat of play.

    Args:
        file: the script.
        seat: index of the seat.

    Raises:
        UserError: if a line has a mistake.
    """
    _script(file)

    def make() -> Press:
        return _ScriptPress(_script(file), seat)

    return make


def _script(file: Script) -> KeyScript:
    script = KeyScript()
    for line in file.lines:
        if wrong := script.add(line):
            raise UserError(say("fork.bad-script", file=file.file, why=wrong))
    return script


class _ScriptPress:
    """Presses the keys of a script, at their times."""

    def __init__(self, script: KeyScript, seat: int) -> None:
        self._script = script
        self._seat = seat
        self._begun: int | None = None
        self._level: Level | None = None

    def __call__(self, match: Match, frame: Frame) -> Key | None:
        if self._begun is None:
            state = match.seats[self._seat].state
            self._begun = match.ticks
            self._level = state.level if state else match.rules.open_levels[0]
        pressed: Key | None = None
        for name in self._script.due((match.ticks - self._begun) * BEAT_S, True):
            pressed = self._key(match, name) or pressed
        return pressed

    def _key(self, match: Match, name: str) -> Key | None:
        """Return the key for a name in the script; None if it stands for a level, or for no key."""
        assert self._level is not None
        if name.isdecimal():
            return Key(self._level, int(name))
        if name == "x":
            return Key(self._level, RESTART_KEY)
        if name in ARROWS and self._level is Level.LOCOMOTION:
            return Key(self._level, ARROWS[name])
        if name == "tab":
            levels = match.rules.open_levels
            following = levels.index(self._level) + 1 if self._level in levels else 0
            self._level = levels[following % len(levels)]
        return None
