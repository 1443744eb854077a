"""A class as files for a teacher: evidence as CSV, tables as a zip archive."""

import csv
import io
import re
import zipfile
from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

import msgspec

from lacoc_client.phases.class_file import Kept, KeptTable
from lacoc_client.phases.evidence import Evidence, Guessed

_FIRST = ("number", "time", "student", "kind")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_FORBIDDEN = re.compile(r'[/\\:*?"<>|\x00-\x1f\x7f]')  # in names of files, on one system or another


def evidence_csv(evidence: Iterable[Kept]) -> bytes:
    """Write evidence as CSV, one line each, with a column for each name that occurs.

    It begins with a byte order mark, so that Excel reads it as UTF-8. A text that a spreadsheet
    would take for a formula gets an apostrophe before it.
    """
    lines = [_line(one) for one in evidence]
    columns = dict.fromkeys((*_FIRST, *(name for line in lines for name in line)))
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, list(columns), restval="")
    writer.writeheader()
    writer.writerows(lines)
    return text.getvalue().encode("utf-8-sig")


def tables_zip(tables: Iterable[KeptTable]) -> bytes:
    """Put the newest tables into a zip archive, a folder for each student."""
    data = io.BytesIO()
    folders: dict[str, str] = {}
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for table in tables:
            if table.student not in folders:
                folders[table.student] = _free(_file_name(table.student), folders.values())
            name = f"{folders[table.student]}/{_file_name(table.name)}"
            at = datetime.fromtimestamp(max(table.at_s, 315_619_200), UTC)  # zip begins in 1980
            info = zipfile.ZipInfo(name, at.timetuple()[:6])
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, table.content)
    return data.getvalue()


def _line(one: Kept) -> dict[str, Any]:
    at = datetime.fromtimestamp(one.at_s, UTC).isoformat(timespec="milliseconds")
    first = (one.number, at, one.student, type(one.evidence).__name__.lower())
    values = {**dict(zip(_FIRST, first, strict=True)), **_values(one.evidence)}
    return {name: _harmless(value) for name, value in values.items()}


def _values(evidence: Evidence) -> dict[str, Any]:
    """Return the values of evidence by column; facts of a trial have columns of their own."""
    values: dict[str, Any] = msgspec.to_builtins(evidence)
    values.pop("kind")
    values |= values.pop("facts", {})
    if isinstance(evidence, Guessed):
        values["right"] = evidence.right
    return values


def _harmless(value: Any) -> Any:
    match value:
        case list() | tuple():
            return _harmless(" ".join(map(_as_text, value)))
        case str() if value.startswith(_FORMULA):
            return f"'{value}"
    return value


def _as_text(value: Any) -> str:
    return value if isinstance(value, str) else msgspec.json.encode(value).decode()


def _file_name(name: str) -> str:
    return _FORBIDDEN.sub("_", name).strip(". ")[:100] or "_"


def _free(name: str, taken: Iterable[str]) -> str:
    """Add a number to a name if it is taken; capitals make no difference to some systems."""
    others = {one.casefold() for one in taken}
    numbered = name
    number = 2
    while numbered.casefold() in others:
        numbered = f"{name} ({number})"
        number += 1
    return numbered
