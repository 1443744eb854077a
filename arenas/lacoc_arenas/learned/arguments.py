"""Checks arguments that a program gives to an environment or to a learned policy."""

from operator import index
from typing import Any

import numpy as np

from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

_LONGEST = 80


def whole(name: str, value: Any, least: int, most: int | None = None) -> int:
    """Return an argument as a Python int; numpy's whole numbers are allowed too.

    Args:
        name: name of the argument, for the message.
        value: what was given.
        least: smallest number that is allowed.
        most: largest number that is allowed; None: there is no upper bound.

    Raises:
        UserError: if it is not a whole number, or out of these bounds.
    """
    try:
        number = index(value)
    except TypeError:
        number = least - 1
    if number < least or (most is not None and number > most):
        raise UserError(
            say("argument.whole", name=name, found=short(value), least=least, most=most)
        )
    return number


def table(name: str, value: Any, example: str) -> dict[str, Any]:
    """Return an argument that must be a dict; None gives an empty dict.

    Args:
        name: name of the argument, for the message.
        value: what was given.
        example: a right value, for the message.

    Raises:
        UserError: if it is neither a dict nor None.
    """
    if value is None:
        return {}
    if not isinstance(value, dict):
        raise UserError(say("argument.table", name=name, found=short(value), example=example))
    return value


def short(value: Any) -> str:
    """Return the value of an argument as one short line, to quote it in a message."""
    if isinstance(value, np.ndarray):
        numbers = np.array2string(value, precision=3, threshold=6, edgeitems=2, separator=", ")
        text = f"array {value.shape} {numbers}"
    else:
        text = repr(value)
    return printable(" ".join(text.split()), _LONGEST)
