"""Sends a page's requests to a studio: with tables as files, and unique names of searches."""

import asyncio
import secrets
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.answers import in_loop
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.files import sent_gait
from lacoc_client.workshop.design.studios.asker import Asker
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_client.workshop.design.table import FileTable
from lacoc_shared.messages import PROTOCOL, Done, SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import (
    CancelRequest,
    CoachReply,
    CoachRequest,
    GaitFiles,
    MapReply,
    MapRequest,
    Progress,
    RobotReply,
    RobotRequest,
    TrialReply,
    TrialRequest,
    VariantsReply,
    VariantsRequest,
)

_ROBOT_S = 20.0
_TRIAL_S = 120.0
_CANCEL_S = 5.0
_COACH_MOST_S = 3600.0
_COACH_MORE_S = 300.0
"""A reply may come this much later than the search time [s]: the search may have to wait for
others, and after it the coach undoes changes that hardly help."""


class StudioDesk:
    """Sends the requests of one page to the studios.

    Args:
        studios: the connections to the studios.
        send: sends a message to the page; drops it if the page reads too slowly.
    """

    def __init__(self, studios: Studios, send: Callable[[bytes], None]) -> None:
        self._studios = studios
        self._send = send
        self._page = secrets.token_hex(4)
        self._trying = asyncio.Lock()
        self._jobs: dict[str, Asker] = {}
        """Name of each search that runs -> the connection to the studio that runs it."""

    async def robot(self, asked: requests.RobotAsk) -> msgspec.Raw:
        """Ask the studio what a robot file describes.

        All methods of this class raise the errors of `Asker.ask`.
        """
        request = RobotRequest(protocol=PROTOCOL, robot=asked.robot)
        asker = self._studios.free()
        return msgspec.Raw((await asker.ask("robot", request, RobotReply, _ROBOT_S))[1])

    async def trial(self, asked: requests.TrialAsk) -> tuple[TrialReply, bytes]:
        """Let the robot walk; while a trial of this page runs, its next trial waits.

        Returns:
            The answer, and its bytes.
        """
        request = TrialRequest(
            protocol=PROTOCOL,
            files=_files(asked.table, asked.robot, asked.sequences),
            keys=asked.keys,
            seconds=asked.seconds,
        )
        async with self._trying:
            return await self._studios.free().ask("trial", request, TrialReply, _TRIAL_S)

    async def coach(self, asked: requests.CoachAsk) -> msgspec.Raw:
        """Let a studio search for better numbers of a gait, and report to the page."""
        request = CoachRequest(
            protocol=PROTOCOL,
            job=self._job(asked.job),
            files=_files(asked.table, asked.robot, asked.sequences),
            key=asked.key,
            goal=asked.goal,
            size=asked.size,
            seconds=asked.seconds,
            seed=asked.seed,
        )
        return await self._search("coach", asked.job, request, CoachReply, asked.seconds)

    async def map(self, asked: requests.MapAsk) -> msgspec.Raw:
        """Let a studio search for gaits of many speeds and arousals; report to the page."""
        request = MapRequest(
            protocol=PROTOCOL,
            job=self._job(asked.job),
            files=_files(asked.table, asked.robot, asked.sequences),
            key=asked.key,
            seconds=asked.seconds,
            seed=asked.seed,
        )
        return await self._search("map", asked.job, request, MapReply, asked.seconds)

    async def variants(self, asked: requests.VariantsAsk) -> msgspec.Raw:
        """Let a studio search for six gaits that look different; report to the page."""
        request = VariantsRequest(
            protocol=PROTOCOL,
            job=self._job(asked.job),
            files=_files(asked.table, asked.robot, asked.sequences),
            key=asked.key,
            keep=asked.keep,
            before=asked.before,
            round=asked.round,
            seed=asked.seed,
        )
        return await self._search("variants", asked.job, request, VariantsReply, 0.0)

    async def _search(
        self,
        what: str,
        name: str,
        request: CoachRequest | MapRequest | VariantsRequest,
        reply: type[CoachReply | MapReply | VariantsReply],
        seconds: float,
    ) -> msgspec.Raw:
        """Let a studio search, and tell the page how far the search is.

        Args:
            what: name of the request.
            name: the page's own name of the search.
            request: the request.
            reply: type of the answer.
            seconds: how long the page asks to search [s].
        """
        job, loop = request.job, asyncio.get_running_loop()

        def tell(progress: Progress) -> None:
            body = {"job": name, **msgspec.structs.asdict(progress)}
            in_loop(loop, lambda: self._send(wire.map_message(MessageKind.PROGRESS, body)))

        asker = self._studios.free()
        listening = await asker.progress(job, tell)
        self._jobs[job] = asker
        try:
            # The studio itself refuses a time that is too long or not a number; wait for that.
            search_s = seconds if 0 <= seconds <= _COACH_MOST_S else 0.0
            timeout_s = search_s + _COACH_MORE_S
            return msgspec.Raw((await asker.ask(what, request, reply, timeout_s))[1])
        except asyncio.CancelledError:  # the page has gone, so nobody waits for the search
            with suppress(UserError):
                await self._cancel(job)
            raise
        finally:
            self._jobs.pop(job, None)
            await asyncio.shield(asyncio.to_thread(listening.close))

    async def cancel(self, job: str) -> dict[str, Any]:
        """End a search of this page early, and return an empty reply.

        The request that began the search is then answered with the best result so far; if the
        search still waits for others to end, the request is refused.
        """
        await self._cancel(self._job(job))
        return {}

    async def _cancel(self, job: str) -> None:
        request = CancelRequest(protocol=PROTOCOL, job=job)
        asker = self._jobs.get(job) or self._studios.free()
        await asker.ask("cancel", request, Done, _CANCEL_S)

    def _job(self, name: str) -> str:
        """Return a name for a search, unique among all pages: the page's id, then `name`."""
        return f"{self._page}-{name}"


def _files(
    table: FileTable | None, robot: SentFile | None, sequences: tuple[tuple[int, ...], ...] | None
) -> GaitFiles:
    """Turn a page's table into the files of a request.

    Raises:
        FileRefused: with every mistake of the table.
        UserError: if a locomotion table has no row of a key below its highest key.
    """
    if table is None:
        return GaitFiles(robot=robot, sequences=sequences)
    sent = sent_gait(table)
    if table.kind == "postures":
        return GaitFiles(robot=robot, postures=sent, sequences=sequences)
    return GaitFiles(robot=robot, locomotion=sent)
