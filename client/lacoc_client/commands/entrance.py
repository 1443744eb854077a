"""Finds the way to a court from the options of a command."""

from pathlib import Path

from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import Contest
from lacoc_shared.contest.invitation import Access, Role, read_invitation
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def seat(
    invitation: Path | None,
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Find the way to a seat; see `entrances.seat_access`.

    Raises:
        UserError: if the contest file or the invitation is wrong, or something is missing.
    """
    if invitation is not None:
        return _invited(invitation, "seat", contest, court, connect, seat, token)
    return entrances.seat_access(_load(contest), court, connect, seat, token)


def team(
    invitation: Path | None,
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access | None:
    """Find the way to a court for a team that has a token but names no seat.

    Teams have such tokens in a contest with an office; the office says where each team plays.
    None: there is an invitation, a seat is named or is the only one, or there is no token.

    Raises:
        UserError: if the contest file is wrong.
    """
    if invitation is not None or seat is not None or token is None:
        return None
    plan = _load(contest)
    if plan is not None:
        name, entry = plan.court(court or plan.asked)
        if len(entry.seat) == 1:
            return None
        court = name
    return entrances.spectator_access(plan, court, connect).of_seat("", token)


def perhaps_seat(
    invitation: Path | None,
    contest: Path | None,
    court: str | None,
    connect: str | None,
    seat: str | None,
    token: str | None,
) -> Access:
    """Find the way to a court, with seat and token if they are known; a page asks for the rest.

    Raises:
        UserError: if the contest file or the invitation is wrong.
    """
    if invitation is not None:
        return _invited(invitation, "seat", contest, court, connect, seat, token)
    plan = _load(contest)
    access = entrances.spectator_access(plan, court, connect)
    seats = plan.court(court)[1].seat if plan else {}
    if seat is None and len(seats) == 1:
        seat = next(iter(seats))
    if token is None and seat in seats:
        token = seats[seat].token
    return access.of_seat(seat or "", token or "")


def referee(
    invitation: Path | None,
    contest: Path | None,
    court: str | None,
    connect: str | None,
    token: str | None,
) -> Access:
    """Find the way to a court for its referee; see `entrances.referee_access`.

    Raises:
        UserError: if the contest file or the invitation is wrong, or something is missing.
    """
    if invitation is not None:
        return _invited(invitation, "referee", contest, court, connect, token)
    return entrances.referee_access(_load(contest), court, connect, token)


def spectator(
    invitation: Path | None, contest: Path | None, court: str | None, connect: str | None
) -> Access:
    """Find the way to a court for a spectator; any invitation is accepted.

    Raises:
        UserError: if the contest file or the invitation is wrong.
    """
    if invitation is not None:
        return _invited(invitation, None, contest, court, connect).watching()
    return entrances.spectator_access(_load(contest), court, connect)


def gateway(
    invitation: Path | None, contest: Contest | None, court: str | None, connect: str | None
) -> Access:
    """Find the way to a court for a gateway; with a person's invitation it can only watch.

    Raises:
        UserError: if the invitation or the contest's keys can't be read.
    """
    if invitation is not None:
        access = _invited(invitation, None, contest, court, connect)
        return access if access.role == "gateway" else access.watching()
    return entrances.gateway_access(contest, court, connect)


def _invited(path: Path, role: Role | None, *others: object) -> Access:
    if any(other is not None for other in others):
        raise UserError(say("contest.invitation-alone"))
    access = read_invitation(path)
    if role is not None and access.role != role:
        raise UserError(
            say("contest.invitation-for", path=str(path), wanted=role, role=access.role)
        )
    return access


def _load(path: Path | None) -> Contest | None:
    return None if path is None else contests.load(path)
