"""The requests of an organiser's and of teams' pages to a contest's office (docs/contest.md 12).

A gateway passes these requests on; it only limits how often files are handed in. The office checks
the secret in a request. The organiser's key, or a token of the staff, lets a page decide. The event
code lets a team apply. A team's token lets the team see and change its own entry.
"""

from typing import Annotated, Literal

import msgspec

from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase

DESK_MAX_BYTES = 98_304
"""Longest request that is read [bytes]."""
REPLY_MAX_BYTES = 2 << 20
"""Longest answer that is read [bytes]."""

PUBLISHED = "published/"
"""Path of a published contest, after the address of the pages."""

TEAM_NAME_MAX = 24
"""Most characters of a team's name."""

Replays = Literal["at-once", "after-stage", "after-contest"]
"""When everybody may see the record of a game: at once, or when its stage or the contest is
over."""

_Name = Annotated[str, msgspec.Meta(max_length=64)]
_Text = Annotated[str, msgspec.Meta(max_length=500)]


class TeamFiles(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True
):
    """The files that a team hands in to the office; None for a file that it leaves out."""

    robot: SentFile | None = None
    """Robot file; None: the contest's robot."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    picture: SentFile | None = None
    """A picture of the team; None: the picture that it handed in before stays, if there is one."""


class DeskRequest(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    omit_defaults=True,
    tag_field="do",
):
    """The fields that all requests to a desk have."""

    secret: Annotated[str, msgspec.Meta(max_length=200)] = ""
    """The organiser's key, the event code, or the token of a team, of the staff or of a referee."""


# Everybody


class LookAtEvent(DeskRequest, frozen=True, kw_only=True, tag="look"):
    """Ask for what everybody may know about the event."""


# With the event code


class Apply(DeskRequest, frozen=True, kw_only=True, tag="apply"):
    """Apply to take part in the contest with a team; the organiser decides."""

    team: _Name
    files: TeamFiles
    contact: Annotated[str, msgspec.Meta(max_length=200)] = ""
    """How to reach the team; only the organiser and the staff can read it."""
    club: _Name = ""
    """The team's school or club; a stage may keep teams of one club apart in its draw."""


# With a team's token


class ChangeFiles(DeskRequest, frozen=True, kw_only=True, tag="change"):
    """Hand in other files of a team. If entries are closed, the organiser decides about them."""

    files: TeamFiles


class Own(DeskRequest, frozen=True, kw_only=True, tag="own"):
    """Ask for the state of the entry of the team that has this token."""


# With the token of a court's referee


class CourtDay(DeskRequest, frozen=True, kw_only=True, tag="court_day"):
    """Ask what comes next at a court, and what a given result of its game would change."""

    court: _Name
    scores: tuple[int, int] | None = None
    """Points of the left and of the right seat with which the game would end; None: do not ask
    about a result."""
    outcome: Literal["left", "right", "draw"] = "draw"
    """Who would win with these `scores`."""


# With the organiser's key, or a token of the staff


class Overview(DeskRequest, frozen=True, kw_only=True, tag="overview"):
    """Ask for everything that the organiser's page shows."""

    known: str = ""
    """Version of the view that the page has; if this is the newest, the answer contains no view."""


class Approve(DeskRequest, frozen=True, kw_only=True, tag="approve"):
    """Let teams take part that applied or had withdrawn, or accept files that they sent late."""

    teams: tuple[_Name, ...]
    reason: _Text = ""
    """The reason, for teams and files that are late; everybody can read it."""


class Decline(DeskRequest, frozen=True, kw_only=True, tag="decline"):
    """Refuse the applications of teams, and forget them."""

    teams: tuple[_Name, ...]


class NewCode(DeskRequest, frozen=True, kw_only=True, tag="new_code"):
    """Make another event code; from then on no team can apply with the old one."""


class CloseEntries(DeskRequest, frozen=True, kw_only=True, tag="close"):
    """Let no more teams enter; the first stage can then be drawn, and its games called."""


class Draw(DeskRequest, frozen=True, kw_only=True, tag="draw"):
    """Make the draw of the stage that waits for the organiser's draw, as the page shows it."""

    stage: _Name
    entries: tuple[_Name, ...]
    """The teams in the order of their seeding, as the page shows them; for "hand" in the order that
    the organiser wants. If the office would now draw other teams, nothing is drawn."""
    how: Literal["", "hand", "lot"] = ""
    """How the seeding is made. "": by the ranking before. hand: by the organiser, with a reason.
    lot: by lot."""
    lot: _Name = ""
    """For "lot": the lot, which was drawn in front of everybody."""
    reason: _Text = ""


class Undraw(DeskRequest, frozen=True, kw_only=True, tag="undraw"):
    """Take back the draw of a stage in which nothing has been played."""

    stage: _Name
    reason: _Text
    really: bool = False
    """Whether to do it; False: only say what would change."""


class Substitute(DeskRequest, frozen=True, kw_only=True, tag="substitute"):
    """Let a team take the place of a team that has not played yet."""

    team: _Name
    substitute: _Name
    reason: _Text
    really: bool = False
    """Whether to do it; False: only say what would change."""


class PauseContest(DeskRequest, frozen=True, kw_only=True, tag="pause"):
    """Pause the contest: the office gives no game to a court until the contest goes on."""

    until_ms: Annotated[int, msgspec.Meta(ge=0, le=2**53)] = 0
    """Time at which the contest goes on by itself, in milliseconds since 1970 (UTC); 0: it goes on
    when the organiser says so."""
    reason: _Text = ""


class ResumeContest(DeskRequest, frozen=True, kw_only=True, tag="resume"):
    """Let a paused contest go on."""


class Shift(DeskRequest, frozen=True, kw_only=True, tag="shift"):
    """Postpone by `by_ms` all matches and all other times of the contest that are still to come."""

    by_ms: Annotated[int, msgspec.Meta(ge=60_000, le=86_400_000)]
    reason: _Text = ""


class Unshift(DeskRequest, frozen=True, kw_only=True, tag="unshift"):
    """Take back the newest shift, which postponed what was still to come."""

    shift: _Name
    """Id of the shift, as the page shows it. So the same request, sent twice, takes back only one
    shift."""


class Announce(DeskRequest, frozen=True, kw_only=True, tag="announce"):
    """Show a line of text of the organiser on all pages; "" removes it."""

    text: Annotated[str, msgspec.Meta(max_length=200)]


class Publish(DeskRequest, frozen=True, kw_only=True, tag="publish"):
    """Publish the contest: write the folder with its results, which the gateway serves."""


class Staff(DeskRequest, frozen=True, kw_only=True, tag="staff"):
    """Give a member of the staff a link to the organiser's page, or take the link away.

    Only the organiser may do so.
    """

    name: _Name
    remove: bool = False


class TakeOut(DeskRequest, frozen=True, kw_only=True, tag="take_out"):
    """Take a team out of the contest: it withdraws or is disqualified."""

    team: _Name
    reason: _Text = ""
    disqualify: bool = False
    really: bool = False
    """Whether to do it; False: only say what would change."""


class SeePicture(DeskRequest, frozen=True, kw_only=True, tag="picture"):
    """Ask for the newest picture that a team handed in, or delete it."""

    team: _Name
    remove: bool = False


class Rule(DeskRequest, frozen=True, kw_only=True, tag="rule"):
    """Make an organiser's decision about a match or one of its games.

    A game is played again (`replay`), its result is given (`result`), the match is void (`void`),
    or a team did not come (`no-show`).
    """

    kind: Literal["replay", "result", "void", "no-show"]
    pairing: _Name
    game: Annotated[int, msgspec.Meta(ge=1, le=200)] = 1
    """Number of the game in the match; not needed for "void" and "no-show"."""
    team: _Name = ""
    """For "no-show": the team that did not come."""
    scores: tuple[int, int] | None = None
    """For "result": points of the left and of the right seat."""
    reason: _Text = ""
    really: bool = False
    """Whether to do it; False: only say what would change."""


class Move(DeskRequest, frozen=True, kw_only=True, tag="move"):
    """Plan a match for another court or time; of several plans for a match the newest counts."""

    pairing: _Name
    court: _Name = ""
    """Name of the court; "": any court."""
    before: _Name = ""
    """Pairing of the match before which it is to be played; "": in the order of the schedule."""
    not_before_ms: Annotated[int, msgspec.Meta(ge=0, le=2**53)] = 0
    """Earliest time of the match, in milliseconds since 1970 (UTC); 0: at any time."""


class Tokens(DeskRequest, frozen=True, kw_only=True, tag="tokens"):
    """Ask for the tokens of all people who play or referee, to make links of them."""


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
"""The requests of organiser and staff, except `Publish`; only the organiser may use `Staff`."""
AnyRequest = LookAtEvent | Apply | ChangeFiles | Own | CourtDay | Publish | OfStaff
"""Every request to the desk."""


# Answers


class EventInfo(msgspec.Struct, frozen=True, kw_only=True):
    """The facts about an event that everybody may read."""

    name: str
    open: bool
    """Whether entries are open: teams can apply, and files that they change count at once."""
    closes_ms: int
    """When entries close, in milliseconds since 1970 (UTC); 0: when the organiser closes them."""
    replays: Replays
    """When everybody may see the records of games."""
    announced: str = ""
    """The organiser's line of text to all; "": there is none."""


class OwnEntry(msgspec.Struct, frozen=True, kw_only=True):
    """The state of a team's own entry, as the answer to the team."""

    event: EventInfo
    team: str
    token: str
    """The team's token for the whole contest."""
    state: Literal["waits", "in", "late", "left", "none"]
    """State of the entry. waits: the organiser has not approved it. in: it takes part. late: it
    takes part, but the organiser has not approved its newest files. left: it was taken out. none:
    the team has no entry."""
    files: str = ""
    """Hash of the files with which the team plays, or will play after approval."""
    at_ms: int = 0
    """When files were handed in that wait for approval, in milliseconds since 1970 (UTC); 0: no
    files wait."""


class TeamRow(msgspec.Struct, frozen=True, kw_only=True):
    """A team, as the organiser's page lists it."""

    team: str
    state: Literal["refused", "waits", "late", "in", "withdrawn", "disqualified"]
    """State of the team. refused: its newest files had mistakes, and it has not entered. withdrawn,
    disqualified: it was taken out. For the others see `OwnEntry`."""
    replaced_by: str = ""
    """The team that took this team's place, so that it is withdrawn; "": no team did."""
    files: str = ""
    bot: str = ""
    """Name of the bot that plays for the team; "": people play."""
    picture: bool = False
    """Whether the team's newest files contain a picture."""
    at_ms: int = 0
    mistakes: tuple[Mistake, ...] = ()
    """The mistakes in the files that the team handed in last."""
    contact: str = ""
    club: str = ""
    substitute: bool = False
    """Whether another team can still take this team's place: it has not played in a drawn stage."""
    reserve: bool = False
    """Whether the team may take another team's place: it takes part, but has no place of its own in
    a stage that is being played."""


class CourtRow(msgspec.Struct, frozen=True, kw_only=True):
    """A court, as the organiser's page lists it."""

    court: str
    here: bool
    """Whether the court has been heard lately."""


class MatchMove(msgspec.Struct, frozen=True):
    """To which court and time the organiser has moved a match; see `Move`."""

    court: str
    before: str
    not_before_ms: int


class Slot(msgspec.Struct, frozen=True, kw_only=True):
    """A match that is being played or will be played, with its court and its time."""

    pairing: str
    fixture: Phrase
    teams: tuple[str, str]
    """The left and the right team; "": not known yet."""
    who: tuple[Phrase, Phrase] | None = None
    """Who plays, as far as it is known, such as "winner of Semi-final 1"; None: `teams` has
    both."""
    court: str
    """Name of the court; "": not known, because no court is running."""
    at_ms: int
    """When the match began or will probably begin, in milliseconds since 1970 (UTC); 0: not
    known."""
    running: bool = False
    begun: bool = False
    """Whether its game at the court has begun; then a move changes nothing for this game."""
    absent: tuple[str, ...] = ()
    """Teams that have not come to the court some time after their game was called."""
    moved: MatchMove | None = None
    """How the match was moved; None: it was not moved."""
    held: Phrase | None = None
    """Why a court refused the game of this match; None: no court did."""


class ToDraw(msgspec.Struct, frozen=True, kw_only=True):
    """A stage whose draw the organiser must make now."""

    stage: str
    title: Phrase
    """Name of the stage for people."""
    entries: tuple[str, ...]
    """Its teams in the order of their seeding, the best first."""
    why: tuple[Phrase, ...] = ()
    """For each team, why it is in the stage; empty: the stage follows no other one."""
    meet: tuple[tuple[int, int], ...] = ()
    """Pairs of places in the seeding, from 0, whose teams are sure to meet: in the first round, or
    in a group."""
    met: tuple[tuple[str, str], ...] = ()
    """Pairs of teams of this stage that met in the stage before."""
    apart: tuple[str, ...] = ()
    """An order of the teams in which fewer pairs of `met` meet again; empty: there is no better
    order."""


class Undrawable(msgspec.Struct, frozen=True, kw_only=True):
    """A stage whose draw can still be taken back."""

    stage: str
    title: Phrase


class DayState(msgspec.Struct, frozen=True, kw_only=True):
    """Whether the office gives games to courts now; if not, until when and why not."""

    paused: bool
    """Whether no game is called until the organiser says so."""
    until_ms: int
    """No game is called before this time, in milliseconds since 1970 (UTC); 0: there is no such
    time."""
    reason: str


class ShiftState(msgspec.Struct, frozen=True, kw_only=True):
    """A shift that can be taken back: its id, and how long it postponed."""

    shift: str
    """Id of the shift."""
    by_ms: int


class OfficeView(msgspec.Struct, frozen=True, kw_only=True):
    """What the organiser's page shows in addition to the sheet of the contest."""

    version: str
    """Hash of all other fields."""
    event: EventInfo
    code: str
    """The event code."""
    drawn: bool
    """Whether any stage has been drawn."""
    to_draw: ToDraw | None
    """The stage that waits for the organiser's draw; None: no stage waits."""
    teams: tuple[TeamRow, ...]
    courts: tuple[CourtRow, ...]
    slots: tuple[Slot, ...]
    """The matches that are played now or later, sorted by court and then by time."""
    day: DayState
    shift: ShiftState | None
    """The newest shift, as long as it still changes something; None: there is none."""
    announced: str
    """The line of text to all; "": there is none."""
    undrawable: Undrawable | None
    """The newest stage, if nothing has been played in it; None: no draw can be taken back."""
    published: str
    """Path of the published contest after the address of the pages; "": the contest is not
    published."""
    folder: str
    """The published folder on the disk of the office's machine; "": the contest is not
    published."""
    staff: tuple[str, ...]
    """Names of the staff who have a link."""
    me: str
    """Name of the member of the staff who asks; "": it is the organiser."""


class Overviewed(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to `Overview`: what the organiser's page shows."""

    view: OfficeView | None
    """The view; None: the page has the newest one already."""


class Effect(msgspec.Struct, frozen=True, kw_only=True):
    """What an organiser's decision has changed, or would change."""

    lines: tuple[Phrase, ...]
    done: bool


class CourtPlan(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to `CourtDay`: what comes next at a court."""

    coming: tuple[Slot, ...]
    """The games that are probably played next at the court, by time, without the game that is
    on."""
    changes: tuple[Phrase, ...]
    """What the result would change in matches and ranks (`decide.*`); empty: the request has no
    result, or the court has no game."""


class Said(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to a request that was carried out: a sentence about what was done."""

    said: tuple[Phrase, ...]


class TeamPicture(msgspec.Struct, frozen=True, kw_only=True):
    """The newest picture of a team."""

    webp: bytes
    """The picture as a WebP file; empty: the team has no picture."""


class OpenSeat(msgspec.Struct, frozen=True, kw_only=True):
    """An open seat of a court, for friendly matches: whoever has its token may sit there."""

    court: str
    seat: str
    """Id of the seat in its arena."""
    token: str


class TokenList(msgspec.Struct, frozen=True, kw_only=True):
    """The tokens that the organiser gives to people."""

    teams: dict[str, str]
    """Tokens of the teams of people, by the names of the teams."""
    referees: dict[str, str]
    """Tokens of the referees, by the names of their courts."""
    seats: tuple[OpenSeat, ...] = ()
    """The open seats of all courts, if the contest has a stage of friendly matches."""
    staff: dict[str, str] = {}
    """Tokens of the staff, by their names; only in an answer to the organiser."""
    contacts: dict[str, str] = {}
    """How to reach each team, by the name of the team."""


Answer = EventInfo | OwnEntry | CourtPlan | Overviewed | Effect | Said | TeamPicture | TokenList
"""All answers of the desk; the request decides which of them comes."""
