"""What students do, as it is kept: the evidence from which the phases are decided.

Each kind has one meaning. Evidence is only added, never changed.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Literal

import msgspec

from lacoc_client.phases.facts import Difference, TrialFacts
from lacoc_shared.gait.tables import JOINTS_PER_LEG

SAMPLE = "sample"
"""The version that stands for the sample gait of the robot."""

By = Literal["hand", "tool", "paste", "coach"]
"""How cells were changed. A tool makes cells from others, as mirror and copy do."""
Rows = Mapping[tuple[int, int], Sequence[float]]
"""A table: key and index in its sequence -> (joints,) angles [deg], by joint id."""

_Word = Annotated[str, msgspec.Meta(max_length=40)]
_Name = Annotated[str, msgspec.Meta(max_length=100)]


class _Kind(msgspec.Struct, frozen=True, kw_only=True, tag_field="kind", tag=str.lower):
    """A kind of evidence; its name in lower case stands in the JSON."""


class Joined(_Kind, frozen=True, kw_only=True):
    """The student came into the class."""


class Moved(_Kind, frozen=True, kw_only=True):
    """The student went to a phase, forward or back."""

    phase: int
    """From 1 to 6."""


class LegEdit(msgspec.Struct, frozen=True, array_like=True):
    """A leg of one posture after an edit."""

    key: int
    posture: int
    """Index in the key's sequence; 0 in a table of postures."""
    leg: int
    """Index of the leg."""
    changed: tuple[int, ...]
    """Levels of the joints that were changed: 0 is root, 1 is 1st, 2 is 2nd."""
    angles_deg: tuple[float, ...]
    """(3,) angles of the leg after the edit."""


class Edited(_Kind, frozen=True, kw_only=True):
    """The student changed cells of the table."""

    version: _Word
    """The version that the edit made."""
    by: By
    legs: tuple[LegEdit, ...]


class Guessed(_Kind, frozen=True, kw_only=True):
    """The student predicted something, and then saw it."""

    about: Literal["foot", "pace", "way"]
    """Where a foot goes (`facts.FootWay`); whether a gait becomes faster (`facts.Pace`); where the
    robot turns (`facts.Way`)."""
    said: _Word
    was: tuple[_Word, ...]
    """All right answers."""

    @property
    def right(self) -> bool:
        """Whether the student was right."""
        return self.said in self.was


class Tried(_Kind, frozen=True, kw_only=True):
    """The student let the robot walk."""

    version: _Word
    facts: TrialFacts


class Checked(_Kind, frozen=True, kw_only=True):
    """A gait was checked, as `lacoc gait check` does."""

    version: _Word
    keys: int
    """Number of keys of level B that it has."""
    mistakes: int


class Compared(_Kind, frozen=True, kw_only=True):
    """The student compared the trials of two versions."""

    version: _Word
    against: _Word
    """The other version; `SAMPLE`: the sample gait."""
    differs: tuple[Difference, ...]
    """In what the walks differ so much that people see it (`facts.differences`)."""


class Named(_Kind, frozen=True, kw_only=True):
    """The student chose a word for how the robot shall walk, such as "elegant"."""

    word: _Word


class Voted(_Kind, frozen=True, kw_only=True):
    """The student voted whether A or B fits a word better; for which one, nobody can see."""

    poll: _Name


class Coached(_Kind, frozen=True, kw_only=True):
    """The student took over what the coach found."""

    version: _Word
    size: Literal["cell", "three", "table"]


class Hand(_Kind, frozen=True, kw_only=True):
    """The student raised the hand for help, or took it down."""

    up: bool


Evidence = (
    Joined | Moved | Edited | Guessed | Tried | Checked | Compared | Named | Voted | Coached | Hand
)

_DECODER = msgspec.json.Decoder(Evidence)


def to_json(evidence: Evidence) -> bytes:
    """Encode evidence."""
    return msgspec.json.encode(evidence)


def from_json(data: bytes | str) -> Evidence:
    """Decode evidence.

    Raises:
        ValueError: if it is none.
    """
    evidence: Evidence = _DECODER.decode(data)
    return evidence


def edited(before: Rows, after: Rows, version: str, by: By) -> Edited | None:
    """Find what an edit changed; None if it changed no angle.

    Args:
        before: the table before the edit.
        after: the table after it. Rows that were not there before count as changed; rows that are
            gone do not.
        version: name of the version that the edit made.
        by: how the cells were changed.
    """
    legs = tuple(
        leg for place, angles in sorted(after.items()) for leg in _legs(place, before, angles)
    )
    return Edited(version=version, by=by, legs=legs) if legs else None


def _legs(place: tuple[int, int], before: Rows, angles: Sequence[float]) -> Iterator[LegEdit]:
    old, legs = before.get(place), len(angles) // JOINTS_PER_LEG
    known = old is not None and len(old) == len(angles)
    for leg in range(legs):
        joints = range(leg, legs * JOINTS_PER_LEG, legs)
        changed = tuple(
            level
            for level, joint in enumerate(joints)
            if old is None or not known or old[joint] != angles[joint]
        )
        if changed:
            yield LegEdit(*place, leg, changed, tuple(angles[joint] for joint in joints))
