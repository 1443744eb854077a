"""Folders of programs that have gone are removed, and nothing else is."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lacoc_shared.command import holding, scratch
from lacoc_shared.command.scratch import Scratch, sweep

_HOLDS = """
import pathlib, sys
from lacoc_shared.command.scratch import Scratch
one = Scratch("x", pathlib.Path(sys.argv[1]))
(one.path / "a").write_text("a")
print(one.path, flush=True)
sys.stdin.read()
"""


def _other(parent: Path) -> tuple["subprocess.Popen[str]", Path]:
    """Start a program that has such a folder; return it and the folder."""
    process = subprocess.Popen(
        [sys.executable, "-c", _HOLDS, str(parent)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    return process, Path(process.stdout.readline().strip())


def test_a_folder_ends_with_its_block(tmp_path: Path) -> None:
    """A folder is private, and is gone after its block, also if there are files in it."""
    with Scratch("x", tmp_path) as folder:
        (folder / "deep").mkdir()
        (folder / "deep" / "file").write_text("a")
        if os.name == "posix":
            assert folder.stat().st_mode & 0o777 == 0o700
    assert [*tmp_path.iterdir()] == []


def test_without_locks_no_folder_is_taken_for_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a file system without locks nobody can tell whether a folder's program runs."""

    def none(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(holding, "_lock", none)
    with Scratch("x", tmp_path) as folder, Scratch("y", tmp_path) as other:
        assert folder.is_dir()
        assert other.is_dir()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="kill -9")
def test_the_next_program_removes_what_a_killed_one_left(tmp_path: Path) -> None:
    """What a killed program left is removed; the folder of one that runs stays."""
    killed, left = _other(tmp_path)
    running, kept = _other(tmp_path)
    killed.kill()
    killed.communicate()
    assert {left, kept} <= {*tmp_path.iterdir()}
    with Scratch("x", tmp_path) as own:
        assert {*tmp_path.iterdir()} == {kept, own}
        assert (kept / "a").read_text() == "a"
    os.kill(running.pid, signal.SIGKILL)
    running.communicate()
    sweep(tmp_path)
    assert [*tmp_path.iterdir()] == []


def test_folders_of_others_stay(tmp_path: Path) -> None:
    """A folder without our lock is somebody's own, however old it is and whatever its name is."""
    mine = tmp_path / "lacoc-gaits"
    mine.mkdir()
    (mine / "Loco-data.txt").write_text("0")
    empty = tmp_path / "lacoc-empty"
    empty.mkdir()
    file = tmp_path / "lacoc-file"
    file.write_text("")
    for path in (mine, empty, file):
        os.utime(path, (0, 0))
    sweep(tmp_path)
    assert {*tmp_path.iterdir()} == {mine, empty, file}


def test_a_folder_that_was_never_finished_goes_after_an_hour(tmp_path: Path) -> None:
    """A program that was killed while it made its folder leaves nothing for long."""
    young, old = (tmp_path / f"lacoc-x-{name}" for name in ("young", "old"))
    for folder in (young, old):
        folder.mkdir()
        (folder / scratch._MAKING).touch()
    long_ago_s = time.time() - 2 * scratch._MAKING_S
    os.utime(old / scratch._MAKING, (long_ago_s, long_ago_s))
    sweep(tmp_path)
    assert [*tmp_path.iterdir()] == [young]
