"""What every bot is: a brain that sees frames and gives keys.

A brain is pure: it sees the sheet and the frames and nothing else, so it plays the
same behind a controller (`lacoc bot`), in a headless match (`lacoc simulate`) or in a
learning environment.
"""

from collections.abc import Callable
from typing import NamedTuple

from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame, Sheet


class Key(NamedTuple):
    """A key that a brain wants to stand: a digit at a level, or `RESTART_KEY`."""

    level: Level
    key: int


Brain = Callable[[Frame], Key | None]
"""Sees each new frame of PLAYING; None leaves the standing command as it is."""

BotFactory = Callable[[Sheet, int], Brain]
"""(sheet, seat's index) -> a brain for one match."""
