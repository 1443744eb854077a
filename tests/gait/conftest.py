"""The workshop's gait, as rules 2 prints it."""

import math

import pytest

from lacoc_shared.gait.tables import PostureTable

# Copied from rules 2, columns 16 and 17 restored.
_TABLE = """
 0  | 45   0 -45 -45   0  45 | 20  20  20  20  20  20 |  0   0   0   0   0   0
 1  |  0   0 -45   0   0  45 | 20  20  20  20  20  20 | 40   0  40   0  40   0
 2  | 45   0   0 -45   0   0 | 20  20  20  20  20  20 | 40   0  40   0  40   0
 3  | 45   0   0 -45   0   0 | 20  20  20  20  20  20 |  0  40   0  40   0  40
 4  |  0   0 -45   0   0  45 | 20  20  20  20  20  20 |  0  40   0  40   0  40
 5  | 45   0   0   0   0  45 | 20  20  20  20  20  20 | 40   0  40   0  40   0
 6  | 45  45   0 -45   0   0 | 20  20  20  20  20  20 | 40   0  40   0  40   0
 7  | 45  45   0 -45   0   0 | 20  20  20  20  20  20 |  0  40   0  40   0  40
 8  | 45   0   0   0   0  45 | 20  20  20  20  20  20 |  0  40   0  40   0  40
"""


@pytest.fixture(scope="session")
def legs() -> tuple[str, ...]:
    """Labels of the hexapod's legs (rules 1)."""
    return ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")


@pytest.fixture(scope="session")
def workshop() -> PostureTable:
    """The complete sample table of rules 2."""
    postures = {}
    for line in _TABLE.strip().splitlines():
        digit, *angles = line.replace("|", " ").split()
        postures[int(digit)] = tuple(math.radians(int(angle)) for angle in angles)
    return PostureTable(postures)
