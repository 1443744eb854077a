"""Run courts of a contest on a machine that is not the office's."""

import time
from contextlib import ExitStack
from typing import Annotated

import typer

from lacoc_server.commands.contest.playing import ContestArgument
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import screen
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def courts(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="COURT",
            help="Courts to run here; by default all courts with 'elsewhere' in the contest file.",
        ),
    ] = None,
    contest: ContestArgument = FILE,
    speed: Annotated[
        float, typer.Option(help="2 plays twice as fast as real time.", min=0.1, max=50)
    ] = 1.0,
) -> None:
    """Run courts on a machine of their own, for an office on another machine.

    In the contest file, 'elsewhere' of a court is the address of this machine. Both machines need
    the same contest file and the same secrets file (contest.secrets.json). The courts stay open
    until Ctrl-C; a court that ends is started again.

    The office copies their records while they are written. If this machine is gone for ten seconds,
    the office runs a court itself: its match goes on where the copy ends. If this machine comes
    back, its court ends.
    """
    from lacoc_server.contest.kept.folder import ContestFolder
    from lacoc_server.contest.live import venue

    where = ContestFolder(contest)
    chosen = names or [name for name, one in where.contest.courts.items() if one.elsewhere]
    if not chosen:
        raise UserError(say("contest.none-elsewhere", file=str(contest)))
    for name in chosen:
        if not where.contest.court(name)[1].elsewhere:
            raise UserError(say("contest.not-elsewhere", court=name))
    where.contest.secrets.check_copied(*chosen)
    with ExitStack() as stack:
        logs = stack.enter_context(Scratch("courts"))
        for name in chosen:
            opened = venue.court(where, name, logs / name, speed, screen.note, here=False)
            screen.show(say("contest.court-runs", court=name, at=stack.enter_context(opened)))
        while True:
            time.sleep(1)
