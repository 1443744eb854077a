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
_LONG_NUMBER = "a number of very many digits"
_TOO_LONG = re.compile(r"[0-9][0-9_]{4000,}")
_PLACE = re.compile(r" \(at line (\d+), column \d+\)")


class BadToml(ValueError):
    """It can't be read as TOML; `row` is the line, counted from 1, where that is known.

    `remedy` says what to do, where that is more than to write TOML.
    """

    def __init__(self, reason: str, row: int | None = None, remedy: str = "") -> None:
        where = "" if row is None else f" (line {row})"
        super().__init__(f"{reason}{where}" + (f": {remedy}" if remedy else ""))
        self.reason = reason
        self.row = row
        self.remedy = remedy


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
        raise _not_utf_8() from None
    if "\0" in text:  # UTF-16 without a byte order mark
        raise _not_utf_8()
    for row, line in enumerate(text.split("\n"), start=1):
        if line.count(".") > _DOTS:
            raise BadToml(f"more than {_DOTS} dots in a line", row)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = _PLACE.search(str(error))
        reason = str(error).replace(place[0], "") if place else str(error)
        raise BadToml(reason[:80], int(place[1]) if place else None) from None
    except ValueError:  # Python reads integers of at most 4,300 digits
        long_row = _row_of_long_number(text)
        raise BadToml(_LONG_NUMBER, long_row, "write it with at most 15 digits") from None
    except RecursionError:
        raise BadToml("brackets in brackets, too deep") from None
    _check_values(table, any_integers)
    return table


def _not_utf_8() -> BadToml:
    return BadToml("text that is not in UTF-8", remedy="save it as UTF-8")


def _row_of_long_number(text: str) -> int | None:
    found = _TOO_LONG.search(text)
    return found and text.count("\n", 0, found.start()) + 1


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
                raise BadToml(_LONG_NUMBER)
        if not inner:
            return
        level = inner
    raise BadToml("tables in tables, too deep")
