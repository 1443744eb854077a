"""Finds robots by name or path: installed ones, folders, and single robot files.

A robot's folder holds `robot.toml`, and its sample gait as `Loco-data.txt` and
`LocoTra-data.txt`. Other people's robots are installed under the entry-point group
`lacoc.robots`, or given as a path.
"""

from pathlib import Path
from typing import NamedTuple

from lacoc_shared.command import plugins
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

GROUP = "lacoc.robots"

WORKSHOPS_ROBOT = "hexapod"
"""Name of the workshop's robot, which is used if nobody names a robot."""

GAIT_NAMES = ("Loco-data.txt", "LocoTra-data.txt")
"""Names of the gait files in a folder, by level (rules 2)."""


class FolderGait(NamedTuple):
    """The gait files that lie beside a robot file."""

    postures: SentFile | None
    """Loco-data.txt (level A); None: there is no such file."""
    locomotion: SentFile | None
    """LocoTra-data.txt (level B); None: there is no such file."""


def find_robot(name_or_path: str) -> tuple[str, bytes]:
    """Read the file of a robot, which is named or given as a path.

    Args:
        name_or_path: an installed name such as "hexapod", a folder, or a .toml file.

    Returns:
        The file's name and its content, not checked yet.

    Raises:
        UserError: if there is no such robot, or its file can't be read.
    """
    file = robot_file(name_or_path)
    return text_of(file.name), read_content(file)


def sample_gait_files(name_or_path: str) -> FolderGait:
    """Read the gait files beside a robot's file; None for a missing file.

    Raises:
        UserError: if there is no such robot, or a file can't be read.
    """
    folder = robot_folder(name_or_path)
    postures, locomotion = (
        SentFile(name, read_content(folder / name)) if (folder / name).exists() else None
        for name in GAIT_NAMES
    )
    return FolderGait(postures, locomotion)


def robot_folder(name_or_path: str) -> Path:
    """Return the folder of a robot's file; its gait files are there too.

    Raises:
        UserError: if there is no such robot.
    """
    return robot_file(name_or_path).parent


def installed_robots() -> tuple[str, ...]:
    """Return the names of the installed robots, in alphabetical order."""
    return tuple(plugins.installed(GROUP))


def robot_file(name_or_path: str) -> Path:
    """Return the path of a robot's file.

    Raises:
        UserError: if there is no such robot.
    """
    if name_or_path.endswith(".toml"):
        return Path(name_or_path).expanduser()
    return plugins.folder_of(plugins.package(GROUP, "robot", name_or_path)) / "robot.toml"


def read_content(file: Path) -> bytes:
    """Read the bytes of a file.

    Raises:
        UserError: if it can't be read.
    """
    try:
        return file.read_bytes()
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-read", path=str(file), why=why)) from None
