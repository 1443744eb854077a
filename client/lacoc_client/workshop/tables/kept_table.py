"""Finds a student's table in a class file, also in one of an earlier version of the program."""

from collections.abc import Iterable

import msgspec

from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.tables.document import document_of
from lacoc_client.workshop.tables.entries import Entry
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError

TABLE = "table"
"""Name of the document with a student's table."""
_DRAFT = "draft"


class _OldDraft(msgspec.Struct, frozen=True, kw_only=True):
    table: FileTable
    sequences: tuple[tuple[int, ...], ...] | None = None
    robot: SentFile | None = None
    file: str = ""
    file_version: str = ""
    robot_version: str | None = None


def kept_table(documents: Iterable[Document]) -> Document | None:
    """Return the table in the documents of a student; None: there is none, or no readable draft.

    A draft that an earlier version of the program wrote is turned into a table.
    """
    kept = {one.name: one for one in documents}
    if TABLE in kept or _DRAFT not in kept:
        return kept.get(TABLE)
    draft = kept[_DRAFT]
    try:
        old = msgspec.msgpack.decode(draft.content, type=_OldDraft)
        state = document_of(_entries_of(old)).state
    except (msgspec.DecodeError, UnicodeError, UserError):
        return None  # of another version of this program
    return Document(draft.student, TABLE, "", draft.at_s, state)


def _entries_of(draft: _OldDraft) -> dict[str, Entry]:
    table, robot = draft.table, draft.robot
    shape = f"{table.kind[0]}{table.legs}"
    # Nothing says whether the file has this table: the page asks before it saves over another one.
    file = {
        "name": draft.file,
        "version": draft.file_version,
        "digest": "",
        "robotVersion": draft.robot_version,
    }
    entries: dict[str, Entry] = {
        "shape": shape,
        "keys": ",".join("".join(map(str, digits)) for digits in draft.sequences or ()),
        "robot": "",
        "file": msgspec.json.encode(file).decode(),
    }
    if robot is not None:
        text = {"name": robot.name, "text": robot.data.decode()}
        entries["robot"] = msgspec.json.encode(text).decode()
    for row in table.rows:
        name = f"{shape}/{row.key}.{row.posture}"
        entries[name] = True
        entries |= {f"{name}/{joint}": float(angle) for joint, angle in enumerate(row.angles_deg)}
    return entries
