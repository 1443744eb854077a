"""`lacoc web`: serve the pages of a contest's courts to everybody at the venue."""

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from lacoc_client.commands.pages import public_address
from lacoc_client.gateway import server
from lacoc_client.gateway.browser import open_browser
from lacoc_client.gateway.files import NOT_BUILT, PageFiles
from lacoc_client.gateway.home import VIEWERS_MOST, Home
from lacoc_client.gateway.site import site
from lacoc_client.gateway.wire import JOIN_BYTES
from lacoc_client.office.site import DESK_BYTES, DeskSite
from lacoc_shared.command import log, options, screen
from lacoc_shared.command.metrics import Exporter
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.entrances import spectator_access
from lacoc_shared.contest.file import Contest
from lacoc_shared.words import render, say

app = typer.Typer()


@app.command(name="web")
def web_command(
    contest: options.ContestFile = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    listen: Annotated[
        str,
        typer.Option(
            envvar="LACOC_WEB_LISTEN",
            metavar="HOST:PORT",
            help="Address for the pages; 0.0.0.0:8080 lets everybody on the same network see them.",
        ),
    ] = server.LOOPBACK,
    pages: options.Pages = None,
    certificate: options.Certificate = None,
    private_key: options.PrivateKey = None,
    proxy: options.Proxy = None,
    recordings: Annotated[
        Path | None,
        typer.Option(
            envvar="LACOC_RECORDINGS",
            metavar="FOLDER",
            help="Folder of the recordings for /replay; by default the contest's, or 'recordings'.",
        ),
    ] = None,
    viewers: Annotated[
        int,
        typer.Option(
            min=1,
            max=2000,
            help="How many watching pages may be open at once; further pages are refused.",
        ),
    ] = VIEWERS_MOST,
    browser: Annotated[
        bool,
        typer.Option(
            "--open/--no-open", help="Open /watch in the browser; with an office, /contest."
        ),
    ] = False,
    office: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Address of the desk of a contest's office; 'lacoc contest run' passes it on. If "
            "it is given, the pages /office and /enter are served.",
        ),
    ] = None,
    metrics: options.Metrics = None,
    json: options.Json = False,
) -> None:
    """Serve the pages: spectators, broadcast, contestants, referee, replays.

    Everybody who can reach this machine may watch. Who has the token of a seat or of a referee can
    play or referee. The pages wait for a court that is not running yet.
    """
    plan = None if contest is None else contests.load(contest)
    exporter = Exporter(metrics) if metrics else None
    home = Home(
        courts=_courts(plan, court, connect),
        contest=plan.given_name if plan else "",
        sheet=contests.sheet_path(contest) if contest else None,
        recordings=recordings or (plan.recordings if plan else Path("recordings")),
        keeps_back=plan is not None and plan.replays != "at-once",
        desk=office is not None,
        viewers_most=viewers,
        exporter=exporter,
    )
    own = None if plan is None else plan.public
    public = public_address(pages, certificate, private_key, proxy, own)
    port = server.listen(listen, public)
    address = port.url

    def ready() -> None:
        built = PageFiles().built
        first = "contest" if plan is not None and plan.office is not None else "watch"
        shown = browser and built and open_browser(f"{address}/{first}")
        if json:
            opened = {"kind": "open", "url": address, "key": home.key, "built": built}
            opened |= {"shown": shown, "metrics": None if exporter is None else exporter.url}
            screen.print_json(opened)
        else:
            _tell(home, address, office=first == "contest")
            if exporter is not None:
                screen.note(say("command.metrics-at", where=exporter.url))
        if not built:
            screen.warn(render(NOT_BUILT))
        log.start(json)

    with exporter or nullcontext():
        desk = None if office is None else DeskSite(office, address)
        server.run(site(home, PageFiles(), desk), port, ready, DESK_BYTES if desk else JOIN_BYTES)


def _courts(plan: Contest | None, court: str | None, connect: str | None) -> dict[str, Access]:
    """Find the access to the named court, or to all courts of the contest."""
    if plan is None or court is not None or connect is not None or len(plan.courts) == 1:
        access = spectator_access(plan, court, connect)
        return {access.court: access}
    return {name: spectator_access(plan, name, None) for name in plan.courts}


def _tell(home: Home, address: str, *, office: bool) -> None:
    screen.show(say("web.pages", courts=[*home.courts]))
    if office:
        screen.show(say("web.contest", url=f"{address}/contest"))
    screen.show(say("web.spectators", url=f"{address}/watch"))
    screen.show(say("web.broadcast", url=f"{address}/overlay"))
    screen.show(say("web.recordings", url=f"{address}/replay"))
    screen.show(say("web.forks", url=f"{address}/replay#key={home.key}"))
    screen.show(say("web.contestants", url=f"{address}/play"))
    screen.show(say("web.referee", url=f"{address}/referee"))
