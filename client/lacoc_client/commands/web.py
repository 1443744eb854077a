"""`lacoc web`: serve the pages of a contest's courts to everybody at the venue."""

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Annotated
from urllib.parse import urlsplit

import typer

from lacoc_client.commands import entrance
from lacoc_client.commands.pages import public_address
from lacoc_client.play.link.event import FoundEvent, find
from lacoc_client.play.link.mirror import SheetMirror
from lacoc_client.web.gateway import contest_sheet, server
from lacoc_client.web.gateway.browser import open_browser
from lacoc_client.web.gateway.files import NOT_BUILT, PageFiles
from lacoc_client.web.gateway.home import VIEWERS_MOST, Home
from lacoc_client.web.gateway.site import site
from lacoc_client.web.gateway.wire import JOIN_BYTES
from lacoc_client.web.office.site import DESK_BYTES, DeskSite
from lacoc_shared.command import log, options, screen
from lacoc_shared.command.metrics import Exporter
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import host as address_host
from lacoc_shared.network.public import is_loopback
from lacoc_shared.words import render, say

app = typer.Typer()

_RECORDINGS = Path("recordings")


@app.command(name="web")
def web_command(
    link: options.Link = None,
    contest: options.ContestOption = None,
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
            help="How many watching pages get each frame at once; further pages see the match in "
            "pieces, 2 to 4 s later.",
        ),
    ] = VIEWERS_MOST,
    browser: Annotated[
        bool,
        typer.Option(
            "--open/--no-open", help="Open /watch in the browser; /contest if there is a contest."
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
    """Serve the pages of courts: spectators, broadcast, contestants, referee, replays.

    'lacoc contest run' does this by itself. With a link to its pages, this command serves them once
    more, for a larger crowd, from a machine without any secret. With --connect it serves the pages
    of a court that was started alone.

    Everybody who can reach this machine may watch. Who has the token of a seat or of a referee can
    play or referee. The pages wait for a court that is not running yet.
    """
    plan = None if contest is None else contests.load(contest)
    exporter = Exporter(metrics) if metrics else None
    own = None if plan is None else plan.public
    public = public_address(pages, certificate, private_key, proxy, own)
    port = server.listen(listen, public)
    address = port.url
    with ExitStack() as stack:
        if exporter is not None:
            stack.enter_context(exporter)
        if link is not None:
            if connect is not None:
                raise UserError(say("link.or-address"))
            home = _again(stack, find(link), court)
        elif plan is not None and contest is not None:
            home = _of_contest(plan, contest, court, urlsplit(address).hostname or "")
        else:
            home = _alone(entrance.courts(None, court, connect))
        home = replace(
            home,
            recordings=recordings or home.recordings,
            desk=office is not None,
            viewers_most=viewers,
            exporter=exporter,
        )
        has_contest = home.sheet is not None

        def ready() -> None:
            built = PageFiles().built
            first = "contest" if has_contest else "watch"
            shown = browser and built and open_browser(f"{address}/{first}")
            if json:
                opened = {"kind": "open", "url": address, "key": home.key, "built": built}
                opened["listen"] = port.listens
                opened |= {"shown": shown, "metrics": None if exporter is None else exporter.url}
                screen.print_json(opened)
            else:
                _tell(home, address, office=has_contest)
                if exporter is not None:
                    screen.note(say("command.metrics-at", where=exporter.url))
            if not built:
                screen.warn(render(NOT_BUILT))
            log.start(json)

        desk = (
            None
            if office is None
            else DeskSite(office, address, plan.public.fingerprint if plan else "")
        )
        server.run(site(home, PageFiles(), desk), port, ready, DESK_BYTES if desk else JOIN_BYTES)


def _again(stack: ExitStack, found: FoundEvent, court: str | None) -> Home:
    """Return the settings of a further gateway that serves an event's pages to a larger crowd."""
    event = found.event
    sheet = stack.enter_context(Scratch("mirror")) / contest_sheet.NAME
    stack.enter_context(SheetMirror(found.link.pages, event.authority, sheet))
    courts = entrance.reached(found, court)
    return Home(
        courts={name: access.watching() for name, access in courts.items()},
        contest=event.name,
        recordings=_RECORDINGS,
        sheet=sheet,
        told={name: event.courts[name] for name in courts},
        authority=event.authority,
    )


def _alone(courts: dict[str, Access]) -> Home:
    """Return the settings of a gateway for courts that were started alone, without a contest."""
    told = {name: tuple(access.addresses) for name, access in courts.items()}
    return Home(courts=courts, recordings=_RECORDINGS, told=told)


def _of_contest(plan: ContestFile, file: Path, court: str | None, host: str) -> Home:
    """Return the settings of a gateway that serves the courts of a contest.

    Args:
        plan: the contest file.
        file: its path.
        court: name of the only court to serve; None: all courts.
        host: the host of the gateway's pages.
    """
    names = [plan.court(court)[0]] if court else [*plan.courts]
    return Home(
        courts={name: plan.access(name) for name in names},
        contest=plan.given_name,
        recordings=plan.recordings,
        sheet=contests.sheet_path(file),
        keeps_back=plan.replays != "at-once",
        cheers=plan.cheers,
        told={name: _told(plan, name, host) for name in names},
        authority=plan.public.read_authority(),
    )


def _told(plan: ContestFile, court: str, host: str) -> tuple[str, ...]:
    """Return the addresses at which others reach a court.

    Return no address if only the court's own machine can reach it.

    Args:
        plan: the contest file.
        court: the court's name.
        host: the host of the pages. If it is this machine itself, whoever opens the pages can reach
            its courts too.
    """
    entry = plan.courts[court]
    found = [entry.address(plan.own_host), entry.stand_in(plan.own_host)]
    return tuple(
        one for one in found if one and (is_loopback(host) or not is_loopback(address_host(one)))
    )


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
