"""Saves postures into a student's text file; its legend, remarks and encoding stay."""

from lacoc_shared.gait.cells import angle_of, leg_labels, narrow, number_of
from lacoc_shared.gait.legend import KEY
from lacoc_shared.gait.tables import JOINTS_PER_LEG, Posture, PostureTable
from lacoc_shared.gait.text import LINE_END, decoded, line_cells, read_gait, write_gait
from lacoc_shared.mistakes import FileRefused


def edit_text(data: bytes, name: str, table: PostureTable) -> bytes:
    """Return the bytes of a text file of postures after a table has replaced its postures.

    Lines of unchanged postures, and all lines below the postures, stay as they are. If the file
    has locomotion, another number of legs than the table, or mistakes, all is written anew.

    Args:
        data: the file as it is now.
        name: name of the file, for messages.
        table: the new postures.
    """
    fresh = write_gait(table, leg_labels(table.joints // JOINTS_PER_LEG))
    try:
        before = read_gait(data, name)
    except FileRefused:
        return fresh
    if not isinstance(before, PostureTable) or before.joints != table.joints:
        return fresh
    if before == table:
        return data
    text, encoding, bom = decoded(data, name)
    edited = bom + _edited(text, fresh.decode(), table).encode(encoding)
    return edited if read_gait(edited, name) == table else fresh


def _edited(text: str, fresh: str, table: PostureTable) -> str:
    end = LINE_END.search(text)
    header, *rows = LINE_END.split(text.lstrip())
    new_header, *new_rows = fresh.splitlines()
    count = str(len(table.postures))
    if line_cells(narrow(header))[-1] != count:
        header = new_header
    new_of = dict(zip(sorted(table.postures), new_rows, strict=False))
    key_of = {index: key for index, row in enumerate(rows) if (key := _key(row)) is not None}
    lines = [header]
    for index, key in key_of.items():
        if key in new_of:
            new = new_of.pop(key)
            lines.append(rows[index] if _has(rows[index], table.postures[key]) else new)
    lines += [*new_of.values(), *rows[max(key_of, default=-1) + 1 :]]
    return (end[0] if end else "\n").join(lines)


def _key(row: str) -> int | None:
    cells = line_cells(narrow(row))
    found = KEY.fullmatch(cells[0]) if cells else None
    return int(found[1]) if found else None


def _has(row: str, posture: Posture) -> bool:
    numbers = [number_of(cell) for cell in line_cells(narrow(row))[1 : len(posture) + 1]]
    return [None if one is None else angle_of(one) for one in numbers] == [*posture]
