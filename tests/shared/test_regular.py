"""Files of a folder that a stranger may have made: regular ones are read, and nothing else."""

import os
import sys
from pathlib import Path

import pytest

from lacoc_shared.command import regular
from lacoc_shared.mistakes import UserError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pipes by name")


def code(folder: Path, *names: str, most_bytes: int = 100) -> str:
    """Return the code of the error with which a file is refused."""
    with pytest.raises(UserError) as raised:
        regular.read(folder, *names, most_bytes=most_bytes)
    return raised.value.phrase.code


def test_a_regular_file_is_read(tmp_path: Path) -> None:
    """A file is read whole if it is not larger than allowed; the folder itself may be a link."""
    (tmp_path / "real" / "a").mkdir(parents=True)
    (tmp_path / "real" / "a" / "b").write_bytes(b"x" * 100)
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert regular.read(tmp_path / "link", "a", "b", most_bytes=100) == b"x" * 100
    assert regular.names(tmp_path / "link", "a") == ["b"]
    assert regular.names(tmp_path / "link", "c") == []
    assert code(tmp_path / "real", "a", "b", most_bytes=99) == "regular.too-large"


def test_what_is_no_regular_file_is_refused_at_once(tmp_path: Path) -> None:
    """A link, a pipe without a writer, a device, a folder and a linked folder are refused."""
    (tmp_path / "file").write_bytes(b"x")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "file").write_bytes(b"x")
    (tmp_path / "to-file").symlink_to(tmp_path / "file")
    (tmp_path / "to-zero").symlink_to("/dev/zero")
    (tmp_path / "to-folder").symlink_to(tmp_path / "folder")
    os.mkfifo(tmp_path / "pipe")
    for name in ("to-file", "to-zero", "pipe", "folder"):
        assert code(tmp_path, name) == "regular.no-file"
        assert not regular.is_regular(tmp_path / name)
    assert code(tmp_path, "to-folder", "file") == "regular.no-folder"
    assert code(tmp_path, "file", "file") == "regular.no-folder"
    with pytest.raises(UserError):
        regular.names(tmp_path, "to-folder")
    assert code(Path("/dev"), "zero") == "regular.no-file"


@pytest.mark.parametrize("name", ["", ".", "..", "a/b", "/etc/passwd", "\0", "../x"])
def test_no_name_leads_out_of_the_folder(tmp_path: Path, name: str) -> None:
    """A name that is none of a file in the folder is refused."""
    assert code(tmp_path, name) == "regular.bad-name"
    assert not regular.is_regular(tmp_path / "\0")


def test_a_missing_file_is_told_apart(tmp_path: Path) -> None:
    """A file that is not there is missing; one that can't be there is refused."""
    with pytest.raises(regular.Missing):
        regular.read(tmp_path, "none", most_bytes=1)
    with pytest.raises(regular.Missing):
        regular.read(tmp_path, "none", "none", most_bytes=1)
    assert code(tmp_path, "x" * 5000) == "command.cannot-read"
