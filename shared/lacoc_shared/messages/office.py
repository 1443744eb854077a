"""What the office of a contest and its courts say to each other (docs/protocol.md).

An office gives courts their matches. A court of a contest with an office plays only what the office
assigns: each match has a call, its teams, the tokens that open their seats, and their files. A seat
of an open match has no team yet: whoever has its token sits down there, with a name and files.
The office also tells each court where all teams are. So a team can ask any court of the contest,
with its one token, and a stranger can't answer in the office's name.
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
"""Most tokens that open a seat."""


class AssignedSeat(msgspec.Struct, frozen=True, kw_only=True):
    """A seat of an assigned match: its team, and the files that the team plays with.

    Without a team the seat is open: whoever has a token brings a name and files.
    """

    id: str
    """The arena's name of the seat: "left"."""
    team: str = ""
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
        """Robot file, Loco-data file and LocoTra-data file; None for a missing file."""
        return self.robot, self.postures, self.locomotion


class Assigned(msgspec.Struct, frozen=True, kw_only=True):
    """What the office assigned, as the match's setup keeps it: all that a restarted court needs."""

    call: str
    """Id of the call, which is unique in the contest; "": the office gave none. The court waits for
    it then, or was started alone and opened an open match by itself."""
    fixture: Phrase
    """What is played, for people: a phrase of `fixture.*` such as "Semi-final 1, game 2 of 3"."""
    seats: tuple[AssignedSeat, ...]

    @property
    def waits(self) -> bool:
        """Whether no match is assigned."""
        return not self.call and not self.seats

    @property
    def is_alone(self) -> bool:
        """Whether the court was started alone: no office says what it plays next."""
        return not self.call and bool(self.seats)

    @property
    def is_open(self) -> bool:
        """Whether it has an open seat."""
        return any(not seat.team for seat in self.seats)

    def seat(self, seat: str) -> AssignedSeat | None:
        """Return a seat by its name; None if nobody may sit there."""
        return next((one for one in self.seats if one.id == seat), None)


WAITING = Assigned(call="", fixture=say("fixture.waiting"), seats=())
"""What a court has from the office while no match is assigned."""


def open_match(tokens: Mapping[str, Collection[str]], call: str = "") -> Assigned:
    """Return an open match.

    Args:
        tokens: salted hashes of the tokens that open each seat, by the seat's name.
        call: id of the office's call; "": the court was started alone.
    """
    seats = (AssignedSeat(id=seat, token_hashes=tuple(hashes)) for seat, hashes in tokens.items())
    return Assigned(call=call, fixture=say("fixture.open"), seats=tuple(seats))


EARLIER_OFFICE = say("refused.earlier-office")
"""Why a court refuses an office that went on at another machine."""


class OfficeRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What all requests of an office have."""

    token: str
    """The office's token."""
    generation: Annotated[int, msgspec.Meta(ge=0)] = 0
    """How often the office has gone to another machine. A court that has heard a later office
    refuses an earlier one."""


class Assign(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: play this match next."""

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
        """Call, fixture and seats of this request, as the match's setup keeps them."""
        return Assigned(call=self.call, fixture=self.fixture, seats=self.seats)


class Withdraw(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: close this match, which then is void."""

    call: Call
    begun: bool = False
    """Whether to close it also when it has begun; else that is refused."""
    official: bool = False
    """Whether to close it also when its result is official, so that its record ends."""


class Copy(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: send the next part of a match's record.

    The office asks again and again, and so keeps a copy of what a court on another machine records.
    """

    match_id: str
    have: dict[str, int] = {}
    """What the office has: bytes of each file, by the file's name."""


class Copied(msgspec.Struct, frozen=True, kw_only=True):
    """A part of a record; the answer to `Copy`."""

    file: str = ""
    """Name of the file; "": the office has all that is recorded so far."""
    offset: int = 0
    """Where the part begins in the file [bytes]."""
    data: bytes = b""
    is_whole: bool = False
    """True: the match is over, and the office has all of its record."""


class Retire(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: end your process. Your court goes on at another machine."""


class Whereabouts(msgspec.Struct, frozen=True, kw_only=True):
    """Where a team plays, or what it waits for; or where an open seat is."""

    team: str
    """"" for an open seat."""
    state: Literal["court", "waits", "out", "over"]
    """court: its match is open at a court. waits: it will be called. out: it plays no more, but the
    contest goes on. over: the contest has ended."""
    said: Phrase
    """All of it for people, a phrase of `team.*`."""
    court: str = ""
    """The court; while the team waits, the court where it will probably play; "": not known."""
    address: str = ""
    """Address to connect to; "" unless the match is open, and at a court that was started alone:
    it is where the question came."""
    seat: str = ""
    """The arena's name of the seat; "" unless the match is open."""
    call: str = ""
    """Id of the call; "" unless the match is open."""
    opponent: str = ""
    """The other team; "": not known yet."""
    fixture: Phrase | None = None
    """What is played, a phrase of `fixture.*`; None: not known yet."""
    games_before: int | None = None
    """Games that probably begin before the team's next one, on all courts; None: not known."""
    about_s: int | None = None
    """Time until then, estimated [s]; None: not known."""
    open: bool = False
    """Whether the seat is open: whoever sits down there brings a name and files."""
    rank: int = 0
    """Rank in the newest stage that is over and has the team; 0: none."""
    news: Phrase | None = None
    """What people decided about a match of the team, since its last game; None: nothing."""


class Tell(OfficeRequest, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of the office: this is where all teams and open seats are.

    It replaces what was told before.
    """

    teams: dict[TokenHash, Whereabouts]
    """By the salted hash of the token of a team or an open seat. All have one salt, so that a court
    hashes a token once, however many teams there are."""


class Where(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A question to a court: where do I play?"""

    token: str
    """The token of a team or of an open seat."""
