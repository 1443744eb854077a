"""The settings of a class: code, page key, rules, groups, and the table that students may take."""

import time

import msgspec

from lacoc_client.web.gateway.home import new_key
from lacoc_client.workshop.classroom.groups.group_state import GroupState
from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_client.workshop.design.learning.rules import FREE, StudentRules
from lacoc_client.workshop.phases.class_file import Document
from lacoc_shared.contest.codes import new_code

NAME, NOBODY = "class", ""
"""Name under which the settings are kept as a document, and the "student" to whom this document
belongs."""
_UNREAD = "class unread "
"""Begins the name under which settings that could not be read are kept; their time follows."""


class ClassState(msgspec.Struct, frozen=True, kw_only=True):
    """The settings of a class."""

    code: str
    """The class code."""
    key: str
    """The page key of the teacher. It stays the same at each start, so open pages go on working."""
    rules: StudentRules = FREE
    handed: Handed | None = None
    """The last table that was handed out to all students; None: none was."""
    handed_count: int = 0
    """How many tables have been handed out, to all students or to groups."""
    groups: tuple[GroupState, ...] = ()

    def kept(self) -> Document:
        """Return the settings of the class as a document for the class file."""
        return Document(NOBODY, NAME, "", time.time(), msgspec.json.encode(self))


def fresh_state() -> ClassState:
    """Make the settings of a new class."""
    return ClassState(code=new_code(), key=new_key())


def unread_state(kept: Document) -> Document:
    """Return settings that can't be read under another name, so that new ones don't replace them.

    They may be the only place where the members of groups are written.
    """
    return kept._replace(name=f"{_UNREAD}{kept.at_s}")


def read_state(kept: Document) -> ClassState | None:
    """Decode the settings from a class file; None if another version of the program wrote them."""
    try:
        state = msgspec.json.decode(kept.content, type=ClassState)
    except (msgspec.DecodeError, UnicodeDecodeError):
        return None
    # An earlier version did not count: the next table would have an older number than this one.
    handed = state.handed.number if state.handed is not None else 0
    return msgspec.structs.replace(state, handed_count=max(state.handed_count, handed))
