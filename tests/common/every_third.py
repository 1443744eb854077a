"""Marks most cases of a table `long`, so that only a part of it runs each time."""

from collections.abc import Iterable
from typing import Any

import pytest


def every_third(cases: Iterable[Any]) -> list[Any]:
    """Return the cases for `parametrize`; two of three run only with --long."""
    return [
        pytest.param(case, marks=pytest.mark.long) if number % 3 else case
        for number, case in enumerate(cases)
    ]
