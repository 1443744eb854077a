"""Publish a contest, and check a published one."""

from pathlib import Path
from secrets import randbits
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lacoc_server.commands.contest.playing import Contest
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import options, screen
from lacoc_shared.words import render, say

if TYPE_CHECKING:
    from lacoc_server.contest.verify.check import Checked

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
    jobs: options.Jobs = None,
    json: options.Json = False,
) -> None:
    """Check a published contest: whether its standings follow from entries, facts and records.

    All draws and tables are computed again from the facts. Each result is compared with its record,
    and each record is proven by playing its inputs again. What people decided is listed, because
    nothing can prove it. The exit code is 0 if everything follows, 1 if something does not, and 2
    if the folder can't be read.
    """
    from lacoc_server.contest.verify.check import check

    seed = randbits(32) if seed is None else seed
    with screen.progress() as progress:
        task = progress.add_task(render(say("simulate.matches")), total=None)

        def changed(done: int, there: int) -> None:
            progress.update(task, completed=done, total=there)

        found = check(folder, changed, earlier=earlier, sampled=sample, seed=seed, jobs=jobs)
    if json:
        screen.print_json(_told(found, seed))
    else:
        _show(found)
    if found.findings:
        raise typer.Exit(NOT_FOLLOWING)


def _told(found: "Checked", seed: int) -> dict[str, Any]:
    return {
        "follows": not found.findings,
        "findings": [{"code": one.code, "text": render(one)} for one in found.findings],
        "decisions": [render(one) for one in found.decisions],
        "facts": found.facts,
        "games": found.games,
        "proven": found.proven,
        "least_forged": found.least_forged,
        "seed": seed,
    }


def _show(found: "Checked") -> None:
    from lacoc_server.contest.verify.sampling import CONFIDENCE

    for finding in found.findings:
        screen.show(finding)
    if found.decisions:
        screen.note(say("verify.decisions", count=len(found.decisions)))
    for decision in found.decisions:
        screen.note(decision)
    if found.findings:
        screen.show(say("verify.wrong", count=len(found.findings)))
    else:
        screen.show(say("verify.follows", games=found.games, facts=found.facts))
    if found.proven < found.games:
        said = say(
            "verify.sampled",
            proven=found.proven,
            games=found.games,
            forged=found.least_forged,
            sure=100 * CONFIDENCE,
        )
        screen.note(said)
