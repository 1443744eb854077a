"""What stands in a shared table: entries by name, each a number, a text or True.

    shape        "p6": a table of postures for six legs; "l6": one of sequences
    p6/3.0       True: the row of key 3 and posture 0 is there
    p6/3.0/14    the angle of joint 14 in this row [deg], or a text that is no angle
    p6/3.0/14?   a proposal for it, of somebody else than the row's owner (JSON)
    keys         the digits of each key of level B, such as "0,8765,1234"
    robot        the robot's file (JSON); "": the workshop's robot
    file         which file has the table (JSON); only pages read it

Names of cells begin with their shape: what somebody typed into another table can't get into this
one. A removed row keeps its cells, so that it can come back whole.
"""

import math
import re
from collections.abc import Mapping
from typing import Literal

import msgspec

from lacoc_client.workshop.design.table import FileRow, FileTable
from lacoc_client.workshop.tables.draft import Draft
from lacoc_shared.gait.tables import JOINTS_PER_LEG
from lacoc_shared.messages import SentFile

Entry = float | str | bool

ENTRIES_MOST = 8_000
"""Most entries of a table."""
TEXT_MOST = 200
"""Longest text of a cell, of a proposal or of the keys [characters]."""
LONG_MOST = 40_000
"""Longest text of a robot file, with its name, or of what is said of a file [characters]."""

_SHAPE = re.compile(r"([pl])([1-9]|[12][0-9]|3[0-2])", re.ASCII)
_PLACE = re.compile(
    rf"({_SHAPE.pattern})/([0-9])\.([0-9]|[1-9][0-9])(?:/([0-9]|[1-9][0-9])(\?)?)?", re.ASCII
)
_KINDS: dict[str, Literal["postures", "locomotion"]] = {"p": "postures", "l": "locomotion"}
_LONG = ("robot", "file")


class _ProposalEntry(msgspec.Struct, frozen=True):
    by: str


class _RobotEntry(msgspec.Struct, frozen=True):
    name: str
    text: str


def is_entry(name: object, value: object) -> bool:
    """Return whether an entry of this name may have this value."""
    if not isinstance(name, str):
        return False
    if name in _LONG:
        return isinstance(value, str) and len(value) <= LONG_MOST
    if name == "keys":
        return isinstance(value, str) and len(value) <= LONG_MOST
    if name == "shape":
        return isinstance(value, str) and _SHAPE.fullmatch(value) is not None
    place = _PLACE.fullmatch(name)
    if place is None:
        return False
    joint, proposed = place[6], place[7]
    if joint is None:
        return value is True
    if int(joint) >= JOINTS_PER_LEG * int(place[3]):
        return False
    if isinstance(value, str):
        return len(value) <= TEXT_MOST
    return not proposed and isinstance(value, float) and math.isfinite(value)


def without_proposals(entries: Mapping[str, Entry], by: str) -> dict[str, Entry]:
    """Return entries without what somebody has proposed."""
    return {
        name: value
        for name, value in entries.items()
        if not name.endswith("?") or _proposer(str(value)) != by
    }


def draft_of(entries: Mapping[str, Entry]) -> Draft | None:
    """Return the table with its keys and robot; None while a cell has no angle."""
    table = _table(entries)
    if table is None:
        return None
    robot = _robot(str(entries.get("robot", "")))
    return Draft(table=table, sequences=_sequences(entries, table), robot=robot)


def _table(entries: Mapping[str, Entry]) -> FileTable | None:
    shape = str(entries.get("shape", ""))
    found = _SHAPE.fullmatch(shape)
    if found is None:
        return None
    kind, legs = _KINDS[found[1]], int(found[2])
    places = sorted(
        (int(place[4]), int(place[5]))
        for place in map(_PLACE.fullmatch, entries)
        if place is not None and place[1] == shape and place[6] is None
    )
    rows = []
    for key, posture in places:
        cells = [
            entries.get(f"{shape}/{key}.{posture}/{joint}")
            for joint in range(JOINTS_PER_LEG * legs)
        ]
        angles = tuple(cell for cell in cells if isinstance(cell, float))
        if len(angles) < len(cells):
            return None
        rows.append(FileRow(key=key, posture=posture, angles_deg=angles))
    if not rows:
        return None
    numbered = _numbered(rows) if kind == "locomotion" else tuple(rows)
    return FileTable(kind=kind, legs=legs, rows=numbered)


def _numbered(rows: list[FileRow]) -> tuple[FileRow, ...]:
    """Close the gaps that are left where rows were removed on one page and added on another."""
    keys = sorted({row.key for row in rows})
    counts = dict.fromkeys(keys, 0)
    numbered = []
    for row in rows:
        numbered.append(
            msgspec.structs.replace(row, key=keys.index(row.key), posture=counts[row.key])
        )
        counts[row.key] += 1
    return tuple(numbered)


def _sequences(
    entries: Mapping[str, Entry], table: FileTable
) -> tuple[tuple[int, ...], ...] | None:
    """Return the digits of each key of level B; None if the table itself has them.

    A key whose postures are not all there gets the first one: each key needs postures.
    """
    keys = entries.get("keys")
    if table.kind == "locomotion" or not isinstance(keys, str):
        return None
    known = {row.key for row in table.rows}
    found = []
    for digits in keys.split(","):
        sequence = tuple(int(digit) for digit in digits if digit in "0123456789")
        fits = sequence and known.issuperset(sequence)
        found.append(sequence if fits else (table.rows[0].key,))
    return tuple(found)


def _proposer(text: str) -> str:
    try:
        return msgspec.json.decode(text, type=_ProposalEntry).by
    except msgspec.DecodeError:
        return ""


def _robot(text: str) -> SentFile | None:
    try:
        robot = msgspec.json.decode(text, type=_RobotEntry)
        return SentFile(robot.name, robot.text.encode())
    except (msgspec.DecodeError, UnicodeError):
        return None  # the workshop's
