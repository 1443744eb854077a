"""Prints and writes the gaits that `lacoc coach` found: a map of gaits, or six to choose from."""

import contextlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from msgspec.structs import asdict
from rich.table import Table
from rich.text import Text

from lacoc_robots.robot import RobotSpec
from lacoc_server.commands.trial import warned_gait
from lacoc_server.studio.coach.table import Angles
from lacoc_server.studio.coach.trials import Task
from lacoc_shared.command import screen
from lacoc_shared.command.keep import save
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable
from lacoc_shared.gait.text import write_gait
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import MapReply, OtherGait, VariantsReply
from lacoc_shared.words import render, say

_WAYS_SHOWN = 3


def map_table(reply: MapReply) -> Table:
    """Make a table of a map of gaits: speed grows to the right, arousal upward.

    A cell has the gait's speed and, in brackets, the number of changed angles.
    """
    table = screen.table(say("coach.arousal"))
    for speed_mm_s in reply.speeds_mm_s:
        table.add_column(f"{speed_mm_s:.0f}")
    cells = {(one.speed, one.arousal): one.gait for one in reply.cells}
    for arousal in reversed(range(len(reply.arousals_mm_s))):
        row = [f"{reply.arousals_mm_s[arousal]:.0f}"]
        for speed in range(len(reply.speeds_mm_s)):
            gait = cells.get((speed, arousal))
            own = " *" if reply.own == (speed, arousal) else ""
            shown = f"{gait.figures['speed_mm_s']:.0f} ({len(gait.changes)})" if gait else "-"
            row.append(shown + own)
        table.add_row(*row)
    cells_in_all = len(reply.speeds_mm_s) * len(reply.arousals_mm_s)
    title = say("coach.map-title", filled=len(reply.cells), cells=cells_in_all)
    table.title, table.title_justify = Text(render(title)), "left"
    return table


def variants_table(reply: VariantsReply) -> Table:
    """Make a table of gaits to choose from: their looks, speed, period and foot clearance."""
    table = screen.table(
        say("coach.variant"),
        say("coach.looks"),
        say("trial.figure-speed"),
        say("coach.period"),
        say("trial.figure-clearance"),
    )
    for number, gait in enumerate(reply.variants, 1):
        figures = gait.figures
        looks = [
            render(
                say("coach.more", way=one.way) if one.steps > 0 else say("coach.less", way=one.way)
            )
            for one in gait.differences[:_WAYS_SHOWN]
        ]
        table.add_row(
            str(number),
            Text(", ".join(looks)),
            f"{figures['speed_mm_s']:.1f} mm/s",
            f"{figures['cycle_s']:.2f} s",
            f"{figures['clearance_mm']:.0f} mm",
        )
    table.title, table.title_justify = Text(render(say("coach.variants-title"))), "left"
    return table


def named_gaits(reply: MapReply | VariantsReply) -> dict[str, OtherGait]:
    """Return all found gaits, by the name of the file that each is written to."""
    if isinstance(reply, VariantsReply):
        return {f"variant-{number}.txt": one for number, one in enumerate(reply.variants, 1)}
    return {
        f"speed-{reply.speeds_mm_s[one.speed]:.0f}-"
        f"arousal-{reply.arousals_mm_s[one.arousal]:.0f}.txt": one.gait
        for one in reply.cells
    }


def write_gaits(
    folder: Path, task: Task, gait: Gait, digit: int, named: Mapping[str, OtherGait]
) -> None:
    """Write gaits into a folder, as LocoTra-data text; the folder is made if it is not there.

    Raises:
        UserError: if a file can't be written.
    """
    with contextlib.suppress(OSError):  # then saving says what is wrong
        folder.mkdir(parents=True, exist_ok=True)
    for name, one in named.items():
        save(folder / name, written(task, gait, digit, one.table))


def written(task: Task, gait: Gait, digit: int, angles: Angles) -> bytes:
    """Return a gait with other angles for one key, as LocoTra-data text."""
    assert gait.locomotion is not None
    sequences = list(gait.locomotion.sequences)
    sequences[digit] = task.table.sequence(angles)
    return write_gait(LocomotionTable(tuple(sequences)), task.robot.labels)


def kept_tables(files: Sequence[Path], robot: RobotSpec, task: Task, digit: int) -> list[Angles]:
    """Read the tables of gaits that the user kept (`--keep`), from which new gaits are bred.

    Raises:
        UserError: if a file can't be read, or its key has another sequence than the task's.
        FileRefused: with every mistake of a file.
    """
    order = task.table.order
    found = []
    for file in files:
        postures = warned_gait(file, robot).sequence(Level.LOCOMOTION, digit) or ()
        rows = dict(zip(order, postures, strict=False))
        if len(postures) != len(order) or any(
            rows[row] != posture for row, posture in zip(order, postures, strict=True)
        ):
            raise UserError(say("coach.other-postures", file=file.name, key=digit))
        table = task.table._replace(rows=tuple(rows[row] for row in range(len(rows))))
        found.append(table.angles_deg)
    return found


def as_json(reply: MapReply | VariantsReply) -> dict[str, Any]:
    """Return a reply as plain values that can be written as JSON."""
    if isinstance(reply, VariantsReply):
        gaits = [_gait(one) for one in reply.variants]
        return {"key": reply.key, "variants": gaits, "trials": reply.trials}
    return {
        "key": reply.key,
        "speeds_mm_s": reply.speeds_mm_s,
        "arousals_mm_s": reply.arousals_mm_s,
        "own": reply.own,
        "cells": [
            {"speed": one.speed, "arousal": one.arousal, **_gait(one.gait)} for one in reply.cells
        ],
        "trials": reply.trials,
    }


def _gait(gait: OtherGait) -> dict[str, Any]:
    return {
        "differences": {one.way: one.steps for one in gait.differences},
        "changes": [
            {**asdict(one.cell), "from_deg": one.from_deg, "to_deg": one.to_deg}
            for one in gait.changes
        ],
        "figures": gait.figures,
    }
