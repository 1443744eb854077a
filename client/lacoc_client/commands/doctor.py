"""`lacoc doctor`: check this machine and its link to courts."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table
from rich.text import Text

from lacoc_client.commands import entrance
from lacoc_client.commands.checks import machine as doctor
from lacoc_client.commands.checks.link import link as look_at
from lacoc_client.commands.checks.machine import Finding, Status
from lacoc_client.commands.checks.pages import pages, plain_courts
from lacoc_shared.command import options, screen
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.courts import LOOPBACK
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render, say

app = typer.Typer()

NOT_READY = 1
"""Exit code if there is a problem."""

_STYLES = {Status.OK: "green", Status.NOTE: "yellow", Status.PROBLEM: "bold red"}
_WEB = "0.0.0.0:8080"
_HOST_PORT = re.compile(r"(?:\w+/)?(?P<host>\[[^\]]+\]|[^:/]+):(?P<port>\d{1,5})")


@app.command(name="doctor")
def doctor_command(
    link: options.Link = None,
    contest: options.ContestOption = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    recordings: Annotated[
        Path | None,
        typer.Option(
            envvar="LACOC_RECORDINGS",
            metavar="FOLDER",
            help="Folder of the records; by default the contest's, or 'recordings'.",
        ),
    ] = None,
    web: Annotated[
        str | None,
        typer.Option(
            envvar="LACOC_WEB_LISTEN",
            metavar="HOST:PORT",
            help=f"Address at which 'lacoc web' will serve; by default {_WEB} is checked.",
        ),
    ] = None,
    seconds: Annotated[
        float,
        typer.Option(
            help="How many seconds to measure the clock and the frames.", min=0.2, max=600
        ),
    ] = 3.0,
    json: options.Json = False,
) -> None:
    """Check whether this machine is ready: packages, ports, graphics, clock, disk.

    With a link, --connect or --contest this command also checks the connection to each court:
    whether the court answers, how long a request takes, and how many frames arrive. If the contest
    file says where everybody opens the pages, this command opens them there as a browser does. With
    --court it checks only that court. A court of the contest file that does not run yet is only a
    note. Every finding is ok, a note or a problem; notes and
    problems say what to do. The exit code is 0 unless there is a problem.
    """
    plan = None if contest is None else contests.load(contest)
    planned = [*plan.courts] if plan and court is None else [court]
    ways: list[Access] = []
    if link is not None or connect is not None:
        ways = [*entrance.courts(link, court, connect).values()]
    elif plan is not None:
        ways = [plan.access(plan.court(one)[0]) for one in planned]
    folder = recordings or (plan.recordings if plan else Path("recordings"))
    findings = list(_look(plan, planned, web, folder, seconds))
    if plan is not None and plan.public.pages:
        findings += [*plain_courts(plan.public, plan.courts), *pages(plan.public, plan.given_name)]
    for way in ways:
        findings += look_at(way, seconds, planned=plan is not None and not (link or connect))
    if json:
        screen.print_json([finding.in_words() for finding in findings])
    else:
        screen.show(_table(findings))
    if any(finding.status is Status.PROBLEM for finding in findings):
        raise typer.Exit(NOT_READY)


def _look(
    plan: ContestFile | None,
    courts: Sequence[str | None],
    web: str | None,
    folder: Path,
    seconds: float,
) -> Iterator[Finding]:
    yield from doctor.packages()
    if plan is None:
        yield doctor.court_port(*_host_port(LOOPBACK), None)
    for name, entry in map(plan.court, courts) if plan else ():
        authority = plan.public.read_authority() if plan else ""
        for address in entry.listen:
            protocol = address.partition("/")[0]
            yield doctor.court_port(*_host_port(address), name, protocol, authority)
    title = plan.given_name if plan else ""
    yield doctor.web_port(*_host_port(web or _WEB), needed=web is not None, title=title)
    yield doctor.graphics()
    yield doctor.clock(seconds)
    yield doctor.disk(folder)


def _host_port(address: str) -> tuple[str, int]:
    match = _HOST_PORT.fullmatch(re.split("[#?]", address)[0])
    if match is None or int(match["port"]) > 65_535:
        raise UserError(say("command.bad-listen", where=address))
    return match["host"].strip("[]"), int(match["port"])


_WIDTH = 100
"""Width of the table where the output is no terminal [characters]."""
_STATUS_WORDS = {
    Status.OK: say("status.ok"),
    Status.NOTE: say("status.note"),
    Status.PROBLEM: say("status.problem"),
}


def _table(findings: list[Finding]) -> Table:
    # A person reads this table, also from a file; programs take --json.
    width = None if screen.stdout.is_terminal else _WIDTH
    titles = ("", render(say("fact.what")), render(say("fact.found-and-todo")))
    table = Table(*titles, width=width)
    for finding in (one.in_words() for one in findings):
        what = Text(str(finding.found))
        if finding.todo:
            what.append(f"\n{finding.todo}", "dim" if finding.status is Status.OK else "bold")
        status = render(_STATUS_WORDS[finding.status])
        table.add_row(Text(status, _STYLES[finding.status]), Text(str(finding.about)), what)
    return table
