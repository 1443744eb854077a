"""Invite teams, referees and staff: a link for each, to hand out."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import typer
from rich.text import Text

from lacoc_server.commands.contest.playing import ContestArgument
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import options, screen
from lacoc_shared.command.csv_text import csv_text
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.contest.link import Link
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, render, say

_PAGES_PORT = 8080
"""Port of the pages in links, until the contest has run once."""


def invite(
    team: Annotated[
        str | None,
        typer.Argument(metavar="TEAM", help="Name of the team; by default all teams of people."),
    ] = None,
    contest: ContestArgument = FILE,
    staff: Annotated[
        bool,
        typer.Option(
            "--staff", help="Print the links of the courts' referees and of the staff instead."
        ),
    ] = False,
    as_csv: Annotated[
        bool,
        typer.Option("--csv", help="Print a table with who, name and link, for letters and mails."),
    ] = False,
    host: options.CourtHost = None,
    json: options.Json = False,
) -> None:
    """Print the link of each team, or with --staff of each referee and each of the staff.

    A team has one link for the whole contest. It opens the page that says when and where the team
    plays next, and goes from court to court by itself; commands take it too ('lacoc play LINK').
    Whoever has the link plays for the team. A referee's link opens the desk of one court; that of
    one of the staff opens /office, and decisions name who made them ('lacoc contest staff').
    """
    if staff and team is not None:
        raise UserError(say("contest.invite-either"))
    plan = contests.load(contest)
    people = [*_staff(plan, contest, host)] if staff else [*_teams(plan, contest, team, host)]
    if json:
        links = {one.name: one.link for one in people}
        of_kind = {
            kind: {one.name: one.link for one in people if one.kind == kind}
            for kind in ("referee", "staff")
        }
        screen.print_json(of_kind if staff else links)
        return
    if as_csv:
        sys.stdout.write(csv_text([Invited._fields, *people]).decode("utf-8-sig"))
        return
    for one in people:
        screen.show(Text(render(_title(one)), style="dim"))
        screen.stdout.print(one.link, markup=False, soft_wrap=True)  # to be copied whole
    if not staff and team is None:
        screen.note(say("contest.invite-staff"))
    if not plan.public.pages:
        screen.note(say("contest.invite-pages", pages=_pages(plan, contest, host)))


class Invited(NamedTuple):
    """A link, and the person or team that gets it."""

    kind: Literal["team", "referee", "staff"]
    name: str
    """Name of the team, of the referee's court, or of the member of the staff."""
    link: str


def _teams(plan: ContestFile, file: Path, team: str | None, host: str | None) -> Iterator[Invited]:
    """Yield the links of all teams that people (not bots) play for, or of one team."""
    from lacoc_server.contest.acts import organiser

    for name, token in organiser.tokens(file, team).items():
        yield Invited("team", name, link(plan, file, "play", token, host))


def _staff(plan: ContestFile, file: Path, host: str | None) -> Iterator[Invited]:
    """Yield the link of each court's referee, then those of the staff."""
    for court in plan.courts:
        token = plan.secrets.referee(court)
        yield Invited("referee", court, link(plan, file, "referee", token, host, court))
    for name in plan.secrets.staff_names:
        yield Invited("staff", name, link(plan, file, "office", plan.secrets.staff(name), host))


def _title(one: Invited) -> Phrase:
    if one.kind == "referee":
        return say("contest.for-referee", court=one.name)
    if one.kind == "staff":
        return say("contest.for-staff", name=one.name)
    return say("contest.for-team", team=one.name)


def link(
    plan: ContestFile, file: Path, page: str, token: str, host: str | None = None, court: str = ""
) -> str:
    """Return a link to a page of a contest.

    Args:
        plan: the contest.
        file: its contest file.
        page: name of the page.
        token: token of the person or team that gets the link.
        host: host in the link, if the contest file does not say where the pages are; None: this
            machine's.
        court: the court that the link names; "": none.
    """
    authority = plan.public.fingerprint
    pages = _pages(plan, file, host)
    return Link(pages=pages, page=page, court=court, token=token, authority=authority).text


def _pages(plan: ContestFile, file: Path, host: str | None) -> str:
    """Return the address of the pages: that of the file, else the port of the last run here."""
    if plan.public.pages:
        return plan.public.pages
    try:
        port = contests.port_path(file).read_text()
    except OSError:  # it has not run yet
        port = str(_PAGES_PORT)
    return f"{plan.public.scheme}://{host or plan.own_host}:{port}"
