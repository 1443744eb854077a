"""The links that an organiser gives out, each with its QR code. Pure."""

import io
from functools import lru_cache
from typing import Any

import msgspec
import segno

from lacoc_shared.contest.link import Link

_BORDER = 4
"""Width of the white edge that scanners need, in squares of the code."""


class TeamLink(msgspec.Struct, frozen=True, kw_only=True):
    """A link that opens the page of a team."""

    team: str
    link: str
    qr: str
    """The link as a QR code: a picture in SVG."""


class RefereeLink(msgspec.Struct, frozen=True, kw_only=True):
    """The link that opens the page of a court's referee."""

    court: str
    link: str
    qr: str
    """The link as a QR code: a picture in SVG."""


class StaffLink(msgspec.Struct, frozen=True, kw_only=True):
    """The link with which a member of the staff opens the organiser's page."""

    name: str
    link: str
    qr: str
    """The link as a QR code: a picture in SVG."""


class SeatLink(msgspec.Struct, frozen=True, kw_only=True):
    """The link that opens an open seat, for friendly matches."""

    court: str
    seat: str
    """Id of the seat in its arena."""
    link: str
    qr: str
    """The link as a QR code: a picture in SVG."""


class ContestLinks(msgspec.Struct, frozen=True, kw_only=True):
    """Links of teams, referees, open seats and staff, and the address at which teams enter."""

    enter: str
    enter_qr: str
    """The address at which teams enter, as a QR code: a picture in SVG."""
    teams: tuple[TeamLink, ...]
    referees: tuple[RefereeLink, ...]
    seats: tuple[SeatLink, ...] = ()
    staff: tuple[StaffLink, ...] = ()


class LinkMaker:
    """Makes the links that open the pages of an event.

    Args:
        address: address of the pages, such as "http://192.168.1.20:8080".
        authority: fingerprint of the event's own authority; "": it has none.
    """

    def __init__(self, address: str, authority: str = "") -> None:
        self.address = address
        self._authority = authority

    def team(self, team: str, token: str) -> TeamLink:
        """Make the link that opens the page of the team with this token."""
        link = self._link("play", token)
        return TeamLink(team=team, link=link, qr=qr_code(link))

    def seat(self, court: str, seat: str, token: str) -> SeatLink:
        """Make the link that opens the open seat with this token."""
        link = self._link("play", token)
        return SeatLink(court=court, seat=seat, link=link, qr=qr_code(link))

    def staff(self, name: str, token: str) -> StaffLink:
        """Make the link with which a member of the staff opens the organiser's page."""
        link = self._link("office", token)
        return StaffLink(name=name, link=link, qr=qr_code(link))

    def referee(self, court: str, token: str) -> RefereeLink:
        """Make the link of a court's referee, with the token that opens the referee's desk."""
        link = Link(
            pages=self.address,
            page="referee",
            court=court,
            token=token,
            authority=self._authority,
        ).text
        return RefereeLink(court=court, link=link, qr=qr_code(link))

    def _link(self, page: str, token: str) -> str:
        return Link(pages=self.address, page=page, token=token, authority=self._authority).text


@lru_cache(maxsize=1024)  # one takes some milliseconds, and a large contest has hundreds
def qr_code(text: str) -> str:
    """Return the picture of a text as a QR code: SVG, black on white."""
    out = io.BytesIO()
    options: dict[str, Any] = {"border": _BORDER, "light": "#fff", "xmldecl": False}
    segno.make(text, error="m", micro=False).save(out, kind="svg", omitsize=True, **options)
    return out.getvalue().decode()
