"""Read entries of a TOML table and note every mistake.

A number that can't be read becomes NaN. Every comparison with NaN is false, so a check
such as "is it too large?" reports no second mistake after the first.
"""

import math
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from lacoc_shared.mistakes import Mistake, printable
from lacoc_shared.words import Phrase, say

_HUGE = sys.float_info.max


class Entries:
    """The entries of one TOML table; all tables of a file share one list of mistakes."""

    def __init__(self, table: dict[str, Any], place: str, file: str, book: list[Mistake]) -> None:
        """Prepare to read the entries of a table.

        Args:
            table: the table as parsed.
            place: text before an entry's name in messages, such as "body." or "leg 2, ".
            file: the file's name.
            book: list to which mistakes are appended.
        """
        self.place = place
        self._table = table
        self._file = file
        self._book = book
        self._taken: set[str] = set()

    def __contains__(self, name: str) -> bool:
        return name in self._table

    def note(self, name: str, found: Phrase | str, expected: Phrase, **where: Any) -> None:
        """Note a mistake in an entry of the table."""
        self._book.append(
            Mistake(
                file=self._file,
                field=self.place + printable(name),
                found=found,
                expected=expected,
                **where,
            )
        )

    def number(
        self,
        name: str,
        low: float,
        high: float,
        unit: str = "",
        default: float | None = None,
        *,
        with_time: bool = False,
    ) -> float:
        """Read a number between two bounds; NaN if it is wrong, or missing without a default.

        Args:
            name: the entry.
            low: lowest value.
            high: highest value.
            unit: a code below `unit.` in the table of words, or a unit symbol.
            default: value if the entry is missing; None: it must not be missing.
            with_time: whether the bounds are those for `advance = "time"`.
        """
        if with_time:
            expected = say("robot.number-with-time", low=low, high=high, unit=unit)
        else:
            expected = say("robot.number-from", low=low, high=high, unit=unit)
        value = self._take(name, expected, default)
        return math.nan if value is None else self._check(name, value, low, high, expected)

    def numbers(
        self,
        name: str,
        bounds: Sequence[tuple[float, float]],
        unit: str = "",
        where: Sequence[Mapping[str, Any]] = (),
    ) -> tuple[float, ...]:
        """Read a list of numbers; NaN for each wrong number, and for all if their count is wrong.

        Args:
            name: the entry.
            bounds: lowest and highest value of each number.
            unit: unit of all numbers.
            where: place of each number within the entry, as fields of `Mistake`.
        """
        expected = say("robot.numbers", count=len(bounds))
        values = self._take(name, expected)
        if values is None:
            return (math.nan,) * len(bounds)
        if not isinstance(values, list):
            self.note(name, _shown(values), expected)
            return (math.nan,) * len(bounds)
        if len(values) != len(bounds):
            # It is unknown which number belongs where, but each entry must be a number.
            self.note(name, say("robot.entries", count=len(values)), expected)
            for i, value in enumerate(values):
                self._check(name, value, -_HUGE, _HUGE, say("robot.number"), column=i + 1)
            return (math.nan,) * len(bounds)
        places = where or [{"column": i + 1} for i in range(len(bounds))]
        return tuple(
            self._check(
                name,
                value,
                low,
                high,
                say("robot.number-from", low=low, high=high, unit=unit),
                **place,
            )
            for value, (low, high), place in zip(values, bounds, places, strict=True)
        )

    def text(self, name: str, longest: int) -> str:
        """Read an entry that is a word or a short text; "" if it is wrong or missing."""
        expected = say("robot.text", longest=longest)
        value = self._take(name, expected)
        if isinstance(value, str) and value.isprintable() and 1 <= len(value.strip()) <= longest:
            return value.strip()
        if value is not None:
            self.note(name, _shown(value), expected)
        return ""

    def flag(self, name: str) -> bool:
        """Read an entry that is true or false; false if it is missing or wrong."""
        expected = say("robot.flag")
        value = self._take(name, expected, False)
        if not isinstance(value, bool):
            self.note(name, _shown(value), expected)
            return False
        return value

    def choice(self, name: str, options: tuple[str, ...]) -> str:
        """Read an entry that is one of several words; the first word if it is missing or wrong."""
        expected = say("robot.either", options=options)
        value = self._take(name, expected, options[0])
        if value in options:
            return str(value)
        self.note(name, _shown(value), expected)
        return options[0]

    def table(self, name: str, *, optional: bool = False) -> "Entries":
        """Read an entry that is a table; an empty table if it is missing or wrong."""
        expected = say("robot.table", line=f"[{name}]")
        value = self._take(name, expected, {} if optional else None)
        if value is not None and not isinstance(value, dict):
            self.note(name, _shown(value), expected)
        return Entries(value if isinstance(value, dict) else {}, f"{name}.", self._file, self._book)

    def tables(self, name: str, expected: Phrase) -> list["Entries"]:
        """Read an entry that is a list of tables, numbered from 0; none if missing or wrong."""
        value = self._take(name, expected)
        if value is None:
            return []
        if not value or not isinstance(value, list) or not all(isinstance(v, dict) for v in value):
            self.note(name, _shown(value), expected)
            return []
        return [
            Entries(one, f"{name} {index}, ", self._file, self._book)
            for index, one in enumerate(value)
        ]

    def ask(self, name: str) -> None:
        """Note that an entry is allowed, although its value is not read."""
        self._taken.add(name)

    def finish(self) -> None:
        """Note a mistake for each entry that is neither read nor allowed."""
        known = say("robot.one-of", names=sorted(self._taken))
        for name in self._table:
            if name not in self._taken:
                self.note(name, say("robot.unknown-entry"), known)

    def _take(self, name: str, expected: Phrase, default: Any = None) -> Any:
        self._taken.add(name)
        value = self._table.get(name, default)
        if value is None:
            self.note(name, say("gait.no-entry"), expected)
        return value

    def _check(
        self, name: str, value: Any, low: float, high: float, expected: Phrase, **where: Any
    ) -> float:
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if number and low <= value <= high:  # before float(), which fails for a very large int
            return float(value)
        self.note(name, _shown(value), expected, **where)
        return math.nan


def _shown(value: Any) -> Phrase | str:
    """Return a TOML value as it stands in a file, shortened for a message."""
    if isinstance(value, dict):
        return say("robot.a-table")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) > 10**15:
        return say("robot.many-digits")
    try:
        text = f'"{value}"' if isinstance(value, str) else str(value)
    except ValueError:  # a list with an int of too many digits
        return say("robot.many-digits")
    return printable(text if len(text) <= 40 else text[:37] + "...")
