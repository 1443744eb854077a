"""The requests of the teacher's page (docs/gateway.md has them in a table)."""

from typing import Annotated, Literal

import msgspec

from lacoc_client.web.gateway.wire import Ask, Ping
from lacoc_client.workshop.design.learning.rules import StudentRules
from lacoc_client.workshop.design.requests import Hello, Name, ParseAsk, Sequences, read_with
from lacoc_client.workshop.design.table import FileTable


class RulesAsk(Ask, frozen=True, kw_only=True, tag="rules"):
    """Set what students may do."""

    rules: StudentRules


class HandOutAsk(Ask, frozen=True, kw_only=True, tag="hand_out"):
    """Offer a gait's table to all students or to a group.

    The request contains the table, or names a student whose table is offered. If it does neither,
    the sample's table is offered.
    """

    title: Name = ""
    table: FileTable | None = None
    sequences: Sequences | None = None
    student: Name | None = None
    group: Name = ""
    """Name of the group that gets it; "": all students get it."""


class SeatAsk(Ask, frozen=True, kw_only=True, tag="seat"):
    """Put a student into a group, or let the student work alone."""

    student: Name
    group: Name
    """Name of the group; a group that does not exist is made. "": the student works alone."""


class LowerAsk(Ask, frozen=True, kw_only=True, tag="lower"):
    """Take down the hand that a student has raised for help."""

    student: Name


class AdmitAsk(Ask, frozen=True, kw_only=True, tag="admit"):
    """Allow one more browser to enter under a student's name with the class code."""

    student: Name


class ForgetAsk(Ask, frozen=True, kw_only=True, tag="forget"):
    """Delete everything that is kept of a student."""

    student: Name


class NewCodeAsk(Ask, frozen=True, kw_only=True, tag="new_code"):
    """Make another class code."""


class ShowAsk(Ask, frozen=True, kw_only=True, tag="show"):
    """Let a student's robot walk with the student's newest table, to show it on a big screen."""

    student: Name


class ExportAsk(Ask, frozen=True, kw_only=True, tag="export"):
    """Make a file to download, with the evidence or the tables of all students."""

    what: Literal["evidence", "tables"]


class TournamentAsk(Ask, frozen=True, kw_only=True, tag="play"):
    """Start a tournament in which the students' newest tables play."""

    arena: Name
    rounds: Annotated[int, msgspec.Meta(ge=1, le=20)]
    seconds: Annotated[float, msgspec.Meta(ge=1, le=180)]


class StopPlayAsk(Ask, frozen=True, kw_only=True, tag="stop_play"):
    """End the running tournament early."""


Asked = (
    Hello
    | Ping
    | RulesAsk
    | HandOutAsk
    | ParseAsk
    | LowerAsk
    | SeatAsk
    | AdmitAsk
    | ForgetAsk
    | NewCodeAsk
    | ShowAsk
    | ExportAsk
    | TournamentAsk
    | StopPlayAsk
)
"""Every request of the teacher's page."""

_asked: msgspec.msgpack.Decoder[Asked] = msgspec.msgpack.Decoder(Asked)


def read(data: bytes) -> Asked:
    """Decode a request of the teacher's page.

    Raises:
        Unreadable: if it is no known request, or too long for its kind.
    """
    return read_with(_asked, data)
