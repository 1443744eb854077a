"""A phrase: a sentence as a code and its values, not yet in any language."""

from collections.abc import Sequence
from typing import Union

import msgspec


class Phrase(msgspec.Struct, frozen=True, omit_defaults=True):
    """A sentence for a person; `render` puts it into words."""

    code: str
    """Code of the sentence in the table, such as "decision.adjust"."""
    values: dict[str, "Value"] = {}
    """Values for the holes of the sentence, by name."""

    def with_values(self, **values: "Value") -> "Phrase":
        """Return the phrase with further values, which were not known when it was made."""
        return Phrase(self.code, {**self.values, **values})

    def __hash__(self) -> int:
        return hash((self.code, tuple(sorted(self.values))))


Scalar = Union[str, int, float, bool, None, Phrase]  # noqa: UP007 (Phrase is read by msgspec)
Value = Union[str, int, float, bool, None, Phrase, tuple[Scalar, ...]]  # noqa: UP007


def say(code: str, /, **values: str | int | float | Phrase | Sequence[Scalar] | None) -> Phrase:
    """Make a phrase from a code and values.

    Nothing is checked here, so that a wrong value never stops a match. Instead
    tests/shared/test_words.py compares the code and the names in every call of `say` with the
    table, and `faults` checks the values that occur in tests.

    Args:
        code: a code of the table, written as a literal.
        values: all values that the table has for the code; None: there is no such value, so that a
            clause with it is left out.
    """
    return Phrase(code, {name: _value(value) for name, value in values.items()})


def _value(value: str | int | float | Phrase | Sequence[Scalar] | None) -> Value:
    if value is None or isinstance(value, str | int | float | Phrase):
        return value
    return tuple(value)
