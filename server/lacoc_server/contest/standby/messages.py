"""What the two machines of an office say to each other, sealed (`sealing`).

The second machine says what it has, and the office answers with what is missing. Neither has to
remember how far the other is, so a restart of either needs no care.
"""

from typing import Annotated, Literal

import msgspec

from lacoc_shared.messages.office import Copied
from lacoc_shared.words import Phrase

Kind = Literal["entry", "application", "file"]
"""entry: files of a team, by their hash. application: an entry that waits, by its team. file: one
of `FILES`, by its name."""
FILES = ("contest", "secrets", "code", "contacts", "stand-ins")
"""The small files: contest file, all tokens, event code, contacts of teams, list of courts that
stand in."""


class StandbyAsk(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="ask"
):
    """What all requests have."""

    generation: Annotated[int, msgspec.Meta(ge=0)]
    """How often the office has gone to another machine, as far as is known to who asks. An office
    that is asked with a later generation ends."""


class KnockAsk(StandbyAsk, frozen=True, kw_only=True, tag="knock"):
    """A question whether an office is there. The answer is `OfficeThere`."""


class StepAsk(StandbyAsk, frozen=True, kw_only=True, tag="step"):
    """A question of the second machine: what is there that I lack? The answer is `There`."""

    address: str
    """Where the second machine would be asked if the office went on there."""
    facts: Annotated[int, msgspec.Meta(ge=0)]
    """How many facts it has."""
    last: str
    """Hash of the last one as it is stored; "": it has none."""
    applications: str
    """Version of the list of applications that it has."""


class PartAsk(StandbyAsk, frozen=True, kw_only=True, tag="part"):
    """A question for a part of something. The answer is `Copied`."""

    kind: Kind
    name: str
    offset: Annotated[int, msgspec.Meta(ge=0)]
    """Where the part begins [bytes]."""


class RecordAsk(StandbyAsk, frozen=True, kw_only=True, tag="record"):
    """A question for the next part of a match's record, as `Copy` of an office to a court."""

    match_id: str
    have: dict[str, int]
    """Bytes that are here already, by the file's name."""


AnyAsk = KnockAsk | StepAsk | PartAsk | RecordAsk


class OfficeThere(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="known"):
    """An office is there."""

    generation: int


class There(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="there"):
    """What the office has."""

    facts: tuple[str, ...]
    """The next facts as they are stored."""
    has_more: bool
    """Whether there are more facts than these."""
    files: dict[str, str]
    """Hashes of the small files by name; a file that is not there is missing."""
    applications: str
    """Version of the list of applications."""
    waiting: dict[str, int] | None
    """The list: when each team handed its files in [ms since 1970, UTC]; None: no other version."""
    records: tuple[str, ...]
    """Ids of the matches whose records are still written, or not packed yet."""


class Got(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="got"):
    """A part of a small file, or of a record."""

    part: Copied


class Lacks(msgspec.Struct, frozen=True, kw_only=True, tag_field="answer", tag="lacks"):
    """There is no such thing (any more)."""

    why: Phrase


AnyAnswer = OfficeThere | There | Got | Lacks
