"""From what was said on the command line to the way to a court."""

from pathlib import Path

import msgspec

from lacoc_shared import contest as contests
from lacoc_shared.contest import Access, Contest


def seat(
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Find the way to a seat; see `contest.seat_access`.

    Raises:
        UserError: if the contest file is wrong, or something is missing.
    """
    return contests.seat_access(_load(contest), court, connect, seat, token)


def perhaps_seat(
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Find the way to a court, and to a seat as far as it is known: a page asks for the rest.

    Raises:
        UserError: if the contest file is wrong.
    """
    plan = _load(contest)
    access = contests.spectator_access(plan, court, connect)
    seats = plan.court(court)[1].seat if plan else {}
    if seat is None and len(seats) == 1:
        seat = next(iter(seats))
    if token is None and seat in seats:
        token = seats[seat].token
    return msgspec.structs.replace(access, seat=seat or "", token=token or "")


def referee(
    contest: Path | None, court: str | None, connect: str | None, token: str | None
) -> Access:
    """Find the way to a court for its referee; see `contest.referee_access`.

    Raises:
        UserError: if the contest file is wrong, or something is missing.
    """
    return contests.referee_access(_load(contest), court, connect, token)


def spectator(contest: Path | None, court: str | None, connect: str | None) -> Access:
    """Find the way to a court for somebody who only watches; see `contest.spectator_access`.

    Raises:
        UserError: if the contest file is wrong.
    """
    return contests.spectator_access(_load(contest), court, connect)


def _load(path: Path | None) -> Contest | None:
    return None if path is None else contests.load(path)
