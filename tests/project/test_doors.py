"""docs/security.md lists all doors for strangers: each with its limit, and a test that knocks."""

import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_TABLE = re.search(
    r"^## The doors\n.*?^\|---.*?\n(.*?)\n\n",
    (ROOT / "docs" / "security.md").read_text("utf-8"),
    re.MULTILINE | re.DOTALL,
)
assert _TABLE is not None
ROWS = [[cell.strip() for cell in line.strip("|").split("|")] for line in _TABLE[1].splitlines()]
LIMITS = [
    pytest.param(name, float(value), id=name)
    for row in ROWS
    for name, value in re.findall(r"`([\w.]+)` = ([\d.]+)", row[3])
]


@pytest.mark.parametrize(("name", "value"), LIMITS)
def test_a_limit_is_what_the_table_says(name: str, value: float) -> None:
    """Each limit of the table is that of the code."""
    module, _, constant = name.rpartition(".")
    assert float(getattr(importlib.import_module(module), constant)) == value


@pytest.mark.parametrize("test", [row[4] for row in ROWS], ids=[row[0] for row in ROWS])
def test_each_door_has_a_test(test: str) -> None:
    """The test that the table names for a door is there."""
    path, _, name = test.partition("::")
    text = (ROOT / path).read_text("utf-8")
    assert re.search(rf"^(async )?def {name}\b", text, re.MULTILINE)


def test_each_number_that_people_read_is_a_limit() -> None:
    """A row names the limit in words and in code, except where there is no number."""
    for door, who, limit, where, _ in ROWS:
        assert who
        assert bool(where) == bool(re.search(r"\d", limit)), door
