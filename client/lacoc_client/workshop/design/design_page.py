"""The connection of one /design page: reads the page's requests and sends the answers."""

import asyncio
from functools import partial
from pathlib import PurePath
from typing import Any

import msgspec
from starlette.websockets import WebSocket

from lacoc_client.web.gateway.answers import Answers
from lacoc_client.web.gateway.page_requests import GARBAGE, serve_requests
from lacoc_client.web.gateway.threads import Threads
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import Ping
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.files import FileContent, file_bytes, read_file
from lacoc_client.workshop.design.folder import Folder
from lacoc_client.workshop.design.host import Host
from lacoc_client.workshop.design.learning.learner import Learner
from lacoc_client.workshop.design.saving.robot_edit import edit_robot
from lacoc_client.workshop.design.studios.studio_desk import StudioDesk
from lacoc_client.workshop.phases.evidence import Hand, Named, WentToPhase
from lacoc_client.workshop.phases.facts import TrialFacts
from lacoc_client.workshop.tables.draft import Draft
from lacoc_client.workshop.tables.shared_table import TableUpdate
from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot
from lacoc_robots.seat_files import SeatFiles
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.studio import TrialReply
from lacoc_shared.words import say

_ASKS_HZ, _ASKS_BURST = 50.0, 100
_FILE_THREADS = Threads(2)
"""They read and write the files of all students."""


class DesignPage:
    """The connection of one page /design.

    Args:
        websocket: the page's WebSocket, not accepted yet.
        host: the folder or class for which the page works.
    """

    def __init__(self, websocket: WebSocket, host: Host) -> None:
        self._websocket = websocket
        self._host = host
        self._viewer = Viewer(websocket.state.socket)
        self._answers = Answers(self._viewer, lambda *_: None)
        self._studio = StudioDesk(host.studios, self._viewer.send_if_fast)
        self._learner: Learner | None = None
        """Turns what the page does into evidence; None: the page was not let in yet."""
        self._comparing: set[asyncio.Task[None]] = set()

    async def serve(self) -> None:
        """Answer the page's requests until the page goes."""
        try:
            await serve_requests(
                self._websocket, self._answers, requests.read, self._take, _ASKS_HZ, _ASKS_BURST
            )
        finally:
            self._leave()
            self._answers.stop()
            for task in self._comparing:
                task.cancel()

    async def _take(self, asked: requests.Asked) -> bool:
        """Answer a request, or close the connection; return False if it was closed.

        A page that has not been let in yet may only send `Hello` and `Ping`.
        """
        if isinstance(asked, requests.Hello):
            await self._enter(asked)
        elif isinstance(asked, Ping):  # also while somebody types the class code
            self._answers.reply(asked.id, {"t": asked.t})
        elif self._learner is not None and self._viewer.can_act:
            self._answer(asked, self._learner)
        else:
            self._answers.refuse(asked.id, UserError(say("design.wrong-key")))
            await self._websocket.close(GARBAGE, "no hello")
            return False
        return True

    async def _enter(self, hello: requests.Hello) -> None:
        """Let the page in if its page key, class code or token is right.

        Raises:
            UserError: if the page is not let in; it may try again.
        """
        client = self._websocket.client
        entered = await self._host.enter(hello, client.host if client else "")
        student = entered.student
        self._leave()
        self._learner = Learner(student, self._sample_trial)
        self._viewer.can_act = True
        value = {
            "robot": self._host.robot,
            "student": student.name or None,
            "token": entered.token,
            "table": None if hello.lesson else student.table.opened(),
            "earned": student.diary.has_earned_sample,
            "steps": student.diary.lesson,
            "court": _court(self._host),
        }
        self._answers.reply(hello.id, value)
        self._host.greet(student, self._viewer, hello.lesson)

    def _leave(self) -> None:
        if self._learner is not None:
            self._host.leave(self._learner.student, self._viewer)

    def _answer(self, asked: requests.Asked, learner: Learner) -> None:
        answers = self._answers
        match asked:
            case requests.TableAsk():
                answers.later(asked.id, self._share(asked, learner))
            case requests.PlaceAsk():
                place = asked.row, asked.col, asked.typing
                learner.student.table.move(self._viewer, *place)
                answers.reply(asked.id, {})
            case requests.GroupAsk():
                answers.later(asked.id, self._group(asked, learner))
            case requests.RobotAsk():
                answers.later(asked.id, self._studio.robot(asked))
            case requests.TrialAsk():
                answers.later(asked.id, self._trial(asked, learner))
            case requests.CoachAsk():
                _must_allow(learner, asked.size)
                answers.later(asked.id, self._studio.coach(asked))
            case requests.MapAsk():
                _must_allow(learner, "table")
                answers.later(asked.id, self._studio.map(asked))
            case requests.VariantsAsk():
                _must_allow(learner, "table")
                answers.later(asked.id, self._studio.variants(asked))
            case requests.CancelAsk():
                answers.later(asked.id, self._studio.cancel(asked.job))
            case requests.HandOnAsk():  # a kind of `PlayAsk`
                answers.later(asked.id, self._hand_on(asked, learner))
            case requests.PlayAsk():
                answers.later(asked.id, self._play(asked, learner))
            case (
                requests.EditAsk()
                | requests.CheckAsk()
                | requests.PhaseAsk()
                | requests.AnswerAsk()
                | requests.LessonAsk()
                | requests.NameAsk()
                | requests.VoteAsk()
                | requests.HandAsk()
            ):
                answers.later(asked.id, self._learn(asked, learner))
            case _:
                answers.later(asked.id, self._with_files(asked, learner))

    async def _trial(self, asked: requests.TrialAsk, learner: Learner) -> msgspec.Raw:
        """Let the robot walk, and keep as evidence what the trial shows.

        A trial of the coach's table, which the student only watches, is no evidence.
        """
        reply, payload = await self._studio.trial(asked)
        if asked.watched:
            return msgspec.Raw(payload)
        facts = await learner.tried(asked, reply)
        self._host.learned(learner.student, reply)
        task = asyncio.get_running_loop().create_task(self._compare(asked, facts, learner))
        self._comparing.add(task)
        task.add_done_callback(self._comparing.discard)
        return msgspec.Raw(payload)

    async def _compare(
        self, asked: requests.TrialAsk, facts: TrialFacts | None, learner: Learner
    ) -> None:
        if await learner.compared(asked, facts):
            self._host.learned(learner.student)

    async def _sample_trial(self, asked: requests.TrialAsk) -> TrialReply | None:
        """Repeat a trial with the sample gait.

        None: the trial was of the sample gait itself, or no sample has the table's number of legs.
        """
        table = (await asyncio.to_thread(self._host.sample)).table
        if table is None or asked.table is None or table.legs != asked.table.legs:
            return None
        sample = msgspec.structs.replace(asked, table=table, sequences=None, guesses=())
        return (await self._studio.trial(sample))[0]

    async def _share(self, asked: requests.TableAsk, learner: Learner) -> Any:
        """Merge a page's change into the shared table; see `SharedTable.take`."""
        update = TableUpdate(
            table=asked.table,
            epoch=asked.epoch,
            update=asked.update,
            cells=asked.cells,
            seen=asked.seen,
            begins=asked.begins,
        )
        return await learner.student.table.take(self._viewer, update)

    async def _group(self, asked: requests.GroupAsk, learner: Learner) -> dict[str, Any]:
        await self._host.group(learner.student, asked)
        return {}

    async def _play(self, asked: requests.PlayAsk, learner: Learner) -> dict[str, str]:
        """Check a table, and give its files to a court, where the student can play with them.

        Returns:
            `url`: the address of the page at that court.

        Raises:
            FileRefused: with every mistake of the table or of the robot.
            UserError: if there is no court here, or it does not become ready.
        """
        if self._host.playing is None:
            raise UserError(say("class.no-court"))
        files = await self._checked_files(asked, learner)
        return {"url": await asyncio.to_thread(self._host.playing.open, files)}

    async def _hand_on(self, asked: requests.HandOnAsk, learner: Learner) -> dict[str, Any]:
        """Check a table, and make the files with which a team enters a contest.

        Returns:
            The files, by the names of the fields of `SeatFiles`.

        Raises:
            FileRefused: with every mistake of the table or of the robot.
        """
        return (await self._checked_files(asked, learner))._asdict()

    async def _checked_files(self, asked: requests.PlayAsk, learner: Learner) -> SeatFiles:
        """Check a table with its robot, and return the files of both.

        Raises:
            FileRefused: with every mistake of the table or of the robot.
            UserError: if the student has asked too much lately.
        """
        check = requests.CheckAsk(
            id=0, table=asked.table, robot=asked.robot, sequences=asked.sequences
        )
        learner.student.diary.spend_request()
        if mistakes := (await learner.checked(check)).mistakes:
            raise FileRefused(list(mistakes))
        robot = asked.robot or self._host.robot
        return Draft(table=asked.table, sequences=asked.sequences, robot=robot).files()

    async def _learn(self, asked: requests.Asked, learner: Learner) -> Any:
        """Answer a request about the phases, such as an answer to a question."""
        student, diary = learner.student, learner.student.diary
        diary.spend_request()
        value: Any = {}
        match asked:
            case requests.EditAsk():
                value = await learner.edited(asked)
            case requests.CheckAsk():
                value = await learner.checked(asked)
            case requests.PhaseAsk():
                _must_be_open(learner, asked.number)
                await diary.add(WentToPhase(phase=asked.number))
            case requests.AnswerAsk():
                _must_be_open(learner, asked.phase)
                value = await learner.answered(asked)
            case requests.LessonAsk():
                await learner.stepped(asked)
            case requests.NameAsk():
                await diary.add(Named(word=asked.word))
            case requests.VoteAsk():
                await diary.vote(diary.word, asked.choice)
            case requests.HandAsk():
                await diary.add(Hand(up=asked.up))
        self._host.learned(student)
        return value

    async def _with_files(self, asked: requests.Asked, learner: Learner) -> Any:
        """Answer a request about gait and robot files.

        A student's files are read one after another, and all files on a few threads: a workbook
        may take long, and nobody else should wait for it.
        """
        async with learner.student.reading:
            return await _FILE_THREADS.run(partial(self._answer_with_files, asked))

    def _answer_with_files(self, asked: requests.Asked) -> Any:
        """Answer a page's request about gait and robot files; runs on another thread."""
        match asked:
            case requests.ReadAsk():
                return self._folder().read(asked.name)
            case requests.SampleAsk():
                return self._host.sample()
            case requests.ParseAsk():
                return parsed(asked)
            case requests.SetRobotAsk():
                return robot_with(asked)
            case requests.SaveAsk():
                content = asked.robot if asked.table is None else asked.table
                if content is None:
                    raise UserError(say("design.nothing-to-save"))
                return self._folder().save(asked.name, content, asked.version, asked.force)
            case requests.WriteAsk():
                return {"data": file_bytes(asked.name, asked.table)}
        raise AssertionError(asked)

    def _folder(self) -> Folder:
        if self._host.folder is None:
            raise UserError(say("class.no-folder"))
        return self._host.folder


def robot_with(asked: requests.SetRobotAsk) -> FileContent:
    """Return a robot file with one number changed; may wait for the disk.

    Raises:
        UserError: if the file can't be read, or has no place for the number.
    """
    file = asked.robot or SentFile(*find_robot(WORKSHOPS_ROBOT))
    text = read_file(f"{PurePath(file.name).stem}.toml", file.data).robot
    assert text is not None  # a .toml is a robot file
    return FileContent(robot=edit_robot(text, asked.entry, asked.value, asked.leg))


def parsed(asked: requests.ParseAsk) -> Any:
    """Read a file that was dropped on a page, or a whole pasted spreadsheet; may take long.

    Raises:
        FileRefused: with every mistake of a gait file.
        UserError: if the page sent neither bytes nor text, or a robot file is not UTF-8 text.
    """
    data = asked.data.encode() if isinstance(asked.data, str) else asked.data
    if not isinstance(data, bytes):
        raise UserError(say("gateway.bad-message", error=type(data).__name__))
    return read_file(asked.name, data)


def _must_allow(learner: Learner, size: str | None) -> None:
    """Check that the teacher lets the coach search for a change of this size.

    Args:
        learner: the student who asks.
        size: "cell", "three" or "table"; None: the coach only says which numbers matter.

    Raises:
        UserError: if the teacher does not allow it.
    """
    if not learner.student.rules.allows(size):
        raise UserError(say("class.coach-closed"))


def _must_be_open(learner: Learner, phase: int) -> None:
    """Check that the teacher has not closed a phase.

    Raises:
        UserError: if the phase is closed.
    """
    if phase in learner.student.rules.closed:
        raise UserError(say("class.phase-closed", number=phase))


def _court(host: Host) -> str | None:
    """Return "practice", the name of the court where a page can try its table; None: no court."""
    return None if host.playing is None else "practice"
