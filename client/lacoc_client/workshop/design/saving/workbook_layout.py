"""Finds the postures in a workbook's sheet, and chooses rows for new postures."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from lacoc_client.workshop.design.saving.sheet_xml import Place
from lacoc_shared.gait.cells import Row, degrees_of, number_of
from lacoc_shared.gait.legend import KEY, find_legend, trimmed
from lacoc_shared.gait.tables import JOINTS_PER_LEG, PostureTable
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


@dataclass(frozen=True)
class Layout:
    """Where the cells of a sheet's table are, and their new contents."""

    texts: Mapping[Place, str]
    """The present contents of all cells of the sheet that are not empty, as text."""
    columns: int
    """Number of columns of the table."""
    bottom: int
    """Row of the last posture before the change."""
    legend: tuple[int, int]
    """First row of the legend, and the row after its last row; (0, 0): there is no legend."""
    down: int
    """Number of rows by which the legend moves down."""
    wanted: Mapping[Place, str | float | None]
    """New content of each cell of the table: a text, a number, or None for an empty cell."""
    rows: frozenset[int]
    """Rows of the number of postures, and of the postures as they are now."""


def find_layout(rows: Sequence[Row], name: str, table: PostureTable) -> Layout:
    """Find the sheet's row of each posture, and a row for each new posture.

    A new posture gets an empty row, the row of a removed posture, or a row of the legend. The
    legend then moves down.

    Raises:
        UserError: if the postures do not fit into the sheet, or it is for another number of legs.
    """
    filled = [Row(row.number, trimmed(row.cells)) for row in rows]
    filled = [row for row in filled if row.cells]
    if not filled:
        raise UserError(say("design.cannot-edit", name=name))
    header, *others = filled
    body, legend, _ = find_legend(others)
    row_of = {int(found[1]): row for row in body if (found := KEY.fullmatch(row.cells[0]))}
    _check_robot(row_of.values(), name, table)
    first = legend[0].number if legend else 0
    stop = first
    while stop in {row.number for row in legend}:  # texts below a gap are the student's remarks
        stop += 1
    end = first or filled[-1].number + len(table.postures) + 1
    used = {row.number for row in filled}
    free = [number for number in range(header.number + 1, end) if number not in used]
    free += [row.number for key, row in row_of.items() if key not in table.postures]
    down = max(0, len(table.postures.keys() - row_of.keys()) - len(free))
    if used & {*range(stop, stop + down)}:
        raise UserError(say("design.no-room", name=name, rows=down, row=first))
    free += range(first, first + down)
    place_of = {key: row.number for key, row in row_of.items() if key in table.postures}
    _place_new(place_of, table, free)
    wanted: dict[Place, str | float | None] = {}
    for key, row in row_of.items():
        if key not in table.postures:
            wanted |= {(row.number, column): None for column in range(1, table.joints + 2)}
    for key, number in place_of.items():
        if key not in row_of:
            wanted[number, 1] = f"{key} Key"
        for column, angle in enumerate(table.postures[key], start=2):
            wanted[number, column] = degrees_of(angle)
    if number_of([*header.cells, ""][1]) != len(table.postures):
        wanted[header.number, 2] = float(len(table.postures))
    return Layout(
        texts={
            (row.number, column): cell
            for row in filled
            for column, cell in enumerate(row.cells, start=1)
            if cell
        },
        columns=table.joints + 1,
        bottom=max((row.number for row in row_of.values()), default=header.number),
        legend=(first, stop),
        down=down,
        wanted=wanted,
        rows=frozenset([header.number, *(row.number for row in row_of.values())]),
    )


def _check_robot(rows: Iterable[Row], name: str, table: PostureTable) -> None:
    """Check that the sheet has the columns of the table's robot.

    Raises:
        UserError: if the sheet is for another number of legs.
    """
    counts = Counter(len(row.cells) - 1 for row in rows).most_common(1)
    joints = counts[0][0] if counts else table.joints
    if joints != table.joints and joints % JOINTS_PER_LEG == 0:
        legs, wanted = joints // JOINTS_PER_LEG, table.joints // JOINTS_PER_LEG
        raise UserError(say("design.other-robot", name=name, legs=legs, wanted=wanted))


def _place_new(place_of: dict[int, int], table: PostureTable, free: list[int]) -> None:
    """Give each posture without a row a free row, in the order of the keys if possible.

    Args:
        place_of: row of each posture; the new ones are added.
        table: the postures.
        free: rows that can be used; each row that is taken is removed.
    """
    for key in sorted(table.postures.keys() - place_of.keys()):
        row = min(free, key=lambda row: (_disorder(place_of, key, row), row))
        free.remove(row)
        place_of[key] = row


def _disorder(place_of: Mapping[int, int], key: int, row: int) -> int:
    """Count the placed postures that would be out of order if a new posture got a row.

    These are the postures above the new one with a larger key, and below it with a smaller key.

    Args:
        place_of: row of each placed posture, by key.
        key: key of the new posture.
        row: row that the new posture would get.
    """
    return sum((other < key) != (place < row) for other, place in place_of.items())
