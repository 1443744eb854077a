"""A phrase: what is said, as a code and its values, in no language yet."""

from collections.abc import Sequence
from typing import Union

import msgspec


class Phrase(msgspec.Struct, frozen=True, omit_defaults=True):
    """Something said to a person; `render` puts it into words."""

    code: str
    """Names the sentence in the table: "decision.adjust"."""
    values: dict[str, "Value"] = {}
    """What fills the holes of the sentence, by name."""

    def with_values(self, **values: "Value") -> "Phrase":
        """Return the phrase with these values: for what only a later place knows."""
        return Phrase(self.code, {**self.values, **values})

    def __hash__(self) -> int:
        return hash((self.code, tuple(sorted(self.values))))


Scalar = Union[str, int, float, bool, None, Phrase]  # noqa: UP007 (Phrase is read by msgspec)
Value = Union[str, int, float, bool, None, Phrase, tuple[Scalar, ...]]  # noqa: UP007


def say(code: str, /, **values: str | int | float | Phrase | Sequence[Scalar] | None) -> Phrase:
    """Make a phrase.

    Nothing is checked here, so a wrong value never stops a match: tests/shared/test_words.py
    reads every call of `say` in the source and holds its code and names against the table, and
    `faults` checks the values that a test gets.

    Args:
        code: of the table, written as a literal.
        values: all values that the table declares for the code; None for one that is left out.
    """
    return Phrase(code, {name: _value(value) for name, value in values.items()})


def _value(value: str | int | float | Phrase | Sequence[Scalar] | None) -> Value:
    if value is None or isinstance(value, str | int | float | Phrase):
        return value
    return tuple(value)
