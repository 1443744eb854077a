"""The kinds of evidence that students produce; the phases decide from it which tasks are done.

Evidence is never changed; it is deleted only when everything about a student is deleted.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Literal

import msgspec

from lacoc_client.workshop.phases.facts import Difference, TrialFacts
from lacoc_shared.gait.tables import JOINTS_PER_LEG

SAMPLE = "sample"
"""Name of the version that is the sample gait of the robot."""

LESSON_STEPS = 8
"""Number of steps of the lesson of one leg; the last one has no question."""

By = Literal["hand", "tool", "paste", "coach", "lesson"]
"""How cells were changed: typed, or made in another way. A tool of the page, such as mirror or
copy, makes cells from others; the lesson of one leg gives the three numbers of a leg."""
Rows = Mapping[tuple[int, int], Sequence[float]]
"""A table: (key, index in the key's sequence) -> (joints,) angles [deg], by joint id."""

_Word = Annotated[str, msgspec.Meta(max_length=40)]
_Name = Annotated[str, msgspec.Meta(max_length=100)]


class _EvidenceKind(msgspec.Struct, frozen=True, kw_only=True, tag_field="kind"):
    """A kind of evidence; its tag is the field "kind" of its JSON."""


class JoinedClass(_EvidenceKind, frozen=True, kw_only=True, tag="joined"):
    """The student entered the class."""


class WentToPhase(_EvidenceKind, frozen=True, kw_only=True, tag="moved"):
    """The student went to a phase, forward or back."""

    phase: int
    """Number of the phase, from 0 to 6."""


class TookStep(_EvidenceKind, frozen=True, kw_only=True, tag="step"):
    """The student reached a step of the lesson of one leg, or answered a question of it."""

    step: int
    """Number of the step, from 1 to 8 (`LESSON_STEPS`)."""
    robot: _Word
    """Name of the robot whose leg was shown."""
    question: int = -1
    """Index of the question in the step; -1: the student reached the step."""
    of: int = 0
    """Number of questions of the step."""
    choice: int = -1
    """Index of the chosen answer."""
    right: bool = False


class LegEdit(msgspec.Struct, frozen=True, array_like=True):
    """An edit of one leg in one row of the table."""

    key: int
    posture: int
    """Index in the key's sequence; 0 in a table of postures."""
    leg: int
    """Index of the leg."""
    changed: tuple[int, ...]
    """Levels of the joints that were changed: 0 is root, 1 is 1st, 2 is 2nd."""
    angles_deg: tuple[float, ...]
    """(3,) angles of the leg after the edit."""
    before_deg: tuple[float, ...] = ()
    """(3,) angles of the leg before the edit; empty: the row is new, or had other legs."""


class Edited(_EvidenceKind, frozen=True, kw_only=True, tag="edited"):
    """The student changed cells of the table."""

    version: _Word
    """Name of the version of the table after the edit."""
    by: By
    legs: tuple[LegEdit, ...]


class Guessed(_EvidenceKind, frozen=True, kw_only=True, tag="guessed"):
    """The student guessed where a foot would go, or how the robot would walk, and then saw it.

    The guess was about an edit, or about the next trial.
    """

    about: Literal["foot", "pace", "way"]
    """What was guessed: where a foot goes (`facts.FootWay`), whether the robot becomes faster
    (`facts.Pace`), or to which side it turns (`facts.Way`)."""
    said: _Word
    """The student's answer."""
    was: tuple[_Word, ...]
    """All correct answers."""
    leg: int = -1
    """Index of the leg; only if the guess was about a foot that was moved by one number."""
    level: int = -1
    """Level of the joint with this number: 0 is root, 1 is 1st, 2 is 2nd."""
    before_deg: float = 0.0
    """Angle of the joint before the change."""
    after_deg: float = 0.0
    """Angle of the joint after the change."""
    of_legs: int = 0
    """Number of legs of the robot."""

    @property
    def right(self) -> bool:
        """Whether the student guessed right."""
        return self.said in self.was


class TriedNumber(msgspec.Struct, frozen=True, array_like=True):
    """A number of a table in a trial that differs from the robot's start posture."""

    key: int
    posture: int
    """Index in the key's sequence; 0 in a table of postures."""
    leg: int
    level: int
    """Level of the joint: 0 is root, 1 is 1st, 2 is 2nd."""
    angle_deg: float
    start_deg: float
    """Angle of the joint in the robot's start posture."""


class Tried(_EvidenceKind, frozen=True, kw_only=True, tag="tried"):
    """The student let the robot walk."""

    version: _Word
    facts: TrialFacts
    rows: tuple[int, ...] = ()
    """The rows that the measured key used, in order: in a table of level A their digits, in a table
    of level B 1, 2 ..."""
    numbers: tuple[TriedNumber, ...] = ()
    """All numbers in the rows of the pressed keys that differ from the robot's start posture."""


class CheckedGait(_EvidenceKind, frozen=True, kw_only=True, tag="checked"):
    """The student checked a gait, as `lacoc gait check` does.

    Checks that find mistakes are not kept.
    """

    version: _Word
    keys: int
    """Number of keys, as in the reply to the check (`learner.CheckReply`)."""
    mistakes: int
    """Number of mistakes that were found; 0 in evidence that is kept."""


class Compared(_EvidenceKind, frozen=True, kw_only=True, tag="compared"):
    """A trial of the student was compared with the same trial of another version of the table."""

    version: _Word
    against: _Word
    """The other version; `SAMPLE`: the sample gait."""
    differs: tuple[Difference, ...]
    """The differences between the walks that people can see (`facts.differences`)."""


class Named(_EvidenceKind, frozen=True, kw_only=True, tag="named"):
    """The student chose a word for how the robot should walk, such as "elegant"."""

    word: _Word


class Voted(_EvidenceKind, frozen=True, kw_only=True, tag="voted"):
    """The student voted whether A (the sample) or B (the own gait) fits a word better.

    The choice is not in the evidence.
    """

    poll: _Name
    """Name of the poll: the word."""


class Coached(_EvidenceKind, frozen=True, kw_only=True, tag="coached"):
    """The student took over the coach's changes."""

    version: _Word
    size: Literal["cell", "three", "table"]
    """How much the coach was allowed to change: one number, three, or all."""


class Answered(_EvidenceKind, frozen=True, kw_only=True, tag="answered"):
    """The student answered the question that a phase asks before it is done."""

    phase: int
    """Number of the phase, from 0 to 6."""
    question: _Word
    """Name of the question, such as "margin"."""
    said: int
    """Index of the chosen answer."""
    right: bool


class Hand(_EvidenceKind, frozen=True, kw_only=True, tag="hand"):
    """The student raised a hand to ask for help, or it was taken down."""

    up: bool


Evidence = (
    JoinedClass
    | WentToPhase
    | TookStep
    | Edited
    | Guessed
    | Tried
    | CheckedGait
    | Compared
    | Named
    | Voted
    | Coached
    | Answered
    | Hand
)

_DECODER = msgspec.json.Decoder(Evidence)


def to_json(evidence: Evidence) -> bytes:
    """Encode evidence as JSON."""
    return msgspec.json.encode(evidence)


def kind_of(evidence: Evidence) -> str:
    """Return the kind of a piece of evidence, as in the field "kind" of its JSON."""
    return str(evidence.__struct_config__.tag)


def from_json(data: bytes | str) -> Evidence:
    """Decode evidence from JSON.

    Raises:
        ValueError: if the data are not evidence.
    """
    evidence: Evidence = _DECODER.decode(data)
    return evidence


def edited(before: Rows, after: Rows, version: str, by: By) -> Edited | None:
    """Return an edit of a table as evidence; None if it changed no angle.

    Args:
        before: the table before the edit.
        after: the table after the edit. New rows count as changed; removed rows do not count.
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
            before_deg = tuple(old[joint] for joint in joints) if old and known else ()
            angles_deg = tuple(angles[joint] for joint in joints)
            yield LegEdit(*place, leg, changed, angles_deg, before_deg)
