"""The groups of a class: students join and leave them, take roles and vote for words."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.classroom.class_student import ClassStudent
from lacoc_client.workshop.classroom.groups.group_state import GROUPS_MOST, GroupState, Role
from lacoc_client.workshop.classroom.groups.group_tables import GroupTables
from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.phases.evidence import Named
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_client.workshop.tables.draft import Draft
from lacoc_shared.contest.names import look_alike, read_name, same_name
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

_LONGEST_NAME = 20
_CHANGES_HZ, _CHANGES_BURST = 10.0, 60
"""How many changes of groups a class may make: in a second on average, and in a burst. Each change
is told to the whole class."""
_OWN_HZ, _OWN_BURST = 1.0, 20
"""How many of these changes one student may make: in a second on average, and in a burst. So one
student can't use up the changes of the class."""


class Groups:
    """The groups of a class; used from the event loop only.

    Args:
        store: opens the class file.
        changed: called after each change; it writes `states` to the class file, and tells the
            teacher.
        students: all students, by `same_name` of the nickname.
    """

    def __init__(
        self,
        store: Callable[[], Awaitable[ClassStore]],
        changed: Callable[[], Awaitable[None]],
        students: Mapping[str, ClassStudent],
    ) -> None:
        self.states: dict[str, GroupState] = {}
        """The state of each group, by its id."""
        self._changed = changed
        self._students = students
        self._tables = GroupTables(store)
        self._allowance = Allowance(_CHANGES_HZ, _CHANGES_BURST)
        self._own_allowances: dict[str, Allowance] = {}
        self._moving = asyncio.Lock()
        """Held while a student joins or leaves a group."""

    async def begin(self, states: Iterable[GroupState], documents: Iterable[Document]) -> None:
        """Load the groups from the class file; let the students work on their groups' tables again.

        The program may have been ended while a student was deleted or a group ended; what is left
        of them is removed.
        """
        gone: dict[str, list[str]] = {}
        for state in states:
            lost = [name for name in state.members if same_name(name) not in self._students]
            for name in lost:
                state = state.left(name)
            if state.members or same_name(state.last) in self._students:
                self.states[state.id] = state
                gone[state.id] = lost
        await self._tables.begin(documents, gone)
        for state in self.states.values():
            for name in state.members:
                self._students[same_name(name)].sit_at(self._tables[state.id])

    def of(self, student: ClassStudent) -> GroupState | None:
        """Return the group of a student; None: the student works alone."""
        found = (state for state in self.states.values() if student.name in state.members)
        return next(found, None)

    def find(self, name: str) -> GroupState:
        """Return the group with this name.

        Raises:
            UserError: if there is no group of this name.
        """
        for state in self.states.values():
            if same_name(state.name) == same_name(name):
                return state
        raise UserError(say("groups.none", name=name))

    def drafts(self) -> dict[str, Draft]:
        """Return the newest table of each group with members, by the name of the group.

        A group without a table is left out.
        """
        drafts = self._tables.drafts().items()
        return {self.states[id_].name: one for id_, one in drafts if self.states[id_].members}

    async def join(self, student: ClassStudent, name: str) -> None:
        """Put a student into a group; a new group begins with a copy of the student's table.

        Raises:
            UserError: if the name is not allowed, or is too much like that of another group; if the
                group is full; or if there are too many groups.
        """
        read = read_name(name, _LONGEST_NAME)
        if read is None:
            raise UserError(say("class.bad-name", most=_LONGEST_NAME))
        async with self._moving:
            if self._students.get(same_name(student.name)) is not student:
                return  # deleted meanwhile
            known = [one for one in self.states.values() if same_name(one.name) == same_name(read)]
            state = known[0] if known else await self._new(read)
            state.joined(student.name)  # raises an error if the group is full
            if student.name in state.members:
                return
            document = student.table.fresh()
            await self._leave(student)
            # Somebody in the group may have voted meanwhile.
            self.states[state.id] = self.states.get(state.id, state).joined(student.name)
            table = self._tables[state.id] if known else self._tables.add(state.id, document)
            student.sit_at(table)
            if not known:
                await table.keep_now()
            await self._tell()

    async def leave(self, student: ClassStudent) -> None:
        """Take a student out of the student's group, back to the student's own table.

        A group without members stays, with its table, for whoever comes back. It ends if nothing
        was made in it.
        """
        async with self._moving:
            if await self._leave(student):
                await self._tell()

    async def forget(self, student: ClassStudent) -> None:
        """Remove a deleted student from the group, and the student's proposals from all tables.

        The tables of groups that the student has left may have proposals too.
        """
        async with self._moving:
            self._own_allowances.pop(student.name, None)
            own = None if (state := self.of(student)) is None else state.id
            has_left = await self._leave(student)
            for state in [*self.states.values()]:
                if state.last == student.name:
                    await self._end(state)
                    has_left = True
                elif state.handed is not None and state.handed.of == student.name:
                    self.states[state.id] = msgspec.structs.replace(state, handed=None)
                    has_left = True
            for id_ in [*self.states]:
                if id_ == own or self._tables[id_].has_proposals(student.name):
                    await self._tables[id_].forget(student.name)
            if has_left:
                await self._tell()

    async def set_role(self, student: ClassStudent, role: Role) -> None:
        """Give a student a role in the group; "": no role."""
        await self._change(self._own(student).with_role(student.name, role))

    async def vote(self, student: ClassStudent, word: str) -> None:
        """Count a student's vote for a word; if the word is new, the student proposes it."""
        word = word.strip()
        if not word:
            raise UserError(say("groups.no-word"))
        await self._change(self._own(student).voted(student.name, word))
        await student.diary.add(Named(word=word))

    async def hand_out(self, name: str, handed: Handed) -> None:
        """Offer a gait's table to the members of a group.

        Raises:
            UserError: if there is no group of this name.
        """
        state = msgspec.structs.replace(self.find(name), handed=handed)
        await self._change(state)
        for member in state.members:
            if student := self._students.get(same_name(member)):
                student.send(handed.message())

    async def take(self, student: ClassStudent, number: int) -> None:
        """Note that a student has taken a handed-out table for the group: the others are not asked.

        Args:
            student: a member of a group.
            number: number of the table.
        """
        state = self._own(student)
        await self._change(msgspec.structs.replace(state, taken=max(state.taken, number)))

    def spend(self, student: ClassStudent) -> None:
        """Count a request of a student to change a group.

        Raises:
            UserError: if this student, or the class, has made too many such requests lately.
        """
        own = self._own_allowances.setdefault(student.name, Allowance(_OWN_HZ, _OWN_BURST))
        now_s = time.monotonic()
        if not own.take(1, now_s) or not self._allowance.take(1, now_s):
            raise UserError(say("gateway.too-much"))

    def message(self, student: ClassStudent) -> bytes:
        """Return the message to a student about the student's group and all groups of the class."""
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
                "taken": state.taken,
            }
        return wire.map_message(MessageKind.GROUP, body)

    def tell(self, only: GroupState | None = None) -> None:
        """Tell all students, or only the members of one group, the state of their groups."""
        for student in self._students.values():
            if only is None or student.name in only.members:
                student.send(self.message(student))

    def _own(self, student: ClassStudent) -> GroupState:
        state = self.of(student)
        if state is None:
            raise UserError(say("groups.not-in"))
        return state

    async def _new(self, name: str) -> GroupState:
        if any(look_alike(one.name, name) for one in self.states.values()):
            raise UserError(say("groups.alike", name=name))
        if len(self.states) >= GROUPS_MOST:
            left = next((one for one in self.states.values() if not one.members), None)
            if left is None:
                raise UserError(say("groups.too-many", most=GROUPS_MOST))
            await self._end(left)
        return GroupState(id=new_token(), name=name)

    async def _change(self, state: GroupState) -> None:
        self.states[state.id] = state
        await self._changed()
        self.tell(state)

    async def _leave(self, student: ClassStudent) -> bool:
        """Remove a student from the student's group; return whether there was such a group."""
        state = self.of(student)
        if state is None:
            return False
        student.sit_at(student.own)
        self.states[state.id] = state = state.left(student.name)
        if not state.members and self._tables[state.id].equals(student.own):
            await self._end(state)
        return True

    async def _end(self, state: GroupState) -> None:
        del self.states[state.id]
        # First: a table without a group is deleted at the next start, a group needs its table.
        await self._changed()
        await self._tables.end(state.id)

    async def _tell(self) -> None:
        await self._changed()
        self.tell()
