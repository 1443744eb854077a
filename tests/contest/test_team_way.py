"""Tests that teams find their courts with one token each, in a whole contest on two courts."""

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from lacoc_process import run_lacoc, started
from ports import free_port
from waiting import LIMIT_S

from lacoc_server.contest.acts.organiser import enter

TEAMS = ("Ants", "Bees", "Crabs", "Dogs")
PEOPLE = TEAMS[:2]
"""Teams that play with `lacoc play` in a terminal; the others are bots."""


def write_contest(folder: Path) -> Path:
    """Write a contest in which four teams play each other on two courts; enter the teams."""
    courts = "".join(
        f"""
[court.{name}]
arena = "othello"
listen = ["127.0.0.1:{free_port()}"]
"""
        for name in ("north", "south")
    )
    file = folder / "contest.toml"
    file.write_text(f"""
{courts}
[stage.league]
format = "round-robin"
arena = "othello"
settings.match.duration_s = 2.0
settings.match.countdown_s = 0.1
settings.match.start = "ready"
""")
    for team in TEAMS:
        enter(file, team, None, "" if team in PEOPLE else "straight", "")
    return file


@pytest.mark.long
@pytest.mark.slow
def test_teams_follow_from_court_to_court(tmp_path: Path) -> None:
    """With one token each, people and bots play all their matches, wherever they are called.

    `lacoc play` is given only the link that `lacoc contest invite` printed. It says what comes
    next, plays every match of its team on both courts, and ends when the contest is over.
    """
    file, port = write_contest(tmp_path), free_port()
    pages = f'[contest]\npages = "http://127.0.0.1:{port}"\n'
    file.write_text(pages + file.read_text())
    invited = run_lacoc("contest", "invite", "--contest", str(file), "--json")
    links = json.loads(invited.stdout)
    assert list(links) == list(PEOPLE)
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    words = ("contest", "run", str(file), "--listen", f"127.0.0.1:{port}", "--until-over")
    run = started(*words, "--speed", "10", "--json", **streams)
    assert run.stdout is not None
    opened = json.loads(run.stdout.readline())
    assert list(opened["courts"]) == ["north", "south"]
    here: dict[str, Any] = {"stdin": subprocess.DEVNULL, "cwd": tmp_path, **streams}
    players = [started("play", links[team], "--terminal", "--ready", **here) for team in PEOPLE]
    try:
        told = [player.communicate(timeout=LIMIT_S)[0] for player in players]
        end = json.loads(run.communicate(timeout=LIMIT_S)[0].splitlines()[-1])
    finally:
        for process in (*players, run):
            process.kill()
    for team, text, player in zip(PEOPLE, told, players, strict=True):
        assert player.returncode == 0, text
        played = [line for line in text.splitlines() if "seat, against" in line]
        assert len(played) == 3, text
        for other in set(TEAMS) - {team}:
            assert sum(f"against {other}" in line for line in played) == 1, text
        # Who hears of the last result before the contest is over has no place yet.
        ends = ("The contest is over: place", "You have played your last match.")
        assert text.splitlines()[-1].startswith(ends), text
    assert any("Court south" in text for text in told)
    assert (run.returncode, end["games"]) == (0, 6)


@pytest.mark.long
@pytest.mark.slow
def test_the_terminal_tells_what_happens(tmp_path: Path) -> None:
    """Without --json the organiser reads a line for each draw, call and result."""
    file = write_contest(tmp_path)
    for team in PEOPLE:
        enter(file, team, None, "straight", "")
    ran = run_lacoc("contest", "run", str(file), "--until-over", "--speed", "10", timeout_s=LIMIT_S)
    assert ran.returncode == 0, ran.stderr
    told = ran.stderr
    assert told.count("Result: ") == 6
    assert told.count(" is called. Round robin, round ") == 6
    assert told.rstrip().endswith("The contest is over.")
