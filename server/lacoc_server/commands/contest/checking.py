"""Publish a contest, and check a published one."""

from pathlib import Path
from secrets import randbits
from typing import Annotated

import typer

from lacoc_server.commands.contest.playing import Contest
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import options, screen
from lacoc_shared.words import render, say

NOT_FOLLOWING = 1
"""Exit code: the standings do not follow from what is published."""

_Folder = Annotated[Path, typer.Argument(metavar="FOLDER", help="The published folder.")]


def publish(folder: _Folder, contest: Contest = FILE) -> None:
    """Write the contest as a folder that any web server can show and anybody can check.

    It has pages, tables (CSV and JSON), the facts, the files of all teams and the records of all
    games, but no token. It can be written again while the contest goes on.
    """
    from lacoc_server.contest import organiser

    organiser.publish_to(contest, folder)
    screen.show(say("contest.published", folder=str(folder)))


def verify(
    folder: _Folder,
    sample: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, help="Prove only N games, chosen by chance."),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(help="Number that chooses the games of --sample; by default a new one."),
    ] = None,
    jobs: options.Jobs = None,
    json: options.Json = False,
) -> None:
    """Check a published contest: whether its standings follow from entries, facts and records.

    All tables are computed again from the facts. Each result is compared with its record, and each
    record is proven by playing its inputs again. The exit code is 0 if everything follows, 1 if
    something does not, and 2 if the folder can't be read.
    """
    from lacoc_server.contest import organiser
    from lacoc_server.contest.verify import CONFIDENCE

    seed = randbits(32) if seed is None else seed
    with screen.progress() as progress:
        task = progress.add_task(render(say("simulate.matches")), total=None)

        def changed(done: int, there: int) -> None:
            progress.update(task, completed=done, total=there)

        found = organiser.check(folder, sample, seed, jobs, changed)
    if json:
        lines = [{"code": one.code, "text": render(one)} for one in found.findings]
        end = {"follows": not lines, "games": found.games, "of": found.all_games, "seed": seed}
        screen.print_json({**end, "facts": found.facts, "findings": lines})
    else:
        for finding in found.findings:
            screen.show(finding)
        if found.findings:
            screen.show(say("verify.wrong", count=len(found.findings)))
        else:
            screen.show(say("verify.follows", games=found.games, facts=found.facts))
        if sample is not None:
            share, sure = 100 * found.least_share, 100 * CONFIDENCE
            there = found.all_games
            said = say("verify.sampled", games=found.games, all=there, share=share, sure=sure)
            screen.note(said)
    if found.findings:
        raise typer.Exit(NOT_FOLLOWING)
