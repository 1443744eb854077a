"""`lacoc practice`: practise alone on a court of your own."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from lacoc_client.commands import pages
from lacoc_client.commands.play import Gaits, Robot, TeamName, own_files, play
from lacoc_client.web.gateway.home import Prefill, player_home
from lacoc_robots.seat_files import SeatFiles
from lacoc_shared.command import options
from lacoc_shared.command.child import child
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.contest.access import Access
from lacoc_shared.words import render, say

app = typer.Typer()


@app.command(name="practice")
def practice_command(
    name: TeamName = "",
    robot: Robot = None,
    gait: Gaits = None,
    recordings: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Folder for the record of this practice; by default no record is kept.",
        ),
    ] = None,
    terminal: pages.Terminal = False,
    browser: pages.Browser = True,
    json: options.Json = False,
) -> None:
    """Walk your robot on a field of its own, with all keys, as long as you like.

    A page opens in your browser. Both levels are open: postures (A) and locomotion (B); Tab changes
    the level. x puts the robot back to the start, z leaves and writes Pos-data.txt.

    With --terminal q leaves. Keys can come from a pipe as in 'lacoc play'; practice ends after the
    last key.
    """
    files = own_files(robot, gait or [])
    if not terminal:
        pages.check_pages()
    with ExitStack() as stack:
        folder = stack.enter_context(Scratch("practice"))
        access = stack.enter_context(_court(folder, recordings or folder / "recordings"))
        if terminal:
            greeting = _greeting(files.files)
            play(access, name or "Practice", files.files, ready=True, greeting=greeting)
            return
        prefill = Prefill(access.seat, access.token, name or "Practice", files)
        home = player_home({access.court: access}, prefill, "practice", recordings)
        pages.show_page(home, f"/practice#key={home.key}", browser, json)


def _greeting(files: SeatFiles) -> Text:
    sample = files.postures is None and files.locomotion is None
    return Text(render(say("practice.sample") if sample else say("practice.own-gait")))


@contextmanager
def _court(folder: Path, recordings: Path) -> Iterator[Access]:
    """Run a court with the practice arena in a process of its own, until the `with` block ends.

    Yield its address, with seat and token.
    """
    # Fresh: a practice begins anew, even if a killed court left a match in the folder.
    words = ["serve", "--json", "--fresh", "--arena", "practice", "--listen", "tcp/127.0.0.1:0"]
    words += ["--recordings", str(recordings)]
    with child(words, folder, say("child.court")) as opened:
        ((seat, token),) = opened["tokens"].items()
        access = Access(court=opened["court"], connect=opened["locators"][0])
        yield access.of_seat(seat, token)
