"""`lacoc demo --contest`: a whole contest of bots, from its file to its proof."""

from pathlib import Path

from lacoc_server.commands.contest import checking, playing
from lacoc_shared.command import screen
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.words import say

_SECONDS = 20.0
"""Length of a game where the command names none [s]."""


def show(arena: str, seconds: float | None, speed: float, folder: Path, *, headless: bool) -> None:
    """Play a contest of eight bots, publish it, and check what is published.

    Args:
        arena: the game.
        seconds: length of a game [s]; None: shorter than in a real contest.
        speed: 2 plays twice as fast as real time.
        folder: the folder in which the contest is published.
        headless: whether to play without courts and pages.

    Raises:
        typer.Exit: with the exit code of `lacoc contest verify`, if it is not 0. It is 3 if bots
            played at courts.
        UserError: if something can't be written, or a process does not start.
    """
    from lacoc_server.commands.contest.demo_files import champion, write_contest

    with Scratch("demo") as place:
        screen.show(say("demo.contest"))
        file = write_contest(place, arena, seconds or _SECONDS)
        playing.run(file, headless=headless, speed=speed, browser=not headless)
        checking.publish(folder, file)
        screen.show(say("demo.champion", team=champion(file)))
    checking.verify(folder)
