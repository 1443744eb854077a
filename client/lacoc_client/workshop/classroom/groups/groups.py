"""The groups of a class: who comes and goes, and the table of each."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterable, Mapping
from contextlib import suppress
from typing import Any

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.classroom.class_student import ClassStudent
from lacoc_client.workshop.classroom.groups.group_state import GROUPS_MOST, GroupState, Role
from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_client.workshop.design.learning.student import TABLE
from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.phases.evidence import Named
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_client.workshop.tables.draft import Draft
from lacoc_client.workshop.tables.shared_table import SharedTable
from lacoc_shared.contest.names import look_alike, read_name, same_name
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

OF_GROUP = "group\n"
"""Before the id of a group: whose its documents are in the class file. No nickname has it."""
_LONGEST_NAME = 20
_CHANGES_HZ, _CHANGES_BURST = 10.0, 60
"""Changes of all groups [1/s]: each is told to the whole class."""


class Groups:
    """The groups of a class; used from the event loop only.

    Args:
        store: opens the class file.
        changed: called after each change; keeps the states, and tells the teacher.
        students: all students, by `same_name` of the nickname.
    """

    def __init__(
        self,
        store: Callable[[], Awaitable[ClassStore]],
        changed: Callable[[], Awaitable[None]],
        students: Mapping[str, ClassStudent],
    ) -> None:
        self.states: dict[str, GroupState] = {}
        """By id."""
        self._store = store
        self._changed = changed
        self._students = students
        self._tables: dict[str, SharedTable] = {}
        self._allowance = Allowance(_CHANGES_HZ, _CHANGES_BURST)

    def begin(self, states: Iterable[GroupState], documents: Iterable[Document]) -> None:
        """Begin with what the class file has; students sit down at their groups' tables."""
        kept = {one.student: one for one in documents if one.name == TABLE}
        for state in states:
            one = kept.get(OF_GROUP + state.id)
            content, epoch = (one.content, one.version) if one else (b"", "")
            self.states[state.id] = state
            try:
                table = SharedTable(state.id, self._keeps(state.id), content, epoch)
            except UserError:  # of another version of this program
                table = SharedTable(state.id, self._keeps(state.id))
            self._tables[state.id] = table
            for name in state.members:
                if student := self._students.get(same_name(name)):
                    student.sit_at(table)

    def of(self, student: ClassStudent) -> GroupState | None:
        """Return the group of a student; None: the student works alone."""
        found = (state for state in self.states.values() if student.name in state.members)
        return next(found, None)

    def find(self, name: str) -> GroupState:
        """Return a group.

        Raises:
            UserError: if there is none of this name.
        """
        for state in self.states.values():
            if same_name(state.name) == same_name(name):
                return state
        raise UserError(say("groups.none", name=name))

    def drafts(self) -> dict[str, tuple[GroupState, Draft]]:
        """Return the newest table of each group that has one, by id."""
        drafts = {id_: table.draft for id_, table in self._tables.items()}
        return {id_: (self.states[id_], draft) for id_, draft in drafts.items() if draft}

    async def join(self, student: ClassStudent, name: str) -> None:
        """Bring a student into a group, which begins with the student's table if it is new.

        Raises:
            UserError: if the name is none, too much like another one, or the group is full.
        """
        self._spend()
        read = read_name(name, _LONGEST_NAME)
        if read is None:
            raise UserError(say("class.bad-name", most=_LONGEST_NAME))
        known = [one for one in self.states.values() if same_name(one.name) == same_name(read)]
        state = known[0] if known else self._new(read)
        state = state.joined(student.name)
        if self.of(student) is not None:
            await self._leave(student)
        is_new = state.id not in self.states
        self.states[state.id] = self.states.get(state.id, state).joined(student.name)
        if is_new:
            table = SharedTable(state.id, self._keeps(state.id))
            table.replace(student.table.fresh())
            self._tables[state.id] = table
        student.sit_at(self._tables[state.id])
        if is_new and student.draft is None:
            await self._tables[state.id].keep_now()
        await self._tell()

    async def leave(self, student: ClassStudent) -> None:
        """Let a student go back to the own table; a group without members ends."""
        self._spend()
        if await self._leave(student):
            await self._tell()

    async def forget(self, student: ClassStudent) -> None:
        """Remove a student who is deleted, and what the student typed, from the group."""
        state = self.of(student)
        if state is None:
            return
        table = self._tables[state.id]
        await self._leave(student)
        if state.id in self.states:
            await table.forget(student.name)
        await self._tell()

    async def set_role(self, student: ClassStudent, role: Role) -> None:
        """Give a student a role in the group; "": none."""
        self._spend()
        await self._change(self._own(student).with_role(student.name, role))

    async def vote(self, student: ClassStudent, word: str) -> None:
        """Count a student's vote for a word; it is the student's own word then."""
        self._spend()
        word = word.strip()
        if not word:
            raise UserError(say("groups.no-word"))
        await self._change(self._own(student).voted(student.name, word))
        await student.diary.add(Named(word=word))

    async def hand_out(self, name: str, handed: Handed) -> None:
        """Offer a table to the members of a group.

        Raises:
            UserError: if there is no such group.
        """
        state = msgspec.structs.replace(self.find(name), handed=handed)
        await self._change(state)
        for member in state.members:
            if student := self._students.get(same_name(member)):
                student.send(handed.message())

    def message(self, student: ClassStudent) -> bytes:
        """Return the message with a student's group, and with all groups that can be joined."""
        state = self.of(student)
        listed = [{"name": one.name, "members": len(one.members)} for one in self.states.values()]
        body: dict[str, Any] = {"groups": listed, "group": None}
        if state is not None:
            online = {
                name
                for name in state.members
                if (one := self._students.get(same_name(name))) and one.viewers
            }
            body["group"] = {
                "name": state.name,
                "members": [
                    {"name": name, "role": state.roles.get(name, ""), "online": name in online}
                    for name in state.members
                ],
                "words": [
                    {"word": one.word, "by": one.by, "votes": state.count(one.word)}
                    for one in state.words
                ],
                "word": state.word,
                "voted": state.votes.get(student.name, ""),
            }
        return wire.map_message(MessageKind.GROUP, body)

    def tell(self, only: GroupState | None = None) -> None:
        """Tell all students, or the members of one group, how their groups are."""
        for student in self._students.values():
            if only is None or student.name in only.members:
                student.send(self.message(student))

    def _own(self, student: ClassStudent) -> GroupState:
        state = self.of(student)
        if state is None:
            raise UserError(say("groups.not-in"))
        return state

    def _new(self, name: str) -> GroupState:
        if any(look_alike(one.name, name) for one in self.states.values()):
            raise UserError(say("groups.alike", name=name))
        if len(self.states) >= GROUPS_MOST:
            raise UserError(say("groups.too-many", most=GROUPS_MOST))
        return GroupState(id=new_token(), name=name)

    async def _change(self, state: GroupState) -> None:
        self.states[state.id] = state
        await self._changed()
        self.tell(state)

    async def _leave(self, student: ClassStudent) -> bool:
        """Remove a student from the group; return whether there was one."""
        state = self.of(student)
        if state is None:
            return False
        student.sit_at(student.own)
        state = state.left(student.name)
        self.states[state.id] = state
        if not state.members:
            del self.states[state.id]
            del self._tables[state.id]
            with suppress(UserError):  # `trouble` says why
                store = await self._store()
                await asyncio.wrap_future(store.forget(OF_GROUP + state.id))
        return True

    async def _tell(self) -> None:
        await self._changed()
        self.tell()

    def _keeps(self, id_: str) -> Callable[[bytes, str], Awaitable[None]]:
        async def keep(content: bytes, epoch: str) -> None:
            if id_ not in self.states:
                return  # it has ended
            with suppress(UserError):  # `trouble` says why
                store = await self._store()
                document = Document(OF_GROUP + id_, TABLE, epoch, time.time(), content)
                await asyncio.wrap_future(store.write(document))

        return keep

    def _spend(self) -> None:
        if not self._allowance.take(1, time.monotonic()):
            raise UserError(say("gateway.too-much"))
