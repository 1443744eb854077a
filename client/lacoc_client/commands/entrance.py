"""Finds the way to a court from the options of a command."""

from pathlib import Path

from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.file import Contest


def seat(
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Find the way to a seat; see `entrances.seat_access`.

    Raises:
        UserError: if the contest file is wrong, or something is missing.
    """
    return entrances.seat_access(_load(contest), court, connect, seat, token)


def team(
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access | None:
    """Find the way to a court for a team that has a token but names no seat.

    Teams have such tokens in a contest with an office; the office says where each team plays.
    None: a seat is named or is the only one, or there is no token.

    Raises:
        UserError: if the contest file is wrong.
    """
    if seat is not None or token is None:
        return None
    plan = _load(contest)
    if plan is not None:
        name, entry = plan.court(court or plan.asked)
        if len(entry.seat) == 1:
            return None
        court = name
    return entrances.spectator_access(plan, court, connect).of_seat("", token)


def perhaps_seat(
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Find the way to a court, with seat and token if they are known; a page asks for the rest.

    Raises:
        UserError: if the contest file is wrong.
    """
    plan = _load(contest)
    access = entrances.spectator_access(plan, court, connect)
    seats = plan.court(court)[1].seat if plan else {}
    if seat is None and len(seats) == 1:
        seat = next(iter(seats))
    if token is None and seat in seats:
        token = seats[seat].token
    return access.of_seat(seat or "", token or "")


def referee(
    contest: Path | None,
    court: str | None,
    connect: str | None,
    token: str | None,
) -> Access:
    """Find the way to a court for its referee; see `entrances.referee_access`.

    Raises:
        UserError: if the contest file is wrong, or something is missing.
    """
    return entrances.referee_access(_load(contest), court, connect, token)


def spectator(contest: Path | None, court: str | None, connect: str | None) -> Access:
    """Find the way to a court for a spectator; see `entrances.spectator_access`.

    Raises:
        UserError: if the contest file is wrong.
    """
    return entrances.spectator_access(_load(contest), court, connect)


def _load(path: Path | None) -> Contest | None:
    return None if path is None else contests.load(path)
