"""The settings of a gateway: its kind, its courts, and what its pages have filled in."""

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
"""Most pages whose token a court has accepted, in addition: several for each seat and referee of a
large contest, and more than one machine may have.
"""
CLAIMING_MOST = 100
"""Most pages, in addition, with a token that no court has accepted yet: a school, and more."""


def new_key() -> str:
    """Make a random page key."""
    return secrets.token_urlsafe(16)


@dataclass(frozen=True)
class Prefill:
    """What one person gave on the command line, so that the page need not ask for it."""

    seat: str = ""
    token: str = ""
    name: str = ""
    files: OwnFiles | None = None
    """Files on this machine; the page may send others."""


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
    """The newest sheet of the contest, which its office writes."""
    keeps_back: bool = False
    """Whether pages may fetch only the recordings that the sheet names."""
    cheers: bool = True
    """Whether people who watch may cheer."""
    desk: bool = False
    """Whether there are the pages of a contest's desk: /enter and /office."""
    viewers_most: int = VIEWERS_MOST
    exporter: Exporter | None = None
    """Serves the gateway's metrics."""
    told: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """For each court the addresses that commands are told; none: it plays with pages only."""
    authority: str = ""
    """Certificate (PEM) of the event's own authority; "": it has none."""
    key: str = field(default_factory=new_key)
    """The page key: a page with it belongs to the person who started the gateway."""


def player_home(
    courts: Mapping[str, Access], prefill: Prefill, kind: Kind, recordings: Path | None
) -> Home:
    """Return the settings of a gateway for one person, whose way leads to these courts."""
    watching = {name: access.watching() for name, access in courts.items()}
    return Home(watching, kind, "", prefill, recordings)
