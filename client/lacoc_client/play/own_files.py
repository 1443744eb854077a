"""A contestant's files on this machine, read again when they change."""

from collections.abc import Sequence
from pathlib import Path

from lacoc_robots.library import GAIT_NAMES, robot_file
from lacoc_robots.seat_files import SeatFiles, gaits_in, gather
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import Phrase

_Saved = tuple[tuple[Path, int, int], ...]
"""Each file with its modification time [ns] and size [bytes]."""


class OwnFiles:
    """The robot and gait files on this machine that a page sends, unless its user chose others.

    Args:
        robot: an installed robot, a folder or a robot file; None: the contest's.
        gaits: gait files; none: the newest of each kind in `folder`, else those beside the robot.
        folder: where gait files are looked for.

    Raises:
        FileRefused: with every mistake of every gait file.
        UserError: if a file can't be read, or two are for the same level.
    """

    def __init__(
        self, robot: str | None = None, gaits: Sequence[Path] = (), folder: Path = Path()
    ) -> None:
        self._robot = robot
        self._robot_file = None if robot is None else robot_file(robot)
        self._gaits = tuple(gaits)
        self._folder = folder
        self._read_as = self._seen = self._saved()
        self.notes: list[Phrase] = []
        """Remarks on things in the files that are legal, but probably not meant."""
        self.files = self._read()
        self.version = 1
        """Number of the version; it grows with each change of the files."""
        self.changed: tuple[str, ...] = ()
        """Names of the files that the newest version changed, added or removed."""
        self.refused: FileRefused | UserError | None = None
        """Why the newest version can't be used; then `files` stays at the version before it. None:
        it can be used."""

    def look(self) -> bool:
        """Read the files again if they have changed; return whether there is a new version.

        A file that is still being written is read at a later call.
        """
        now = self._saved()
        if now == self._read_as or now != self._seen:
            self._seen = now
            return False
        changed = {path.name for path, *_ in {*now} ^ {*self._read_as}}
        self._read_as = now
        try:
            files = self._read()
        except (FileRefused, UserError) as refused:
            self.refused = refused
        else:
            if files == self.files and self.refused is None:
                return False
            self.files, self.refused = files, None
        self.changed = tuple(sorted(changed))
        self.version += 1
        return True

    def _read(self) -> SeatFiles:
        self.notes = []
        return gather(self._robot, self._gaits or gaits_in(self._folder), self.notes)

    def _saved(self) -> _Saved:
        paths = [*(self._gaits or gaits_in(self._folder))]
        if (robot := self._robot_file) is not None:
            paths += [robot, *(robot.parent / name for name in GAIT_NAMES if not paths)]
        saved = []
        for path in paths:
            try:
                stat = path.stat()
            except OSError:  # it is missing, or is being replaced right now
                continue
            saved.append((path, stat.st_mtime_ns, stat.st_size))
        return tuple(saved)
