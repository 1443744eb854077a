"""The inputs of a match: everything that enters it from outside, each at its beat.

The record keeps them. A match is a pure function of its setup and its inputs, beat by beat: the
same inputs give the same match, bit for bit, live or headless, at any speed (rules 4). Inputs have
passed the court's checks (token, session, sequence number). The match then decides whether an input
has an effect, and a replay decides the same.
"""

import msgspec

from lacoc_shared.decisions import Decision
from lacoc_shared.messages import SentFile
from lacoc_shared.words import Phrase

THE_COURT = ""
"""Author of the court's own decisions: no referee can have this name."""


class _Input(msgspec.Struct, frozen=True, array_like=True):
    pass


class JoinSeat(_Input, frozen=True, tag="join"):
    """A controller with the seat's token took the seat, or took it again."""

    seat: int
    team: str
    robot: SentFile
    postures: SentFile | None
    locomotion: SentFile | None
    token_hash: str
    """Salted hash of the token, by which a restarted court recognises the controllers of its
    seats."""


class ReadySeat(_Input, frozen=True, tag="ready"):
    """A contestant said that the team is ready, or no longer ready."""

    seat: int
    ready: bool


class LeaveSeat(_Input, frozen=True, tag="leave"):
    """A contestant gave up the seat."""

    seat: int


class KeySeat(_Input, frozen=True, tag="key"):
    """A player pressed a key of a seat: a digit at a level, or `RESTART_KEY`."""

    seat: int
    seq: int
    level: int
    key: int
    seen: int = 0
    """Beat of the newest frame that the player had seen when the key was pressed; 0: no frame of
    this match yet."""
    held: int = 0
    """Number of beats for which the court delayed the command, to make the seats' links equal."""
    late: int = 0
    """Beats (20 ms each) between the end of the common delay and the command's effect; 0: in time.
    """


class SilentSeat(_Input, frozen=True, tag="silent"):
    """A seat's controller has not been heard for a second of wall time (rules 3)."""

    seat: int


class HeardSeat(_Input, frozen=True, tag="heard"):
    """The controller of a silent seat was heard again."""

    seat: int


class Decide(_Input, frozen=True, tag="decide"):
    """A referee, or the court itself, made a decision about the match."""

    by: str
    """The referee's name; `THE_COURT` for the court itself."""
    reason: Phrase | str
    """A text that the referee wrote, or a phrase of `reason.*`."""
    decision: Decision


class Advice(_Input, frozen=True, tag="advice"):
    """The court advises to play the match again, as it ran too badly, or takes this advice back."""

    reasons: tuple[Phrase | str, ...]
    """Why the match should be played again (`health.*`; a text in a record of protocol 1). Empty:
    it need not be played again.
    """


Input = JoinSeat | ReadySeat | LeaveSeat | KeySeat | SilentSeat | HeardSeat | Decide | Advice
