"""The newest table of somebody, with all that is needed to let a robot walk with it."""

import msgspec

from lacoc_client.workshop.design.files import sent_gait
from lacoc_client.workshop.design.table import FileTable
from lacoc_robots.seat_files import SeatFiles, with_level_b
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError


class Draft(msgspec.Struct, frozen=True, kw_only=True):
    """A table whose cells all have angles, its keys and its robot."""

    table: FileTable
    sequences: tuple[tuple[int, ...], ...] | None = None
    robot: SentFile | None = None
    """None: the workshop's."""

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
