"""A contest at two courts with its office and pages, whose entries are open."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from lacoc_process import contest_run, run_lacoc
from ports import free_port

from lacoc_robots.library import robot_folder, sample_gait_files


class Event(NamedTuple):
    """An event with open entries, and files of a team."""

    url: str
    office: str
    code: str
    facts: Path
    right: tuple[Path, Path]
    wrong: Path
    cut: Path
    """A workbook that is cut off."""


@contextmanager
def running(folder: Path, *teams: str, waits: bool = False) -> Iterator[Event]:
    """Run a contest at two courts whose entries are open.

    Args:
        folder: an empty folder.
        teams: teams that have entered by command.
        waits: whether the finals wait for the organiser's draw.
    """
    file = folder / "contest.toml"
    run_lacoc("contest", "init", str(file), "--courts", "2")
    text = file.read_text().replace("0.0.0.0:", "127.0.0.1:").replace("groups = 2", "groups = 1")
    for port in ("7447", "7448"):
        text = text.replace(f"127.0.0.1:{port}", f"127.0.0.1:{free_port()}")
    if waits:
        text = text.replace("# draw =", "draw =")
    file.write_text(text)
    for team in teams:
        run_lacoc("contest", "enter", team, "--contest", str(file))
    given = [one for one in sample_gait_files("hexapod") if one is not None]
    paths = [folder / one.name for one in given]
    for path, one in zip(paths, given, strict=True):
        path.write_bytes(one.data)
    wrong = folder / "LocoTra-wrong.txt"
    wrong.write_bytes(given[1].data.replace(b"0", b"x", 3))
    cut = folder / "Loco-data.xlsx"
    cut.write_bytes((robot_folder("hexapod") / "Loco-data.xlsx").read_bytes()[:4000])
    with contest_run(file, "--entries") as run:
        opened = run.opened
        yield Event(
            opened["url"],
            opened["office"],
            opened["code"],
            folder / "contest.db",
            (paths[0], paths[1]),
            wrong,
            cut,
        )
