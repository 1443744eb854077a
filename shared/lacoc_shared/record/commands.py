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

from lacoc_shared.command import keep, listing, screen
from lacoc_shared.command.cli import lazy_group
from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import HealthVerdict, LinkVerdict
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export import tables as exports
from lacoc_shared.record.forked import how
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase, render, say

_NOT_IN_NAMES = re.compile(r"[^\w.-]")

app = lazy_group(
    "lacoc.commands.replay",
    help="Look at the record of a match, check it, or export tables from it.",
    listing=listing.REPLAY,
)

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="The .mcap file of a match, or any of its segments.")
]


@app.command()
def info(
    file: File,
    json: Annotated[
        bool, typer.Option("--json", help="Print one line of JSON for a program.")
    ] = False,
) -> None:
    """Say what a record holds: teams, result, versions, whether it is complete."""
    record = Record.read(file)
    found = _summary(record)
    if json:
        screen.print_json(found)
        return
    table = Table(show_header=False, box=None)
    for name, value in _lines(record, found):
        table.add_row(render(name), Text(render(value)))
    screen.show(table)
    if record.warning:
        screen.warn(record.warning)


@app.command()
def export(
    file: File,
    pos_data: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SEAT",
            help="Export the path of a seat's robot as Pos-data.txt; can be given more than once.",
        ),
    ] = None,
    events: Annotated[
        bool,
        typer.Option(
            "--events",
            help="Export all events as CSV; pos_data_s is the time in the exported Pos-data.txt.",
        ),
    ] = False,
    result: Annotated[bool, typer.Option("--result", help="Export the result as JSON.")] = False,
    picture: Annotated[
        bool,
        typer.Option(
            "--foxglove", help="Export an MCAP file that Foxglove, Lichtblick and Rerun can show."
        ),
    ] = False,
    out: Annotated[
        Path,
        typer.Option(
            metavar="DIR",
            help="Folder for the files; it is made if it does not exist. By default the current "
            "folder, not that of the record.",
        ),
    ] = Path(),
) -> None:
    """Export tables, the result or a 3D view from a record; without an option, all of them.

    An older file of the same name is kept with a number.
    """
    record = Record.read(file)
    if record.warning:
        screen.warn(record.warning)
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
    from lacoc_shared.record.export.foxglove import foxglove  # 30 modules, needed only here

    return foxglove(record)


def _made(make: Callable[[Record], bytes], record: Record) -> bytes:
    """Make the bytes of an exported file from a record.

    Raises:
        UserError: if it can't be made, for example because messages of the record contradict each
            other. A record may come from anywhere.
    """
    try:
        return make(record)
    except (ValueError, ArithmeticError, LookupError, TypeError, struct.error) as error:
        match = record.header.match_id[:80]
        raise UserError(say("replay.damaged-copy", match=match, error=str(error)[:80])) from None


def _save(folder: Path, match_id: str, made: list[tuple[str, bytes]]) -> None:
    keep.make_folder(folder)
    for name, data in made:
        # The names of match and seats come from the record, and may be any text.
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
        "fork_of": msgspec.to_builtins(header.setup.origin),
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
        "lost": record.lost,
        "cut": render(record.cut) if record.cut else "",
        "flaw": render(record.flaw) if record.flaw else "",
        "result": msgspec.to_builtins(record.result),
        "given_s": record.given_s,
        "health": msgspec.to_builtins(record.health),
    }


def _keys(record: Record, seat: int) -> dict[str, int]:
    """Count the key presses of a seat, and those of them that took effect late.

    Also find the longest time for which the court held a key back, to make links equal [beats].
    """
    inputs = (item for items in record.inputs.values() for item in items)
    keys = [item for item in inputs if isinstance(item, KeySeat) and item.seat == seat]
    return {
        "count": len(keys),
        "held_most_beats": max((key.held for key in keys), default=0),
        "late": sum(key.late > 0 for key in keys),
    }


def _how_it_ran(health: HealthVerdict | None, lost: bool) -> Phrase:
    """Return a sentence about how well the match ran."""
    if health is None:
        return say("info.result-lost") if lost else say("info.not-measured")
    measured = say(
        "info.measured",
        factor=health.real_time_factor,
        slow=health.slow_beats,
        beats=health.played_beats,
        worst_ms=health.worst_late_ms,
        faults=health.faults,
        restarts=health.resumptions,
        seats=[_link(seat) for seat in health.seats],
    )
    if health.advice:
        return say("info.replay-advised", reasons=health.advice, measured=measured)
    return say("info.well", measured=measured)


def _link(seat: LinkVerdict) -> Phrase:
    return say(
        "info.seat",
        seat=seat.id,
        arrived=seat.arrived,
        expected=seat.expected,
        times=seat.silences,
        seconds=seat.silent_s,
        refused=[say("info.refused", count=count, why=why) for why, count in seat.refused.items()],
    )


def _result(record: Record) -> Phrase:
    result = record.result
    if result is None:
        return say("info.result-lost") if record.lost else say("info.no-result")
    pairs = zip(result.teams, result.scores, strict=False)
    scores = [say("info.score", team=team, score=score) for team, score in pairs]
    given_s = record.given_s
    played_s = result.clock_s + given_s
    clock_s = result.clock_s if given_s else None
    if result.official:
        return say(
            "info.result",
            scores=scores,
            winner=result.official,
            why=result.reason,
            played_s=played_s,
            clock_s=clock_s,
        )
    return say(
        "info.result-not-official",
        scores=scores,
        winner=result.computed,
        why=result.reason,
        played_s=played_s,
        clock_s=clock_s,
    )


def _lines(record: Record, found: dict[str, Any]) -> list[tuple[Phrase, Phrase | str]]:
    """List the lines that describe a record, each with its heading."""
    match = say("info.match", match=found["match_id"], arena=found["arena"], number=found["match"])
    teams = [
        say("info.team", seat=seat, team=team) if team else say("info.no-team", seat=seat)
        for seat, team in found["teams"].items()
    ]
    keys = [
        say(
            "info.keys",
            seat=seat,
            count=counts["count"],
            beats=counts["held_most_beats"],
            late=counts["late"],
        )
        for seat, counts in found["keys"].items()
    ]
    beats = record.last_beat + 1
    holds = say(
        "info.holds",
        frames=found["frames"],
        inputs=found["inputs"],
        events=found["events"],
        snapshots=found["snapshots"],
        segments=found["segments"],
    )
    versions = ", ".join(f"{name} {version}" for name, version in found["versions"].items())
    complete = say("word.yes") if found["complete"] else say("word.no")
    if record.lost:
        complete = say("info.part-lost")
    origin = record.header.setup.origin
    fork: list[tuple[Phrase, Phrase | str]] = []
    if origin is not None:
        at = say("info.fork", match=origin.match_id, beat=origin.beat)
        fork = [(say("info-name.fork"), at), (say("info-name.forked"), how(origin.changes))]
    return [
        (say("info-name.match"), match),
        *fork,
        (say("info-name.court"), found["court"]),
        (say("info-name.begun"), found["started"]),
        (say("info-name.teams"), say("plain.sentences", sentences=teams)),
        (say("info-name.result"), _result(record)),
        (say("info-name.ran"), _how_it_ran(record.health, record.lost)),
        (say("info-name.keys"), say("plain.sentences", sentences=keys)),
        (say("info-name.length"), say("info.length", seconds=beats * BEAT_S, beats=beats)),
        (say("info-name.holds"), holds),
        (say("info-name.written-by"), versions),
        (say("info-name.complete"), complete),
    ]
