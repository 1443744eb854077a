"""Types of which bots are made: a bot makes a brain, which reads frames and returns keys.

A brain is pure: it sees only the sheet and the frames. So it plays in the same way behind a
controller (`lacoc bot`), in a headless match (`lacoc simulate`) or in a learning
environment.
"""

from collections.abc import Callable
from typing import NamedTuple

from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame, Sheet


class Key(NamedTuple):
    """A key that a brain wants to press: a digit at a level, or `RESTART_KEY`."""

    level: Level
    key: int


Brain = Callable[[Frame], Key | None]
"""A function that is called with each new frame of the phase PLAYING and returns the key to press;
None keeps the current command.
"""

BotFactory = Callable[[Sheet, int], Brain]
"""(sheet, seat's index) -> a brain for one match."""
