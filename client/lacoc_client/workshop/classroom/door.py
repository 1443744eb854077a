"""The door of a class: checks who may enter, by token, or by class code and nickname."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping

from lacoc_client.web.gateway.guesses import Guesses
from lacoc_client.workshop.classroom.class_student import ClassStudent
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.host import LetIn
from lacoc_client.workshop.phases.evidence import JoinedClass
from lacoc_shared import seal
from lacoc_shared.contest.codes import read_code
from lacoc_shared.contest.names import look_alike, read_name, same_name
from lacoc_shared.contest.tokens import new_token, new_token_hash
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_MOST_STUDENTS = 100
_LONGEST_NAME = 20


class ClassDoor:
    """Lets students into a class.

    Args:
        students: everybody who entered and was not deleted, by `same_name` of the nickname.
        code: returns the class code.
        new: makes a student and adds it to `students`.
        forget: deletes everything that is kept of a student.
    """

    def __init__(
        self,
        students: Mapping[str, ClassStudent],
        code: Callable[[], str],
        new: Callable[[str], ClassStudent],
        forget: Callable[[ClassStudent], Awaitable[None]],
    ) -> None:
        self._students = students
        self._code = code
        self._new = new
        self._forget = forget
        self._guesses = Guesses()
        self._coming = asyncio.Lock()
        """Held while a new student gets a nickname, so that two can't get the same."""

    async def enter(self, hello: requests.Hello, where: str) -> LetIn:
        """Let a student in: with a token, or with the class code and a nickname.

        Args:
            hello: the token, or the code and the nickname.
            where: address of the machine; wrong codes are counted for each machine.

        Raises:
            UserError: if the student may not enter; the page shows the sentence.
        """
        if hello.token:
            student, token = self._known(hello), hello.token
        else:
            student, token = await self._newcomer(hello, where), new_token()
            student.add_token(new_token_hash(token))
            await student.keep_token()
        if self._students.get(same_name(student.name)) is not student:
            raise UserError(say("class.enter"))  # forgotten while it came in
        return LetIn(student, token)

    def _known(self, hello: requests.Hello) -> ClassStudent:
        student = self._students.get(same_name(hello.name))
        hashes = () if student is None else student.token_hashes
        if student is None or not any(seal.verify_token(hello.token, one) for one in hashes):
            raise UserError(say("class.unknown-token"))
        return student

    async def _newcomer(self, hello: requests.Hello, where: str) -> ClassStudent:
        """Check the class code and the nickname; return this student, or make a new one.

        A student of this nickname who did nothing and has no page open is deleted first: perhaps
        this is the same browser, which lost its connection before it had its token.
        """
        if not hello.code:
            raise UserError(say("class.enter"))
        if read_code(hello.code) != self._code():
            await asyncio.sleep(self._guesses.wait_s(where, time.monotonic()))
            raise UserError(say("class.wrong-code"))
        name = read_name(hello.name, _LONGEST_NAME)
        if name is None:
            raise UserError(say("class.bad-name", most=_LONGEST_NAME))
        async with self._coming:
            if same_name(name) not in self._students and len(self._students) >= _MOST_STUDENTS:
                await self._make_room()
            student = self._students.get(same_name(name))
            if student is not None and not student.is_admitting:
                if not (student.seen_s and student.is_idle):
                    raise UserError(say("class.name-taken", name=name))
                await self._forget(student)
                student = None
            if student is None:
                names = (one.name for one in self._students.values())
                if (there := next((n for n in names if look_alike(n, name)), None)) is not None:
                    raise UserError(say("class.name-taken", name=there))
                student = self._new(name)
            student.is_admitting = False  # nobody else takes the name while this is written
        await student.diary.add(JoinedClass())
        return student

    async def _make_room(self) -> None:
        """Make room in a full class: delete a student who did nothing and has no page open.

        So nobody can fill the class by entering under a hundred nicknames.

        Raises:
            UserError: if there is no such student.
        """
        idle = (student for student in self._students.values() if student.is_idle)
        student = next(idle, None)
        if student is None:
            raise UserError(say("class.full", most=_MOST_STUDENTS))
        await self._forget(student)
