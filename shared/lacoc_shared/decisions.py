"""The referee's decisions (rules 4.1; workshop 5-1 rule 8, 5-2 rule 9), as small values.

The court defines what each decision does and when it is legal (`lacoc_server.match.referee`). This
module defines the names and arguments, which both ends share. A seat is named by its id ("left"), a
marker by its name ("c2r3", "corner0", "flag7").
"""

from typing import get_args

import msgspec

NUMBER_MAX = 1_000_000
"""Largest absolute value of a decision's seconds, points or event number."""
REFEREE_NAME_MAX = 100


class _Decision(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    pass


class Ready(_Decision, frozen=True, tag="ready"):
    """Say ready for a contestant who cannot."""

    seat: str


class Start(_Decision, frozen=True, tag="start"):
    """Begin the countdown of the match."""


class Halt(_Decision, frozen=True, tag="halt"):
    """Stop physics and the clock at once."""


class Resume(_Decision, frozen=True, tag="resume"):
    """Go on after a halt, with a countdown."""


class Restart(_Decision, frozen=True, tag="restart"):
    """Put a robot back at its start place."""

    seat: str


class Freeze(_Decision, frozen=True, tag="freeze"):
    """Let a robot stand (key 0) and refuse its keys for some seconds of the clock."""

    seat: str
    seconds: float


class Unfreeze(_Decision, frozen=True, tag="unfreeze"):
    """Let a frozen robot move again."""

    seat: str


class Adjust(_Decision, frozen=True, tag="adjust"):
    """Add points to a score; a negative number takes them away."""

    seat: str
    points: int


class Set(_Decision, frozen=True, tag="set"):
    """Set a disc, corner or flag: neutral, left, right or down."""

    marker: str
    state: str


class TakeBack(_Decision, frozen=True, tag="take-back"):
    """Take back one event and judge the match again without it."""

    event: int
    """Number of the event."""
    dry_run: bool = False
    """Whether the decision is not made, and the reply only says what would change."""


class Clock(_Decision, frozen=True, tag="clock", omit_defaults=True):
    """Add time to play; a negative number takes time away."""

    gives_s: float = 0.0
    """Seconds that are added to the time left; a negative number takes time away."""
    seconds: float = 0.0
    """Seconds that are taken away; only in old records, from before `gives_s`."""


class Abort(_Decision, frozen=True, tag="abort"):
    """Declare the match void."""


class Declare(_Decision, frozen=True, tag="declare"):
    """Declare the winner, also against the result of the rules."""

    winner: str
    """Id of the winner's seat, or "draw"."""


class Official(_Decision, frozen=True, tag="official"):
    """Make the result official."""


class Next(_Decision, frozen=True, tag="next"):
    """Open the next match."""


Decision = (
    Ready
    | Start
    | Halt
    | Resume
    | Restart
    | Freeze
    | Unfreeze
    | Adjust
    | Set
    | TakeBack
    | Clock
    | Abort
    | Declare
    | Official
    | Next
)
"""Any decision; on the wire a map whose entry "type" is the decision's name."""

OLD_FIELDS = frozenset({(Clock, "seconds")})
"""Fields that are only read in old records; no program offers them."""

DECISIONS: dict[str, type[Decision]] = {
    str(kind.__struct_config__.tag): kind for kind in get_args(Decision)
}
"""Every decision by its name, in the order of a match."""

NEED_A_REASON = frozenset(
    {"restart", "freeze", "adjust", "set", "take-back", "clock", "abort", "declare"}
)
"""Decisions for which a referee must give a reason; the record keeps it."""
