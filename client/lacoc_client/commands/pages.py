"""Shows a page: starts a gateway, by default for this machine only, and a browser."""

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer
from starlette.types import ASGIApp

from lacoc_client.web.gateway import server
from lacoc_client.web.gateway.browser import open_browser, unseen
from lacoc_client.web.gateway.files import NOT_BUILT, PageFiles
from lacoc_client.web.gateway.home import Home
from lacoc_client.web.gateway.site import site
from lacoc_client.web.gateway.wire import JOIN_BYTES
from lacoc_shared.command import screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import say

Browser = Annotated[
    bool,
    typer.Option(
        "--open/--no-open", help="Open the page in the browser, or only print its address."
    ),
]
Terminal = Annotated[
    bool,
    typer.Option("--terminal", help="Use this terminal instead of a page in the browser."),
]


def public_address(
    pages: str | None,
    certificate: Path | None,
    private_key: Path | None,
    proxy: Sequence[str] | None,
    own: PublicAddress | None = None,
) -> PublicAddress:
    """Return the address at which others reach the pages, from the options of a command.

    Args:
        pages: `options.Pages`.
        certificate: `options.Certificate`.
        private_key: `options.PrivateKey`.
        proxy: `options.Proxy`.
        own: the values to take for options that are not given; None: there are none.

    Raises:
        UserError: if something is wrong.
    """
    own = own or PublicAddress()
    return PublicAddress.of(
        pages or own.pages,
        certificate or own.certificate,
        private_key or own.private_key,
        proxy or own.proxies,
        own.authority,
    )


def check_pages(*, terminal: bool = True) -> None:
    """Check that the pages were built, so that there is something to show.

    Args:
        terminal: whether the command has `--terminal` too.

    Raises:
        UserError: if the pages are not built.
    """
    if not PageFiles().built:
        raise UserError(say("pages.not-built-for-play", why=NOT_BUILT) if terminal else NOT_BUILT)


def show_page(home: Home, path: str, browser: bool, json: bool = False) -> None:
    """Serve a gateway's pages and show one in the user's browser, until Ctrl-C.

    Args:
        home: the gateway's settings.
        path: path of the page, with its fragment.
        browser: whether to open the page in the browser.
        json: print the address as JSON.

    Raises:
        UserError: if the pages are not built.
    """
    check_pages()
    show_app(site(home, PageFiles()), path, browser, json=json)


def show_app(
    app: ASGIApp,
    path: str,
    browser: bool,
    listen: str = server.LOOPBACK,
    public: PublicAddress | None = None,
    most_bytes: int = JOIN_BYTES,
    json: bool = False,
) -> None:
    """Serve a gateway's application and show a page of it in the user's browser, until Ctrl-C.

    Args:
        app: a gateway's application.
        path: path of the page to open, with its fragment.
        browser: whether to open the page in the browser.
        listen: "HOST:PORT"; see `server.listen`.
        public: how others reach the page.
        most_bytes: longest message of a page.
        json: print the address as JSON.

    Raises:
        UserError: if the address is wrong, or can't be listened on.
    """
    opened = server.listen(listen, public)
    address = f"{opened.url}{path}"
    stack = ExitStack()

    def ready() -> None:
        shown = browser and open_browser(stack.enter_context(unseen(address)))
        if json:
            screen.print_json({"kind": "open", "url": address})
            return
        # Said in any case: a browser may open in a place where nobody looks.
        screen.show(say("web.opened", url=address) if shown else say("web.open", url=address))
        screen.note(say("web.keep-running"))

    with stack:
        server.run(app, opened, ready, most_bytes)
