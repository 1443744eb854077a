"""From what was said on the command line to the way to a court."""

from pathlib import Path

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
