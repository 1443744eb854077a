"""Reads TOML that may be hostile.

On hostile text `tomllib` raises three kinds of exceptions, and takes seconds and a gigabyte for 32
KiB of `a.a.a.a`. This module raises one kind of error, and limits the result: nesting is limited,
and every integer fits into 64 bits unless the caller allows more.
"""

import re
import tomllib
from typing import Any

from lacoc_shared.mistakes import printable
from lacoc_shared.words import Phrase, render, say

MAX_BYTES = 1 << 20
"""Largest file that an organiser writes [bytes]; for a contestant's file the limit may be lower."""

_DOTS = 100  # most dots in a line; time and memory for a key grow with the square of its parts
_DEEPEST = 32
_LINE = 80  # most characters of a line that a message shows
_INTEGERS = range(-(2**63), 2**64)  # the integers that a message can carry
_TOO_LONG = re.compile(r"[0-9][0-9_]{4000,}")
_PLACE = re.compile(r" \(at line (\d+), column \d+\)")


class BadToml(ValueError):
    """The text can't be read as TOML; `row` is the line, counted from 1, if it is known.

    `remedy` says what should be there, if that is not obvious. `reason` is a phrase, or the plain
    text that Python's own parser gave. `line` is the line's text, if Python's parser refused it.
    """

    def __init__(
        self,
        reason: Phrase | str,
        row: int | None = None,
        remedy: Phrase | None = None,
        line: str = "",
    ) -> None:
        super().__init__(reason, row, remedy, line)
        self.reason = reason
        self.row = row
        self.remedy = remedy
        self.line = line

    @property
    def phrase(self) -> Phrase:
        """What is wrong in the TOML text, in which line, and what should be there, as a phrase.

        The text of a line with a token is left out, because the reader of the message may not see
        the token.
        """
        line = None if "token" in self.line else printable(self.line.strip(), _LINE) or None
        return say("toml.bad", reason=self.reason, row=self.row, remedy=self.remedy, line=line)

    def __str__(self) -> str:
        return render(self.phrase)


def read_toml(
    text: str | bytes, max_bytes: int = MAX_BYTES, *, any_integers: bool = False
) -> dict[str, Any]:
    """Read a TOML file.

    Args:
        text: the file; bytes are UTF-8, with or without a byte order mark.
        max_bytes: a longer text is refused without being read.
        any_integers: whether integers beyond 64 bits are accepted. The caller then checks the
            integers, and can say at which place a wrong one is.

    Raises:
        BadToml: if it is too long, not TOML or nested too deep, has too many dots in a line, or has
            an integer beyond 64 bits that is not accepted.
    """
    if len(text) > max_bytes:
        raise BadToml(say("toml.too-long", bytes=len(text), most=max_bytes))
    try:
        text = text if isinstance(text, str) else text.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise _not_utf_8() from None
    if "\0" in text:  # UTF-16 without a byte order mark
        raise _not_utf_8()
    for row, line in enumerate(text.split("\n"), start=1):
        if line.count(".") > _DOTS:
            raise BadToml(say("toml.many-dots", most=_DOTS), row)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = _PLACE.search(str(error))
        reason = str(error).replace(place[0], "") if place else str(error)
        refused = int(place[1]) if place else None
        line = text.split("\n")[refused - 1] if refused else ""
        raise BadToml(reason[:80], refused, line=line) from None
    except ValueError:  # Python reads integers of at most 4,300 digits
        long_row = _row_of_long_number(text)
        raise BadToml(say("robot.many-digits"), long_row, say("toml.short-number")) from None
    except RecursionError:
        raise BadToml(say("toml.too-deep")) from None
    _check_values(table, any_integers)
    return table


def _not_utf_8() -> BadToml:
    return BadToml(say("toml.not-utf-8"), remedy=say("robot.toml-utf-8"))


def _row_of_long_number(text: str) -> int | None:
    found = _TOO_LONG.search(text)
    return found and text.count("\n", 0, found.start()) + 1


def _check_values(table: dict[str, Any], any_integers: bool) -> None:
    """Check each value of a parsed TOML file, without recursion.

    Raises:
        BadToml: if a value is nested too deep or too large.
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
                raise BadToml(say("robot.many-digits"), remedy=say("toml.short-number"))
        if not inner:
            return
        level = inner
    raise BadToml(say("toml.tables-too-deep"))
