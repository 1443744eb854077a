"""What the office of a contest and its courts say to each other (docs/protocol.md).

An office gives courts their matches. A court of a contest with an office plays only what the office
assigns: each match has a call, its teams, the tokens that open their seats, and their files.
"""

from typing import Annotated, Any

import msgspec

from lacoc_shared.messages import SentFile
from lacoc_shared.seat import Colour, Pattern
from lacoc_shared.words import Phrase, say

Call = Annotated[str, msgspec.Meta(min_length=1, max_length=64, pattern="^[!-~]*$")]
TokenHash = Annotated[str, msgspec.Meta(pattern="^[0-9a-f]{32}[$][0-9a-f]{64}$")]

TOKENS_MOST = 8
"""Most tokens that open a seat."""


class AssignedSeat(msgspec.Struct, frozen=True, kw_only=True):
    """A seat of an assigned match: its team, and the files that the team plays with."""

    id: str
    """The arena's name of the seat: "left"."""
    team: str
    token_hashes: Annotated[
        tuple[TokenHash, ...], msgspec.Meta(min_length=1, max_length=TOKENS_MOST)
    ]
    """Salted hashes of the tokens that open the seat (`seal.hash_token`). A team that has the same
    hashes in two matches of a court, one after the other, and the same seat, keeps the seat."""
    robot: SentFile | None = None
    """Robot file; None: the contest's robot. In a `Setup` it is filled in."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    """With no file at all: the contest's robot with its sample gait."""
    colour: Colour | None = None
    """The team's own colour; None: the colour of the seat in the arena file."""
    pattern: Pattern | None = None

    @property
    def look(self) -> dict[str, str]:
        """The colour and pattern that the team has chosen."""
        both = {"colour": self.colour, "pattern": self.pattern}
        return {name: own for name, own in both.items() if own}

    @property
    def files(self) -> tuple[SentFile | None, SentFile | None, SentFile | None]:
        """Robot file, Loco-data file, LocoTra-data file."""
        return self.robot, self.postures, self.locomotion


class Assigned(msgspec.Struct, frozen=True, kw_only=True):
    """What the office assigned, as the match's setup keeps it: all that a restarted court needs."""

    call: str
    """Id of the call, which is unique in the contest; "": the court waits for the office."""
    fixture: Phrase
    """What is played, for people: a phrase of `fixture.*` such as "Semi-final 1, game 2 of 3"."""
    seats: tuple[AssignedSeat, ...]

    @property
    def waits(self) -> bool:
        """Whether no match is assigned."""
        return not self.call

    def seat(self, seat: str) -> AssignedSeat | None:
        """Return a seat by its name; None if it has no team."""
        return next((one for one in self.seats if one.id == seat), None)


WAITING = Assigned(call="", fixture=say("fixture.waiting"), seats=())
"""What a court has of the office while no match is assigned."""


class Assign(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: play this match next."""

    token: str
    """The office's token."""
    call: Call
    fixture: Phrase
    seats: tuple[AssignedSeat, ...]
    arena: str = ""
    """Name of an installed arena; "": the court's own, with its settings in the contest file."""
    arena_settings: dict[str, Any] = {}
    """Entries that replace those of the arena file."""
    limits: dict[str, float] = {}
    """Limits for robots, by name, where they differ from the defaults (rules 1)."""

    @property
    def assigned(self) -> Assigned:
        """The part of the request that is no secret of the office."""
        return Assigned(call=self.call, fixture=self.fixture, seats=self.seats)


class Withdraw(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: do not play this match, if it has not begun."""

    token: str
    call: Call
