"""`lacoc class`: a class designs gaits in the browser, as in the workshop."""

import asyncio
import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from lacoc_client.commands import pages
from lacoc_client.commands.design import own_studio
from lacoc_client.web.gateway import server
from lacoc_client.web.gateway.browser import open_browser, unseen
from lacoc_client.web.gateway.files import PageFiles
from lacoc_client.workshop.classroom import kept
from lacoc_client.workshop.classroom.classroom import CLASS_FILE, Classroom
from lacoc_client.workshop.classroom.site import PATH, class_site
from lacoc_client.workshop.classroom.tournament import RECORDINGS
from lacoc_client.workshop.design.requests import MESSAGE_BYTES
from lacoc_client.workshop.design.studios.asker import Asker
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_client.workshop.phases.class_file import forget
from lacoc_shared.command import keep, options, screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render, say


class _ClassGroup(TyperGroup):
    """A command group: if the first word is no subcommand, its usual subcommand is run."""

    usual = "open"

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Insert the word `open` before the command line's words if the first is no subcommand.

        See `click.Group.parse_args`.
        """
        if args and args[0] not in self.commands and args[0] not in ctx.help_option_names:
            args = [self.usual, *args]
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=_ClassGroup,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Let a class design gaits in the browser: 'lacoc class FOLDER' opens it.\n\n"
    "Students need nothing but a browser: they open one address, and type the class code and a "
    "nickname. You see on one page how far everybody is, and who needs help.",
)

_Folder = Annotated[
    Path, typer.Argument(metavar="FOLDER", help="The folder of the class; it is made if needed.")
]
_Known = Annotated[Path, typer.Argument(metavar="FOLDER", help="The folder of the class.")]


@app.command(name="open")
def open_command(
    folder: _Folder,
    listen: Annotated[
        str,
        typer.Option(
            metavar="HOST:PORT",
            help="Where to serve the pages; by default the whole room can open them.",
        ),
    ] = "0.0.0.0:8080",
    public_pages: options.Pages = None,
    certificate: options.Certificate = None,
    private_key: options.PrivateKey = None,
    proxy: options.Proxy = None,
    connect: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ADDRESS",
            help="A studio on another machine that shares the work, such as "
            "tcp/192.168.1.20:7447; can be given more than once.",
        ),
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option(
            metavar="FILE|NAME",
            help="The robot of the class: an installed one, a robot's folder, or a robot file "
            "(.toml).",
        ),
    ] = None,
    browser: pages.Browser = True,
    json: options.Json = False,
) -> None:
    """Open a class: students design on /design, you see them on /class.

    Everything is kept in the folder while it happens. After a crash, or the next day, open the same
    folder again: code, students and tables are still there.
    """
    pages.check_pages(terminal=False)
    public = pages.public_address(public_pages, certificate, private_key, proxy)
    with ExitStack() as stack:
        opened = stack.enter_context(server.listen(listen, public))
        own = stack.enter_context(own_studio())
        studios = Studios([Asker(address) for address in (own, *(connect or ()))])
        classroom = Classroom(folder, studios, [opened.url], robot)
        keep.make_folder(folder)  # only now: whoever can't open a class gets no empty folder
        asyncio.run(classroom.open())
        address = opened.url
        teacher = f"{address}{PATH}#key={classroom.state.key}"

        def ready() -> None:
            shown = browser and open_browser(stack.enter_context(unseen(teacher)))
            if json:
                code = classroom.state.code
                screen.print_json({"kind": "open", "url": address, "class": teacher, "code": code})
                return
            screen.show(say("class.students", url=address, code=classroom.state.code))
            screen.show(say("web.opened", url=teacher) if shown else say("web.open", url=teacher))
            screen.note(say("class.keep-running"))
            if classroom.sample().table is None:
                screen.warn(say("class.robot-without-sample"))

        server.run(class_site(classroom, PageFiles()), opened, ready, MESSAGE_BYTES)


@app.command(name="export")
def export_command(
    folder: _Known,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Where to write them; by default the class's folder."),
    ] = None,
) -> None:
    """Write what students did (evidence.csv) and their newest tables (tables.zip)."""
    files = kept.export(folder / CLASS_FILE)
    place = out or folder
    keep.make_folder(place)
    for name, data in files.items():
        kept_as = keep.save(place / name, data)
        screen.show(say("class.written", file=str(place / name)))
        if kept_as is not None:
            screen.note(say("command.kept", path=str(place / name), kept=str(kept_as)))


@app.command(name="forget")
def forget_command(
    folder: _Known,
    yes: Annotated[bool, typer.Option("--yes", help="Delete without asking.")] = False,
) -> None:
    """Delete everything that is kept of a class: evidence, tables, nicknames, its matches.

    Files that you exported stay.
    """
    path = folder / CLASS_FILE
    if not path.exists():
        raise UserError(say("class.none", file=str(path)))
    if not yes and not typer.confirm(render(say("class.forget-sure", folder=str(folder)))):
        raise UserError(say("class.not-forgotten"))
    for file in forget(path):
        screen.show(say("class.deleted", file=str(file)))
    records = folder / RECORDINGS
    if records.exists():
        shutil.rmtree(records)
        screen.show(say("class.deleted", file=str(records)))
