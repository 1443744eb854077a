"""The messages between the office of a contest and its courts (docs/protocol.md).

An office gives courts their matches. A court of a contest with an office plays only what the office
assigns: each match has a call, its teams, the tokens that open their seats, and their files. A seat
of an open match has no team yet: whoever has its token sits down there, with a name and files.

The office also tells each court where all teams play. So a team can ask any court of the contest,
with its token, where it plays. Only a program with the office's token can tell a court this.
"""

from collections.abc import Collection, Mapping
from typing import Annotated, Any, Literal

import msgspec

from lacoc_shared.messages import SentFile
from lacoc_shared.seat import Colour, Pattern
from lacoc_shared.words import Phrase, say

Call = Annotated[str, msgspec.Meta(min_length=1, max_length=64, pattern="^[!-~]*$")]
TokenHash = Annotated[str, msgspec.Meta(pattern="^[0-9a-f]{32}[$][0-9a-f]{64}$")]

TOKENS_MOST = 8
"""Most tokens that open one seat."""


class AssignedSeat(msgspec.Struct, frozen=True, kw_only=True):
    """A seat of an assigned match: its team, and the files that the team plays with.

    Without a team the seat is open: whoever has one of its tokens may sit there, with a name and
    files.
    """

    id: str
    """Id of the seat in the arena, such as "left"."""
    team: str = ""
    token_hashes: Annotated[
        tuple[TokenHash, ...], msgspec.Meta(min_length=1, max_length=TOKENS_MOST)
    ]
    """Salted hashes of the tokens that open the seat (`seal.hash_token`). If the next match of the
    court has the same hashes for the same seat, the controller keeps the seat."""
    robot: SentFile | None = None
    """Robot file; None: the contest's robot. In a `Setup` the robot file is always there."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    """LocoTra-data file. If a team has no file at all, the contest's robot and its sample gait are
    used."""
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
        """Robot file, Loco-data file and LocoTra-data file; None for a file that is missing."""
        return self.robot, self.postures, self.locomotion


class Assigned(msgspec.Struct, frozen=True, kw_only=True):
    """The match that the office assigned to a court, as the match's record keeps it.

    So a restarted court finds it again.
    """

    call: str
    """Id of the call, which is unique in the contest. "": the office gave no call. Then the court
    waits for one, or it was started alone and opened an open match by itself."""
    fixture: Phrase
    """Name of the match for people: a phrase of `fixture.*`, such as "Semi-final 1, game 2 of
    3"."""
    seats: tuple[AssignedSeat, ...]

    @property
    def waits(self) -> bool:
        """Whether no match is assigned, so that the court waits."""
        return not self.call and not self.seats

    @property
    def is_alone(self) -> bool:
        """Whether the court was started alone, so that no office assigns matches to it."""
        return not self.call and bool(self.seats)

    @property
    def is_open(self) -> bool:
        """Whether the match has an open seat."""
        return any(not seat.team for seat in self.seats)

    def seat(self, seat: str) -> AssignedSeat | None:
        """Return a seat of the assigned match by its id; None if nobody may sit there."""
        return next((one for one in self.seats if one.id == seat), None)


WAITING = Assigned(call="", fixture=say("fixture.waiting"), seats=())
"""What is assigned while a court waits for the office: nothing."""


def open_match(tokens: Mapping[str, Collection[str]], call: str = "") -> Assigned:
    """Return the assignment of an open match, in which people with tokens may sit down.

    Args:
        tokens: salted hashes of the tokens that open each seat, by the seat's name.
        call: id of the office's call; "": the court was started alone.
    """
    seats = (AssignedSeat(id=seat, token_hashes=tuple(hashes)) for seat, hashes in tokens.items())
    return Assigned(call=call, fixture=say("fixture.open"), seats=tuple(seats))


EARLIER_OFFICE = say("refused.earlier-office")
"""Why a court refuses the requests of an office that went on at another machine."""


def call_is_over(call: str) -> Phrase:
    """Say why a court refuses a call: it has had the call's match, and closed it."""
    return say("refused.call-is-over", call=call)


class OfficeRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The fields that all requests of an office to a court have."""

    token: str
    """The office's token."""
    generation: Annotated[int, msgspec.Meta(ge=0)] = 0
    """How often the office has gone to another machine. A court refuses an office with a smaller
    number than one that it has heard before."""


class Assign(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office to a court: play this match as the next one."""

    call: Call
    fixture: Phrase
    seats: tuple[AssignedSeat, ...]
    arena: str = ""
    """Name of an installed arena; "": the arena that the contest file gives to the court, with its
    settings."""
    arena_settings: dict[str, Any] = {}
    """Entries that replace those of the arena file."""
    limits: dict[str, float] = {}
    """Limits for robots, by name, where they differ from the defaults (rules 1)."""

    @property
    def assigned(self) -> Assigned:
        """Call, fixture and seats of this request, in the form that the match's setup keeps."""
        return Assigned(call=self.call, fixture=self.fixture, seats=self.seats)


class Withdraw(
    OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True
):
    """A request of the office to a court: close this match; if it is not over, it becomes void."""

    call: Call
    begun: bool = False
    """Whether to close the match even if it has begun; if False, the court then refuses."""
    official: bool = False
    """Whether to close the match even if its result is official, so that its record ends."""
    why: Phrase | None = None
    """Why, in words; the court adds it to its decision. None: no reason is known."""


class Copy(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office to a court: send the next part of a match's record.

    The office sends this again and again, and so gets a copy of what a court on another machine
    records.
    """

    match_id: str
    have: dict[str, int] = {}
    """How many bytes of each file the office already has, by the file's name."""


class Copied(msgspec.Struct, frozen=True, kw_only=True):
    """The next part of a match's record: the answer to `Copy`."""

    file: str = ""
    """Name of the file; "": the office has everything that is recorded so far."""
    offset: int = 0
    """Position of the part in the file [bytes]."""
    data: bytes = b""
    is_whole: bool = False
    """Whether the match is over and the office has all of its record."""


class Retire(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office to a court: end, because this court goes on at another machine."""


class Whereabouts(msgspec.Struct, frozen=True, kw_only=True):
    """Where a team plays, or what it waits for; or where an open seat is. The answer to `Where`."""

    team: str
    """Name of the team; "": the seat is an open one."""
    state: Literal["court", "waits", "out", "over"]
    """court: its match is open at a court. waits: it will be called. out: it plays no more, but the
    contest goes on. over: the contest has ended."""
    said: Phrase
    """Everything in a sentence for people, a phrase of `team.*`."""
    court: str = ""
    """Name of the court; while the team waits, that of the court where it will probably play; "":
    not known."""
    address: str = ""
    """Address to which the team connects. "": its match is not open yet; or the court was started
    alone, so that it is the court that was asked."""
    seat: str = ""
    """Id of the seat in its arena; "": the match is not open yet."""
    call: str = ""
    """Id of the call; "": the match is not open yet."""
    opponent: str = ""
    """Name of the other team; "": not known yet."""
    fixture: Phrase | None = None
    """Name of the match (`fixture.*`); None: not known yet."""
    games_before: int | None = None
    """How many games on all courts will probably begin before the team's next one; None: not
    known."""
    about_s: int | None = None
    """Estimated time until the team's next game [s]; None: not known."""
    open: bool = False
    """Whether the seat is open: whoever sits there brings a name and files."""
    rank: int = 0
    """Rank of the team in the newest stage that is over and in which it played; 0: none."""
    news: Phrase | None = None
    """What was decided about a match of the team since its last game; None: nothing."""


class Tell(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A message of the office to a court: where each team plays, and where each open seat is.

    It replaces what the office told before.
    """

    teams: dict[TokenHash, Whereabouts]
    """Where each team or open seat is, by the salted hash of its token. All hashes have the same
    salt, so that a court hashes a token only once, however many teams there are."""


class Where(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A question to a court: where does the team with this token play?"""

    token: str
    """The token of a team or of an open seat."""
