"""`lacoc replay odds`: the chance to win over the course of a match."""

from collections.abc import Sequence

import typer

from lacoc_server.commands.replay.curve import ArenaFolder, Every, File, Players, Times, odds_of
from lacoc_server.simulate.forks.odds import near_margins
from lacoc_shared.command import options, screen
from lacoc_shared.words import say

app = typer.Typer()


@app.command(name="odds")
def odds_command(
    file: File,
    players: Players = None,
    times: Times = 4,
    every: Every = 4.0,
    arena: ArenaFolder = None,
    jobs: options.Jobs = None,
    json: options.Json = False,
) -> None:
    """Print how the chance to win changes during a match, computed from forks that bots play.

    The chance is that of two bots that take over at a moment. So it tells what the position is
    worth, not who plays better. The last column says by how many points each fork ended. In
    brackets are those of moments nearby, which count for the chance too.

    The odds are kept beside the record, as MATCH.odds.json; /replay shows them as a curve. Forks
    that were played are not played again.
    """
    _, found = odds_of(file, players, times, every, arena, jobs)
    if json:
        screen.print_json(found)
        return
    left, right = found.seats
    table = screen.table(
        say("fact.clock-s"),
        say("fact.beat"),
        say("fact.chance", seat=left),
        say("fact.chance", seat=right),
        say("fact.margins"),
    )
    for one, near in zip(found.moments, near_margins(found.moments), strict=True):
        percent = round(100 * one.chance)
        margins = _margins(one.margins) + (f" ({_margins(near)})" if near else "")
        table.add_row(
            f"{one.clock_s:.1f}", str(one.beat), f"{percent} %", f"{100 - percent} %", margins
        )
    screen.show(table)


def _margins(margins: Sequence[float]) -> str:
    return " ".join(f"{margin:+g}" if margin else "0" for margin in margins)
