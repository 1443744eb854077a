"""Finds how to reach courts: from a link, or from the address of a court that was started alone."""

from pathlib import Path

from msgspec.structs import replace

from lacoc_client.play.link.event import FoundEvent, find
from lacoc_shared.contest.access import Access
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import endpoint
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import say

MAIN = "main"
"""Name of a court that was started without a name."""

_HERE = "127.0.0.1"


def courts(
    link: str | None,
    court: str | None,
    connect: str | None,
    token: str | None = None,
    authority: Path | None = None,
) -> dict[str, Access]:
    """Find how to reach all courts of a link, or the named court, each with this user's token.

    Args:
        link: a link, or the address of pages.
        court: the court's name; None: the court that the link names, if it names a court.
        connect: address of a court, used without a link; or several addresses with commas, if the
            court is at one of these.
        token: the token, used without a link.
        authority: file with the certificate of a private authority, used without a link.

    Returns:
        An access for each court, by its name.

    Raises:
        UserError: if both a link and an address are given; if something is wrong with them; if the
            pages of the link do not answer; or if there is no such court.
    """
    if link is None:
        return {court or MAIN: _alone(court or MAIN, connect or _HERE, token or "", authority)}
    if connect is not None or token is not None:
        raise UserError(say("link.or-address"))
    return reached(find(link), court)


def reached(found: FoundEvent, court: str | None) -> dict[str, Access]:
    """Return how to reach all courts of an event that a link led to, or the named court only.

    Raises:
        UserError: if the event has no such court, or none that a command can reach.
    """
    there, name = found.courts, court or found.link.court
    if name and name not in there:
        raise UserError(say("gateway.no-court", court=name, courts=[*there]))
    return {
        one: Access(
            court=one,
            connect=first,
            others=tuple(others),
            token=found.link.token,
            authority=found.event.authority,
        )
        for one, (first, *others) in there.items()
        if name in ("", one)
    }


def one_court(
    link: str | None, court: str | None, connect: str | None, token: str | None = None
) -> Access:
    """Find how to reach one court; arguments as in `courts`.

    Raises:
        UserError: if a link leads to several courts and none is named; also for the reasons of
            `courts`.
    """
    found = courts(link, court, connect, token)
    if len(found) > 1:
        raise UserError(say("entrance.which-court", courts=[*found]))
    return next(iter(found.values()))


def referee(link: str | None, court: str | None, connect: str | None, token: str | None) -> Access:
    """Find how a referee reaches a court; arguments as in `courts`.

    Raises:
        UserError: if there is no token; also for the reasons of `one_court`.
    """
    return _with_token(one_court(link, court, connect, token))


def contestant(
    link: str | None,
    court: str | None,
    connect: str | None,
    token: str | None,
    authority: Path | None = None,
) -> Access:
    """Find how a contestant or a bot reaches any court of the event.

    That court then says where the seat is.

    Args:
        link: as in `courts`.
        court: name of the court to ask.
        connect: address of a court.
        token: the token.
        authority: file with the certificate of a private authority.

    Raises:
        UserError: if there is no token; also for the reasons of `courts`.
    """
    first, *others = courts(link, court, connect, token, authority).values()
    further = (at for one in others for at in one.addresses)
    return replace(_with_token(first), others=(*first.others, *further))


def _with_token(access: Access) -> Access:
    """Return the access to a court unchanged, after a check that it contains a token.

    Raises:
        UserError: if it has no token.
    """
    if not access.token:
        raise UserError(say("entrance.no-token"))
    return access


def _alone(court: str, connect: str, token: str, authority: Path | None) -> Access:
    trusted = PublicAddress(authority=authority).read_authority()
    first, *others = map(endpoint, connect.split(","))
    return Access(court=court, connect=first, others=tuple(others), token=token, authority=trusted)
