"""A class while it runs: its students, its teacher's pages, and its file."""

import asyncio
import time
from collections.abc import AsyncIterator, Iterable, Sequence
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar, cast, get_args

import msgspec

from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.workshop.classroom.cards import Card
from lacoc_client.workshop.classroom.class_student import ClassStudent
from lacoc_client.workshop.classroom.door import ClassDoor
from lacoc_client.workshop.classroom.groups.group_state import Role
from lacoc_client.workshop.classroom.groups.group_tables import OF_GROUP
from lacoc_client.workshop.classroom.groups.groups import Groups
from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_client.workshop.classroom.state import (
    NAME,
    NOBODY,
    ClassState,
    fresh_state,
    read_state,
    unread_state,
)
from lacoc_client.workshop.classroom.teacher.news import (
    Trouble,
    card_message,
    class_message,
    gone_message,
    tournament_message,
)
from lacoc_client.workshop.classroom.tournament import TOURNAMENT, Tournament
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.designer import folder_message, sample_postures, studio_message
from lacoc_client.workshop.design.files import FileContent
from lacoc_client.workshop.design.folder import Folder
from lacoc_client.workshop.design.host import LetIn
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.rules import StudentRules
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.design.playing import Playing
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import Document, Kept
from lacoc_client.workshop.phases.evidence import Hand
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot
from lacoc_shared.contest.codes import new_code
from lacoc_shared.contest.names import same_name
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import TrialReply
from lacoc_shared.words import say

CLASS_FILE = "lacoc-class.sqlite"
"""Name of the file in the folder of a class."""

_T = TypeVar("_T", Kept, Document)

_SOON_S = 0.1
"""Time after which pages are told that a studio has come or gone [s]."""
_ALIVE_S = 1.0
"""Time between two signs of life to students' pages [s]."""
_QUIET_LOOK_S = 10.0
"""Time between two searches for students who have done nothing for long [s]."""


class Classroom:
    """A class, the `Host` of its students' pages; used from the event loop only.

    Args:
        folder: folder of the class.
        studios: the connections to the studios; they are started and closed here.
        addresses: addresses of the class that students can open.
        robot: the robot of the class; None: the workshop's.

    Raises:
        UserError: if there is no such robot.
    """

    folder: Folder | None = None
    playing: Playing | None = None

    def __init__(
        self,
        folder: Path,
        studios: Studios,
        addresses: Sequence[str] = (),
        robot: str | None = None,
    ) -> None:
        self.studios = studios
        self.robot = SentFile(*find_robot(robot)) if robot else None
        self.addresses = tuple(addresses)
        self.state: ClassState = fresh_state()
        self.students: dict[str, ClassStudent] = {}
        """All students who ever entered and were not deleted, by `same_name` of the nickname."""
        self.teachers: dict[Viewer, None] = {}
        """The open pages of the teacher."""
        self.tournament = Tournament(folder, self._tell_tournament, self._keep_tournament)
        self._keeper = Keeper(folder / CLASS_FILE)
        self.groups = Groups(self._store, self._keep_groups, self.students)
        self._robot_name = robot or WORKSHOPS_ROBOT
        self._door = ClassDoor(self.students, lambda: self.state.code, self._new, self.forget)

    @asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Tell pages of studios that come or go, until the block ends; then close the class."""
        self.studios.start()
        looking = asyncio.get_running_loop().create_task(self._look())
        try:
            yield
        finally:
            looking.cancel()
            await self.tournament.stop()
            await self._keeper.close()
            await asyncio.to_thread(self.studios.close)

    async def open(self) -> None:
        """Read the settings, the students and their evidence from the class file.

        Raises:
            UserError: if the class file can't be opened.
        """
        store = await self._store()
        kept = await asyncio.wrap_future(store.evidence())
        evidence = _by_student(kept)
        documents = _by_student(store.documents())
        of_class = {one.name: one for one in documents.pop(NOBODY, [])}
        if (played := of_class.pop(TOURNAMENT, None)) is not None:
            self.tournament.load(played.content)
        if (settings := of_class.pop(NAME, None)) is not None:
            state = read_state(settings)
            if state is None:
                unread = unread_state(settings)
                await asyncio.wrap_future(store.write(unread))
                of_class[unread.name] = unread
            self.state = state or self.state
        of_groups = [name for name in documents if name.startswith(OF_GROUP)]
        kept_groups = [one for name in of_groups for one in documents.pop(name)]
        if of_class:  # groups in settings that were not read have tables, too: they must stay
            known = {OF_GROUP + one.id for one in self.state.groups}
            kept_groups = [one for one in kept_groups if one.student in known]
        for name in dict.fromkeys((*evidence, *documents)):
            self._new(name).begin(evidence.get(name, []), documents.get(name, []))
        await self.groups.begin(self.state.groups, kept_groups)
        self.state = msgspec.structs.replace(self.state, groups=tuple(self.groups.states.values()))
        await asyncio.wrap_future(store.write(self.state.kept()))

    # What students do

    async def enter(self, hello: requests.Hello, where: str) -> LetIn:
        """Let a student in, with a token or with class code and nickname; see `Host.enter`."""
        return await self._door.enter(hello, where)

    def greet(self, student: Student, viewer: Viewer, lesson: bool) -> None:
        """Send a page everything that it shows first; see `Host.greet`."""
        assert isinstance(student, ClassStudent)
        student.greet(viewer, lesson)
        student.seen_s = time.time()
        viewer.send(folder_message("", None))
        viewer.send(studio_message(self.studios))
        viewer.send(student.phases_message())
        if (handed := self._handed(student)) is not None:
            viewer.send(handed.message())
        if (state := self.groups.of(student)) is not None:
            self.groups.tell(state)  # that the student is online
        viewer.send(self.groups.message(student))
        self._tell_card(student)

    def leave(self, student: Student, viewer: Viewer) -> None:
        """Remove a page that was closed, and tell the teacher; see `Host.leave`."""
        assert isinstance(student, ClassStudent)
        student.leave(viewer)
        if (state := self.groups.of(student)) is not None:
            self.groups.tell(state)
        self._tell_card(student)

    def learned(self, student: Student, trial: TrialReply | None = None) -> None:
        """Tell the student's pages and the teacher what a student did; see `Host.learned`."""
        assert isinstance(student, ClassStudent)
        student.learned(trial)
        student.tell()
        self._tell_card(student)

    async def group(self, student: Student, asked: requests.GroupAsk) -> None:
        """Do what a student asks about groups, such as join one; see `Host.group`."""
        assert isinstance(student, ClassStudent)
        self.groups.spend(student)
        match asked.act:
            case "join":
                await self.groups.join(student, asked.text)
            case "leave":
                await self.groups.leave(student)
            case "role":
                await self.groups.set_role(student, _role(asked.text))
            case "word":
                await self.groups.vote(student, asked.text)
                student.tell()
            case "take":
                await self.groups.take(student, min(asked.number, self.state.handed_count))

    def sample(self) -> FileContent:
        """Return the sample postures of the class's robot; empty if it has none. May read files."""
        return sample_postures(self._robot_name)

    # What the teacher does

    def find(self, name: str) -> ClassStudent:
        """Return the student with this nickname.

        Raises:
            UserError: if there is no student of this name.
        """
        student = self.students.get(same_name(name))
        if student is None:
            raise UserError(say("class.no-student", name=name))
        return student

    async def set_rules(self, rules: StudentRules) -> None:
        """Set what students may do, and tell all students and the teacher."""
        await self._set(rules=rules)
        for student in self.students.values():
            student.tell()

    async def set_code(self) -> None:
        """Make another class code. Students who have entered stay in the class."""
        await self._set(code=new_code())

    async def hand_out(
        self,
        title: str,
        table: FileTable,
        sequences: tuple[tuple[int, ...], ...] | None,
        group: str = "",
        of: str = "",
    ) -> None:
        """Offer a gait's table to a group, or to all students and those who come later.

        Args:
            title: what students read.
            table: the table.
            sequences: the sequences of its keys; None: the usual ones.
            group: name of the group; "": all students.
            of: nickname of the student whose table it is; "": nobody's.

        Raises:
            UserError: if there is no group of this name.
        """
        number = self.state.handed_count + 1
        handed = Handed(number=number, title=title, table=table, sequences=sequences, of=of)
        if group:
            await self.groups.hand_out(group, handed)
            await self._set(handed_count=number)
            return
        await self._set(handed=handed, handed_count=number)
        for student in self.students.values():
            student.send(handed.message())

    async def put_into_group(self, student: ClassStudent, name: str) -> None:
        """Put a student into a group, or let the student work alone.

        Args:
            student: the student.
            name: name of the group; "": none.

        Raises:
            UserError: if the group is full, its name is not allowed, or there are too many groups.
        """
        if name:
            await self.groups.join(student, name)
        else:
            await self.groups.leave(student)

    async def lower(self, student: ClassStudent) -> None:
        """Take down the hand that a student has raised for help."""
        await student.diary.add(Hand(up=False))
        student.hand_moved()
        student.tell()
        self._tell_card(student)

    async def admit(self, student: ClassStudent) -> None:
        """Allow one more browser to enter under a student's name with the class code."""
        student.is_admitting = True

    async def forget(self, student: ClassStudent) -> None:
        """Delete everything that is kept of a student.

        Raises:
            UserError: if the class file can't be written; then the student stays.
        """
        await student.diary.forget()
        # First: what its pages still ask for brings it back into no group.
        if self.students.get(same_name(student.name)) is student:  # else another page was quicker
            del self.students[same_name(student.name)]
        student.send_away()
        if self.state.handed is not None and self.state.handed.of == student.name:
            await self._set(handed=None)
        await self.groups.forget(student)
        await self.tournament.forget(student.name)
        self._tell(gone_message(student.name))

    async def evidence(self) -> list[Kept]:
        """Read the evidence of all students.

        Raises:
            UserError: if the class file can't be read.
        """
        return await asyncio.wrap_future((await self._store()).evidence())

    async def documents(self) -> list[Document]:
        """Return the documents of the class: tables, hashes of students' tokens, and settings."""
        return (await self._store()).documents()

    def add_teacher(self, viewer: Viewer) -> None:
        """Add a page of the teacher, and send it everything about the class."""
        self.teachers[viewer] = None
        cards = [student.card() for student in self.students.values()]
        viewer.send(self._class_message(cards))
        viewer.send(tournament_message(self.tournament.state))

    # Messages

    def _new(self, name: str) -> ClassStudent:
        diary = Diary(self._keeper, name)
        student = ClassStudent(name, diary, lambda: self.state.rules)
        self.students[same_name(name)] = student
        return student

    async def _set(self, **changes: Any) -> None:
        """Change settings of the class, write them to the class file, and tell the teacher."""
        self.state = msgspec.structs.replace(self.state, **changes)
        with suppress(UserError):  # the message has the reason as `trouble`
            await asyncio.wrap_future((await self._store()).write(self.state.kept()))
        self._tell(self._class_message())

    async def _store(self) -> ClassStore:
        store = await self._keeper.opened()
        if store is None:
            assert self._keeper.trouble is not None
            raise UserError(self._keeper.trouble)
        return store

    async def _look(self) -> None:
        loop = asyncio.get_running_loop()
        told, alive_s, quiet_s = self._public(), loop.time(), loop.time()
        while True:
            await asyncio.sleep(_SOON_S)
            now_s = loop.time()
            if now_s >= alive_s or self._public() != told:
                alive_s = now_s + _ALIVE_S
                message = studio_message(self.studios)
                for student in self.students.values():
                    student.send(message)
            if self._public() != told:
                told = self._public()
                self._tell(self._class_message())
                for student in self.students.values():
                    student.tell()  # whether what it does is kept
            if now_s >= quiet_s:
                quiet_s = now_s + _QUIET_LOOK_S
                for student in self.students.values():
                    self._tell_card(student)

    async def _keep_groups(self) -> None:
        await self._set(groups=tuple(self.groups.states.values()))

    async def _keep_tournament(self) -> None:
        content = msgspec.json.encode(self.tournament.state)
        with suppress(UserError):  # `Keeper.trouble` says why
            store = await self._store()
            document = Document(NOBODY, TOURNAMENT, "", time.time(), content)
            await asyncio.wrap_future(store.write(document))

    def _handed(self, student: ClassStudent) -> Handed | None:
        """Return the last table that the teacher offered to the class or to this student's group.

        None: the teacher has offered no table.
        """
        state = self.groups.of(student)
        both = (self.state.handed, state.handed if state is not None else None)
        found = [one for one in both if one is not None]
        return max(found, key=lambda one: one.number, default=None)

    def _tell_card(self, student: ClassStudent) -> None:
        # Whoever has just been forgotten has no card.
        if self.students.get(same_name(student.name)) is student:
            card = student.changed_card()
            if card is not None:
                self._tell(card_message(card))

    def _tell_tournament(self) -> None:
        self._tell(tournament_message(self.tournament.state))

    def _tell(self, message: bytes) -> None:
        for viewer in self.teachers:
            viewer.send(message)

    def _public(self) -> Trouble:
        return Trouble(self._keeper.trouble, self.studios.present, self.studios.why)

    def _class_message(self, cards: Sequence[Card] | None = None) -> bytes:
        return class_message(self.state, self.addresses, self._public(), cards)


def _by_student(kept: Iterable[_T]) -> dict[str, list[_T]]:
    """Group evidence or documents by student; those of one student stay in their order."""
    groups: dict[str, list[_T]] = {}
    for one in kept:
        groups.setdefault(one.student, []).append(one)
    return groups


def _role(text: str) -> Role:
    for role in get_args(Role):
        if role == text:
            return cast(Role, role)
    raise UserError(say("groups.no-role", role=text))
