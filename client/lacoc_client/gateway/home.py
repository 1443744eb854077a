"""What a gateway was started for: whose it is, which courts, what is filled in already."""

import hashlib
import secrets
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from lacoc_client.own_files import OwnFiles
from lacoc_shared.command.metrics import Exporter
from lacoc_shared.contest.file import Contest
from lacoc_shared.contest.invitation import Access

Kind = Literal["venue", "player", "practice"]

VIEWERS_MOST = 400
"""More pages than this that only watch are sent away: 25 frames a second of 400 need 3 MB/s."""
ACTING_MOST = 100
"""Pages that have the key, besides: several for each seat and referee of a large contest."""


def new_key() -> str:
    """Make a random key."""
    return secrets.token_urlsafe(16)


@dataclass(frozen=True)
class Prefill:
    """What one person said on the command line, so that the page need not ask."""

    seat: str = ""
    token: str = ""
    name: str = ""
    files: OwnFiles | None = None
    """What lies on this machine; a page may bring others."""


@dataclass(frozen=True)
class Home:
    """A gateway's settings."""

    courts: dict[str, Access]
    """The way to each court by its name; the first is shown where a page names none."""
    kind: Kind = "venue"
    contest: str = ""
    """The contest's name; "" if nobody gave it one."""
    prefill: Prefill | None = None
    recordings: Path | None = None
    """Folder of the recordings that may be fetched."""
    names: frozenset[str] = frozenset()
    """Names by which browsers may call this machine, besides its own."""
    viewers_most: int = VIEWERS_MOST
    exporter: Exporter | None = None
    """Where its numbers are shown."""
    key: str = field(default_factory=new_key)
    """Lets a page act; without it a page only watches."""


def lasting_key(contest: Contest) -> str:
    """A key that is the same each time the gateway of a contest is started.

    So pages that are open go on when it is started again. It is as secret as the contest file.
    """
    secret = " ".join(court.referee.token for court in contest.courts.values())
    digest = hashlib.blake2b(secret.encode(), digest_size=16, person=b"lacoc web key").digest()
    return digest.hex()


def player_home(access: Access, prefill: Prefill, kind: Kind, recordings: Path | None) -> Home:
    """The gateway of one person at one court."""
    return Home({access.court: access.watching()}, kind, "", prefill, recordings)
