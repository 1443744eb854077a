"""Options that several commands share, with the same name, variable and help in each.

The command line takes precedence over the environment: typer's `envvar` does this. Both
take precedence over the contest file and the defaults: an option that is not given is
None, and `contest.entrances` looks it up in the contest file.
"""

from pathlib import Path
from typing import Annotated

import typer

ContestFile = Annotated[
    Path | None,
    typer.Option(
        "--contest",
        envvar="LACOC_CONTEST",
        metavar="FILE",
        help="Contest file: says what is left open here (see 'lacoc contest').",
    ),
]
Invitation = Annotated[
    Path | None,
    typer.Option(
        "--invitation",
        envvar="LACOC_INVITATION",
        metavar="FILE",
        help="Your invitation, from the organiser: it says court, address, seat and token.",
    ),
]
CourtName = Annotated[
    str | None,
    typer.Option(
        "--court",
        envvar="LACOC_COURT",
        metavar="NAME",
        help="Name of the court; by default the contest's only one, or 'main'.",
    ),
]
Connect = Annotated[
    str | None,
    typer.Option(
        "--connect",
        envvar="LACOC_CONNECT",
        metavar="ADDRESS",
        help="Address of the court, such as tcp/192.168.1.20:7447; by default this machine.",
    ),
]
SeatName = Annotated[
    str | None,
    typer.Option(
        "--seat", envvar="LACOC_SEAT", metavar="SEAT", help="Your seat: 'left' or 'right'."
    ),
]
Token = Annotated[
    str | None,
    typer.Option(
        "--token",
        envvar="LACOC_TOKEN",
        metavar="TOKEN",
        help="Your token, from the organiser. In the environment others on this machine "
        "can't read it.",
    ),
]
WaitForCourt = Annotated[
    float | None,
    typer.Option(
        "--wait",
        envvar="LACOC_WAIT",
        metavar="SECONDS",
        min=0,
        help="How long to wait for a court that is not there, as a service does.",
    ),
]
Metrics = Annotated[
    str | None,
    typer.Option(
        "--metrics",
        envvar="LACOC_METRICS",
        metavar="HOST:PORT",
        help="Answer Prometheus there, such as 127.0.0.1:9100; without it nothing listens.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON for a program to read.")]
