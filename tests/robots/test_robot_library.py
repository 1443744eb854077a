from pathlib import Path

import pytest

from lacoc_robots.library import find_robot, installed_robots, sample_gait_files
from lacoc_robots.robot_file import read_robot
from lacoc_shared.mistakes import UserError


@pytest.fixture
def third_party(tmp_path: Path) -> Path:
    """Give the folder of a robot that has only one gait file."""
    folder = tmp_path / "stilts"
    folder.mkdir()
    text = find_robot("hexapod")[1].replace(b'"Hexapod"', b'"Stilts"')
    (folder / "robot.toml").write_bytes(text)
    (folder / "Loco-data.txt").write_bytes(b"Num of Posture\t0\n")
    return folder


def test_installed() -> None:
    """An installed sample robot is found by its name, with both gait files."""
    assert {"hexapod", "long-legs", "octopod", "quadruped"} <= set(installed_robots())
    assert read_robot(*find_robot("octopod")[::-1]).name == "Octopod"
    assert None not in sample_gait_files("octopod")


def test_folder_of_a_third_party(third_party: Path) -> None:
    """A robot in a folder is found by its path; a gait file that it lacks is None."""
    name, data = find_robot(str(third_party))
    assert (name, read_robot(data, name).name) == ("robot.toml", "Stilts")
    files = sample_gait_files(str(third_party))
    assert files.postures is not None
    assert files.postures.name == "Loco-data.txt"
    assert files.locomotion is None


def test_single_file(third_party: Path) -> None:
    """A .toml file is found as a robot by its path, with the gait files beside it."""
    mine = third_party.joinpath("robot.toml").rename(third_party / "mine.toml")
    assert find_robot(str(mine))[0] == "mine.toml"
    assert sample_gait_files(str(mine)).postures is not None


@pytest.mark.parametrize("name", ["no-such", "no/such.toml", "."])
def test_nothing_there(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A missing robot raises UserError with a sentence that names it."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UserError, match=r"no-such|such\.toml|robot\.toml"):
        find_robot(name)
