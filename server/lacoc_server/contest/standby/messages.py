"""Messages between an office and the machine that copies it (the second machine).

The second machine says what it has, and the office answers with what it lacks. Neither has to
remember what the other has, so both can be restarted at any time. `sealing` encrypts the messages.
"""

from typing import Annotated, Literal

import msgspec

from lacoc_shared.messages.office import Copied
from lacoc_shared.words import Phrase

Kind = Literal["entry", "application", "file"]
"""Kinds of things that are copied in parts. entry: files of a team, named by their hash.
application: an entry that waits, named by its team. file: one of `FILES`, by its name."""
FILES = ("contest", "secrets", "code", "contacts", "stand-ins")
"""The small files: contest file, all tokens, event code, contacts of teams, and the list of courts
that the office's machine runs in place of theirs."""


class StandbyAsk(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="ask"
):
    """The fields of all requests between an office and the machine that copies it."""

    generation: Annotated[int, msgspec.Meta(ge=0)]
    """How often the office has gone to another machine, as far as the sender can tell. An office
    that is asked with a later generation ends."""


class KnockAsk(StandbyAsk, frozen=True, kw_only=True, tag="knock"):
    """Asks whether an office runs on the other machine, and tells it the sender's generation.

    The answer is `OfficeThere`.
    """


class StepAsk(StandbyAsk, frozen=True, kw_only=True, tag="step"):
    """Asks what the office has that the machine which copies it lacks. The answer is `There`."""

    address: str
    """Address of the office if it went on at the second machine."""
    facts: Annotated[int, msgspec.Meta(ge=0)]
    """How many facts the second machine has."""
    last: str
    """Hash of the second machine's last fact, as it is stored; "": it has none."""
    applications: str
    """Version of the second machine's list of applications."""


class PartAsk(StandbyAsk, frozen=True, kw_only=True, tag="part"):
    """Asks for a part of an entry, application or small file. The answer is `Got`, or `Lacks`."""

    kind: Kind
    name: str
    offset: Annotated[int, msgspec.Meta(ge=0)]
    """Where the part begins, in bytes from the beginning."""


class RecordAsk(StandbyAsk, frozen=True, kw_only=True, tag="record"):
    """Asks for the next part of a match's record. The answer is `Got`, or `Lacks`."""

    match_id: str
    have: dict[str, int]
    """Length in bytes of each file of the record that the asking machine has, by its name."""


AnyAsk = KnockAsk | StepAsk | PartAsk | RecordAsk


class OfficeThere(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="known"):
    """Answer to `KnockAsk`: an office runs on the machine that was asked, with its generation."""

    generation: int


class There(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="there"):
    """Answer to `StepAsk`: what the office has that the asking machine lacks."""

    facts: tuple[str, ...]
    """The stored texts of the next facts."""
    has_more: bool
    """Whether the office has further facts, which did not fit."""
    files: dict[str, str]
    """Hashes of the small files by name; files that do not exist are left out."""
    applications: str
    """Version of the office's list of applications."""
    waiting: dict[str, int] | None
    """The time at which each waiting team sent its files [ms since 1970, UTC]; None: the second
    machine has this version of the list already."""
    records: tuple[str, ...]
    """Ids of the matches whose records are still in segments, and not in one file."""


class Got(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="got"):
    """A part of what was asked for: of an entry, an application, a small file or a record."""

    part: Copied


class Lacks(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="lacks"):
    """Answer to a request for something that the office does not have, or no longer has."""

    why: Phrase


AnyAnswer = OfficeThere | There | Got | Lacks
