"""Invite the teams: one line for each, to hand out."""

from typing import Annotated

import typer
from rich.text import Text

from lacoc_server.commands.contest.playing import ContestArgument
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import options, screen
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.contest.link import Link
from lacoc_shared.words import render, say

_PAGES_PORT = 8080


def invite(
    team: Annotated[
        str | None,
        typer.Argument(metavar="TEAM", help="Name of the team; by default all teams of people."),
    ] = None,
    contest: ContestArgument = FILE,
    host: options.CourtHost = None,
    json: options.Json = False,
) -> None:
    """Print the link of each team.

    A team has one link for the whole contest. It opens the page that says when and where the team
    plays next, and goes from court to court by itself; commands take it too ('lacoc play LINK').
    Whoever has the link plays for the team.
    """
    from lacoc_server.contest.acts import organiser

    tokens = organiser.tokens(contest, team)
    plan = contests.load(contest)
    links = {name: link(plan, "play", token, host) for name, token in tokens.items()}
    if json:
        screen.print_json(links)
        return
    for name, text in links.items():
        screen.show(Text(render(say("contest.for-team", team=name)), style="dim"))
        screen.stdout.print(text, markup=False, soft_wrap=True)  # to be copied whole
    if not plan.public.pages:
        screen.note(say("contest.invite-pages", pages=_pages(plan, host)))


def link(plan: ContestFile, page: str, token: str, host: str | None = None) -> str:
    """Return a link to a page of a contest.

    Args:
        plan: the contest file.
        page: name of the page.
        token: token of whom the link is for.
        host: host in the link, if the contest file does not say where the pages are; None: this
            machine's.
    """
    authority = plan.public.fingerprint
    return Link(pages=_pages(plan, host), page=page, token=token, authority=authority).text


def _pages(plan: ContestFile, host: str | None) -> str:
    return plan.public.pages or (f"{plan.public.scheme}://{host or plan.own_host}:{_PAGES_PORT}")
