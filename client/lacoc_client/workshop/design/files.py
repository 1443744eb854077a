"""The content of gait and robot files: from bytes to a table or a robot's text, and back."""

from dataclasses import dataclass
from pathlib import PurePath

from lacoc_client.workshop.design.saving.text_edit import edit_text
from lacoc_client.workshop.design.saving.workbook_edit import edit_workbook, formulas_in
from lacoc_client.workshop.design.table import FileTable, gait_of, page_table
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.tables import LocomotionTable
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook.file import read_workbook, write_workbook
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

_WORKBOOK, _ROBOT = ".xlsx", ".toml"
_PACKED = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")  # workbooks, also old ones


@dataclass(frozen=True)
class FileContent:
    """The content of a gait or robot file: a table, or the robot file's text."""

    table: FileTable | None = None
    robot: str | None = None
    notes: tuple[Phrase, ...] = ()
    """Remarks on things that are no mistakes, but perhaps not intended."""


def read_file(name: str, data: bytes) -> FileContent:
    """Read a gait file or a robot file.

    The content, not the name, decides whether a gait file is a workbook or text, whether it is a
    file of postures (level A) or of locomotion (level B), and for how many legs.

    Raises:
        FileRefused: with every mistake of a gait file.
        UserError: if a robot file is not UTF-8 text.
    """
    if _suffix(name) == _ROBOT:
        try:
            return FileContent(robot=data.decode("utf-8-sig"))
        except UnicodeDecodeError:
            raise UserError(say("design.no-text", name=name)) from None
    notes: list[Phrase] = []
    read = read_workbook if data.startswith(_PACKED) else read_gait
    gait = read(data, name, notes=notes)
    if read is read_workbook and (count := formulas_in(data, name, gait.joints)):
        notes.append(say("design.formulas", file=name, count=count))
    return FileContent(table=page_table(gait), notes=tuple(notes))


def file_bytes(name: str, content: FileTable | str, before: bytes | None = None) -> bytes:
    """Return the bytes of a gait or robot file, in the format that its suffix asks for.

    Args:
        name: name of the file.
        content: the table, or a robot file's text.
        before: the file as it is now; all of it but the postures is kept if the content is a table
            of postures. None: there is no file.

    Raises:
        FileRefused: with every mistake of the table, or of the workbook to change.
        UserError: if a file with this suffix can't have this content, if the workbook would lose
            something, or if a locomotion table has no row of a key below its highest key.
    """
    if isinstance(content, str):
        if _suffix(name) != _ROBOT:
            raise UserError(say("design.bad-name", name=name))
        return content.encode()
    if _suffix(name) == _ROBOT:
        raise UserError(say("design.bad-name", name=name))
    gait = gait_of(content, name)
    if isinstance(gait, LocomotionTable):
        if _suffix(name) == _WORKBOOK:
            raise UserError(say("design.sequences-in-workbook", name=name))
        return write_gait(gait, leg_labels(content.legs))
    if before is not None:
        edit = edit_workbook if _suffix(name) == _WORKBOOK else edit_text
        return edit(before, name, gait)
    write = write_workbook if _suffix(name) == _WORKBOOK else write_gait
    return write(gait, leg_labels(content.legs))


def sent_gait(table: FileTable) -> SentFile:
    """Return a table as a gait file that can be sent, under the usual name of such a file.

    Raises:
        FileRefused: with every mistake of the table.
        UserError: if a locomotion table has no row of a key below its highest key.
    """
    gait = gait_of(table, table.file_name)
    return SentFile(table.file_name, write_gait(gait, leg_labels(table.legs)))


def _suffix(name: str) -> str:
    return PurePath(name).suffix.lower()
