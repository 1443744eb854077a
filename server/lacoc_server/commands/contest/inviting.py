"""Invite the teams: one line for each, to hand out."""

from typing import Annotated

import typer
from rich.text import Text

from lacoc_server.commands.contest.playing import Contest
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import options, screen
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.words import render, say

_PAGES_PORT = 8080


def invite(
    team: Annotated[
        str | None,
        typer.Argument(metavar="TEAM", help="Name of the team; by default all teams of people."),
    ] = None,
    contest: Contest = FILE,
    host: options.CourtHost = None,
    json: options.Json = False,
) -> None:
    """Print the link of each team, and the command that does the same.

    A team has one token for the whole contest. Its link opens the page that says when and where the
    team plays next, and goes from court to court by itself. Whoever has the link plays for the
    team.
    """
    from lacoc_server.contest import organiser

    tokens = organiser.tokens(contest, team)
    plan = contests.load(contest)
    any_host = host or plan.own_host
    address = plan.public.pages or f"{plan.public.scheme}://{any_host}:{_PAGES_PORT}"
    lines = {
        name: entrances.team_lines(plan, token, address, any_host) for name, token in tokens.items()
    }
    if json:
        screen.print_json(lines)
        return
    for name, ways in lines.items():
        screen.show(Text(render(say("contest.for-team", team=name)), style="dim"))
        for way in ways.values():
            screen.stdout.print(way, markup=False, soft_wrap=True)  # to be copied whole
    if not plan.public.pages:
        screen.note(say("contest.invite-pages", pages=address))
