"""`lacoc film`: make an MP4 of a recorded match, or of the best moments of a contest."""

import os
import re
import signal
import time
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from lacoc_client.film.look import Look, Quality, View
from lacoc_shared import words
from lacoc_shared.command import screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

app = typer.Typer()

_SIZE = re.compile(r"(\d{2,4})x(\d{2,4})")
_LEAST_PX, _MOST_PX = 160, 3840
_BROWSERS_MOST = 4


class Language(StrEnum):
    """Language of a film or a stream."""

    EN = "en"
    JA = "ja"


LanguageOption = Annotated[
    Language | None,
    typer.Option(help="Language of the overlay; by default that of this program."),
]
SizeOption = Annotated[
    str,
    typer.Option(
        metavar="WIDTHxHEIGHT",
        help="Size of the film in pixels: two even numbers from 160 to 3840.",
    ),
]
FpsOption = Annotated[int, typer.Option(min=1, max=60, help="Pictures a second.")]


@app.command(name="film")
def film_command(
    record: Annotated[
        Path,
        typer.Argument(
            metavar="RECORD",
            help="The .mcap file of a match, any of its segments, or a contest: its published "
            "folder, its contest file, or that file's folder.",
        ),
    ],
    out: Annotated[Path, typer.Argument(metavar="OUT", help="The film: a name with .mp4.")],
    view: Annotated[
        View,
        typer.Option(
            help="What the camera shows: auto follows the action, left and right follow a robot, "
            "split has two pictures, each from behind one robot."
        ),
    ] = View.AUTO,
    overlay: Annotated[
        bool, typer.Option("--overlay", help="Show score, clock, events and names too.")
    ] = False,
    highlights: Annotated[
        bool,
        typer.Option(
            "--highlights", help="Show only the five largest moments and the end of the match."
        ),
    ] = False,
    moments: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="With --highlights: a JSON file with the moments to choose from; by default those "
            "in which the score changed.",
        ),
    ] = None,
    poster: Annotated[
        bool,
        typer.Option("--poster", help="Write a still of each match too, as .png beside the film."),
    ] = False,
    language: LanguageOption = None,
    size: SizeOption = "1280x720",
    fps: FpsOption = 30,
    quality: Annotated[
        Quality,
        typer.Option(
            help="low: as pages draw without a graphics card. smooth: the same with smooth edges. "
            "high: with shadows, and many times slower."
        ),
    ] = Quality.SMOOTH,
    jobs: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=16,
            help="How many browsers draw at a time; by default one for each core, at most four.",
        ),
    ] = None,
) -> None:
    """Make a film of a recorded match, or of the best moments of a contest, as an MP4.

    Chromium draws picture by picture, however long each takes, so no picture is missing. The
    command needs Chromium and the extra "film".
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that nothing is left behind
    look = look_of(size, view, quality, overlay, language)
    _check(record, out, highlights, moments)
    # Only now: without the extra, the help of this command must still be shown.
    from lacoc_client.film import contest, film
    from lacoc_client.film import moments as ranked

    if _is_contest(record):
        parts = [
            replace(film.part(game.record, film.REEL, opening=True), counted=game.scores)
            for game in contest.games(record)
        ]
        look = replace(look, overlay=True)
    else:
        parts = [film.part(record, film.HIGHLIGHTS if highlights else None)]
        if moments is not None:
            parts = [replace(parts[0], chosen=tuple(ranked.from_file(moments)))]
    for part in parts:
        if part.record.warning:
            screen.warn(part.record.warning)
    begin_s = time.monotonic()
    browsers = jobs or min(_BROWSERS_MOST, os.cpu_count() or 1)
    with screen.progress() as bar:
        task = bar.add_task(out.name, total=None)

        def show(done: int, known: int) -> None:
            bar.update(task, completed=done, total=known)

        count = film.make(parts, out, look, fps, browsers, show)
    took_s, length_s = time.monotonic() - begin_s, count / fps
    screen.show(str(out))
    screen.note(
        say(
            "film.made",
            pictures=count,
            length_s=length_s,
            took_s=took_s,
            ratio=took_s / length_s,
        )
    )
    if poster:
        for part, path in zip(parts, _stills(out, len(parts)), strict=True):
            film.still(part, path, look)
            screen.show(str(path))


def _is_contest(record: Path) -> bool:
    """Return whether the command's first argument is a contest, not a record."""
    return record.is_dir() or record.suffix == ".toml"


def _stills(out: Path, count: int) -> list[Path]:
    """Return the paths to which a film's still pictures are written, one for each match."""
    if count == 1:
        return [out.with_suffix(".png")]
    return [out.with_name(f"{out.stem}-{number}.png") for number in range(1, count + 1)]


def look_of(
    size: str, view: View, quality: Quality, overlay: bool, language: Language | None
) -> Look:
    """Return the look of a film, from the options of the command.

    Raises:
        UserError: if a film can't have this size.
    """
    found = _SIZE.fullmatch(size)
    width, height = (int(found[1]), int(found[2])) if found else (0, 0)
    if not all(_LEAST_PX <= px <= _MOST_PX and px % 2 == 0 for px in (width, height)):
        raise UserError(say("film.bad-size", size=size, least=_LEAST_PX, most=_MOST_PX))
    return Look(view, overlay, language or words.current(), width, height, quality)


def _check(record: Path, out: Path, highlights: bool, moments: Path | None) -> None:
    """Check the paths and options of the command before a film is drawn.

    Raises:
        UserError: if one of them is wrong, or they do not fit together.
    """
    if out.suffix.lower() != ".mp4":
        raise UserError(say("film.not-mp4", file=str(out)))
    if out.is_dir():
        raise UserError(say("command.folder-has-name", path=str(out)))
    if not out.parent.is_dir():
        raise UserError(say("film.no-folder", folder=str(out.parent)))
    if _is_contest(record) and (highlights or moments):
        raise UserError(say("film.reel-only"))
    if moments is not None and not highlights:
        raise UserError(say("film.moments-alone"))
