"""The newest table of a student, kept so that nothing is lost when a program ends."""

import msgspec

from lacoc_client.workshop.design.files import sent_gait
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import Document
from lacoc_robots.seat_files import SeatFiles, with_level_b
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError

NAME = "draft"
"""Name under which a draft is kept."""


class Draft(msgspec.Struct, frozen=True, kw_only=True):
    """A table as it was last seen on a page, with all that is needed to go on with it."""

    table: FileTable
    sequences: tuple[tuple[int, ...], ...] | None = None
    robot: SentFile | None = None
    """None: the workshop's."""
    file: str = ""
    """Name of the file that was open; "": none."""
    file_version: str = ""
    """Version of that file that the table was made from."""
    saved: bool = False
    """Whether the files have this table and this robot."""
    robot_version: str | None = None
    """Version of the file that the robot was made from, if that file lacks changes of the robot;
    "": the robot has no file; None: nothing is lacking."""

    def kept(self, student: str, version: str, at_s: float) -> Document:
        """Return the draft as a class file keeps it."""
        return Document(student, NAME, version, at_s, msgspec.msgpack.encode(self))

    def files(self) -> SeatFiles:
        """Return the files of a match: robot, postures and locomotion.

        There is no locomotion file if keys use postures that the table does not have.

        Raises:
            FileRefused: with every mistake of the table.
            UserError: if a key of a locomotion table is missing.
        """
        gait = sent_gait(self.table)
        if self.table.kind == "locomotion":
            return SeatFiles(self.robot, None, gait)
        files = SeatFiles(self.robot, gait)
        try:
            return with_level_b(files, self.sequences)
        except UserError:
            return files


def read_draft(kept: Document) -> Draft | None:
    """Decode a kept draft; None if it is of another version of this program."""
    try:
        return msgspec.msgpack.decode(kept.content, type=Draft)
    except (msgspec.DecodeError, UnicodeDecodeError):
        return None
