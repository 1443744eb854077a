"""`lacoc replay verify`: simulate a record again and compare it bit for bit."""

from pathlib import Path
from typing import Annotated

import typer

from lacoc_server.journal.replay import Verdict, verify
from lacoc_shared.command import options, screen
from lacoc_shared.record.files import record_paths
from lacoc_shared.record.reader import Record

app = typer.Typer()

DIFFERENT = 1
"""Exit code: the record is not what its inputs give."""


@app.command(name="verify")
def verify_command(
    file: Annotated[Path, typer.Argument(help="The record: a .mcap file.")],
    arena: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="The folder of a game that is not installed; its code is run.",
            exists=True,
            file_okay=False,
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Simulate a record again and say "same", or name the first beat that differs.

    No folder is used because a record names it: its code would run.
    """
    record = Record.read(record_paths(file))
    verdict = Verdict(0, 0)
    with screen.progress() as progress:
        task = progress.add_task("simulating", total=record.last_beat + 1)
        for step in verify(record, arena):
            if isinstance(step, Verdict):
                verdict = step
            else:
                progress.update(task, completed=step + 1)
    if json:
        screen.print_json(
            {
                "same": verdict.differs_at is None,
                "beats": verdict.beats,
                "frames": verdict.frames,
                "differs_at": verdict.differs_at,
                "text": verdict.text,
                "cut": record.cut,
            }
        )
    else:
        cut = f" {record.cut}" if record.cut else ""
        screen.show(f"{verdict.text}: {verdict.beats} beats, {verdict.frames} frames.{cut}")
    if verdict.differs_at is not None:
        raise typer.Exit(DIFFERENT)
