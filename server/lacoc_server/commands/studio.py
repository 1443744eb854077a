"""`lacoc studio`: let robots walk for whoever asks."""

import signal
import threading
from typing import Annotated

import typer

from lacoc_server.studio.service import Studio
from lacoc_shared.command import log, options, screen
from lacoc_shared.words import say

app = typer.Typer()


@app.command(name="studio")
def studio_command(
    listen: Annotated[
        list[str] | None,
        typer.Option(
            envvar="LACOC_LISTEN",
            metavar="ADDRESS",
            help="Where to listen, such as tcp/0.0.0.0:7447; port 0 takes a free one. Several may "
            "be given; by default only programs on this machine can connect.",
        ),
    ] = None,
    name: Annotated[
        str, typer.Option(metavar="NAME", help="Name of the studio: a-z, 0-9 and hyphens.")
    ] = "studio",
    jobs: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Number of processes for trials; by default one for each core.", min=1
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Run a studio: it lets robots walk and measures them, for pages on which gaits are designed.

    It answers requests for trials and for the coach from every machine that can reach its address.
    It saves nothing. Ctrl-C ends it.
    """
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    with Studio(name, listen or ["tcp/127.0.0.1:7447"], jobs) as studio:
        if json:
            screen.print_json({"studio": name, "locators": studio.locators})
        else:
            screen.show(say("studio.open", studio=name, at=studio.locators))
        log.start(json)
        while not stop.wait(0.5):  # a wait without an end could not be interrupted on Windows
            pass
