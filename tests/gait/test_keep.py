"""Writing a file never overwrites an older one (workshop 4-1, rules 2)."""

import subprocess
import sys
import threading
from pathlib import Path

import pytest

from lacoc_shared.command.keep import make_room, save
from lacoc_shared.mistakes import UserError


def test_older_files_are_kept_with_numbers(tmp_path):
    """Saving keeps each older file under the next free number."""
    path = tmp_path / "Loco-data.txt"
    assert save(path, b"one") is None
    assert save(path, b"two") == tmp_path / "Loco-data.1.txt"
    assert save(path, b"three") == tmp_path / "Loco-data.2.txt"
    contents = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert contents == {
        "Loco-data.txt": b"three",
        "Loco-data.1.txt": b"one",
        "Loco-data.2.txt": b"two",
    }


def test_a_number_that_is_taken_is_left_alone(tmp_path):
    """Saving does not overwrite a file that already has the next number."""
    (tmp_path / "a.1").write_bytes(b"mine")
    (tmp_path / "a").write_bytes(b"old")
    assert save(tmp_path / "a", b"new") == tmp_path / "a.2"
    assert (tmp_path / "a.1").read_bytes() == b"mine"


def test_making_room_without_a_file(tmp_path):
    """`make_room` creates and renames nothing where no file is in the way."""
    assert make_room(tmp_path / "a.txt") is None
    assert make_room(tmp_path / "none" / "a.txt") is None
    assert list(tmp_path.iterdir()) == []


def test_a_link_is_moved_not_followed(tmp_path):
    """Saving over a link renames the link itself, even when its target is missing."""
    (tmp_path / "a.txt").symlink_to(tmp_path / "gone.txt")
    assert save(tmp_path / "a.txt", b"new") == tmp_path / "a.1.txt"
    assert (tmp_path / "a.1.txt").is_symlink()
    assert not (tmp_path / "gone.txt").exists()


def test_what_cannot_be_written_is_said(tmp_path):
    """Saving over a folder, or into a missing folder, raises UserError with the reason."""
    with pytest.raises(UserError, match="a folder has this name"):
        save(tmp_path, b"")
    with pytest.raises(UserError, match="No such file or directory"):
        save(tmp_path / "none" / "a.txt", b"")


def test_writers_at_once_lose_nothing(tmp_path):
    """Threads that save the same file at the same moment keep every version."""
    path = tmp_path / "a.txt"
    writers = [threading.Thread(target=save, args=(path, str(n).encode())) for n in range(8)]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert sorted(file.read_text() for file in tmp_path.iterdir()) == list("01234567")


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of a file's size")
def test_a_full_disk_leaves_no_part_of_a_file(tmp_path: Path) -> None:
    """If the disk takes only a part, that part is removed and the older file has its name again."""
    program = (
        "import resource, signal, sys\n"
        "from pathlib import Path\n"
        "from lacoc_shared.command.keep import save\n"
        "from lacoc_shared.mistakes import UserError\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))\n"
        "for name in ('old.txt', 'new.txt'):\n"
        "    try:\n"
        "        save(Path(name), bytes(1000))\n"
        "    except UserError as error:\n"
        "        print(error)\n"
    )
    (tmp_path / "old.txt").write_text("older")
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True
    )

    assert [line.split(":")[0] for line in done.stdout.splitlines()] == [
        "Cannot write old.txt",
        "Cannot write new.txt",
    ], done.stdout
    assert {one.name: one.read_text() for one in tmp_path.iterdir()} == {"old.txt": "older"}
