"""Computes the odds of a record, for `lacoc replay odds` and `lacoc replay highlights`."""

from pathlib import Path
from typing import Annotated

import typer

from lacoc_arenas import arena as arenas
from lacoc_server.simulate.forks.chances import Odds, Wish, compute_odds
from lacoc_server.simulate.forks.jobs import opened_record
from lacoc_server.simulate.forks.kept import read_odds, write_odds
from lacoc_server.simulate.forks.origin import ForkSource
from lacoc_server.simulate.workers import WorkerDied, Workers
from lacoc_shared.command import screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import odds_path, record_paths
from lacoc_shared.words import render, say

_LONGEST_S = 86_400.0
"""Longest time that the forks of a moment may take [s]."""

File = Annotated[Path, typer.Argument(help="The record: a .mcap file.")]
Players = Annotated[
    str | None,
    typer.Option(
        metavar="A,B",
        help="Bots that play the forks, in the order of the seats; by default the game's best bot.",
    ),
]
Times = Annotated[int, typer.Option(metavar="K", help="Number of forks at each moment.", min=2)]
Every = Annotated[float, typer.Option(help="Seconds of play between two moments.", min=1.0)]
ArenaFolder = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER",
        help="The folder of a game that is not installed; its code is run.",
        exists=True,
        file_okay=False,
    ),
]


def odds_of(
    file: Path,
    players: str | None,
    times: int,
    every_s: float,
    arena: Path | None,
    jobs: int | None,
) -> tuple[ForkSource, Odds]:
    """Compute the odds of a record, and keep them beside it.

    Args:
        file: the record.
        players: bots, by seat, with a comma between them; None: the game's best.
        times: forks at each moment.
        every_s: seconds of play between two moments.
        arena: folder of the arena, if it is not installed.
        jobs: number of processes; None: one for each core.

    Raises:
        UserError: as `compute_odds` does; or if there are not two players, a process dies, or the
            file of odds can't be written.
    """
    path = record_paths(file)[0]
    source = opened_record(str(path))
    if source.record.warning:
        screen.warn(source.record.warning)
    wish = Wish(
        file=str(path),
        bots=_bots(source, players, arena),
        forks=times,
        step_s=every_s,
        arena=None if arena is None else str(arena),
    )
    out = odds_path(path, source.match_id)
    found: Odds | None = None
    with Workers(jobs, background=True, limit_s=_LONGEST_S) as workers, screen.progress() as bar:
        task = bar.add_task(render(say("odds.moments")), total=None)
        try:
            for found in compute_odds(
                wish,
                workers,
                read_odds(out),
                lambda done, of: bar.update(task, completed=done, total=of),
            ):
                write_odds(out, found)
        except WorkerDied:
            raise UserError(say("odds.died")) from None
    assert found is not None
    return source, found


def _bots(source: ForkSource, players: str | None, folder: Path | None) -> tuple[str, str]:
    if players is None:
        setup = source.record.header.setup
        best = [*arenas.from_settings(setup.arena, setup.settings, folder).bots][-1]
        return best, best
    names = players.split(",")
    if len(names) != 2:
        raise UserError(say("odds.players", given=len(names)))
    return names[0], names[1]
