"""A small contest that was played and published, for tests and forgeries."""

from collections.abc import Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Self

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless.pool import Job, PlayedAlone, Pool, attempt_match
from lacoc_shared.words import Phrase

CONTEST = """\
[contest]
name = "Cup"
recordings = "records"
[court.main]
arena = "othello"
"""
SWISS = """\
[stage.swiss]
format = "swiss"
rounds = 2
arena = "flag-strike"
settings.match = { duration_s = 2.6, countdown_s = 0.1 }
settings.game = { clearance_m = 0.05, starts = [[-0.42, -0.22], [-0.42, 0.22]] }
"""
FINAL = """\
[stage.final]
format = "single-knockout"
after = "swiss"
teams = 2
games = 3
settings.match = { duration_s = 4.0, countdown_s = 0.1 }
settings.game = { pitch_m = 0.12, disc_radius_m = 0.06, opening = "neutral" }
"""
IDLE = "def bot(sheet, seat):\n    return lambda frame: None\n"
"""A program of a bot that presses no key; it loses."""
BOTS = {"Ann": "planner", "Bob": "straight", "Café 日本": "nearest", "=Dé": "", "Eve": "planner"}
"""The teams in the order in which they enter, and their bots; "": `IDLE`."""


def enter(
    folder: Path,
    contest: str = CONTEST + SWISS + FINAL,
    bots: Mapping[str, str | tuple[str, Path]] = BOTS,
) -> Path:
    """Write a contest file and enter the teams; return the file.

    Args:
        folder: where the file goes.
        contest: its text.
        bots: the bot of each team, or a pair of it and a folder with its robot.
    """
    folder.mkdir(parents=True, exist_ok=True)
    file, idle = folder / "contest.toml", folder / "bot.py"
    file.write_text(contest, "utf-8")
    idle.write_text(IDLE)
    for team, how in bots.items():
        bot, robot = how if isinstance(how, tuple) else (how, None)
        organiser.enter(file, team, robot, bot or str(idle), "")
    return file


class Here:
    """Plays games in this process, one after another; used as a context manager."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def submit(self, job: Job) -> "Future[PlayedAlone | Phrase]":
        """Play a game at once; return a future that already holds its result."""
        future: Future[PlayedAlone | Phrase] = Future()
        future.set_result(attempt_match(job))
        return future


def play(file: Path, jobs: int = 0) -> int:
    """Play a contest without a network; return how many games were played now.

    Args:
        file: the contest file.
        jobs: number of processes; 0: this one alone.
    """
    engine = Pool(jobs) if jobs else Here()
    return organiser.play_headless(file, "planner", engine, lambda done, there: None)[1]


def publish(file: Path) -> Path:
    """Publish a contest; return the folder."""
    folder = file.parent / "published"
    organiser.publish_to(file, folder)
    return folder
