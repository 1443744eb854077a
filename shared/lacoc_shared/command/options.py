"""Options that several commands share, with the same name, environment variable and help in each.

If an option and its variable are both set, the option is used: typer's `envvar` does this.
"""

from pathlib import Path
from typing import Annotated

import typer

Link = Annotated[
    str | None,
    typer.Argument(
        envvar="LACOC_LINK",
        metavar="LINK",
        help="Your link, from the organiser, in quotes; or the address of the pages.",
    ),
]
LinkOption = Annotated[
    str | None,
    typer.Option(
        "--link", envvar="LACOC_LINK", metavar="LINK", help="Your link, from the organiser."
    ),
]
ContestOption = Annotated[
    Path | None,
    typer.Option(
        "--contest",
        envvar="LACOC_CONTEST",
        metavar="FILE",
        help="Contest file; it has what you do not give here (see 'lacoc contest').",
    ),
]
CourtName = Annotated[
    str | None,
    typer.Option(
        "--court",
        envvar="LACOC_COURT",
        metavar="NAME",
        help="Name of the court; by default any court of the link, or 'main'.",
    ),
]
Connect = Annotated[
    str | None,
    typer.Option(
        "--connect",
        envvar="LACOC_CONNECT",
        metavar="ADDRESS",
        help="Without a link: address of a court that was started alone, such as "
        "tcp/192.168.1.20:7447; by default this machine.",
    ),
]
CourtHost = Annotated[
    str | None,
    typer.Option(
        "--host",
        metavar="HOST",
        help="Name or address of the court's machine, if the file does not name it; by default "
        "this machine's address.",
    ),
]
Token = Annotated[
    str | None,
    typer.Option(
        "--token",
        envvar="LACOC_TOKEN",
        metavar="TOKEN",
        help="Without a link: your token, which the court printed. To hide it from others on this "
        "machine, set it as LACOC_TOKEN.",
    ),
]
WaitForCourt = Annotated[
    float | None,
    typer.Option(
        "--wait",
        envvar="LACOC_WAIT",
        metavar="SECONDS",
        min=0,
        help="How many seconds to wait for a court that is not running yet; for programs that "
        "start by themselves.",
    ),
]
Pages = Annotated[
    str | None,
    typer.Option(
        "--pages",
        envvar="LACOC_PAGES",
        metavar="URL",
        help="Address at which others open the pages, such as https://lacoc.example.org; by "
        "default this machine's.",
    ),
]
Certificate = Annotated[
    Path | None,
    typer.Option(
        "--certificate",
        envvar="LACOC_CERTIFICATE",
        metavar="FILE",
        help="Certificate for https (PEM); it may be renewed while the command runs.",
    ),
]
PrivateKey = Annotated[
    Path | None,
    typer.Option(
        "--private-key",
        envvar="LACOC_PRIVATE_KEY",
        metavar="FILE",
        help="The certificate's key (PEM).",
    ),
]
Proxy = Annotated[
    list[str] | None,
    typer.Option(
        "--proxy",
        envvar="LACOC_PROXY",
        metavar="ADDRESS",
        help="Address or network of a proxy in front of the pages, such as 127.0.0.1: it says who "
        "asks; can be given more than once.",
    ),
]
Metrics = Annotated[
    str | None,
    typer.Option(
        "--metrics",
        envvar="LACOC_METRICS",
        metavar="HOST:PORT",
        help="Address for metrics, which Prometheus reads, such as 127.0.0.1:9100; by default "
        "there are none.",
    ),
]
Jobs = Annotated[
    int | None, typer.Option(help="Processes at a time; by default one for each core.", min=1)
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON for a program to read.")]
