"""Writes the work of a school class into files for its teacher: evidence as CSV, tables as zip."""

import io
import re
import unicodedata
import zipfile
from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

import msgspec

from lacoc_client.workshop.phases.class_file import Document, Kept
from lacoc_client.workshop.phases.evidence import Evidence, Guessed, kind_of
from lacoc_shared.command.csv_text import csv_text

_FIRST = ("number", "time", "student", "kind")
_FORBIDDEN = re.compile(r'[/\\:*?"<>|\x00-\x1f\x7f\ud800-\udfff]')  # in names, on some system
_LONGEST = 60  # characters of a name: systems allow 255 bytes, and a character has up to four
_DEVICES = {"con", "prn", "aux", "nul"} | {
    f"{device}{number}" for device in ("com", "lpt") for number in range(1, 10)
}
"""File names that Windows reserves for devices."""


def evidence_csv(evidence: Iterable[Kept]) -> bytes:
    """Write evidence as CSV: one line for each piece, one column for each field that occurs.

    A value that a spreadsheet program would take for a formula gets an apostrophe before it.
    """
    lines = [_line(one) for one in evidence]
    columns = list(dict.fromkeys((*_FIRST, *(name for line in lines for name in line))))
    return csv_text([columns, *([line.get(name, "") for name in columns] for line in lines)])


def tables_zip(tables: Iterable[Document]) -> bytes:
    """Put the newest tables into a zip archive with one folder for each student or group."""
    data = io.BytesIO()
    folders: dict[str, str] = {}
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for table in tables:
            if table.student not in folders:
                folders[table.student] = free_name(table.student, folders.values())
            name = f"{folders[table.student]}/{_file_name(table.name)}"
            at = datetime.fromtimestamp(max(table.at_s, 315_619_200), UTC)  # zip begins in 1980
            info = zipfile.ZipInfo(name, at.timetuple()[:6])
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, table.content)
    return data.getvalue()


def _line(one: Kept) -> dict[str, Any]:
    at = datetime.fromtimestamp(one.at_s, UTC).isoformat(timespec="milliseconds")
    first = (one.number, at, one.student, kind_of(one.evidence))
    values = {**dict(zip(_FIRST, first, strict=True)), **_values(one.evidence)}
    return {name: _as_cell(value) for name, value in values.items()}


def _values(evidence: Evidence) -> dict[str, Any]:
    """Return the values of evidence by column; each fact of a trial has its own column."""
    values: dict[str, Any] = msgspec.to_builtins(evidence)
    values.pop("kind")
    values |= values.pop("facts", {})
    if isinstance(evidence, Guessed):
        values["right"] = evidence.right
    return values


def _as_cell(value: Any) -> Any:
    return " ".join(map(_as_text, value)) if isinstance(value, list | tuple) else value


def _as_text(value: Any) -> str:
    return value if isinstance(value, str) else msgspec.json.encode(value).decode()


def free_name(name: str, taken: Iterable[str]) -> str:
    """Make a name for a file or folder from the name of a person.

    Every system accepts the result. A name that is taken gets a number, such as "Ada (2)". Names
    that differ only in capital letters or in the form of accents count as equal.

    Args:
        name: name of the person.
        taken: names of other files or folders in the same place.
    """
    others = {_same(one) for one in taken}
    plain = numbered = _file_name(name)
    number = 2
    while _same(numbered) in others:
        numbered = f"{plain} ({number})"
        number += 1
    return numbered


def _file_name(name: str) -> str:
    plain = _FORBIDDEN.sub("_", name).strip(". ")[:_LONGEST].rstrip(". ") or "_"
    return f"_{plain}" if plain.partition(".")[0].rstrip().casefold() in _DEVICES else plain


def _same(name: str) -> str:
    return unicodedata.normalize("NFKC", name).casefold()
