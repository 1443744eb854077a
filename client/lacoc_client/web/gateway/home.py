"""The settings of a gateway: its kind, its courts, and what is filled in on its pages."""

import secrets
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from lacoc_client.play.own_files import OwnFiles
from lacoc_shared.command.metrics import Exporter
from lacoc_shared.contest.access import Access

Kind = Literal["venue", "player", "practice"]

VIEWERS_MOST = 400
"""Most pages that only watch: 25 frames a second for 400 pages need 3 MB/s."""
ACTING_MOST = 250
"""Most pages whose token a court has accepted; these come in addition. The limit allows several
pages for each seat and referee of a large contest, and is above the limit of one machine."""
CLAIMING_MOST = 100
"""Most pages with a token that no court has accepted yet; these come in addition. Enough for a
school."""


def new_key() -> str:
    """Make a random page key."""
    return secrets.token_urlsafe(16)


@dataclass(frozen=True)
class Prefill:
    """What a person gave on the command line, so that the page need not ask for it."""

    seat: str = ""
    token: str = ""
    name: str = ""
    files: OwnFiles | None = None
    """Gait and robot files on this machine; the page may send others instead."""


@dataclass(frozen=True)
class Home:
    """A gateway's settings."""

    courts: dict[str, Access]
    """Access to each court, by its name; a page that names no court gets the first."""
    kind: Kind = "venue"
    contest: str = ""
    """The contest's name; "" if nobody gave it one."""
    prefill: Prefill | None = None
    recordings: Path | None = None
    """Folder of the recordings that pages may fetch."""
    sheet: Path | None = None
    """Path of the contest's sheet, which its office writes again and again; None: no contest."""
    keeps_back: bool = False
    """Whether pages may fetch only the recordings that the contest's sheet names, as /contest does.
    """
    cheers: bool = True
    """Whether people who watch may cheer."""
    desk: bool = False
    """Whether the gateway has the pages /enter and /office, whose requests go to a contest's
    desk."""
    viewers_most: int = VIEWERS_MOST
    exporter: Exporter | None = None
    """Serves the gateway's metrics."""
    told: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """For each court the addresses that the gateway tells to commands; none: the court can be
    reached through pages only."""
    authority: str = ""
    """Certificate (PEM) of the event's own authority; "": it has no authority of its own."""
    key: str = field(default_factory=new_key)
    """The page key: a page that shows it counts as one of the person who started the gateway."""


def player_home(
    courts: Mapping[str, Access], prefill: Prefill, kind: Kind, recordings: Path | None
) -> Home:
    """Return the settings of a gateway for one person who may reach these courts."""
    watching = {name: access.watching() for name, access in courts.items()}
    return Home(watching, kind, "", prefill, recordings)
