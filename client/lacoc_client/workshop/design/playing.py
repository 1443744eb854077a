"""Lets a student play with a table of /design, at the court of `lacoc practice`."""

import threading
from pathlib import Path

from lacoc_robots.seat_files import USUAL_NAMES, SeatFiles
from lacoc_shared.command.child import Child
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class Playing:
    """Runs `lacoc practice` with files from /design; any thread may use it."""

    def __init__(self) -> None:
        self._folder = Scratch("playing")
        self._child: Child | None = None
        self._words: list[str] = []
        """The command line of the child."""
        self._url = ""
        self._lock = threading.Lock()

    def open(self, files: SeatFiles) -> str:
        """Give files to the page of `lacoc practice`; first start the command if needed.

        The start takes some seconds. A page that is open already notices the new files, and asks
        whether to use them. If there are other kinds of files than before, such as a robot of the
        student's own, the command is started again, and the page has a new address.

        Returns:
            The address of the page, with the page key.

        Raises:
            UserError: if the command does not become ready.
        """
        with self._lock:
            words = _command_line(self._write(files))
            if self._child is None or self._child.ended or words != self._words:
                self._end()
                self._child = Child(words, self._folder.path, say("child.court"))
                self._words = words
                try:
                    self._url = self._child.opened()["url"]
                except UserError:
                    self._end()
                    raise
            return self._url

    def close(self) -> None:
        """End the running `lacoc practice`, and delete the files that it was given."""
        with self._lock:
            self._end()
            self._folder.close()

    def _end(self) -> None:
        if self._child is not None:
            self._child.close()
            self._child = None

    def _write(self, files: SeatFiles) -> list[Path]:
        """Write the robot and gait files; return the paths of robot file, level A and level B."""
        paths = [self._folder.path / name for name in USUAL_NAMES]
        for path, file in zip(paths, files, strict=True):
            if file is None:
                path.unlink(missing_ok=True)
            else:
                path.write_bytes(file.data)
        return paths


def _command_line(paths: list[Path]) -> list[str]:
    robot, *gaits = paths
    words = ["practice", "--json", "--no-open"]
    if robot.exists():
        words += ["--robot", str(robot)]
    for gait in gaits:
        words += ["--gait", str(gait)] if gait.exists() else []
    return words
