"""Seats, phases and the small numbers that frames carry."""

from enum import IntEnum, IntFlag
from typing import Annotated, Literal

import msgspec

from lacoc_shared.words import Phrase, say

Colour = Annotated[str, msgspec.Meta(pattern="^#[0-9a-fA-F]{6}$")]
"""Of a team, as in "#0072b2"."""
Pattern = Literal["plain", "stripes", "dots"]
"""Of a team, for whom colours alone are not told apart."""


class Phase(IntEnum):
    """The phases of a match (rules 4)."""

    CREATED = 0
    LOBBY = 1
    READY = 2
    COUNTDOWN = 3
    PLAYING = 4
    HALTED = 5
    FINISHED = 6
    OFFICIAL = 7
    VOID = 8

    @property
    def word(self) -> str:
        """The name of it in the table, after `phase.`: "halted"."""
        return self.name.lower()


class SeatFlag(IntFlag):
    """What is true of a seat at a beat."""

    JOINED = 1
    READY = 2
    SILENT = 4
    """Its controller has not been heard for a second: it stands (rules 3)."""
    FROZEN = 8
    """A referee froze it."""


class No(IntEnum):
    """Why a seat's command was refused; `WHY_NO` says it."""

    NONE = 0
    NOT_PLAYING = 1
    LEVEL_CLOSED = 2
    NO_SUCH_KEY = 3
    RESTARTED = 4
    FROZEN = 5


WHY_NO: dict[No, Phrase] = {
    No.NOT_PLAYING: say("key.not-playing"),
    No.LEVEL_CLOSED: say("key.level-closed"),
    No.NO_SUCH_KEY: say("key.no-such-key"),
    No.RESTARTED: say("key.restarted"),
    No.FROZEN: say("key.frozen"),
}
"""What a contestant is told of it; `count.*` has the same names."""

RESTART_KEY = 10
"""The key number of [x] in a command; digits are 0-9."""

NOBODY = -1
"""In a place for a seat's index: no seat."""

BEAT_S = 0.02
"""A beat comes every 20 ms in every phase (rules 4)."""
BEAT_US = 20_000
BEATS_PER_S = 50
REPEATS_HZ = 10
"""A controller repeats its last command so often (rules 3)."""
SILENT_AFTER_S = 1.0
"""Whoever has sent nothing for longer than this is silent: a seat's controller to its court
(rules 3), and a court to those who watch it."""
