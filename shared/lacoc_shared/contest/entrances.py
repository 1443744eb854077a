"""Find court, address and token for each kind of client, from options and the contest file.

An option that is None was not given; it is looked up in the contest file.
"""

import hashlib

from lacoc_shared.contest import codes
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.file import LOOPBACK, MAIN, Contest, Court
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import endpoint
from lacoc_shared.words import say


def spectator_access(contest: Contest | None, court: str | None, connect: str | None) -> Access:
    """Return the access of a client that only watches: court, address and authority.

    Args:
        contest: the contest file, if there is one; it gives what the options leave open.
        court: the court's name, or None.
        connect: the court's address, or None.

    Raises:
        UserError: if the contest has no court of this name; if it has several courts and none is
            named; if the address is wrong; or if the authority's certificate can't be read.
    """
    name, entry = _court_of(contest, court)
    address = connect or (entry.address() if entry else LOOPBACK)
    stand_in = entry.stand_in() if entry and not connect else ""
    address = endpoint(address, contest.public.protocol if contest else "tcp")
    authority = contest.public.read_authority() if contest else ""
    return Access(court=name, connect=address, stand_in=stand_in, authority=authority)


def seat_access(
    contest: Contest | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Return court, address, seat and token for a contestant or a bot.

    Args:
        contest: the contest file, if there is one; it gives what the options leave open.
        court: the court's name, or None.
        connect: the court's address, or None.
        seat: the seat's name; None takes the only seat of the contest's court.
        token: the seat's token, or None.

    Raises:
        UserError: if seat or token are neither given nor in the contest file; also for the reasons
            of `spectator_access`.
    """
    access = spectator_access(contest, court, connect)
    _, entry = _court_of(contest, court)
    seats = entry.seat if entry else {}
    if seat is None and len(seats) == 1:
        seat = next(iter(seats))
    if seat is None:
        raise UserError(say("contest.which-seat", seats=[*seats] or ["left", "right"]))
    token = token or (seats[seat].token if seat in seats else None)
    if token is None:
        raise UserError(say("contest.no-token-seat", seat=seat))
    return access.of_seat(seat, token)


def referee_access(
    contest: Contest | None, court: str | None, connect: str | None, token: str | None
) -> Access:
    """Return court, address and token for a referee; arguments as in `seat_access`.

    Raises:
        UserError: if the token is neither given nor in the contest file; also for the reasons of
            `spectator_access`.
    """
    access = spectator_access(contest, court, connect)
    _, entry = _court_of(contest, court)
    token = token or (entry.referee.token if entry else None)
    if token is None:
        raise UserError(say("contest.no-token-referee"))
    return access.of_referee(token)


def organiser_key(contest: Contest) -> str:
    """Return the key that opens the organiser's page; it is the same at each start of the office.

    Raises:
        UserError: if the contest has no office.
    """
    digest = hashlib.blake2b(_office_token(contest), digest_size=16, person=b"lacoc organiser")
    return digest.hexdigest()


def event_code(contest: Contest) -> str:
    """Return the code with which a team applies; it is the same at each start of the office.

    Raises:
        UserError: if the contest has no office.
    """
    return codes.code_of(_office_token(contest).decode())


def _office_token(contest: Contest) -> bytes:
    if contest.office is None:
        raise UserError(say("contest.no-office", file=contest.name))
    return contest.office.token.encode()


def team_lines(contest: Contest, token: str, pages: str, any_host: str) -> dict[str, str]:
    """Return a team's two ways into a contest: its page as "link", its command line as "command".

    Args:
        contest: the contest.
        token: the team's token.
        pages: address of the contest's pages, such as "http://192.168.1.20:8080".
        any_host: the host to name if a court listens on all addresses of its machine.
    """
    court = contest.courts[contest.asked]
    return {
        "link": f"{pages}/play#token={token}",
        "command": f"lacoc play --connect {court.address(any_host)} --token {token}",
    }


def join_lines(name: str, court: Court, any_host: str) -> dict[str, str]:
    """Return the command lines for a court: by seat, for "referee" and for "spectators".

    Args:
        name: the court's name.
        court: the court's entry in the contest file.
        any_host: the host to name if the court listens on all addresses of its machine.
    """
    where = f"--court {name} --connect {court.address(any_host)}"
    seats = {
        seat: f"lacoc play {where} --seat {seat} --token {holder.token}"
        for seat, holder in court.seat.items()
    }
    return {
        **seats,
        "referee": f"lacoc referee status {where} --token {court.referee.token}",
        "spectators": f"lacoc watch {where}",
    }


def _court_of(contest: Contest | None, court: str | None) -> tuple[str, Court | None]:
    return (court or MAIN, None) if contest is None else contest.court(court)
