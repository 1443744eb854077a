"""TOML as people write it, read so that no file can hurt whoever reads it.

`tomllib` meets hostile text with three kinds of exceptions, and takes seconds and a
gigabyte for 32 KiB of `a.a.a.a`. Here there is one error, and what comes out is small:
tables that are not deep, and numbers that every other program can hold.
"""

import re
import tomllib
from typing import Any

MAX_BYTES = 1 << 20
"""For files that an organiser writes; a contestant's may have less."""

_DOTS = 100  # a line with more: a key of so many parts costs its square in time and memory
_DEEPEST = 32
_INTEGERS = range(-(2**63), 2**64)  # what a message can carry
_PLACE = re.compile(r" \(at line (\d+), column \d+\)")


class BadToml(ValueError):
    """It can't be read as TOML; `row` is the line, counted from 1, where that is known."""

    def __init__(self, reason: str, row: int | None = None) -> None:
        super().__init__(reason if row is None else f"{reason} (line {row})")
        self.reason = reason
        self.row = row


def read_toml(
    text: str | bytes, max_bytes: int = MAX_BYTES, *, any_integers: bool = False
) -> dict[str, Any]:
    """Read a TOML file.

    Args:
        text: the file; bytes are UTF-8, with or without a byte order mark.
        max_bytes: a longer one is refused unread.
        any_integers: leave integers beyond 64 bits to the caller, who can name their place.

    Raises:
        BadToml: if it is too long, no TOML, too deep, or has an integer beyond 64 bits.
    """
    if len(text) > max_bytes:
        raise BadToml(f"{len(text)} bytes, and at most {max_bytes} are read")
    try:
        text = text if isinstance(text, str) else text.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise BadToml("bytes that are no text in UTF-8") from None
    for row, line in enumerate(text.split("\n"), start=1):
        if line.count(".") > _DOTS:
            raise BadToml(f"more than {_DOTS} dots in a line", row)
    try:
        table = tomllib.loads(text)
    except ValueError as error:  # also a number too long for Python
        place = _PLACE.search(str(error))
        reason = str(error).replace(place[0], "") if place else str(error)
        raise BadToml(reason[:80], int(place[1]) if place else None) from None
    except RecursionError:
        raise BadToml("brackets in brackets, too deep") from None
    _check_values(table, any_integers)
    return table


def _check_values(table: dict[str, Any], any_integers: bool) -> None:
    """Look at every value, without recursion.

    Raises:
        BadToml: if one is too deep or too large.
    """
    level: list[Any] = [table]
    for _ in range(_DEEPEST):
        inner: list[Any] = []
        for value in level:
            if isinstance(value, dict):
                inner += value.values()
            elif isinstance(value, list):
                inner += value
            elif isinstance(value, int) and not any_integers and value not in _INTEGERS:
                raise BadToml("a number of very many digits")
        if not inner:
            return
        level = inner
    raise BadToml("tables in tables, too deep")
