"""The settings of a class: code, key, rules, groups, and the table that was handed out."""

import time

import msgspec

from lacoc_client.web.gateway.home import new_key
from lacoc_client.workshop.classroom.groups.group_state import GroupState
from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_client.workshop.design.learning.rules import FREE, StudentRules
from lacoc_client.workshop.phases.class_file import Document
from lacoc_shared.contest.codes import new_code

NAME, NOBODY = "class", ""
"""Name under which it is kept, and the student whose it is: nobody's."""


class ClassState(msgspec.Struct, frozen=True, kw_only=True):
    """The settings of a class."""

    code: str
    """The class code."""
    key: str
    """The page key of the teacher: it is the same after each start, so pages stay open."""
    rules: StudentRules = FREE
    handed: Handed | None = None
    """The last table that was handed out to all."""
    handed_count: int = 0
    """How many tables were handed out, to all or to groups."""
    groups: tuple[GroupState, ...] = ()

    def kept(self) -> Document:
        """Return the settings as a class file keeps them."""
        return Document(NOBODY, NAME, "", time.time(), msgspec.json.encode(self))


def fresh_state() -> ClassState:
    """Make the settings of a new class."""
    return ClassState(code=new_code(), key=new_key())


def read_state(kept: Document) -> ClassState | None:
    """Decode kept settings; None if they are of another version of this program."""
    try:
        state = msgspec.json.decode(kept.content, type=ClassState)
    except (msgspec.DecodeError, UnicodeDecodeError):
        return None
    # An earlier version did not count: the next table would have an older number than this one.
    handed = state.handed.number if state.handed is not None else 0
    return msgspec.structs.replace(state, handed_count=max(state.handed_count, handed))
