"""`lacoc stream`: send an event live to a video platform, or into a file."""

from typing import Annotated

import typer

from lacoc_client.commands.film import FpsOption, LanguageOption, SizeOption, look_of
from lacoc_client.film.look import Quality, View
from lacoc_client.play.stopping import stop_signals
from lacoc_shared.command import screen
from lacoc_shared.words import say

app = typer.Typer()

_PAGES = "http://127.0.0.1:8080"
_MUCH = 0.05
"""A report is a warning if a larger share of the pictures than this was left out."""


@app.command(name="stream")
def stream_command(
    wanted: Annotated[
        str,
        typer.Argument(
            metavar="TARGET",
            envvar="LACOC_STREAM",
            help="Where it goes: an address of a video platform (rtmp://..., with the key of the "
            "stream), a folder (HLS), or a file that ends in .m3u8, .mkv, .mp4 or .ts.",
        ),
    ],
    pages: Annotated[
        str,
        typer.Option(metavar="ADDRESS", help="Address of the event's pages."),
    ] = _PAGES,
    court: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Show this court; by default what the director chooses."),
    ] = None,
    language: LanguageOption = None,
    size: SizeOption = "854x480",
    fps: FpsOption = 25,
) -> None:
    """Send an event live to a video platform, or into a file, until Ctrl-C.

    It shows the broadcast's page with score, cards and sound. On a slow machine it leaves pictures
    out, and never falls behind. It goes on when court, pages or platform were gone for a time. The
    command needs Chromium and the extra "film".
    """
    look = look_of(size, View.AUTO, Quality.LOW, True, language)
    # Only now: without the extra, the help of this command must still be shown.
    from lacoc_client.film.live import stream
    from lacoc_client.film.live.target import target

    where = target(wanted)

    def report(found: stream.Report) -> None:
        said = say("stream.report", hz=found.hz, percent=100 * found.left_out)
        (screen.warn if found.left_out > _MUCH else screen.note)(said)

    with stop_signals() as stopping:
        screen.note(say("stream.begins", target=where.shown))
        source = stream.Streamed(pages, court or "")
        stream.stream(source, where, look, fps, stopping, screen.warn, report)
