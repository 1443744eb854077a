"""Gives a contest that was played once for all tests."""

import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
import small_contest

from lacoc_shared.command import cli


@pytest.fixture(scope="session")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of a contest that was played and published; tests must not change it."""
    file = small_contest.enter(tmp_path_factory.mktemp("contest"))
    small_contest.play(file)
    small_contest.publish(file)
    return file.parent


@pytest.fixture
def copied(played: Path, tmp_path: Path) -> Path:
    """Copy the folder `played`, so that a test may change it; give the copy's contest file."""
    shutil.copytree(played, tmp_path / "copy")
    return tmp_path / "copy" / "contest.toml"


Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def lacoc(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Give a function that runs a command: it returns exit code, output and messages."""
    monkeypatch.setenv("COLUMNS", "300")

    def run(*words: str | Path) -> tuple[int, str, str]:
        typed: Sequence[str] = [str(word) for word in words]
        capsys.readouterr()
        with pytest.raises(SystemExit) as stop:
            sys.exit(cli.main(typed))
        told = capsys.readouterr()
        code = stop.value.code
        return (code if isinstance(code, int) else 0), told.out, told.err

    return run
