"""Gives tests the workshop's sample gait (workshop Fig. 4-1)."""

import math

import pytest

from lacoc_shared.gait.tables import PostureTable

# The table of workshop Fig. 4-1. Its columns 16 and 17, which the print lacks, follow the pattern
# of the gait.
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
    """Give the labels of the hexapod's legs (rules 1)."""
    return ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")


@pytest.fixture(scope="session")
def workshop() -> PostureTable:
    """Give the workshop's complete sample table."""
    postures = {}
    for line in _TABLE.strip().splitlines():
        digit, *angles = line.replace("|", " ").split()
        postures[int(digit)] = tuple(math.radians(int(angle)) for angle in angles)
    return PostureTable(postures)
