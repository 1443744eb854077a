"""Finds the legend in a file of postures: the rows that name the joint of each column.

Compares the legend with the order of the columns.
"""

import re
from collections.abc import Sequence

from lacoc_shared.gait.cells import Row, number_of
from lacoc_shared.gait.tables import LEVEL_NAMES, leg_and_level
from lacoc_shared.words import Phrase, say

KEY = re.compile(r"(\d)\s*key", re.IGNORECASE | re.ASCII)
"""Matches the label of a posture's row."""

_IDS_LABEL = "id of joint"
_LABELS = (_IDS_LABEL, "position")


def find_legend(rows: Sequence[Row]) -> tuple[list[Row], list[Row], list[Row]]:
    """Split the rows of a file of postures into postures, legend, and rows below the legend.

    The legend begins below all rows with a key, at the first row that can belong to a legend. From
    there on no row is a posture: there are only legend rows, remarks and empty rows of a sheet.
    """
    keys = [index for index, row in enumerate(rows) if KEY.fullmatch(row.cells[0])]
    table_end = keys[-1] + 1 if keys else 0
    starts = (i for i in range(table_end, len(rows)) if _is_legend(rows[i].cells))
    start = next(starts, len(rows))
    legend, below = [], []
    for row in rows[start:]:
        cells = without_zeros(row.cells)
        if _is_legend(row.cells) or (cells and _is_legend(cells)):
            legend.append(row)
        elif cells:
            below.append(row)
    return list(rows[:start]), legend, below


def contradiction(file: str, row: Row, labels: Sequence[str]) -> Phrase | None:
    """Return a remark if a label in a row of the legend names another joint than its column has.

    Angles are read by the order of the columns, not by the legend.

    Args:
        file: the file's name.
        row: a row of the legend.
        labels: labels of the robot's legs, in order.

    Returns:
        A remark on the first such label only, because one mix-up of columns causes dozens;
        None if all labels fit.
    """
    joints = len(labels) * len(LEVEL_NAMES)
    if all(row.cells) and len(row.cells) <= joints:
        return None  # between spaces empty cells are lost: the columns of the labels are not known
    known = {_plain(label): label for label in labels}
    levels = {_plain(name): name for name in LEVEL_NAMES}
    ids = row.cells[0].casefold() == _IDS_LABEL
    for joint, cell in enumerate(row.cells[1 : joints + 1]):
        leg, level = leg_and_level(joint, len(labels))
        if ids:
            number = number_of(cell)
            wrong = number is not None and number != joint
            is_what = say("gait.column-of-joint", joint=joint)
        elif _plain(cell) in levels:
            wrong = levels[_plain(cell)] != LEVEL_NAMES[level]
            is_what = say("gait.joint-of-level", joint=joint, level=LEVEL_NAMES[level])
        else:
            wrong = known.get(_plain(cell), labels[leg]) != labels[leg]
            is_what = say("gait.joint-of-leg", joint=joint, leg=labels[leg])
        if wrong:
            return say(
                "gait.legend",
                file=file,
                row=row.number,
                column=joint + 2,
                cell=cell,
                what=is_what,
            )
    return None


def without_zeros(cells: Sequence[str]) -> list[str]:
    """Return the row with an empty cell for each 0, and without empty cells at its end.

    A sheet shows 0 where a formula refers to an empty cell.
    """
    return trimmed(["" if number_of(cell) == 0 else cell for cell in cells])


def trimmed(cells: Sequence[str]) -> list[str]:
    """Remove the spaces around cells, and the empty cells at the end of a row."""
    kept = [cell.strip() for cell in cells]
    while kept and not kept[-1]:
        kept.pop()
    return kept


def _is_legend(cells: Sequence[str]) -> bool:
    """Say whether a row belongs to the legend: words without angles, or the joint ids.

    The labels may be in any language, but a row that could be a posture never counts as legend.
    """
    label, *others = cells
    if label.casefold() in _LABELS:
        return True
    if any(character.isdigit() for character in label):
        return False
    numbers = [number_of(cell) for cell in others]
    return all(n is None for n in numbers) or numbers == [*range(len(numbers))]


def _plain(label: str) -> str:
    """Normalise a label, because people write "R,F", "R.F" and "rf" for the same leg."""
    return "".join(filter(str.isalnum, label)).casefold()
