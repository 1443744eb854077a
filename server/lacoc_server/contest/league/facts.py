"""The facts of a contest: what happened and what was decided, each appended once.

A fact has an id, and a number that is its place among the facts. Facts may arrive in any
order and more than once: `ordered` returns each once, in the order of their numbers.
docs/contest.md says what each fact means.
"""

from collections.abc import Iterable
from typing import Annotated, Any, Literal, TypeVar

import msgspec

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

VERSION = 1
"""Version of the format of facts."""

Name = Annotated[str, msgspec.Meta(min_length=1, max_length=64)]
Draw = Literal["at-once", "organiser"]
"""When a stage is drawn: "at-once" as soon as its teams are known, "organiser" only after that,
when the organiser says so. Without a network all stages are drawn at once."""
Outcome = Literal["left", "right", "draw", "void"]
"""Who won a game, by seat. "void": the game counts for nobody and must be played again."""


class Fact(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True, tag_field="fact"):
    """The fields that all facts have."""

    id: Name
    """Names the fact; unique in the contest."""
    number: Annotated[int, msgspec.Meta(ge=0)]
    """Place of the fact among all facts; equal numbers are ordered by id."""
    at_ms: Annotated[int, msgspec.Meta(ge=0)] = 0
    """When it happened, in milliseconds since 1970, UTC."""
    by: Annotated[str, msgspec.Meta(max_length=64)] = ""
    """Who of the staff decided it; "": the organiser, or the office itself."""


class Entered(Fact, frozen=True, kw_only=True, tag="entered"):
    """A team has entered the contest; the fact has the hash of its files."""

    team: Name
    files: str = ""
    """Hash of the robot file, the gait files, the bot and the picture."""
    bot: str = ""
    """Name of the bot that plays for the team; "": none, so people play, or without a network the
    bot that steers teams without one."""
    picture: bool = False
    """Whether a picture of the team is among the files."""
    club: Annotated[str, msgspec.Meta(max_length=64)] = ""
    """The school or club of the team; a stage may draw teams of one club apart. "": none."""
    reason: str = ""
    """Why it entered after entries were closed; "" if they were open."""


class EntriesOpened(Fact, frozen=True, kw_only=True, tag="opened"):
    """Teams may enter until the organiser closes entries, or until the contest file's time."""


class Closed(Fact, frozen=True, kw_only=True, tag="closed"):
    """Entries are closed: from now on teams enter, and files change, only with a reason."""


class Withdrawn(Fact, frozen=True, kw_only=True, tag="withdrawn"):
    """A team leaves; its opponents win what it has not played."""

    team: Name
    reason: str = ""


class Disqualified(Fact, frozen=True, kw_only=True, tag="disqualified"):
    """A team is expelled: it leaves as if withdrawn, and is ranked last."""

    team: Name
    reason: str = ""


class Substituted(Fact, frozen=True, kw_only=True, tag="substituted"):
    """A substitute takes a team's place in all drawn stages in which the team has no result yet."""

    team: Name
    """The team that gives its place up; it leaves the contest."""
    substitute: Name
    reason: str = ""


class FilesChanged(Fact, frozen=True, kw_only=True, tag="files-changed"):
    """The files with which a team plays, or its club, are replaced by others."""

    team: Name
    files: str
    bot: str = ""
    picture: bool = False
    club: Annotated[str, msgspec.Meta(max_length=64)] | None = None
    """The school or club of the team from now on; "": none; None: as before."""
    reason: str = ""
    """Why the files change; "" only while entries are open."""


class StageSettings(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """How a stage is played. Each format reads only some of these settings."""

    games: Annotated[int, msgspec.Meta(ge=1, le=99)] = 1
    """Best of so many games; the sides are swapped after each game."""
    extra_games: Annotated[int, msgspec.Meta(ge=0, le=9)] = 1
    """In a knockout match that is level after `games`: how many extra games are played at most."""
    rounds: Annotated[int, msgspec.Meta(ge=0, le=999)] = 0
    """Number of rounds; in a sequential stage the largest number. 0: the format's own number."""
    places: Annotated[int, msgspec.Meta(ge=1, le=99)] = 1
    """How many first places must be decided before a sequential stage ends early."""
    confidence: Annotated[float, msgspec.Meta(ge=0.5, lt=1.0)] = 0.95
    """Probability with which the first places must be right to end a sequential stage early."""
    groups: Annotated[int, msgspec.Meta(ge=1, le=99)] = 1
    """Number of groups of a round robin; fewer, if a group would have less than two teams."""
    third_place: bool = False
    """True: the losers of the semi-finals of a single knockout play for place 3."""
    reset: bool = True
    """True: if the team from the losers' bracket of a double knockout wins the final, a second
    final decides."""
    tie_breaks: tuple[str, ...] = ()
    """Codes that order teams with equal points; empty: the format's own list."""
    options: dict[str, Any] = {}
    """Further settings, which only formats of other packages read."""


STAGE_NAME = "^[a-z0-9][a-z0-9-]{0,31}$"
"""Pattern of a stage's name."""


class Planned(Fact, frozen=True, kw_only=True, tag="planned"):
    """The plan of a stage: its format and settings. The newest plan before the draw counts."""

    stage: Annotated[str, msgspec.Meta(pattern=STAGE_NAME)]
    format: Name
    settings: StageSettings = StageSettings()
    after: str = ""
    """The stage whose ranking is the seeding of this one; "": all teams, in the order of entry."""
    title: dict[Literal["en", "ja"], Name] = {}
    """What people call it, by language; empty: the usual name of its format."""
    draw: Draw = "at-once"
    apart: bool = False
    """True: teams of one club do not meet in the first round, or in a group, if it can be avoided.
    """
    met_apart: bool = False
    """True: teams that met in the stage before do not meet again in the first round, or in a group,
    if it can be avoided."""
    break_s: Annotated[float, msgspec.Meta(ge=0)] = 0.0
    """Shortest time between the end of the stages before it and its first game [s]."""
    final_court: str = ""
    """The only court for its final; "": any court."""
    final_break_s: Annotated[float, msgspec.Meta(ge=0)] = 0.0
    """Shortest time between the end of all its other games and its final [s]."""
    teams: Annotated[int, msgspec.Meta(ge=0)] = 0
    """This many of the best teams take part; 0: all."""
    arena: str = ""
    """Name of the arena, which is the game that is played."""
    arena_settings: dict[str, Any] = {}
    """Entries that replace those of the arena file."""
    limits: dict[str, float] = {}
    """Limits for robots that differ from the defaults."""


class Unplanned(Fact, frozen=True, kw_only=True, tag="unplanned"):
    """The plan of a stage that is not drawn is taken back.

    The stage is in the contest file no more, or it stands elsewhere in it; then a new plan follows.
    """

    stage: str


class Drawn(Fact, frozen=True, kw_only=True, tag="drawn"):
    """A stage is drawn: its teams are fixed. Their order is their seeding, the best first."""

    stage: str
    entries: tuple[Name, ...]
    how: Literal["", "hand", "lot"] = ""
    """"": by the ranking of the stage before, or by entry. hand: in the order that the organiser
    gave, with a reason. lot: in the order that follows from `lot` (`draws.by_lot`)."""
    lot: Annotated[str, msgspec.Meta(max_length=64)] = ""
    """What was drawn in front of everybody: numbers of dice, a word."""
    reason: str = ""


class Undrawn(Fact, frozen=True, kw_only=True, tag="undrawn"):
    """A decision: the draw of a stage in which nobody has a result is taken back."""

    stage: str
    reason: str


class RoundDrawn(Fact, frozen=True, kw_only=True, tag="round-drawn"):
    """The pairs of a round are fixed, in a stage whose rounds are drawn one by one.

    A later correction of results does not change the pairs.
    """

    stage: str
    round: Annotated[int, msgspec.Meta(ge=1)]
    pairs: tuple[Annotated[tuple[Name, ...], msgspec.Meta(min_length=1, max_length=2)], ...]
    """The left team and the right team; a team alone has a bye."""


class Called(Fact, frozen=True, kw_only=True, tag="called"):
    """A game is given to a court."""

    pairing: Name
    game: int
    teams: tuple[Name, Name]
    court: Name


MOVED = "moved"
"""Reason of `Recalled`: the match was moved to another court, or to a later time."""
COURT_LOST = "court lost"
"""Reason of `Recalled`: the court was silent for too long."""


class Recalled(Fact, frozen=True, kw_only=True, tag="recalled"):
    """A called game is taken away from its court without a result."""

    pairing: Name
    game: int
    reason: str = ""


class Played(Fact, frozen=True, kw_only=True, tag="played"):
    """A game has ended at its court, or without a network, with an official result."""

    pairing: Name
    game: Annotated[int, msgspec.Meta(ge=1)]
    """Number of the game in its match, from 1."""
    teams: tuple[Name, Name]
    """Who sat left and who sat right."""
    scores: tuple[int, int]
    """Points of the left and of the right seat."""
    outcome: Outcome
    record: str = ""
    """File name of the court's record."""
    record_hash: str = ""
    """Hash of the record's file (`lacoc_server.contest.kept.folder.file_hash`); "": the game was
    played at a court."""
    steer: str = ""
    """Name of the bot that steered teams without one, in a game without a network; "": no team
    needed it, or an older version wrote the fact."""
    advice: tuple[Phrase, ...] = ()
    """Why the court advised to play the game again; empty: it did not, or an older version wrote
    the fact."""


class Replaced(Fact, frozen=True, kw_only=True, tag="replaced"):
    """A decision: the game counts with a result that the organiser gives, whatever was played."""

    pairing: Name
    game: Annotated[int, msgspec.Meta(ge=1)]
    teams: tuple[Name, Name]
    scores: tuple[int, int]
    outcome: Literal["left", "right", "draw"]
    reason: str


class Replay(Fact, frozen=True, kw_only=True, tag="replay"):
    """A decision: the results that this game had so far do not count; it is played again.

    If the match was void, or a team did not appear, the match is open again.
    """

    pairing: Name
    game: Annotated[int, msgspec.Meta(ge=1)]
    teams: tuple[Name, Name]
    reason: str


class Voided(Fact, frozen=True, kw_only=True, tag="voided"):
    """A decision: the match counts for nobody and is not played again."""

    pairing: Name
    teams: tuple[Name, Name]
    reason: str


class NoShow(Fact, frozen=True, kw_only=True, tag="no-show"):
    """A decision: the team did not appear; its opponent, if it came, wins the undecided match."""

    pairing: Name
    team: Name
    opponent: Annotated[str, msgspec.Meta(max_length=64)] = ""
    """The other team of the match; "": not known, an older version wrote the fact."""
    reason: str = ""


class Moved(Fact, frozen=True, kw_only=True, tag="moved"):
    """A match is played at another court or time.

    Of several moves of one match the newest counts.
    """

    pairing: Name
    court: str = ""
    """The only court for the match; "": any court."""
    before: str = ""
    """Pairing of another match: this one is played directly before it. "": it keeps its place in
    the schedule."""
    not_before_ms: Annotated[int, msgspec.Meta(ge=0)] = 0
    """The match is not called before this time, in milliseconds since 1970, UTC; 0: at any time."""


class Paused(Fact, frozen=True, kw_only=True, tag="paused"):
    """No game is called until the contest goes on; games that were called are played."""

    until_ms: Annotated[int, msgspec.Meta(ge=0)] = 0
    """When the contest goes on by itself, in milliseconds since 1970, UTC; 0: when somebody resumes
    it."""
    reason: str = ""


class Resumed(Fact, frozen=True, kw_only=True, tag="resumed"):
    """Somebody ends a pause or the wait of a shift: games are called again."""


class Shifted(Fact, frozen=True, kw_only=True, tag="shifted"):
    """All matches that are still to come are postponed by `by_ms`.

    For this time no game is called. The earliest times of moved matches that are still to come are
    postponed too. The end of a pause and the end of entries are not.
    """

    by_ms: Annotated[int, msgspec.Meta(ge=0, le=86_400_000)]
    reason: str = ""


class Unshifted(Fact, frozen=True, kw_only=True, tag="unshifted"):
    """A shift is taken back: all is as if it had never been."""

    shift: Name
    """Id of the `Shifted` fact that is taken back."""


class Announced(Fact, frozen=True, kw_only=True, tag="announced"):
    """The organiser shows a line on all pages; it replaces the line before."""

    text: Annotated[str, msgspec.Meta(max_length=200)]
    """The line; "": no line is shown any more."""


class TakenOver(Fact, frozen=True, kw_only=True, tag="taken-over"):
    """The office goes on at another machine, from a copy of the facts before this one.

    The former machine may have appended facts after that copy; they do not count.
    """


OfDecision = (
    Entered
    | Withdrawn
    | Disqualified
    | Substituted
    | FilesChanged
    | Drawn
    | Undrawn
    | NoShow
    | Replaced
    | Replay
    | Voided
)
"""Facts of decisions by people, most of them with a reason; no record can prove them."""
OfTeam = Entered | EntriesOpened | Closed | Withdrawn | Disqualified | Substituted | FilesChanged
OfMatch = Called | Recalled | Played | Replaced | Replay | Voided | NoShow | Moved
OfStage = Planned | Unplanned | Drawn | Undrawn | RoundDrawn
OfDay = Paused | Resumed | Shifted | Unshifted | Announced
AnyFact = OfTeam | OfMatch | OfStage | OfDay | TakenOver


def stage_of(pairing: str) -> str:
    """Return the name of the stage of a pairing."""
    return pairing.partition(":")[0]


_Kind = TypeVar("_Kind", bound=Fact)


def new(kind: type[_Kind], **values: Any) -> _Kind:
    """Make a fact without id and number; the store sets them when the fact is appended."""
    return kind(id="new", number=0, **values)


def generation(facts: Iterable[AnyFact]) -> int:
    """Return how often the office has gone to another machine."""
    return sum(isinstance(fact, TakenOver) for fact in facts)


def decisions(facts: Iterable[AnyFact]) -> tuple[OfDecision, ...]:
    """Return those facts that are decisions of people, without the other facts.

    Entries and changes of files count as decisions only after entries are closed. Draws count if a
    lot or the organiser made their order.

    Args:
        facts: in their order.
    """
    found: list[OfDecision] = []
    closed = False
    for fact in facts:
        closed = closed or isinstance(fact, Closed)
        match fact:
            case Entered() | FilesChanged():
                decided = closed
            case Drawn():
                decided = bool(fact.how)
            case _:
                decided = isinstance(fact, OfDecision)
        if decided:
            found.append(fact)  # type: ignore[arg-type]
    return tuple(found)


class _FactsFile(msgspec.Struct, frozen=True, kw_only=True):
    version: int
    facts: tuple[AnyFact, ...]


def ordered(facts: Iterable[AnyFact]) -> tuple[AnyFact, ...]:
    """Return the facts in their order, each once.

    Raises:
        UserError: if two different facts have the same id.
    """
    by_id: dict[str, AnyFact] = {}
    for fact in facts:
        if by_id.setdefault(fact.id, fact) != fact:
            raise UserError(say("league.two-facts", id=fact.id))
    return tuple(sorted(by_id.values(), key=lambda fact: (fact.number, fact.id)))


def encode(facts: Iterable[AnyFact]) -> bytes:
    """Write facts as JSON; facts that arrived in another order give the same bytes."""
    return msgspec.json.encode(_FactsFile(version=VERSION, facts=ordered(facts)))


def decode(data: bytes) -> tuple[AnyFact, ...]:
    """Read facts from JSON.

    Raises:
        UserError: if the JSON is wrong or of another version (the message says where), or if two
            different facts have the same id.
    """
    try:
        version = msgspec.json.decode(data, type=dict[str, msgspec.Raw]).get("version")
        if version is not None and bytes(version) != str(VERSION).encode():
            raise UserError(
                say(
                    "league.other-version",
                    found=str(bytes(version), "utf-8", "replace"),
                    known=VERSION,
                )
            )
        return ordered(msgspec.json.decode(data, type=_FactsFile).facts)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise UserError(say("league.wrong-facts", error=str(error))) from None
