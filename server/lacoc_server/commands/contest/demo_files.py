"""The contest of `lacoc demo --contest`: eight bots in two groups and a knockout, on two courts."""

import socket
from pathlib import Path

from lacoc_robots.library import robot_folder
from lacoc_server.contest.acts import organiser

TEAMS = (
    ("Ants", "planner", "hexapod"),
    ("Bees", "nearest", "hexapod"),
    ("Crabs", "straight", "octopod"),
    ("Daddies", "planner", "long-legs"),
    ("Earwigs", "nearest", "quadruped"),
    ("Fleas", "straight", "hexapod"),
    ("Geckos", "planner", "octopod"),
    ("Hornets", "nearest", "long-legs"),
)
"""Name, bot and robot of each team."""
COURTS = ("north", "south")

_STAGES = """
[stage.groups]
format = "round-robin"
groups = 2
arena = "{arena}"
settings = {{ match = {{ duration_s = {seconds}, countdown_s = 1.0, start = "ready" }} }}

[stage.finals]
format = "single-knockout"
after = "groups"
teams = 4
third_place = true
apart = true
arena = "{arena}"
settings = {{ match = {{ duration_s = {seconds}, countdown_s = 1.0, start = "ready" }} }}
"""
_COURT = """
[court.{name}]
arena = "{arena}"
listen = ["127.0.0.1:{port}"]
"""


def write_contest(folder: Path, arena: str, seconds: float) -> Path:
    """Write the contest file of the demonstration, and enter its teams; return the file.

    Args:
        folder: an empty folder.
        arena: the game.
        seconds: length of a game [s].

    Raises:
        UserError: if a robot or a bot is not installed, or a file can't be written.
        OSError: if the contest file can't be written.
    """
    text = '[contest]\nname = "Bots\' Cup"\nrecordings = "recordings"\n'
    for name, port in zip(COURTS, _free_ports(len(COURTS)), strict=True):
        text += _COURT.format(name=name, arena=arena, port=port)
    text += _STAGES.format(arena=arena, seconds=float(seconds))
    file = folder / "contest.toml"
    file.write_text(text, encoding="utf-8")
    for team, bot, robot in TEAMS:
        organiser.enter(file, team, robot_folder(robot), bot, "")
    return file


def champion(file: Path) -> str:
    """Return the winner of the last stage; "" if there is none yet."""
    stages = organiser.sheet(file).stages
    rows = [row for table in stages[-1].tables for row in table.rows if row.rank == 1]
    return rows[0].team if stages[-1].over and len(rows) == 1 else ""


def _free_ports(number: int) -> list[int]:
    sockets = [socket.socket() for _ in range(number)]
    try:
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()
