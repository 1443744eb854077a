"""Publish a contest, and check a published one."""

import os
from pathlib import Path
from secrets import randbits
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lacoc_server.commands.contest.playing import ContestArgument
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import options, screen
from lacoc_shared.words import render, say

if TYPE_CHECKING:
    from lacoc_server.contest.verify.check import ContestCheck

NOT_FOLLOWING = 1
"""Exit code: the standings do not follow from what is published."""
NOT_PROVEN = 3
"""Exit code: nothing contradicts the standings, but not all could be checked here."""

_LISTED = 12
"""Most lines that are shown of a kind of finding; with --json all are printed."""

_Folder = Annotated[Path, typer.Argument(metavar="FOLDER", help="The published folder.")]


def publish(folder: _Folder, contest: ContestArgument = FILE) -> None:
    """Write the contest as a folder that any web server can show and anybody can check.

    It has pages, tables (CSV and JSON), the facts, the files of all teams and the records of all
    games, but no token. It can be written again while the contest goes on.
    """
    from lacoc_server.contest.acts import organiser

    organiser.publish_to(contest, folder)
    screen.show(say("contest.published", folder=str(folder)))


def verify(
    folder: _Folder,
    earlier: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="A folder of this contest that was published earlier, or its facts.json: all that "
            "it said must still be there.",
        ),
    ] = None,
    sample: Annotated[
        int | None,
        typer.Option(
            metavar="N", min=1, help="Prove the records of only N games, chosen at random."
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(help="Number that chooses the games of --sample; by default a new one."),
    ] = None,
    programs: Annotated[
        bool,
        typer.Option(
            "--programs",
            help="Also run the programs of bots that came with entries. They run with your rights: "
            "only for teams that you trust.",
        ),
    ] = False,
    jobs: options.Jobs = None,
    json: options.Json = False,
) -> None:
    """Check a published contest: whether its standings follow from entries, facts and records.

    All draws and tables are computed again from the facts. Each result is compared with its record,
    and each record is proven by playing its inputs again. In games without a network each bot must
    press the recorded keys again. What people decided is listed, because nothing can prove it. The
    exit code is 0 if everything follows, 1 if something does not, 2 if the folder can't be read,
    and 3 if nothing contradicts the standings but not all could be checked.
    """
    from lacoc_server.contest.verify.check import check

    seed = randbits(32) if seed is None else seed
    with screen.progress() as progress:
        task = progress.add_task(render(say("verify.computes")), total=None)

        def changed(done: int, there: int) -> None:
            if not done and there:
                count = min(there, jobs or os.cpu_count() or 1)
                screen.note(say("verify.takes", games=there, jobs=count))
            proves = render(say("verify.proves"))
            progress.update(task, completed=done, total=there, description=proves)

        found = check(
            folder,
            changed,
            earlier=earlier,
            sampled=sample,
            seed=seed,
            jobs=jobs,
            programs=programs,
        )
    if json:
        screen.print_json(_told(found, seed))
    else:
        _show(found)
    if found.findings:
        raise typer.Exit(NOT_FOLLOWING)
    if found.unchecked:
        raise typer.Exit(NOT_PROVEN)


def _told(found: "ContestCheck", seed: int) -> dict[str, Any]:
    return {
        "follows": not found.findings,
        "findings": [{"code": one.code, "text": render(one)} for one in found.findings],
        "unchecked": [render(one) for one in found.unchecked],
        "decisions": [render(one) for one in found.decisions],
        "in_play": [render(one) for one in found.in_play],
        "facts": found.facts,
        "games": found.games,
        "proven": found.proven,
        "by_bots": found.by_bots,
        "by_people": found.by_people,
        "least_forged": found.least_forged,
        "seed": seed,
    }


def _show(found: "ContestCheck") -> None:
    from lacoc_server.contest.verify.sampling import CONFIDENCE

    for finding in found.findings:
        screen.show(finding)
    for title, told in (
        (say("verify.decisions", count=len(found.decisions)), found.decisions),
        (say("verify.referees", count=len(found.in_play)), found.in_play),
        (say("verify.not-all", count=len(found.unchecked)), found.unchecked),
    ):
        if told:
            screen.note(title)
        for one in told[:_LISTED]:
            screen.note(one)
        if (more := len(told) - _LISTED) > 0:
            screen.note(say("verify.more", count=more))
    if found.findings:
        screen.show(say("verify.wrong", count=len(found.findings)))
        return
    screen.show(say("verify.follows", games=found.games, facts=found.facts))
    unchecked = found.games - found.by_bots - found.by_people
    keys = say("verify.keys", bots=found.by_bots, people=found.by_people, unchecked=unchecked)
    screen.show(keys)
    if found.unchecked:
        screen.note(say("verify.usual"))
    if found.proven < found.games:
        said = say(
            "verify.sampled",
            proven=found.proven,
            games=found.games,
            forged=found.least_forged,
            sure=100 * CONFIDENCE,
        )
        screen.note(said)
