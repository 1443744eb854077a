"""The seat that one page holds."""

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any

from lacoc_client.play.asking import NotNow
from lacoc_client.play.controller import Controller, SeenFrame
from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.answers import TOO_MUCH, Answers, in_future, in_loop
from lacoc_client.web.gateway.home import Prefill
from lacoc_client.web.gateway.seat_thread import Answer, SeatThread
from lacoc_client.web.gateway.threads import Threads
from lacoc_client.web.gateway.viewer import MOST_HZ, Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_robots.seat_files import SeatFiles, to_send
from lacoc_shared.contest.access import Access
from lacoc_shared.messages import TryOutReply
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render, say


class PageSeat:
    """Joins a seat for a page, steers its robot, and tells the page the seat's state.

    Used from the event loop only.

    Args:
        viewer: the page.
        answers: answers the page's requests.
        prefill: what was given on the command line; the page need not send it.
        log: logs a line about the page: a sentence, its kind and particulars.
    """

    def __init__(
        self,
        viewer: Viewer,
        answers: Answers,
        prefill: Prefill | None,
        log: Callable[..., None],
    ) -> None:
        self._viewer = viewer
        self._answers = answers
        self._prefill = prefill
        self._log = log
        self._thread: SeatThread | None = None
        self._joins = 0
        self._trying = asyncio.Lock()
        self.brings = True
        """Whether a join must bring files; False for a contest's team, whose files the office has
        already."""
        self._hold = ("", "")
        """Id of the seat, and whether the page held it (`Hold`), as they were logged last."""

    def join(self, asked: wire.JoinAsk, watching: Access, joined: Answer) -> None:
        """Take a seat, in place of the page's earlier seat if it had one.

        Args:
            asked: the page's request.
            watching: how to reach the court, as a spectator.
            joined: called with the result of the join, on another thread.

        Raises:
            UserError: if there is no token.
        """
        access, name, files = self._entry(asked, watching)
        prefill = self._prefill if self._viewer.is_own else None
        own = prefill.files if prefill is not None else None
        self._end()
        loop, viewer, joins = asyncio.get_running_loop(), self._viewer, self._joins
        viewer.watch_closely()
        viewer.at_least(MOST_HZ)

        def tell(seat: dict[str, Any]) -> None:
            in_loop(loop, lambda: self._tell(seat, joins))

        if own is not None:
            viewer.send(wire.files_message(own, used=own.version))
        self._thread = SeatThread(
            access,
            name,
            lambda notes: to_send(files, asked.sequences, notes),
            viewer.unheard_s,
            tell,
            joined,
        )

    def steer(self, asked: wire.ReadyAsk | wire.LeaveAsk | wire.KeyAsk | wire.SawAsk) -> None:
        """Pass a request of the page on to the controller of its seat.

        Raises:
            UserError: if the page has no seat.
        """
        if self._thread is None:
            raise UserError(say("gateway.no-seat"))
        do, answer = self._thread.do, self._answers.from_thread(asked.id)
        match asked:
            case wire.ReadyAsk(ready=ready):
                do(lambda controller: {"said": controller.ready(ready)}, answer)
            case wire.LeaveAsk():
                do(lambda controller: {"said": controller.leave()}, answer)
            case wire.KeyAsk(level=level, key=key, match=number, beat=beat):
                seen = SeenFrame(number, beat)
                do(lambda controller: {"seq": controller.press(level, key, seen)}, answer)
            case wire.SawAsk(match=number, beat=beat):
                do(lambda controller: _saw(controller, SeenFrame(number, beat)), answer)

    async def try_out(self, asked: wire.TryAsk, threads: Threads) -> TryOutReply:
        """Ask the court how the seat's robot would walk alone.

        Wait for the answer on one of `threads`, so that the seat's own thread can go on.

        Raises:
            NotNow: if the page still waits for the answer to such a question.
            UserError: if the page has no seat, or the court refuses or does not answer.
        """
        if self._thread is None:
            raise UserError(say("gateway.no-seat"))
        # One at a time, so that a page that asks without waiting keeps few others waiting.
        if self._trying.locked():
            raise NotNow(TOO_MUCH)
        async with self._trying:
            sealed = asyncio.get_running_loop().create_future()
            self._thread.do(
                lambda controller: controller.try_out(
                    asked.keys, asked.first, asked.until, asked.drawn
                ),
                partial(in_future, sealed),
            )
            ask: Callable[[], TryOutReply] = await sealed
            return await threads.run(ask)

    def leave(self) -> None:
        """Stop steering: the page has gone, or watches another court; the team keeps the seat."""
        self._end()
        if self._hold[0]:
            self._log(f"The page of seat {self._hold[0]} has gone.", "seat", seat=self._hold[0])
        self._hold = ("", "")

    def _end(self) -> None:
        if self._thread is not None:
            self._thread.end()
            self._thread = None
        self._joins += 1

    def _entry(self, asked: wire.JoinAsk, watching: Access) -> tuple[Access, str, SeatFiles]:
        """Return how to reach the seat, the team's name, and the robot and gait files.

        What the page left out was given on the command line (`Prefill`).
        """
        token, name = asked.token, asked.name
        files = SeatFiles(asked.robot, asked.postures, asked.locomotion)
        prefill = self._prefill if self._viewer.is_own else None
        if prefill is not None and (not token or not prefill.token):
            own, theirs = files, SeatFiles()
            if prefill.files is not None and self.brings:
                theirs = prefill.files.files
            if own.postures is None and own.locomotion is None:
                files = SeatFiles(own.robot or theirs.robot, theirs.postures, theirs.locomotion)
            token, name = token or prefill.token, name or prefill.name
        if not token:
            raise UserError(say("gateway.no-token"))
        return (
            watching.of_seat(asked.seat, token),
            name or render(say("page.team", seat=asked.seat)),
            files,
        )

    def _tell(self, seat: dict[str, Any], joins: int) -> None:
        if joins != self._joins:
            return  # an older seat of this page
        self._viewer.send(wire.map_message(MessageKind.SEAT, seat))
        hold = (seat["seat"], seat["hold"])
        if hold != self._hold:
            self._hold = hold
            because = f" ({render(seat['reason'])})" if seat["reason"] else ""
            self._log(f"Seat {hold[0]}: {hold[1]}{because}.", "seat", seat=hold[0], hold=hold[1])


def _saw(controller: Controller, frame: SeenFrame) -> dict[str, Any]:
    controller.saw(frame)
    return {}
