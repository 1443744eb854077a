"""One /class page's connection: the requests that it may make, and who answers them."""

import asyncio
import hmac
from typing import Any

import msgspec
from starlette.websockets import WebSocket

from lacoc_client.web.gateway.answers import Answers
from lacoc_client.web.gateway.page_requests import GARBAGE, serve_requests
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import Ping
from lacoc_client.workshop.classroom.class_student import ClassStudent
from lacoc_client.workshop.classroom.classroom import Classroom
from lacoc_client.workshop.classroom.groups.group_state import group_title
from lacoc_client.workshop.classroom.kept import EVIDENCE, TABLES, student_files
from lacoc_client.workshop.classroom.teacher import requests
from lacoc_client.workshop.design.design_page import parsed
from lacoc_client.workshop.design.requests import Hello, ParseAsk, RobotAsk, TrialAsk
from lacoc_client.workshop.design.studios.studio_desk import StudioDesk
from lacoc_client.workshop.phases.export import evidence_csv, tables_zip
from lacoc_client.workshop.tables.draft import Draft
from lacoc_robots.seat_files import SeatFiles
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import say

_ASKS_HZ, _ASKS_BURST = 20.0, 100


class TeacherPage:
    """The connection of one page /class.

    Args:
        websocket: the page's WebSocket, not accepted yet.
        classroom: the class.
    """

    def __init__(self, websocket: WebSocket, classroom: Classroom) -> None:
        self._websocket = websocket
        self._class = classroom
        self._viewer = Viewer(websocket.state.socket)
        self._answers = Answers(self._viewer, lambda *_: None)
        self._studio = StudioDesk(classroom.studios, self._viewer.send_if_fast)

    async def serve(self) -> None:
        """Answer the page's requests until the page goes."""
        try:
            await serve_requests(
                self._websocket, self._answers, requests.read, self._take, _ASKS_HZ, _ASKS_BURST
            )
        finally:
            self._class.teachers.pop(self._viewer, None)
            self._answers.stop()

    async def _take(self, asked: requests.Asked) -> bool:
        """Answer a request of a page that has shown the page key; close any other page.

        Returns:
            False if the page was closed, else True.
        """
        if isinstance(asked, Hello):
            key = asked.key.encode("utf-8", "surrogatepass")
            self._viewer.can_act = hmac.compare_digest(key, self._class.state.key.encode())
        if not self._viewer.can_act:
            self._answers.refuse(asked.id, UserError(say("class.wrong-key")))
            await self._websocket.close(GARBAGE, "no page key")
            return False
        match asked:
            case Hello():
                self._answers.reply(asked.id, {})
                self._class.add_teacher(self._viewer)
            case Ping():
                self._answers.reply(asked.id, {"t": asked.t})
            case _:
                self._answers.later(asked.id, self._answer(asked))
        return True

    async def _answer(self, asked: requests.Asked) -> Any:
        group = self._class
        value: Any = {}
        match asked:
            case requests.RulesAsk():
                await group.set_rules(asked.rules)
            case requests.HandOutAsk():
                await self._hand_out(asked)
            case ParseAsk():
                value = await asyncio.to_thread(parsed, asked)
            case requests.SeatAsk():
                await group.put_into_group(group.find(asked.student), asked.group)
            case requests.LowerAsk():
                await group.lower(group.find(asked.student))
            case requests.AdmitAsk():
                await group.admit(group.find(asked.student))
            case requests.ForgetAsk():
                # A teacher who closes the page at once wants the student forgotten, too.
                forgetting = group.forget(group.find(asked.student))
                await asyncio.shield(asyncio.ensure_future(forgetting))
            case requests.NewCodeAsk():
                await group.set_code()
            case requests.ShowAsk():
                value = await self._show(group.find(asked.student))
            case requests.ExportAsk():
                value = await self._export(asked.what)
            case requests.TournamentAsk():
                await group.tournament.play(
                    self._players(), asked.arena, asked.rounds, asked.seconds
                )
            case requests.StopPlayAsk():
                await group.tournament.stop()
        return value

    async def _hand_out(self, asked: requests.HandOutAsk) -> None:
        if asked.student is not None:
            student = self._class.find(asked.student)
            draft = _draft(student)
            await self._class.hand_out(
                asked.title, draft.table, draft.sequences, asked.group, student.name
            )
            return
        table = asked.table or (await asyncio.to_thread(self._class.sample)).table
        if table is None:
            raise UserError(say("class.no-sample"))
        await self._class.hand_out(asked.title, table, asked.sequences, asked.group)

    async def _show(self, student: ClassStudent) -> dict[str, Any]:
        """Let a student's robot walk with the student's newest table.

        Return the robot, the trial and the table, for the page to show.
        """
        draft = _draft(student)
        file = draft.robot or self._class.robot
        trial = TrialAsk(id=0, table=draft.table, robot=file, sequences=draft.sequences)
        robot = await self._studio.robot(RobotAsk(id=0, robot=file))
        _, payload = await self._studio.trial(trial)
        return {
            "name": student.name,
            "robot": robot,
            "trial": msgspec.Raw(payload),
            "table": draft.table,
            "sequences": draft.sequences,
        }

    async def _export(self, what: str) -> dict[str, Any]:
        if what == "evidence":
            kept = await self._class.evidence()
            return {"name": EVIDENCE, "data": await asyncio.to_thread(evidence_csv, kept)}
        files = await asyncio.to_thread(student_files, await self._class.documents())
        return {"name": TABLES, "data": await asyncio.to_thread(tables_zip, files)}

    def _players(self) -> dict[str, SeatFiles]:
        """Return the files of each group, and of each student who works alone, by name.

        Groups and students without a table are left out. Whoever has a table that was never
        complete is a player without a gait: the tournament says so.
        """
        students = [one for one in self._class.students.values() if one.table is one.own]
        drafts = {one.name: one.draft for one in students if one.draft is not None}
        bad = [one.name for one in students if one.draft is None and one.own.is_touched]
        for name, draft in self._class.groups.drafts().items():
            drafts[group_title(name, drafts)] = draft
        players = {name: SeatFiles(self._class.robot) for name in bad}
        for name, draft in drafts.items():
            try:
                files = draft.files()
            except (FileRefused, UserError):
                files = SeatFiles(draft.robot)  # it has no key to walk with: it is left out
            players[name] = files._replace(robot=files.robot or self._class.robot)
        return players


def _draft(student: ClassStudent) -> Draft:
    if student.draft is None:
        if student.table.is_touched:
            raise UserError(say("class.bad-table", name=student.name))
        raise UserError(say("class.no-table", name=student.name))
    return student.draft
