"""The rows that explain Loco-data: where they begin, and whether they fit (Fig. 4-1)."""

import re
from collections.abc import Sequence

from lacoc_shared.gait.cells import Row, number_of
from lacoc_shared.gait.tables import LEVEL_NAMES, leg_and_level
from lacoc_shared.words import Phrase, say

KEY = re.compile(r"(\d)\s*key", re.IGNORECASE | re.ASCII)
"""The label of a posture's row."""

_IDS_LABEL = "id of joint"
_LABELS = (_IDS_LABEL, "position")


def find_legend(rows: Sequence[Row]) -> tuple[list[Row], list[Row], list[Row]]:
    """Part the rows of Loco-data: postures, the legend, and what else stands below it.

    Below the last row with a key the legend begins at the first row that can be one. What
    follows it is never a posture: a remark, or the empty rows of a sheet.
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
    """Say which label of a legend stands over another joint's column.

    The columns count, whatever the legend says.

    Args:
        file: the file's name.
        row: a row of the legend.
        labels: labels of the robot's legs, in order.

    Returns:
        The first such place and label: exchanged labels come in dozens. None if there is none.
    """
    known = {_plain(label): label for label in labels}
    levels = {_plain(name): name for name in LEVEL_NAMES}
    ids = row.cells[0].casefold() == _IDS_LABEL
    for joint, cell in enumerate(row.cells[1 : len(labels) * len(LEVEL_NAMES) + 1]):
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
    """Take away what a sheet shows where it mirrors an empty cell: 0."""
    return trimmed(["" if number_of(cell) == 0 else cell for cell in cells])


def trimmed(cells: Sequence[str]) -> list[str]:
    """Take away the spaces around cells, and the empty cells at a row's end."""
    kept = [cell.strip() for cell in cells]
    while kept and not kept[-1]:
        kept.pop()
    return kept


def _is_legend(cells: Sequence[str]) -> bool:
    """Say whether a row explains the table: words without angles, or the joint ids (Fig. 4-1).

    The labels may be in another language, but a row that could be a posture is never a legend.
    """
    label, *others = cells
    if label.casefold() in _LABELS:
        return True
    if any(character.isdigit() for character in label):
        return False
    numbers = [number_of(cell) for cell in others]
    return all(n is None for n in numbers) or numbers == [*range(len(numbers))]


def _plain(label: str) -> str:
    """Leave out what people write differently: "R,F", "R.F" and "rf" are one leg."""
    return "".join(filter(str.isalnum, label)).casefold()
