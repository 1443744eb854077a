"""The teacher's choices of what students of a class may do."""

from typing import Annotated, Literal

import msgspec

Help = Literal["none", "matters", "cell", "three", "table"]
"""How much the coach may help: not at all, only say which numbers matter, or change one number,
three, or the whole table."""
_HELPS: tuple[Help, ...] = ("none", "matters", "cell", "three", "table")


class StudentRules(msgspec.Struct, frozen=True, kw_only=True):
    """What students may do. A person who designs alone may do everything (`FREE`)."""

    closed: tuple[Annotated[int, msgspec.Meta(ge=0, le=6)], ...] = ()
    """Numbers of the phases that are closed: no student can go to them."""
    coach: Help = "table"
    explain_first: bool = False
    """Whether students read the explanation of a phase before its task."""

    def allows(self, size: str | None) -> bool:
        """Return whether the teacher lets the coach search for a change of this size.

        Args:
            size: cell, three or table; None: the coach only says which numbers matter.
        """
        return (size or "matters") in _HELPS[1 : _HELPS.index(self.coach) + 1]


FREE = StudentRules()
