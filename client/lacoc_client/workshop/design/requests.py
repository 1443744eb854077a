"""The requests of a /design page (docs/gateway.md lists them in a table)."""

from typing import Annotated, Any, Literal, TypeVar

import msgspec

from lacoc_client.web.gateway.wire import Ask, Ping, Unreadable, do_of, too_long
from lacoc_client.workshop.design.saving.robot_edit import AnyEntry
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.evidence import LESSON_STEPS, By
from lacoc_client.workshop.phases.facts import FootWay, Pace, Way
from lacoc_client.workshop.tables.entries import ENTRIES_MOST
from lacoc_shared.gait.cells import MAX_KEYS, MAX_POSTURES_PER_KEY
from lacoc_shared.gait.workbook.content import MAX_BYTES
from lacoc_shared.messages import SentFile
from lacoc_shared.studio import STUDIO_MAX_BYTES
from lacoc_shared.words import say

REQUEST_BYTES = STUDIO_MAX_BYTES
"""Longest request [bytes], except for those of `_LONGER`; a longer request is refused."""
PARSE_BYTES = MAX_BYTES + 4096
"""Longest `parse` request [bytes]: it may contain the largest workbook that can be read."""
MESSAGE_BYTES = 16 << 20
"""Longest message [bytes]; a longer one closes the connection."""

_LONGER = {"parse": PARSE_BYTES, "table": 1 << 20}
"""Longest requests [bytes] of other kinds. A table that is too large to be shared must be readable,
so that the page is told why it is refused."""
_MOST_CELLS = 4 * ENTRIES_MOST
_T = TypeVar("_T")
Name = Annotated[str, msgspec.Meta(max_length=200)]
_PhaseNumber = Annotated[int, msgspec.Meta(ge=0, le=6)]
_Small = Annotated[int, msgspec.Meta(ge=0, le=9)]
_Job = Annotated[str, msgspec.Meta(pattern="^[a-z0-9][a-z0-9-]{0,15}$")]
Sequences = tuple[tuple[Annotated[int, msgspec.Meta(ge=0, le=9)], ...], ...]


class Hello(Ask, frozen=True, kw_only=True, tag="hello"):
    """Ask to be let in, with the page key or with a class code and a name; the first message."""

    key: Name = ""
    code: Name = ""
    """The class code."""
    name: Name = ""
    """Nickname in the class."""
    token: Name = ""
    """The token that the class gave to this browser earlier."""
    lesson: bool = False
    """Whether this is a page of the lesson of one leg; such a page works beside a page of
    /design."""


class ReadAsk(Ask, frozen=True, kw_only=True, tag="read"):
    """Read a gait or robot file of the folder."""

    name: Name


class SampleAsk(Ask, frozen=True, kw_only=True, tag="sample"):
    """Read the sample postures of the robot that pages of this folder or class begin with."""


class ParseAsk(Ask, frozen=True, kw_only=True, tag="parse"):
    """Read a file that was dropped on the page, or the text of a whole pasted spreadsheet."""

    name: Name
    data: Any
    """Bytes, or text."""


class SaveAsk(Ask, frozen=True, kw_only=True, tag="save"):
    """Save a table, or the text of a robot file, into the folder."""

    name: Name
    table: FileTable | None = None
    robot: str | None = None
    version: Name = ""
    """Version of the file that the content was made from; "": there was no file of this name."""
    force: bool = False
    """Whether to save even if the file has changed since that version."""


class WriteAsk(Ask, frozen=True, kw_only=True, tag="write"):
    """Make a gait file for the user to download; the suffix of its name decides its format."""

    name: Name
    table: FileTable


class RobotAsk(Ask, frozen=True, kw_only=True, tag="robot"):
    """Ask the studio for the sizes and the shape of the robot that a robot file describes."""

    robot: SentFile | None = None


class SetRobotAsk(Ask, frozen=True, kw_only=True, tag="set_robot"):
    """Change one number in the text of a robot file."""

    robot: SentFile | None = None
    """The robot file to change; None: the workshop's robot."""
    entry: AnyEntry
    leg: Annotated[int, msgspec.Meta(ge=0, le=99)] = 0
    """Index of the leg, for a number of one leg."""
    value: float


class Foretold(msgspec.Struct, frozen=True, kw_only=True):
    """What the student guesses about the next trial."""

    about: Literal["pace", "way"]
    said: Pace | Way


class TrialAsk(Ask, frozen=True, kw_only=True, tag="trial"):
    """Let the robot walk with a table, in a trial."""

    table: FileTable | None = None
    """None: the sample gait of the robot."""
    robot: SentFile | None = None
    sequences: Sequences | None = None
    keys: Name = ""
    seconds: float | None = None
    guesses: tuple[Foretold, ...] = ()
    watched: bool = False
    """Whether the student only watches a table of the coach; then the trial is no evidence."""


class TableAsk(Ask, frozen=True, kw_only=True, tag="table"):
    """Report a change of the table that several pages share."""

    table: Name
    """Id of the table; "": the student's own table."""
    epoch: Name
    """The epoch of the table for which the change was made."""
    update: bytes
    """The changes, in the format of Yjs."""
    cells: Annotated[tuple[Name, ...], msgspec.Meta(max_length=_MOST_CELLS)] = ()
    """Names of the cells into which somebody typed."""
    seen: Annotated[int, msgspec.Meta(ge=0)] = 0
    """Number of the newest update of the table that the page had received."""
    begins: bool = False
    """Whether the change contains the first content that the page has put into an empty table."""


class PlaceAsk(Ask, frozen=True, kw_only=True, tag="place"):
    """Tell the other pages that have this table open which cell the user of this page is at."""

    row: Annotated[int, msgspec.Meta(ge=-1, lt=MAX_KEYS * MAX_POSTURES_PER_KEY)]
    col: Annotated[int, msgspec.Meta(ge=-1, lt=100)]
    typing: Annotated[str, msgspec.Meta(max_length=100)] | None = None
    """The text that is being typed in this cell; None: nothing is being typed."""


class EditAsk(Ask, frozen=True, kw_only=True, tag="edit"):
    """Tell the gateway what the student did to the table, as evidence for the phases."""

    before: FileTable
    """The table without this edit. Changes of others meanwhile are in this table and in `table`."""
    table: FileTable
    robot: SentFile | None = None
    sequences: Sequences | None = None
    by: By
    size: Literal["cell", "three", "table"] | None = None
    """If the student took over the coach's changes, the size of the coach's search."""
    guess: FootWay | None = None
    """The direction in which the student guessed, before the edit, that the foot will go."""


class CheckAsk(Ask, frozen=True, kw_only=True, tag="check"):
    """Check the table against the robot's joints, as `lacoc gait check` does."""

    table: FileTable
    robot: SentFile | None = None
    sequences: Sequences | None = None


class PlayAsk(Ask, frozen=True, kw_only=True, tag="play"):
    """Check the table, and give it to a court, where the student can play with it."""

    table: FileTable
    robot: SentFile | None = None
    sequences: Sequences | None = None


class HandOnAsk(PlayAsk, frozen=True, kw_only=True, tag="hand_on"):
    """Check the table, and make the files with which a team enters a contest."""


class PhaseAsk(Ask, frozen=True, kw_only=True, tag="phase"):
    """Go to another phase, forward or back."""

    number: _PhaseNumber


class AnswerAsk(Ask, frozen=True, kw_only=True, tag="answer"):
    """Answer the question that a phase asks."""

    phase: _PhaseNumber
    question: Name
    """Name of the question: a late answer to another question is refused."""
    choice: _Small


class LessonAsk(Ask, frozen=True, kw_only=True, tag="step"):
    """Report that the student reached a step of the lesson of one leg, or answered a question."""

    step: Annotated[int, msgspec.Meta(ge=1, le=LESSON_STEPS)]
    robot: Annotated[str, msgspec.Meta(max_length=40)]
    question: _Small | None = None
    """Index of the question that was answered; None: the student has reached the step."""
    of: _Small = 0
    """Number of questions of the step."""
    choice: _Small = 0
    right: bool = False


class NameAsk(Ask, frozen=True, kw_only=True, tag="name"):
    """Choose a word for how the robot should walk."""

    word: Annotated[str, msgspec.Meta(min_length=1, max_length=40)]


class VoteAsk(Ask, frozen=True, kw_only=True, tag="vote"):
    """Vote whether A (the sample) or B (the student's own gait) fits the word better."""

    choice: Literal["A", "B"]


class GroupAsk(Ask, frozen=True, kw_only=True, tag="group"):
    """Join or make a group, leave it, take a role, vote for a word, or take what was handed out."""

    act: Literal["join", "leave", "role", "word", "take"]
    text: Annotated[str, msgspec.Meta(max_length=40)] = ""
    """Name of the group, the role ("forward", "turn" or ""), or the word."""
    number: int = 0
    """With "take": number of the handed-out table that the group has now."""


class HandAsk(Ask, frozen=True, kw_only=True, tag="hand"):
    """Raise the hand for help, or take it down."""

    up: bool


class CoachAsk(Ask, frozen=True, kw_only=True, tag="coach"):
    """Ask the coach which numbers of a key matter, and for better numbers."""

    job: _Job
    """Name that the page chooses for the search; reports on the search and `cancel` use it too."""
    table: FileTable | None = None
    robot: SentFile | None = None
    sequences: Sequences | None = None
    key: int | None = None
    goal: Name = "forward"
    size: Name | None = None
    seconds: float = 30.0
    seed: int = 0


class MapAsk(Ask, frozen=True, kw_only=True, tag="map"):
    """Ask the coach for gaits of many speeds and arousals (how excited the robot looks)."""

    job: _Job
    """Name of the search; see `CoachAsk`."""
    table: FileTable | None = None
    robot: SentFile | None = None
    sequences: Sequences | None = None
    key: int | None = None
    seconds: float = 30.0
    seed: int = 0


class VariantsAsk(Ask, frozen=True, kw_only=True, tag="variants"):
    """Ask the coach for six gaits that look different."""

    job: _Job
    """Name of the search; see `CoachAsk`."""
    table: FileTable | None = None
    robot: SentFile | None = None
    sequences: Sequences | None = None
    key: int | None = None
    keep: tuple[tuple[int, ...], ...] = ()
    """Tables of one or two gaits from which the new gaits are made; empty: they are made from
    `table`."""
    before: tuple[tuple[int, ...], ...] = ()
    """Tables of gaits that were shown before: the new gaits must look different."""
    round: int = 0
    """How many rounds of six gaits were shown before."""
    seed: int = 0


class CancelAsk(Ask, frozen=True, kw_only=True, tag="cancel"):
    """End early a search of the coach that this page asked for."""

    job: _Job


Asked = (
    Hello
    | Ping
    | ReadAsk
    | SampleAsk
    | ParseAsk
    | SaveAsk
    | WriteAsk
    | RobotAsk
    | SetRobotAsk
    | TrialAsk
    | CoachAsk
    | MapAsk
    | VariantsAsk
    | CancelAsk
    | TableAsk
    | PlaceAsk
    | EditAsk
    | CheckAsk
    | PlayAsk
    | HandOnAsk
    | PhaseAsk
    | AnswerAsk
    | LessonAsk
    | NameAsk
    | VoteAsk
    | HandAsk
    | GroupAsk
)
"""Every request of a page."""


_asked: msgspec.msgpack.Decoder[Asked] = msgspec.msgpack.Decoder(Asked)


def read(data: bytes) -> Asked:
    """Decode a request of a /design page.

    Raises:
        Unreadable: if the bytes are not a known request, or too long for their kind of request.
    """
    return read_with(_asked, data)


def read_with(decoder: msgspec.msgpack.Decoder[_T], data: bytes) -> _T:
    """Decode a request with this decoder.

    Raises:
        Unreadable: if the decoder can't decode it, or it is too long.
    """
    try:
        if len(data) > REQUEST_BYTES:
            most = _LONGER.get(do_of(data), REQUEST_BYTES)
            if len(data) > most:
                raise too_long(len(data), most)
        return decoder.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise Unreadable(say("gateway.bad-message", error=str(error))) from None
