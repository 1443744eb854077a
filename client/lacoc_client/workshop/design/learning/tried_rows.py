"""Finds the rows and numbers of a table that a trial has used, for the trial's evidence."""

import math

from lacoc_client.workshop.design.requests import TrialAsk
from lacoc_client.workshop.design.table import FileRow
from lacoc_client.workshop.phases.evidence import TriedNumber
from lacoc_robots.robot_file import RobotSpec
from lacoc_shared.gait.tables import SAMPLE_KEYS

_SAME_DEG = 0.01


def row_names(asked: TrialAsk, pressed: str) -> tuple[int, ...]:
    """Return the names of the table's rows that a key pressed in a trial uses.

    In a table of level A the names are its keys; in a table of level B they are 1, 2 ... in order.
    """
    rows = _rows_of(asked, pressed)
    if asked.table is not None and asked.table.kind == "locomotion":
        return tuple(row.posture + 1 for row in rows)
    return tuple(row.key for row in rows)


def numbers(asked: TrialAsk, keys: tuple[str, ...], spec: RobotSpec) -> tuple[TriedNumber, ...]:
    """Return the numbers in the rows of the keys that differ from the robot's start posture."""
    legs = len(spec.legs)
    start_deg = [round(math.degrees(angle), 3) for angle in spec.start_posture]
    rows = {(row.key, row.posture): row for key in keys for row in _rows_of(asked, key)}
    return tuple(
        TriedNumber(*place, joint % legs, joint // legs, angle, start_deg[joint])
        for place, row in sorted(rows.items())
        if len(row.angles_deg) == len(start_deg)
        for joint, angle in enumerate(row.angles_deg)
        if abs(angle - start_deg[joint]) > _SAME_DEG
    )


def _rows_of(asked: TrialAsk, pressed: str) -> list[FileRow]:
    """Return the rows of a pressed key, such as "A1", in the order of its sequence."""
    level, key = pressed[0], int(pressed[1:])
    rows = asked.table.rows if asked.table is not None else ()
    if level == "B" and asked.table is not None and asked.table.kind == "postures":
        sequences = asked.sequences if asked.sequences is not None else SAMPLE_KEYS
        digits = sequences[key] if key < len(sequences) else ()
        known = {row.key: row for row in rows}
        return [known[digit] for digit in digits if digit in known]
    return [row for row in rows if row.key == key]
