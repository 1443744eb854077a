"""`lacoc design`: design a gait on a page, as in the workshop."""

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Annotated

import typer

from lacoc_client.commands import pages
from lacoc_client.web.gateway import server
from lacoc_client.web.gateway.files import PageFiles
from lacoc_client.workshop.design.designer import Designer
from lacoc_client.workshop.design.folder import Folder
from lacoc_client.workshop.design.requests import MESSAGE_BYTES
from lacoc_client.workshop.design.site import PATH, design_site
from lacoc_client.workshop.design.studios.asker import Asker
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_shared.command import options
from lacoc_shared.command.child import kept_child
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.words import say

app = typer.Typer()


@app.command(name="design")
def design_command(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="[FOLDER]", help="The folder with the gait files; by default this one."
        ),
    ] = Path(),
    robot: Annotated[
        str | None,
        typer.Option(
            metavar="FILE|NAME",
            help="The robot to begin with: an installed one, a robot's folder, or a robot file "
            "(.toml).",
        ),
    ] = None,
    connect: Annotated[
        str | None,
        typer.Option(
            envvar="LACOC_STUDIO",
            metavar="ADDRESS",
            help="Address of a studio that runs elsewhere, such as tcp/192.168.1.20:7448.",
        ),
    ] = None,
    listen: Annotated[
        str,
        typer.Option(
            metavar="HOST:PORT",
            help="Where to serve the page; by default only this machine can open it. With "
            "0.0.0.0:8080 a tablet in the room can too.",
        ),
    ] = server.LOOPBACK,
    public_pages: options.Pages = None,
    certificate: options.Certificate = None,
    private_key: options.PrivateKey = None,
    proxy: options.Proxy = None,
    browser: pages.Browser = True,
) -> None:
    """Design a gait: change the table, let the robot walk, and see why it walks as it does.

    A page opens in your browser with the gait and robot files of the folder. It saves into the file
    that you opened, and asks first if another program has changed this file. This command also
    starts a studio, which lets the robot walk, unless --connect names another studio.
    """
    pages.check_pages(terminal=False)
    public = pages.public_address(public_pages, certificate, private_key, proxy)
    files = Folder(folder)
    with nullcontext(connect) if connect else own_studio() as address:
        designer = Designer(files, Studios([Asker(address)]), robot)
        site = design_site(designer, PageFiles())
        pages.show_app(site, f"{PATH}#key={designer.key}", browser, listen, public, MESSAGE_BYTES)


@contextmanager
def own_studio() -> Iterator[str]:
    """Run a studio for this machine until the `with` block ends, and yield its address."""
    with (
        Scratch("design") as folder,
        kept_child(
            _words("tcp/127.0.0.1:0"),
            Path(folder),
            say("child.studio"),
            # A studio that is started again gets the same address, so that pages find it.
            lambda opened: _words(opened["locators"][0]),
        ) as opened,
    ):
        yield opened["locators"][0]


def _words(listen: str) -> list[str]:
    return ["studio", "--json", "--listen", listen]
