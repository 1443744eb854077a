"""What a teacher allows in a class."""

from typing import Annotated, Literal

import msgspec

Help = Literal["none", "matters", "cell", "three", "table"]
"""How much the coach may help: not at all, say which numbers matter, or change so many."""
_HELPS: tuple[Help, ...] = ("none", "matters", "cell", "three", "table")


class StudentRules(msgspec.Struct, frozen=True, kw_only=True):
    """Rules for students. Whoever designs alone may do everything (`FREE`)."""

    closed: tuple[Annotated[int, msgspec.Meta(ge=0, le=6)], ...] = ()
    """Numbers of the phases to which nobody can go."""
    coach: Help = "table"
    explain_first: bool = False
    """Whether students read the explanation of a phase before its task."""

    def allows(self, size: str | None) -> bool:
        """Return whether the coach may search for a change of this size.

        Args:
            size: cell, three or table; None: the coach only says which numbers matter.
        """
        return (size or "matters") in _HELPS[1 : _HELPS.index(self.coach) + 1]


FREE = StudentRules()
