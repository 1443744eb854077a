"""What the pages of an organiser and of teams ask a contest's office (docs/contest.md 12).

A gateway passes these requests on unread: the office alone looks at their secret. Whoever has the
organiser's key decides; the event code lets a team apply; a team's token opens its own entry.
"""

from typing import Annotated, Literal

import msgspec

from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase

DESK_MAX_BYTES = 98_304
"""Longest request that is read."""
REPLY_MAX_BYTES = 2 << 20
"""Longest answer that is read."""

PUBLISHED = "published/"
"""Path of a published contest below the address of the pages."""

TEAM_NAME_MAX = 24
"""Most characters of a team's name."""

Replays = Literal["at-once", "after-stage", "after-contest"]
"""From when everybody may see the record of a game: at once, or when its stage or the contest is
over."""

_Name = Annotated[str, msgspec.Meta(max_length=64)]
_Text = Annotated[str, msgspec.Meta(max_length=500)]


class TeamFiles(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True
):
    """The files that a team hands in; None for each file that it does not."""

    robot: SentFile | None = None
    """Robot file; None: the contest's robot."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    picture: SentFile | None = None
    """A picture of the team; None: the one that it has handed in before, if any."""


class DeskRequest(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    omit_defaults=True,
    tag_field="do",
):
    """What all requests to a desk have."""

    secret: Annotated[str, msgspec.Meta(max_length=200)] = ""
    """The organiser's key, the event code, or the team's token."""


# Everybody


class LookAtEvent(DeskRequest, frozen=True, kw_only=True, tag="look"):
    """Ask what is known of the event without a secret."""


# With the event code


class Apply(DeskRequest, frozen=True, kw_only=True, tag="apply"):
    """Ask to take part; the organiser decides."""

    team: _Name
    files: TeamFiles
    contact: Annotated[str, msgspec.Meta(max_length=200)] = ""
    """How to reach the team; only the organiser reads it."""
    club: _Name = ""
    """Its school or club; a stage may draw teams of one club apart."""


# With a team's token


class ChangeFiles(DeskRequest, frozen=True, kw_only=True, tag="change"):
    """Hand in other files. When entries are closed, the organiser decides."""

    files: TeamFiles


class Own(DeskRequest, frozen=True, kw_only=True, tag="own"):
    """Ask how the team's own entry stands."""


# With the token of a court's referee


class CourtDay(DeskRequest, frozen=True, kw_only=True, tag="court_day"):
    """Ask what comes next at a court, and what a result of its game would change."""

    court: _Name
    scores: tuple[int, int] | None = None
    """Points of the left and of the right seat with which the game would end; None: do not ask."""
    outcome: Literal["left", "right", "draw"] = "draw"
    """Who would win, for `scores`."""


# With the organiser's key, or a token of the staff


class Overview(DeskRequest, frozen=True, kw_only=True, tag="overview"):
    """Ask for everything that the organiser's page shows."""

    known: str = ""
    """Version of the view that the page has; if it is the newest, the answer has no view."""


class Approve(DeskRequest, frozen=True, kw_only=True, tag="approve"):
    """Let teams take part that have applied or had withdrawn, or use files that they sent late."""

    teams: tuple[_Name, ...]
    reason: _Text = ""
    """For teams and files that are late; everybody can read it."""


class Decline(DeskRequest, frozen=True, kw_only=True, tag="decline"):
    """Turn applications down, and forget them."""

    teams: tuple[_Name, ...]


class NewCode(DeskRequest, frozen=True, kw_only=True, tag="new_code"):
    """Make another event code: nobody can apply with the old one any more."""


class CloseEntries(DeskRequest, frozen=True, kw_only=True, tag="close"):
    """Close entries: the office draws and calls the first games."""


class Draw(DeskRequest, frozen=True, kw_only=True, tag="draw"):
    """Draw the stage that waits for the organiser, as the page shows it."""

    stage: _Name
    entries: tuple[_Name, ...]
    """The teams by their seeding, as shown; for "hand" in the order that is wanted. If others would
    be drawn now, nothing is drawn."""
    how: Literal["", "hand", "lot"] = ""
    """As in the fact: by the ranking before, by hand with a reason, or by lot."""
    lot: _Name = ""
    """What was drawn in front of everybody, for "lot"."""
    reason: _Text = ""


class Undraw(DeskRequest, frozen=True, kw_only=True, tag="undraw"):
    """Take the draw of a stage back that nobody has played in."""

    stage: _Name
    reason: _Text
    really: bool = False
    """False: only say what would change."""


class Substitute(DeskRequest, frozen=True, kw_only=True, tag="substitute"):
    """Let a team take the place of another one that has not played yet."""

    team: _Name
    substitute: _Name
    reason: _Text
    really: bool = False
    """False: only say what would change."""


class PauseContest(DeskRequest, frozen=True, kw_only=True, tag="pause"):
    """Call no game until the contest goes on."""

    until_ms: Annotated[int, msgspec.Meta(ge=0, le=2**53)] = 0
    """It goes on by itself then, in milliseconds since 1970, UTC; 0: when somebody says so."""
    reason: _Text = ""


class ResumeContest(DeskRequest, frozen=True, kw_only=True, tag="resume"):
    """Let the contest go on."""


class Shift(DeskRequest, frozen=True, kw_only=True, tag="shift"):
    """Postpone by `by_ms` everything that has not happened yet."""

    by_ms: Annotated[int, msgspec.Meta(ge=60_000, le=86_400_000)]
    reason: _Text = ""


class Unshift(DeskRequest, frozen=True, kw_only=True, tag="unshift"):
    """Take the newest shift back."""

    shift: _Name
    """Its id, as the page shows it: whoever asks twice takes one shift back."""


class Announce(DeskRequest, frozen=True, kw_only=True, tag="announce"):
    """Show a line on all pages; "" takes it away."""

    text: Annotated[str, msgspec.Meta(max_length=200)]


class Publish(DeskRequest, frozen=True, kw_only=True, tag="publish"):
    """Publish the contest: write its folder, which the pages serve."""


class Staff(DeskRequest, frozen=True, kw_only=True, tag="staff"):
    """Give somebody an own link to this page, or take it away; only the organiser may."""

    name: _Name
    remove: bool = False


class TakeOut(DeskRequest, frozen=True, kw_only=True, tag="take_out"):
    """Take a team out of the contest."""

    team: _Name
    reason: _Text = ""
    disqualify: bool = False
    really: bool = False
    """False: only say what would change."""


class SeePicture(DeskRequest, frozen=True, kw_only=True, tag="picture"):
    """Ask for the newest picture of a team, or take it away."""

    team: _Name
    remove: bool = False


class Rule(DeskRequest, frozen=True, kw_only=True, tag="rule"):
    """Decide about a match."""

    kind: Literal["replay", "result", "void", "no-show"]
    pairing: _Name
    game: Annotated[int, msgspec.Meta(ge=1, le=200)] = 1
    """Number of the game; not for "void" and "no-show"."""
    team: _Name = ""
    """The team that did not come; for "no-show"."""
    scores: tuple[int, int] | None = None
    """Points of the left and of the right seat; for "result"."""
    reason: _Text = ""
    really: bool = False
    """False: only say what would change."""


class Move(DeskRequest, frozen=True, kw_only=True, tag="move"):
    """Move a match to another court or time; the newest move of a match counts."""

    pairing: _Name
    court: _Name = ""
    """"": any court."""
    before: _Name = ""
    """Pairing of the match before which it comes; "": as the schedule has it."""
    not_before_ms: Annotated[int, msgspec.Meta(ge=0, le=2**53)] = 0
    """In milliseconds since 1970, UTC."""


class Tokens(DeskRequest, frozen=True, kw_only=True, tag="tokens"):
    """Ask for the tokens of all teams of people and of all referees, to hand out their links."""


OfStaff = (
    Overview
    | Approve
    | Decline
    | NewCode
    | CloseEntries
    | Draw
    | Undraw
    | Substitute
    | TakeOut
    | SeePicture
    | Rule
    | Move
    | PauseContest
    | ResumeContest
    | Shift
    | Unshift
    | Announce
    | Staff
    | Tokens
)
"""What the organiser and the staff may ask; `Staff` only the organiser."""
AnyRequest = LookAtEvent | Apply | ChangeFiles | Own | CourtDay | Publish | OfStaff
"""Every request to the desk."""


# Answers


class EventInfo(msgspec.Struct, frozen=True, kw_only=True):
    """What everybody may know before the first match."""

    name: str
    open: bool
    """Whether teams can apply, and change their files."""
    closes_ms: int
    """When entries close, in milliseconds since 1970, UTC; 0: when the organiser closes them."""
    replays: Replays
    """From when everybody may see the records of games."""
    announced: str = ""
    """The organiser's line to all; "": there is none."""


class OwnEntry(msgspec.Struct, frozen=True, kw_only=True):
    """How a team's own entry stands."""

    event: EventInfo
    team: str
    token: str
    """The team's token for the whole contest."""
    state: Literal["waits", "in", "late", "left", "none"]
    """waits: the organiser has not approved it. in: it takes part. late: it takes part, and the
    organiser has not approved its newest files. left: it was taken out. none: the team has no
    entry."""
    files: str = ""
    """Hash of the files with which it plays, or will play once approved."""
    at_ms: int = 0
    """When files that wait were handed in, in milliseconds since 1970, UTC; 0: none wait."""


class TeamRow(msgspec.Struct, frozen=True, kw_only=True):
    """A team on the organiser's page."""

    team: str
    state: Literal["refused", "waits", "late", "in", "withdrawn", "disqualified"]
    """refused: its newest files had mistakes, and it has not entered. withdrawn,
    disqualified: it was taken out. Others: see `OwnEntry`."""
    replaced_by: str = ""
    """The team that takes its place, so that it is withdrawn; "": none does."""
    files: str = ""
    bot: str = ""
    """The bot that plays for it; "": people play."""
    picture: bool = False
    """Whether its newest files have a picture of the team."""
    at_ms: int = 0
    mistakes: tuple[Mistake, ...] = ()
    """What is wrong with the files that it handed in last."""
    contact: str = ""
    club: str = ""
    substitute: bool = False
    """Whether another team can still take its place: it has not played in a drawn stage."""
    reserve: bool = False
    """Whether it may take another team's place: it takes part, and has no place of its own in a
    stage that is played."""


class CourtRow(msgspec.Struct, frozen=True, kw_only=True):
    """A court on the organiser's page."""

    court: str
    here: bool
    """Whether it was heard lately."""


class MatchMove(msgspec.Struct, frozen=True):
    """How a match was moved: see `Move`."""

    court: str
    before: str
    not_before_ms: int


class Slot(msgspec.Struct, frozen=True, kw_only=True):
    """A match that is being played or is to come, with its court and its time."""

    pairing: str
    fixture: Phrase
    teams: tuple[str, str]
    """Who sits left and right; "": not known yet."""
    who: tuple[Phrase, Phrase] | None = None
    """Who plays, as far as that is known: "winner of Semi-final 1"; None: `teams` says it."""
    court: str
    """"": nobody can say, because no court is there."""
    at_ms: int
    """When it began, or probably begins; in milliseconds since 1970, UTC. 0: nobody can say."""
    running: bool = False
    begun: bool = False
    """Whether its game at the court has begun; a move no longer changes this game."""
    absent: tuple[str, ...] = ()
    """Teams that have not come to the court, a while after their game was called."""
    moved: MatchMove | None = None
    """How it was moved; None: it was not."""
    held: Phrase | None = None
    """Why a court refused its game; None: none did."""


class ToDraw(msgspec.Struct, frozen=True, kw_only=True):
    """A stage that waits for the organiser's draw."""

    stage: str
    title: Phrase
    """What people call it."""
    entries: tuple[str, ...]
    """Its teams by their seeding, the best first."""
    why: tuple[Phrase, ...] = ()
    """Why each of them is in it; (): the stage follows none."""
    meet: tuple[tuple[int, int], ...] = ()
    """Places in the seeding, from 0, whose teams surely meet: in the first round, or in a group."""
    met: tuple[tuple[str, str], ...] = ()
    """Teams of this stage that have met in the stage before."""
    apart: tuple[str, ...] = ()
    """An order in which fewer of those meet again; (): there is none."""


class Undrawable(msgspec.Struct, frozen=True, kw_only=True):
    """A stage whose draw can be taken back."""

    stage: str
    title: Phrase


class DayState(msgspec.Struct, frozen=True, kw_only=True):
    """Whether games are called."""

    paused: bool
    """True: not before somebody says so."""
    until_ms: int
    """Not before this time, in milliseconds since 1970, UTC; 0: at any time."""
    reason: str


class ShiftState(msgspec.Struct, frozen=True, kw_only=True):
    """A shift that can be taken back."""

    shift: str
    """Its id."""
    by_ms: int


class OfficeView(msgspec.Struct, frozen=True, kw_only=True):
    """What the organiser's page shows in addition to the sheet of the contest."""

    version: str
    """Hash of the rest."""
    event: EventInfo
    code: str
    """The event code."""
    drawn: bool
    """Whether a stage is drawn."""
    to_draw: ToDraw | None
    """The stage that waits for the organiser's draw; None: none does."""
    teams: tuple[TeamRow, ...]
    courts: tuple[CourtRow, ...]
    slots: tuple[Slot, ...]
    """By court, and by time."""
    day: DayState
    shift: ShiftState | None
    """The newest shift, while it still changes something; None: there is none."""
    announced: str
    """The line to all; "": there is none."""
    undrawable: Undrawable | None
    """The newest stage, if nobody has played in it; None: its draw stays."""
    published: str
    """Path of the published contest below the address of the pages; "": it is not published."""
    folder: str
    """Where that is on the disk of the office's machine; "": it is not published."""
    staff: tuple[str, ...]
    """Who has a link with a name."""
    me: str
    """The name of whoever asks; "": the organiser."""


class Overviewed(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to `Overview`."""

    view: OfficeView | None
    """None: the page has the newest one."""


class Effect(msgspec.Struct, frozen=True, kw_only=True):
    """What a decision changes, or would change."""

    lines: tuple[Phrase, ...]
    done: bool


class CourtPlan(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to `CourtDay`."""

    coming: tuple[Slot, ...]
    """What is probably played next at the court, by time; not the game that is on."""
    changes: tuple[Phrase, ...]
    """What the result would change in matches and ranks (`decide.*`); empty: there was no result in
    the request, or the court has no game."""


class Said(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to a request that was carried out: what was done."""

    said: tuple[Phrase, ...]


class TeamPicture(msgspec.Struct, frozen=True, kw_only=True):
    """The newest picture of a team."""

    webp: bytes
    """A WebP file; empty: the team has none."""


class OpenSeat(msgspec.Struct, frozen=True, kw_only=True):
    """A seat of a court in open matches: whoever has its token may sit there."""

    court: str
    seat: str
    """The arena's name of the seat."""
    token: str


class TokenList(msgspec.Struct, frozen=True, kw_only=True):
    """The tokens that the organiser hands out."""

    teams: dict[str, str]
    """Tokens of the teams of people, by their names."""
    referees: dict[str, str]
    """Tokens of the referees, by the names of their courts."""
    seats: tuple[OpenSeat, ...] = ()
    """The open seats of all courts, if the contest has a stage of open matches."""
    staff: dict[str, str] = {}
    """Tokens of the staff, by their names; only for the organiser."""
    contacts: dict[str, str] = {}
    """How to reach the teams, by their names."""


Answer = EventInfo | OwnEntry | CourtPlan | Overviewed | Effect | Said | TeamPicture | TokenList
"""Every answer of the desk; which one it is follows from the request."""
