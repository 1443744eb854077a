"""The links that an organiser hands out, each with its QR code; pure."""

import io
from functools import lru_cache
from typing import Any

import msgspec
import segno

_BORDER = 4
"""Width of the white edge that scanners need, in squares of the code."""


class TeamLink(msgspec.Struct, frozen=True, kw_only=True):
    """A team's link."""

    team: str
    link: str
    qr: str
    """The link as a QR code: a picture in SVG."""


class RefereeLink(msgspec.Struct, frozen=True, kw_only=True):
    """The link of a court's referee."""

    court: str
    link: str
    qr: str
    """The link as a QR code: a picture in SVG."""


class Links(msgspec.Struct, frozen=True, kw_only=True):
    """Links of teams and referees, and the address at which teams enter."""

    enter: str
    enter_qr: str
    """That address as a QR code: a picture in SVG."""
    teams: tuple[TeamLink, ...]
    referees: tuple[RefereeLink, ...]


def team_link(team: str, address: str, token: str) -> TeamLink:
    """Make the link of a team.

    Args:
        team: name of the team.
        address: address of the pages, such as "http://192.168.1.20:8080".
        token: the team's token.
    """
    link = f"{address}/play#token={token}"
    return TeamLink(team=team, link=link, qr=qr_code(link))


def referee_link(court: str, address: str, token: str) -> RefereeLink:
    """Make the link of a court's referee; arguments as in `team_link`, with the desk's token."""
    link = f"{address}/referee?court={court}#token={token}"
    return RefereeLink(court=court, link=link, qr=qr_code(link))


@lru_cache(maxsize=1024)  # one takes some milliseconds, and a large contest has hundreds
def qr_code(text: str) -> str:
    """Return a text as a QR code in SVG, black on white."""
    out = io.BytesIO()
    options: dict[str, Any] = {"border": _BORDER, "light": "#fff", "xmldecl": False}
    segno.make(text, error="m", micro=False).save(out, kind="svg", omitsize=True, **options)
    return out.getvalue().decode()
