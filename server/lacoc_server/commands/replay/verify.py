"""`lacoc replay verify`: judge a recorded match again, simulate its physics, and compare."""

from pathlib import Path
from typing import Annotated, Any

import typer

from lacoc_server.journal.replay import verify
from lacoc_server.journal.section import BOUND
from lacoc_server.journal.verdict import Verdict, VerdictKind, other_arithmetic
from lacoc_server.world import arithmetic
from lacoc_shared.command import options, screen
from lacoc_shared.record.files import record_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.words import Phrase, render, say

app = typer.Typer()

NOT_PROVEN = 1
"""Exit code: the record differs from the match computed from its inputs, or lost a part."""


@app.command(name="verify")
def verify_command(
    file: Annotated[Path, typer.Argument(help="The record: a .mcap file.")],
    arena: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="The folder of a game that is not installed; its code is run.",
            exists=True,
            file_okay=False,
        ),
    ] = None,
    bound: Annotated[
        float,
        typer.Option(
            metavar="M",
            help="How far the results of another machine may be from the record [m, rad].",
            min=0.0,
            max=1e-3,
        ),
    ] = BOUND,
    json: options.Json = False,
) -> None:
    """Judge a record again, simulate it again section by section, and print one of three verdicts.

    "same, bit for bit": this machine computes every bit of the record.

    "same match, other arithmetic": another kind of machine recorded it, and only the last bits
    differ. The games and the result are what the inputs give, and no robot is farther than --bound
    from its recorded place.

    "beat N differs": the record is not what its inputs give. The exit code is 1, also if a part of
    the record is lost or damaged. If only the index of the file is damaged, nothing is lost: the
    whole match is verified, and the exit code is that of the verdict.

    A fork ('lacoc replay fork') is verified as any record, and the first line says what it is a
    fork of.

    A folder that only the record names is never used, because its code would run.
    """
    record = Record.read(record_paths(file))
    verdict: Verdict | None = None
    with screen.progress() as progress:
        task = progress.add_task("simulating", total=record.last_beat + 1)
        for step in verify(record, arena, bound):
            if isinstance(step, Verdict):
                verdict = step
            else:
                progress.update(task, completed=step)
    assert verdict is not None
    proven = verdict.same and not record.lost
    if json:
        screen.print_json({"same": proven, **_told(record, verdict)})
    else:
        for line in _lines(record, verdict):
            screen.show(line)
    if not proven:
        raise typer.Exit(NOT_PROVEN)


def _told(record: Record, verdict: Verdict) -> dict[str, Any]:
    return {
        "verdict": verdict.kind.value,
        "lost": record.lost,
        "fork_of": record.header.setup.origin,
        "beats": verdict.beats,
        "frames": verdict.frames,
        "sections": verdict.sections,
        "differs_at": verdict.differs_at,
        "distance": verdict.distance,
        "worst_section": verdict.worst,
        "text": render(_said(record, verdict)),
        "cut": render(record.cut) if record.cut else "",
        "flaw": render(record.flaw) if record.flaw else "",
        "arithmetic": {"record": record.header.arithmetic, "here": dict(arithmetic.here())},
    }


def _said(record: Record, verdict: Verdict) -> Phrase:
    """Return the verdict in words; if a part of the record is lost, they are about the rest."""
    if record.lost and verdict.same:
        return say("verdict.rest", verdict=verdict.said)
    return verdict.said


def _lines(record: Record, verdict: Verdict) -> list[str]:
    origin = record.header.setup.origin
    lines: list[Phrase | str | None] = [
        # First what nobody may overlook: this is a fork, or a part of the record is lost.
        say("verdict.fork", match=origin.match_id, beat=origin.beat, hash=origin.record_hash)
        if origin
        else None,
        say("verdict.lost", cut=record.cut) if record.lost else None,
        say(
            "verdict.line",
            verdict=_said(record, verdict),
            beats=verdict.beats,
            frames=verdict.frames,
            sections=verdict.sections,
        ),
    ]
    if verdict.kind is not VerdictKind.SAME:
        there = record.headers[-1].arithmetic
        lines.append(other_arithmetic(there, arithmetic.here()))
    if not record.lost:
        lines.append(record.warning)
    return [render(line) for line in lines if line]
