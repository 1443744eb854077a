"""What stands in a shared table: entries by name, each a number, a text or True.

    shape        "p6": a table of postures for six legs; "l6": one of sequences
    p6/3.0       True: the row of key 3 is there
    l6/3.1_47    True: key 3 has a row of rank 1.47; of two rows the lower rank comes first
    p6/3.0/14    the angle of joint 14 in this row [deg], or a text that is no angle
    p6/3.0/14?   a proposal for it, of somebody else than the row's owner (JSON)
    keys         the digits of each key of level B, such as "0,8765,1234"
    robot        the robot's file (JSON); "": the workshop's robot
    file         which file has the table (JSON), or ""; only pages read it

The name of a cell begins with the shape, so a number that somebody typed into a table of another
shape can't get into this one. A removed row keeps its cells, so that it can come back complete. A
row keeps its rank while rows beside it are added or removed, so a number that is typed at the same
time stays in its row.
"""

import math
import re
from collections.abc import Mapping
from typing import TypeVar

import msgspec

from lacoc_shared.gait.tables import JOINTS_PER_LEG

Entry = float | str | bool
_S = TypeVar("_S", bound=msgspec.Struct)

ENTRIES_MOST = 8_000
"""Most entries of a table."""
TEXT_MOST = 200
"""Longest text of a cell or of a proposal [characters]."""
LONG_MOST = 40_000
"""Longest text of the keys, of a robot file with its name, or of the entry `file` [characters]."""

SHAPE = re.compile(r"([pl])([1-9]|[12][0-9]|3[0-2])", re.ASCII)
"""Matches a shape: kind and number of legs."""
PLACE = re.compile(
    rf"({SHAPE.pattern})/([0-9])\.((?:[0-9]|[1-9][0-9])(?:_[0-9]{{1,12}})?)(?:/([0-9]|[1-9][0-9])(\?)?)?",
    re.ASCII,
)
"""Matches the name of a row or a cell: shape, kind, legs, key, rank, joint, and "?" for a
proposal."""


class RobotEntry(msgspec.Struct, frozen=True):
    """The robot's file, as it is in the entry `robot`."""

    name: str
    text: str


class _FileEntry(msgspec.Struct, frozen=True, rename="camel"):
    name: str
    version: str
    digest: str
    robot_version: str | None


class _ProposalEntry(msgspec.Struct, frozen=True):
    by: str


_JSON: dict[str, type[msgspec.Struct]] = {"robot": RobotEntry, "file": _FileEntry}
"""What the JSON of an entry has; pages could not open a table with anything else."""


def is_entry(name: object, value: object) -> bool:
    """Return whether an entry of this name may have this value."""
    if not isinstance(name, str):
        return False
    if name == "keys" or name in _JSON:
        kind = _JSON.get(name)
        is_text = isinstance(value, str) and len(value) <= LONG_MOST
        return is_text and (not value or not kind or json_entry(str(value), kind) is not None)
    if name == "shape":
        return isinstance(value, str) and SHAPE.fullmatch(value) is not None
    place = PLACE.fullmatch(name)
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
    """Return entries without the proposals of one person."""
    return {
        name: value
        for name, value in entries.items()
        if not name.endswith("?") or _proposer(str(value)) != by
    }


def json_entry(text: str, kind: type[_S]) -> _S | None:
    """Decode an entry that is JSON; None if it is not of this kind."""
    try:
        return msgspec.json.decode(text, type=kind)
    except (msgspec.DecodeError, UnicodeError, RecursionError):
        return None


def _proposer(text: str) -> str:
    proposal = json_entry(text, _ProposalEntry)
    return "" if proposal is None else proposal.by
