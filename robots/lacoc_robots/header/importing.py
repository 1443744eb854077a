"""Writes a robot file from the values of the workshop's C files (workshop 4-3)."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import tomlkit

from lacoc_robots.header.c_values import Unread, Value, read_c
from lacoc_shared.gait.tables import JOINTS_PER_LEG
from lacoc_shared.mistakes import printable
from lacoc_shared.words import LANGUAGES, Phrase, render, say

DEFAULTS = {
    "ROBOT_BODY_W": 0.1,
    "ROBOT_BODY_D": 0.12,
    "ROBOT_BODY_H": 0.05,
    "ROBOT_LEG_R": 0.015,
    "ROBOT_LEG_L": 0.04,
    "AngMin": 1.2,
}
"""The workshop's own numbers, used in place of values that a file does not have."""
_SIDES = ("ROBOT_BODY_W", "ROBOT_BODY_D", "ROBOT_BODY_H")
_NAMES = (*DEFAULTS, "RJOINT_NUM", "Start_Pos", "Robot_weight", "Joint_Angle")
_PLACES = ("Rjoint_x", "Rjoint_y", "Rjoint_z")
_WEIGHTS_KG = (0.125, 0.055)
_ROOTS_DEG = (45, 0, -45, -45, 0, 45)
_LIFT_DEG = 20.0
_ANG_MIN_TICKS_S = 100
"""Factor from AngMin in the C file (degrees in 10 ms) to degrees a second (rules 1)."""
_RANGE_DEG = "[-150, 150]"
_JOINTS, _MOST_JOINTS = 18, 300


class CFile(NamedTuple):
    """A C file of the workshop: its name and its text."""

    name: str
    text: str


class Imported(NamedTuple):
    """A robot file made from C files, with notes on values that did not come from them."""

    toml: str
    notes: tuple[Phrase, ...]


def import_robot(sources: Sequence[CFile], name: str) -> Imported:
    """Make a robot file of the workshop's header and, if it is given, of its main file.

    If a value is missing or can't be read, the robot file gets the workshop's own value, and a note
    says so. The file is not weighed in yet: its values may be beyond the limits.

    Args:
        sources: the C files; if several give a value, that of the last file counts.
        name: the robot's name.
    """
    values: dict[str, Value] = {}
    places: dict[str, str] = {}
    unread: dict[str, tuple[str, Unread]] = {}
    notes = []
    for source in sources:
        read = read_c(source.text)
        values |= read.values
        places |= {key: f"{source.name}, line {line}" for key, line in read.lines.items()}
        wanted = [one for one in read.unread if one.name in (*_NAMES, *_PLACES)]
        unread |= {one.name: (source.name, one) for one in wanted}
        again = {one.name: one.line for one in read.unread if one.name in read.values}
        for key, other in (read.others | again).items():
            line = read.lines[key]
            notes.append(say("header.again", file=source.name, name=key, other=other, line=line))
    for given in values:
        unread.pop(given, None)
    header = _HeaderRobot(values, places)
    lines = [*header.toml(name)]
    for file, one in unread.values():
        notes.append(say("header.not-read", file=file, line=one.line, name=one.name, why=one.why))
        lines += ["", f"# Not read: {file}, line {one.line}: {printable(one.text, 160)}"]
    told = {*unread, *header.wrong}
    notes += [note for names, note in header.missing if told.isdisjoint(names)]
    return Imported("\n".join(lines) + "\n", (*notes, *header.wrong.values()))


class _HeaderRobot:
    """The robot that the C files describe."""

    def __init__(self, values: dict[str, Value], places: dict[str, str]) -> None:
        self._values = values
        self._places = places
        self.missing: list[tuple[Sequence[str], Phrase]] = []
        """For each value that is the workshop's own: the names that could have given it in the C
        files, and a note."""
        self.wrong: dict[str, Phrase] = {}
        """For each name whose value is there but can't be used: a note."""
        self._w, self._d, self._h = map(self._side, _SIDES)
        self._radius, self._link, self._ang_min = (
            self._number(name) for name in DEFAULTS if name not in _SIDES
        )
        self._legs = self._joints() // JOINTS_PER_LEG
        start = self._list("Start_Pos", 3)
        self._start = start or (0.0, 0.0, self._link + self._radius)
        if start is None:
            self._miss(_shown(self._start[2]), "Start_Pos")

    def toml(self, name: str) -> Iterator[str]:
        """Return the lines of the robot file that is made."""
        yield f"# Made by 'lacoc robot import'. {render(say('header.look'), LANGUAGES[0])}"
        yield ""
        yield f"name = {tomlkit.string(name).as_string()}"
        yield ""
        yield "[body]"
        size = ", ".join(map(_shown, (self._w, self._d, self._h)))
        yield f"size_m = [{size}]  # {self._from(*_SIDES)}"
        body_kg, links_kg = self._weights()
        yield f"mass_kg = {_shown(body_kg)}  # {self._from('Robot_weight')}"
        yield ""
        yield "[start]"
        yield f"height_m = {_shown(self._start[2])}  # {self._from('Start_Pos')}"
        yield "posture_deg = ["
        angles = self._posture()
        for level in range(JOINTS_PER_LEG):
            row = angles[level * self._legs : (level + 1) * self._legs]
            yield f"  {', '.join(map(_shown, row))},"
        yield f"]  # {self._from('Joint_Angle')}"
        yield ""
        yield "[drive]"
        speed = _shown(self._ang_min * _ANG_MIN_TICKS_S)
        yield f"ang_min_deg_s = {speed}  # {self._from('AngMin')}, in degrees for each 10 ms"
        yield ""
        yield "[link]"
        length = _shown(self._link + 2 * self._radius)
        yield f"lengths_m = [{_shown(self._radius)}, {length}, {length}]"
        yield f"radius_m = {_shown(self._radius)}  # {self._from('ROBOT_LEG_R', 'ROBOT_LEG_L')}"
        yield f"masses_kg = [{', '.join(map(_shown, links_kg[0]))}]"
        yield f"range_deg = {_RANGE_DEG}"
        for leg, (x, y, z) in enumerate(self._hinges()):
            label = _label(leg, self._legs)
            shares = (2 * x / self._w, 2 * y / self._d, 2 * z / self._h)
            is_on_body = all(abs(round(share, 6)) <= 1 for share in shares)  # as it is written
            entry, place = ("on_body", shares) if is_on_body else ("position_m", (x, y, z))
            yield ""
            yield "[[leg]]"
            yield f'label = "{label}"'
            yield f"{entry} = [{', '.join(map(_shown, place))}]"
            yield f"outward_deg = {0 if x > 0 else 180}"
            if links_kg[leg] != links_kg[0]:
                yield f"masses_kg = [{', '.join(map(_shown, links_kg[leg]))}]"
            if leg in (0, self._legs - 1):
                yield "accent = true"

    def _joints(self) -> int:
        name = "RJOINT_NUM"
        count = self._values.get(name, _JOINTS)
        if isinstance(count, int) and JOINTS_PER_LEG <= count <= _MOST_JOINTS:
            return count
        where, low = self._places.get(name, ""), JOINTS_PER_LEG
        self.wrong[name] = say("header.joints", name=name, place=where, low=low, high=_MOST_JOINTS)
        return _JOINTS

    def _side(self, name: str) -> float:
        """Return the length of a side of the body [m]; the places of legs are shares of it."""
        length = self._number(name)
        if round(length, 6):  # as it is written
            return length
        self.wrong[name] = say("header.no-side", name=name, place=self._places.get(name, ""))
        return DEFAULTS[name]

    def _number(self, name: str) -> float:
        value = self._values.get(name)
        if isinstance(value, int | float):
            return float(value)
        self._miss(_shown(DEFAULTS[name]), name)
        return DEFAULTS[name]

    def _list(self, name: str, count: int) -> tuple[float, ...] | None:
        """Return the numbers of a list in the C files; as in C, those left out are 0.

        Returns:
            None if there is no list of this name, or it can't be used.
        """
        value = self._values.get(name)
        if value is None:
            return None
        items = value if isinstance(value, tuple) else ()
        numbers = [float(one) for one in items if isinstance(one, int | float)]
        if not numbers or len(numbers) != len(items) or len(numbers) > count:
            where = self._places.get(name, "")
            self.wrong[name] = say("header.entries", name=name, place=where, count=count)
            return None
        return (*numbers, *[0.0] * (count - len(numbers)))

    def _miss(self, value: Phrase | str, *names: str) -> None:
        note = say("header.missing", name=", ".join(names), value=value)
        self.missing.append((names, note))

    def _weights(self) -> tuple[float, list[tuple[float, ...]]]:
        """Return the masses of the body and of each leg's links [kg]."""
        legs = self._legs
        weights = self._list("Robot_weight", 1 + JOINTS_PER_LEG * legs)
        if weights is None:
            body, link = _WEIGHTS_KG
            self._miss(f"{body}, {link}, ...", "Robot_weight")
            weights = (body, *[link] * (JOINTS_PER_LEG * legs))
        return weights[0], [weights[1 + leg :: legs] for leg in range(legs)]

    def _posture(self) -> tuple[float, ...]:
        """Return the robot's start posture [degrees], by joint id."""
        angles = self._list("Joint_Angle", JOINTS_PER_LEG * self._legs)
        if angles is not None:
            return tuple(math.degrees(angle) for angle in angles)
        self._miss("45, 0, -45, ...", "Joint_Angle")
        roots = [*_ROOTS_DEG] if self._legs == len(_ROOTS_DEG) else [0] * self._legs
        return (*roots, *[_LIFT_DEG] * self._legs, *[0.0] * self._legs)

    def _hinges(self) -> list[tuple[float, ...]]:
        """Return where each leg is fixed to the body, from the middle of the body [m]."""
        joints = JOINTS_PER_LEG * self._legs
        axes = [self._list(name, joints) for name in _PLACES]
        start_x, start_y, start_z = self._start
        if all(axis is not None for axis in axes):
            middle = (start_x, start_y, start_z + 0.5 * self._h)
            roots = zip(*(axis[: self._legs] for axis in axes if axis is not None), strict=True)
            return [tuple(a - b for a, b in zip(root, middle, strict=True)) for root in roots]
        self._miss(say("header.places"), *_PLACES)
        a_side = self._legs // 2
        step = 2 / max(1, a_side - 1)
        reach_m = 0.5 * self._d - self._radius
        right = [reach_m * (1 - step * leg) for leg in range(a_side)]
        z = self._radius - 0.5 * self._h
        x = 0.5 * self._w
        return [*((x, y, z) for y in right), *((-x, y, z) for y in reversed(right))]

    def _from(self, *names: str) -> str:
        """Return a comment: where the values were found, or that they are the workshop's own."""
        places = [self._places[name] for name in names if name in self._places]
        return "; ".join(dict.fromkeys(places)) or "the workshop's own"


def _label(leg: int, legs: int) -> str:
    a_side = legs // 2
    side, row = ("R", leg) if leg < a_side else ("L", legs - 1 - leg)
    rows = {2: ("F", "B"), 3: ("F", "C", "B")}.get(a_side)
    return f"{side},{rows[row] if rows else row + 1}"


def _shown(value: float) -> str:
    return f"{round(value, 6) + 0.0:.6g}"
