"""The seats and phases of a match, and the small numbers that stand for them in frames."""

from enum import IntEnum, IntFlag
from typing import Annotated, Literal

import msgspec

from lacoc_shared.words import Phrase, say

Colour = Annotated[str, msgspec.Meta(pattern="^#[0-9a-fA-F]{6}$")]
"""A team's colour, such as "#0072b2"."""
Pattern = Literal["plain", "stripes", "dots"]
"""A team's pattern, for people who can't distinguish the colours."""


class Phase(IntEnum):
    """The phases of a match, in their order; rules 4 tells what happens in them."""

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
        """Last part of the code with which the phase's name is looked up, such as "halted"."""
        return self.name.lower()


IN_PLAY = frozenset({Phase.COUNTDOWN, Phase.PLAYING})
"""Phases in which a match goes on by itself until it is halted."""


class SeatFlag(IntFlag):
    """What holds for a seat at a beat; a frame has a bit for each."""

    JOINED = 1
    READY = 2
    SILENT = 4
    """The seat's controller has not been heard for a second, so its robot stands (rules 3)."""
    FROZEN = 8
    """A referee has frozen the seat's robot."""


class No(IntEnum):
    """Codes of the reasons why a seat's command was refused; `WHY_NO` has their sentences."""

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
"""For each reason, the sentence for the contestant; `count.*` has the same names."""

RESTART_KEY = 10
"""The key number of [x] in a command; digits are 0-9."""

NOBODY = -1
"""Index of a seat that means "no seat"."""

BEAT_S = 0.02
"""Time between beats, in every phase [s]."""
BEAT_US = 20_000
BEATS_PER_S = 50
REPEATS_HZ = 10
"""How often a controller repeats its last command [Hz]."""
FRESH_BEATS = 5 * BEATS_PER_S
"""Greatest age of a frame that a repeated command may name as a sign of life [beats]. For this long
a page may draw nothing before its seat counts as silent."""
SILENT_AFTER_S = 1.0
"""A sender counts as silent when nothing came from it for longer than this [s]: a seat's controller
for its court (rules 3), and a court for its clients."""
