"""`lacoc practice`: practise on a court of your own (workshop 4-4)."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.text import Text

from lacoc_client.commands import pages
from lacoc_client.commands.play import Gaits, Robot, TeamName, own_files, play
from lacoc_client.gateway.home import Prefill, player_home
from lacoc_client.seat_files import SeatFiles
from lacoc_shared.command import screen
from lacoc_shared.contest.invitation import Access
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render, say

app = typer.Typer()

_OPEN_S = 60.0
"""Time for a court to open, also on a slow machine."""
_CLOSE_S = 10.0
_LOOK_S = 0.02


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
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="lacoc-practice-")))
        access = stack.enter_context(_court(folder, recordings or folder / "recordings"))
        if terminal:
            greeting = _greeting(files.files)
            play(access, name or "Practice", files.files, ready=True, greeting=greeting)
            return
        prefill = Prefill(access.seat, access.token, name or "Practice", files)
        home = player_home(access, prefill, "practice", recordings)
        pages.show_page(home, f"/practice#key={home.key}", browser)


def _greeting(files: SeatFiles) -> Text:
    sample = files.postures is None and files.locomotion is None
    hint = (
        "Slowly press 1 2 3 4, again and again: it walks forward. 4 3 2 1 walks back, 5 6 7 8 "
        "turns right, 8 7 6 5 turns left, 0 stands. Tab, and one key does it all."
        if sample
        else "Your own gait is loaded: press its keys and see where it goes."
    )
    return Text.assemble(("Practice. ", "bold"), hint)


@contextmanager
def _court(folder: Path, recordings: Path) -> Iterator[Access]:
    """Run a court with the practice arena, as a process that ends with the block."""
    # Its output goes into a file: it would block on a pipe that nobody empties.
    said, complained = folder / "court.out", folder / "court.err"
    # Fresh: a practice begins anew, even if a killed court left a match in the folder.
    words = ["serve", "--json", "--fresh", "--arena", "practice", "--listen", "tcp/127.0.0.1:0"]
    environment = {name: value for name, value in os.environ.items() if name[:6] != "LACOC_"}
    with said.open("wb") as out, complained.open("wb") as err:
        court = subprocess.Popen(
            [sys.executable, "-m", "lacoc_shared", *words, "--recordings", str(recordings)],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            start_new_session=True,  # keeps Ctrl-C from the court, which ends after the player
        )
    try:
        opened = _opened(court, said, complained)
        ((seat, token),) = opened["tokens"].items()
        access = Access(court=opened["court"], connect=opened["locators"][0])
        yield access.of_seat(seat, token)
        if court.poll():  # it crashed, and its traceback is in a folder that is deleted now
            screen.note(_text(complained))
    finally:
        court.terminate()
        try:
            court.wait(_CLOSE_S)
        except subprocess.TimeoutExpired:
            court.kill()
            court.wait()


def _opened(court: subprocess.Popen[bytes], said: Path, complained: Path) -> dict[str, Any]:
    """Wait for a court to open; return the message that it prints then.

    Raises:
        UserError: if it does not open; the message is the court's own.
    """
    deadline_s = time.monotonic() + _OPEN_S
    while time.monotonic() < deadline_s:
        ended = court.poll() is not None
        first, end, _ = _text(said).partition("\n")
        if end:
            opened: dict[str, Any] = json.loads(first)
            return opened
        if ended:
            reason = _text(complained).strip() or f"its process ended with {court.returncode}."
            raise UserError(say("practice.closed", why=_without_heading(reason)))
        time.sleep(_LOOK_S)
    raise UserError(say("practice.slow", seconds=_OPEN_S))


def _without_heading(error: str) -> str:
    """Remove the word that a command puts before an error, in its language."""
    return error.removeprefix(render(say("command.error"))).strip()


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")
