"""`lacoc replay`: look at the record of a match, and take tables and pictures out of it."""

import re
import struct
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import msgspec
import typer
from rich.table import Table
from rich.text import Text

from lacoc_shared.command import keep, screen
from lacoc_shared.command.cli import lazy_group
from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import HealthVerdict
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export import tables as exports
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import counted, render, say

_NOT_IN_NAMES = re.compile(r"[^\w.-]")

app = lazy_group(
    "lacoc.commands.replay",
    help="Look at the record of a match, check it, take tables out of it.",
)

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="The .mcap of a match, or any of its segments.")
]


@app.command()
def info(
    file: File,
    json: Annotated[bool, typer.Option("--json", help="One line of JSON for a program.")] = False,
) -> None:
    """Say what a record holds: teams, result, versions, whether it is complete."""
    record = Record.read(file)
    found = _summary(record)
    if json:
        screen.print_json(found)
        return
    table = Table(show_header=False, box=None)
    for name, value in _lines(record, found):
        table.add_row(name, Text(value))
    screen.show(table)
    if record.cut:
        screen.warn(record.cut)


@app.command()
def export(
    file: File,
    pos_data: Annotated[
        list[str] | None,
        typer.Option(metavar="SEAT", help="The way of a seat's robot as Pos-data.txt; repeatable."),
    ] = None,
    events: Annotated[bool, typer.Option("--events", help="All events as CSV.")] = False,
    result: Annotated[bool, typer.Option("--result", help="The result as JSON.")] = False,
    picture: Annotated[
        bool, typer.Option("--foxglove", help="An MCAP that Foxglove, Lichtblick and Rerun draw.")
    ] = False,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for the files; made if it is not there.")
    ] = Path(),
) -> None:
    """Take tables, the result or a 3D view out of a record. Without an option: all of them.

    A file of the same name that is there already is kept with a number.
    """
    record = Record.read(file)
    if record.cut:
        screen.warn(record.cut)
    everything = not (pos_data or events or result or picture)
    makers: list[tuple[str, Callable[[Record], bytes]]] = [
        (f"Pos-data-{seat}.txt", partial(exports.pos_data, seat=seat))
        for seat in (exports.seat_ids(record) if everything else pos_data or ())
    ]
    if events or everything:
        makers.append(("events.csv", exports.events_csv))
    if result or everything:
        makers.append(("result.json", exports.result_json))
    if picture or everything:
        makers.append(("foxglove.mcap", _foxglove))
    made: list[tuple[str, bytes]] = []
    for name, make in makers:
        try:
            made.append((name, _made(make, record)))
        except UserError as error:
            if not everything:
                raise
            screen.warn(str(error))
    _save(out, record.header.match_id, made)


def _foxglove(record: Record) -> bytes:
    from lacoc_shared.record.export.foxglove import foxglove  # 30 modules, for this alone

    return foxglove(record)


def _made(make: Callable[[Record], bytes], record: Record) -> bytes:
    """Make a file of a record.

    Raises:
        UserError: if it can't be made, also because the record's messages contradict each other:
            it may come from anywhere.
    """
    try:
        return make(record)
    except (ValueError, ArithmeticError, LookupError, TypeError, struct.error) as error:
        match = record.header.match_id[:80]
        raise UserError(say("replay.damaged-copy", match=match, error=str(error)[:80])) from None


def _save(folder: Path, match_id: str, made: list[tuple[str, bytes]]) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-make-folder", folder=str(folder), why=why)) from None
    for name, data in made:
        # The names of match and seats are the record's, and may be anything.
        path = folder / _NOT_IN_NAMES.sub("_", f"{match_id}-{name}")
        keep.save(path, data)
        screen.show(str(path))


def _summary(record: Record) -> dict[str, Any]:
    header = record.header
    sheet = record.sheets[-1][1] if record.sheets else None
    return {
        "match_id": header.match_id,
        "court": header.setup.court,
        "match": header.setup.match,
        "arena": header.setup.arena,
        "started": header.started,
        "versions": header.versions,
        "teams": {seat.id: seat.team for seat in sheet.seats} if sheet else {},
        "segments": len(record.headers),
        "last_beat": record.last_beat,
        "frames": len(record.frames),
        "inputs": sum(map(len, record.inputs.values())),
        "keys": {
            seat.id: _keys(record, index) for index, seat in enumerate(sheet.seats if sheet else ())
        },
        "events": len(record.events),
        "snapshots": len(record.snapshots),
        "complete": not record.cut,
        "cut": record.cut,
        "result": msgspec.to_builtins(record.result),
        "health": msgspec.to_builtins(record.health),
    }


def _keys(record: Record, seat: int) -> dict[str, int]:
    """How many keys of a seat came in, and what its link made of them."""
    inputs = (item for items in record.inputs.values() for item in items)
    keys = [item for item in inputs if isinstance(item, KeySeat) and item.seat == seat]
    return {
        "count": len(keys),
        "held_most_beats": max((key.held for key in keys), default=0),
        "late": sum(key.late > 0 for key in keys),
    }


def _held(health: HealthVerdict | None) -> str:
    """How well the match was held, in words."""
    if health is None:
        return "headless, or not played: nothing was measured"
    words = [
        f"{health.real_time_factor:.3f} of real time",
        f"{health.slow_beats} of {health.played_beats} beats slow",
        f"the latest by {health.worst_late_ms:.0f} ms",
        f"{health.faults} stops of physics",
        f"{health.resumptions} resumptions",
    ]
    for seat in health.seats:
        refused = ", ".join(f"{count} {counted(why)}" for why, count in seat.refused.items())
        words.append(
            f"{seat.id}: {seat.arrived} of {seat.expected} repeats, {seat.silences} silences of "
            f"{seat.silent_s:.1f} s, refused {refused or 'nothing'}"
        )
    advised = (
        f"Replay advised: {'; '.join(map(render, health.advice))}" if health.advice else "Well held"
    )
    return f"{advised} ({'; '.join(words)})"


def _lines(record: Record, found: dict[str, Any]) -> list[tuple[str, str]]:
    result = record.result
    if result is None:
        ended = "none: the match was never finished"
    else:
        scores = ", ".join(
            f"{team} {score}" for team, score in zip(result.teams, result.scores, strict=False)
        )
        winner = result.official or f"{result.computed} (not official)"
        ended = f"{scores}; winner: {winner}; {render(result.reason)}, after {result.clock_s:.2f} s"
    versions = ", ".join(f"{name} {version}" for name, version in found["versions"].items())
    counts = ("frames", "inputs", "events", "snapshots", "segments")
    return [
        ("Match", f"{found['match_id']}: {found['arena']}, match {found['match']}"),
        ("Court", found["court"]),
        ("Begun", found["started"]),
        (
            "Teams",
            ", ".join(f"{seat}: {team or 'nobody'}" for seat, team in found["teams"].items()),
        ),
        ("Result", ended),
        ("Held", _held(record.health)),
        (
            "Keys",
            "; ".join(
                f"{seat}: {keys['count']}, held for {keys['held_most_beats']} beats at most, "
                f"{keys['late']} late"
                for seat, keys in found["keys"].items()
            ),
        ),
        ("Length", f"{(record.last_beat + 1) * BEAT_S:.2f} s in {record.last_beat + 1} beats"),
        ("Holds", ", ".join(f"{found[name]} {name}" for name in counts)),
        ("Written by", versions),
        ("Complete", "yes" if found["complete"] else "no"),
    ]
