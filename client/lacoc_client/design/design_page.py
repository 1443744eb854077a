"""One /design page's connection: the requests that it may make, and who answers them."""

import asyncio
import hmac
from contextlib import suppress
from typing import Any

import msgspec
from starlette.websockets import WebSocket

from lacoc_client.design import requests
from lacoc_client.design.designer import Designer
from lacoc_client.design.files import file_bytes, read_file
from lacoc_client.design.learning.learner import Learner
from lacoc_client.design.studio_desk import StudioDesk
from lacoc_client.gateway.answers import Answers
from lacoc_client.gateway.page_requests import GARBAGE, serve_requests
from lacoc_client.gateway.viewer import Viewer
from lacoc_client.phases.evidence import Moved, Named
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import TrialReply
from lacoc_shared.words import say

_ASKS_HZ, _ASKS_BURST = 50.0, 100


class DesignPage:
    """One page's connection.

    Args:
        websocket: the page's WebSocket, not accepted yet.
        designer: what all pages share.
    """

    def __init__(self, websocket: WebSocket, designer: Designer) -> None:
        self._websocket = websocket
        self._designer = designer
        self._viewer = Viewer(websocket.state.socket)
        self._answers = Answers(self._viewer, lambda *_: None)
        self._studio = StudioDesk(designer.asker, self._viewer.send_if_fast)
        self._learner = Learner(designer.diary, self._sample_trial)
        self._comparing: set[asyncio.Task[None]] = set()

    async def serve(self) -> None:
        """Answer the page until it goes."""
        try:
            await serve_requests(
                self._websocket, self._answers, requests.read, self._take, _ASKS_HZ, _ASKS_BURST
            )
        finally:
            self._designer.remove(self._viewer)
            self._answers.stop()
            for task in self._comparing:
                task.cancel()
            with suppress(UserError):
                await asyncio.shield(self._studio.gone())

    async def _take(self, asked: requests.Asked) -> bool:
        """Answer a request of a page that has shown the page key; close any other page."""
        if not self._is_greeted(asked):
            self._answers.refuse(asked.id, UserError(say("design.wrong-key")))
            await self._websocket.close(GARBAGE, "no page key")
            return False
        self._answer(asked)
        return True

    def _is_greeted(self, asked: requests.Asked) -> bool:
        """Return whether the page has shown the page key, now or before."""
        if isinstance(asked, requests.Hello):
            key = asked.key.encode("utf-8", "surrogatepass")
            self._viewer.can_act = hmac.compare_digest(key, self._designer.key.encode())
        return self._viewer.can_act

    def _answer(self, asked: requests.Asked) -> None:
        answers = self._answers
        match asked:
            case requests.Hello():
                answers.reply(asked.id, {"robot": self._designer.robot})
                self._designer.add(self._viewer)
            case requests.Ping():
                answers.reply(asked.id, {"t": asked.t})
            case requests.RobotAsk():
                answers.later(asked.id, self._studio.robot(asked))
            case requests.TrialAsk():
                answers.later(asked.id, self._trial(asked))
            case requests.CoachAsk():
                answers.later(asked.id, self._studio.coach(asked))
            case requests.CancelAsk():
                answers.later(asked.id, self._studio.cancel(asked.job))
            case (
                requests.EditAsk()
                | requests.CheckAsk()
                | requests.PhaseAsk()
                | requests.NameAsk()
                | requests.VoteAsk()
            ):
                answers.later(asked.id, self._learn(asked))
            case _:
                answers.later(asked.id, asyncio.to_thread(self._with_files, asked))

    async def _trial(self, asked: requests.TrialAsk) -> msgspec.Raw:
        """Let the robot walk, and keep what it shows as evidence."""
        reply, payload = await self._studio.trial(asked)
        await self._learner.tried(asked, reply)
        self._designer.tell_phases()
        task = asyncio.get_running_loop().create_task(self._compare(asked))
        self._comparing.add(task)
        task.add_done_callback(self._comparing.discard)
        return msgspec.Raw(payload)

    async def _compare(self, asked: requests.TrialAsk) -> None:
        await self._learner.compared(asked)
        self._designer.tell_phases()

    async def _sample_trial(self, asked: requests.TrialAsk) -> TrialReply | None:
        """Let the sample gait walk as a trial did; None if it does not fit the trial's robot."""
        table = (await asyncio.to_thread(self._designer.sample)).table
        if table is None or asked.table is None or table.legs != asked.table.legs:
            return None
        sample = msgspec.structs.replace(asked, table=table, sequences=None, guesses=())
        return (await self._studio.trial(sample))[0]

    async def _learn(self, asked: requests.Asked) -> Any:
        """Answer a request about the phases."""
        diary = self._designer.diary
        value: Any = {}
        match asked:
            case requests.EditAsk():
                value = await self._learner.edited(asked)
            case requests.CheckAsk():
                value = await self._learner.checked(asked)
            case requests.PhaseAsk():
                await diary.add(Moved(phase=asked.number))
            case requests.NameAsk():
                await diary.add(Named(word=asked.word))
            case requests.VoteAsk():
                await diary.vote(diary.phases.word, asked.choice)
        self._designer.tell_phases()
        return value

    def _with_files(self, asked: requests.Asked) -> Any:
        """Answer a request about files; runs on another thread."""
        folder = self._designer.folder
        match asked:
            case requests.ReadAsk():
                return folder.read(asked.name)
            case requests.SampleAsk():
                return self._designer.sample()
            case requests.ParseAsk():
                return _parsed(asked)
            case requests.SaveAsk():
                content = asked.robot if asked.table is None else asked.table
                if content is None:
                    raise UserError(say("design.nothing-to-save"))
                return folder.save(asked.name, content, asked.version, asked.force)
            case requests.WriteAsk():
                return {"data": file_bytes(asked.name, asked.table)}
        raise AssertionError(asked)


def _parsed(asked: requests.ParseAsk) -> Any:
    data = asked.data.encode() if isinstance(asked.data, str) else asked.data
    if not isinstance(data, bytes):
        raise UserError(say("gateway.bad-message", error=type(data).__name__))
    return read_file(asked.name, data)
