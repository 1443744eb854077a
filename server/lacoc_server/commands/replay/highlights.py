"""`lacoc replay highlights`: the moments in which the odds of a match changed most."""

from typing import Annotated, Any

import typer

from lacoc_server.commands.replay.curve import ArenaFolder, Every, File, Players, Times, odds_of
from lacoc_server.simulate.forks.odds import Swing, highlights
from lacoc_server.simulate.forks.origin import ForkSource
from lacoc_shared.command import options, screen
from lacoc_shared.messages import Event
from lacoc_shared.words import render, say

app = typer.Typer()


@app.command(name="highlights")
def highlights_command(
    file: File,
    most: Annotated[
        int, typer.Option(metavar="N", help="Largest number of moments to list.", min=1)
    ] = 8,
    players: Players = None,
    times: Times = 4,
    every: Every = 4.0,
    arena: ArenaFolder = None,
    jobs: options.Jobs = None,
    json: options.Json = False,
) -> None:
    """List the moments in which the odds of a match changed most, the largest change first.

    The odds are those of 'lacoc replay odds'. A moment has its first and last beat, so that a clip
    can be made of it, and what happened in it.
    """
    source, found = odds_of(file, players, times, every, arena, jobs)
    chosen = highlights(found.moments, most)
    if json:
        screen.print_json({"moments": [_told(source, one) for one in chosen]})
        return
    if not chosen:
        screen.show(say("odds.no-highlights"))
        return
    table = screen.table(
        say("fact.clock-s"),
        say("fact.beats"),
        say("fact.chance", seat=found.seats[0]),
        say("fact.what-happened"),
    )
    for one in chosen:
        events = [render(event.said) for event in _events(source, one)]
        table.add_row(
            f"{one.before.clock_s:.1f}-{one.after.clock_s:.1f}",
            f"{one.before.beat}-{one.after.beat}",
            f"{100 * one.before.chance:.0f} → {100 * one.after.chance:.0f} %",
            "\n".join(events),
        )
    screen.show(table)


def _told(source: ForkSource, one: Swing) -> dict[str, Any]:
    """Return a moment in the form that `lacoc film --moments` reads, with some more entries."""
    events = _events(source, one)
    return {
        "beat": events[-1].beat if events else one.after.beat,
        "swing": abs(one.change),
        "first_beat": one.before.beat,
        "last_beat": one.after.beat,
        "chance": (one.before.chance, one.after.chance),
        "events": [event.number for event in events],
    }


def _events(source: ForkSource, one: Swing) -> list[Event]:
    """Return the events at markers, the decisions and the restarts during a swing."""
    return [
        event
        for event in source.record.events
        if one.before.beat <= event.beat < one.after.beat
        and ("marker" in event.data or event.kind in ("decision", "restart"))
    ]
