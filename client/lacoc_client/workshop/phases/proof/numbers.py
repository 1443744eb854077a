"""Finds which numbers of a table are a student's own, and have changed since a phase began.

A number is *typed* if the student typed it by hand into its cell, before the same number came there
in another way. It is *made* if a tool or a paste put it there, and the student had typed the same
number for such a joint (Root, 1st or 2nd) before. It is *given* if it came from the lesson, or if
a tool or a paste copied it from there: it may be in the table, but is not counted. Any other
number is *foreign*: it was pasted, or it came with a file, from the coach, or from the teacher.
Numbers of the robot's start posture are none of these.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from lacoc_client.workshop.phases.evidence import (
    Edited,
    Evidence,
    Guessed,
    LegEdit,
    Tried,
    TriedNumber,
)

NUMBER_DEG = 10.0
"""A number counts if it changes a posture by at least this since the phase began [deg]."""
RECENT_MOVES = 6
"""A guess does not count if its move is one of so many that the student has seen last. A robot of
four legs has 24 moves, so there is always another one to guess."""

_Place = tuple[int, int, int, int]
"""Key, posture, leg and level of a cell."""
_Move = tuple[int, int, bool]
"""Leg and level of a joint, and whether its angle became larger."""
_Source = Literal["typed", "made", "given", "foreign"]
_DIGITS = 3
_COPIES = ("tool", "paste")


def is_apart(one_deg: float, other_deg: float) -> bool:
    """Return whether two angles differ enough for the change to count."""
    return round(abs(one_deg - other_deg), _DIGITS) >= NUMBER_DEG


@dataclass(frozen=True)
class OwnTrial:
    """A trial, and how many numbers in the rows that it used are typed, made and foreign."""

    tried: Tried
    typed: int
    """How many numbers were typed, and differ by at least `NUMBER_DEG` from the number in the same
    cell before the first change that counts."""
    made: int
    """How many numbers were made from typed ones, and differ as much as `typed` asks for."""
    foreign: tuple[TriedNumber, ...]
    """The numbers that are foreign, also those that did not change in this phase."""

    @property
    def is_own(self) -> bool:
        """Whether the gait is the student's: some numbers are typed or made, none is foreign."""
        return self.typed + self.made > 0 and not self.foreign


def own_trials(evidence: Sequence[Evidence], start: int) -> list[OwnTrial]:
    """Find for each trial where the numbers in the rows that it used came from.

    Args:
        evidence: all evidence of a student, in order.
        start: trials and changes from this index on count.
    """
    cells, found = _Cells(), []
    for at, one in enumerate(evidence):
        if isinstance(one, Edited):
            cells.take(one, at >= start)
        elif isinstance(one, Tried) and at >= start:
            found.append(cells.judge(one))
    return found


class _Cells:
    """The cells of a table, with the way in which each number came into them."""

    def __init__(self) -> None:
        self._sources: dict[tuple[_Place, float], _Source] = {}
        """How each number first came into a cell."""
        self._typed: set[tuple[int, float]] = set()
        """Each number that was typed by hand, in any cell, with the level of its joint."""
        self._given: set[tuple[int, float]] = set()
        """Each number that came from the lesson, with the level of its joint."""
        self._base: dict[_Place, float | None] = {}
        """The number in each changed cell before the first change that counts; None: the row is
        new."""

    def take(self, edit: Edited, counts: bool) -> None:
        """Note an edit.

        Args:
            edit: the edit.
            counts: whether the edit belongs to the phase.
        """
        for leg in edit.legs:
            for level in leg.changed:
                place = (leg.key, leg.posture, leg.leg, level)
                angle = round(leg.angles_deg[level], _DIGITS)
                before = round(leg.before_deg[level], _DIGITS) if leg.before_deg else None
                if before is not None:  # whatever was there before the student typed
                    self._sources.setdefault((place, before), "foreign")
                if edit.by == "hand":
                    self._typed.add((level, angle))
                elif edit.by == "lesson":
                    self._given.add((level, angle))
                self._sources.setdefault((place, angle), self._source(edit, level, angle))
                if counts:
                    self._base.setdefault(place, before)

    def judge(self, tried: Tried) -> OwnTrial:
        """Find which numbers in the rows of a trial are typed, made and foreign."""
        counts = {"typed": 0, "made": 0}
        foreign = []
        for number in tried.numbers:
            place = (number.key, number.posture, number.leg, number.level)
            angle = round(number.angle_deg, _DIGITS)
            source = self._sources.get((place, angle), "foreign")
            base = self._base.get(place, angle)
            if base is None:
                base = number.start_deg
            if source == "foreign":
                foreign.append(number)
            elif source != "given" and is_apart(angle, base):
                counts[source] += 1
        return OwnTrial(tried, **counts, foreign=tuple(foreign))

    def _source(self, edit: Edited, level: int, angle: float) -> _Source:
        if edit.by == "hand":
            return "typed"
        if edit.by == "lesson":
            return "given"
        if edit.by in _COPIES and (level, angle) in self._typed:
            return "made"
        return "given" if edit.by in _COPIES and (level, angle) in self._given else "foreign"


@dataclass(frozen=True)
class LegNumbers:
    """How many joints and postures of one leg a student has changed by typing."""

    joints: int
    """How many of the leg's three joints were turned by at least `NUMBER_DEG`."""
    postures: int
    """How many typed postures of the leg differ by `NUMBER_DEG` from each other, and from the leg's
    posture before the first edit."""


def leg_numbers(evidence: Sequence[Evidence]) -> list[LegNumbers]:
    """Return for each leg how many joints and postures of it a student has changed by typing."""
    joints: dict[int, set[int]] = {}
    postures: dict[int, list[tuple[float, ...]]] = {}
    for leg in _typed_legs(evidence):
        turned = [level for level in leg.changed if _is_turned(leg, level)]
        joints.setdefault(leg.leg, set()).update(turned)
        seen = postures.setdefault(leg.leg, [leg.before_deg])
        if turned and all(_apart(leg.angles_deg, one) for one in seen):
            seen.append(leg.angles_deg)
    return [LegNumbers(len(joints[leg]), len(postures[leg]) - 1) for leg in joints]


def foot_guesses(evidence: Sequence[Evidence], start: int = 0) -> list[Guessed]:
    """Return, in order, a student's guesses of where a foot goes, without those that don't count.

    A guess counts if one number of one leg was changed by `NUMBER_DEG`, and this joint did not turn
    in this direction in one of the last `RECENT_MOVES` moves that the student has seen.

    Args:
        evidence: all evidence of a student, in order.
        start: guesses from this index on are returned.
    """
    seen: list[_Move] = []
    newest: list[_Move] = []  # what the last edit has shown; its guess comes after it
    found = []
    for at, one in enumerate(evidence):
        if isinstance(one, Edited):
            seen = _recent(seen, newest)
            newest = _moves(one)
        elif isinstance(one, Guessed) and one.about == "foot" and one.level >= 0:
            move = (one.leg, one.level, one.after_deg > one.before_deg)
            is_large = is_apart(one.after_deg, one.before_deg)
            if is_large and move not in seen and at >= start:
                found.append(one)
            seen = _recent(seen, [*newest, move] if is_large else newest)
            newest = []
    return found


def _recent(seen: list[_Move], more: list[_Move]) -> list[_Move]:
    """Return the last different moves of both lists, the newest last."""
    newest_first = dict.fromkeys(reversed([*seen, *more]))
    return [*newest_first][:RECENT_MOVES][::-1]


def _moves(edit: Edited) -> list[_Move]:
    """Return which joints an edit has turned, and in which direction; none if it was not typed."""
    if edit.by != "hand":
        return []
    return [
        (leg.leg, level, leg.angles_deg[level] > leg.before_deg[level])
        for leg in edit.legs
        if leg.before_deg
        for level in leg.changed
        if _is_turned(leg, level)
    ]


def _typed_legs(evidence: Sequence[Evidence]) -> list[LegEdit]:
    """Return the edits of legs that the student typed, except those that filled new rows."""
    edits = (one for one in evidence if isinstance(one, Edited) and one.by == "hand")
    return [leg for edit in edits for leg in edit.legs if leg.before_deg]


def _is_turned(leg: LegEdit, level: int) -> bool:
    return is_apart(leg.angles_deg[level], leg.before_deg[level])


def _apart(one: Sequence[float], other: Sequence[float]) -> bool:
    return any(is_apart(a, b) for a, b in zip(one, other, strict=True))
