"""Holds a seat for a page: a thread sends the court the commands of the page's player.

The thread passes on at once what the page sends: keys and signs of life, each with the frame that
the page showed. In between it repeats the newest command with the newest of these frames. So the
seat of a page that stutters does not become silent, and the delay of the page's link is measured
only with frames that the page has shown. The thread ends when the page goes. Then the robot stands
after a second (rules 3), and a page that comes back joins again.
"""

import queue
import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple

from lacoc_client.play.controller import REPEAT_S, Controller, Hold
from lacoc_client.web.gateway.wire import FAULT
from lacoc_robots.seat_files import SeatFiles
from lacoc_shared.contest.access import Access
from lacoc_shared.mistakes import FILES_REFUSED, FileRefused, UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.words import Phrase, say

LOST_AFTER_S = 1.0
"""A page that has sent nothing for this long counts as gone, even if its connection is still open
[s]."""

Answer = Callable[[Any, UserError | FileRefused | None], None]
"""Called with the result of a job: its value, or the error."""


_OF_FILES = (FILES_REFUSED, "mistake.line")
"""Codes of a court's notes about mistakes in files."""


class _SeatJob(NamedTuple):
    do: Callable[[Controller], Any]
    answer: Answer


class SeatThread:
    """Joins a seat and holds it until the page has gone.

    Args:
        access: address, seat and token.
        team: the team's name.
        files: returns the team's files, as a court reads them, and their mistakes; adds notes to
            the list that it is given. It is called on the thread, because workbooks take a while.
        unheard_s: returns how long the page has been silent [s].
        tell: receives the state of the seat (see docs/gateway.md, "seat"), on the thread.
        joined: receives the result of the join, on the thread.
    """

    def __init__(
        self,
        access: Access,
        team: str,
        files: Callable[[list[Phrase]], tuple[SeatFiles, FileRefused | None]],
        unheard_s: Callable[[], float],
        tell: Callable[[dict[str, Any]], None],
        joined: Answer,
    ) -> None:
        self._access = access
        self._team = team
        self._files = files
        self._unheard_s = unheard_s
        self._tell = tell
        self._jobs: queue.SimpleQueue[_SeatJob | None] = queue.SimpleQueue()
        self._ended = False
        self._told: dict[str, Any] = {}
        self._thread = threading.Thread(
            target=self._run, args=(joined,), name=f"seat {access.seat}", daemon=True
        )
        self._thread.start()

    def do(self, job: Callable[[Controller], Any], answer: Answer) -> None:
        """Let this thread do a job with the seat's controller.

        Jobs are done one after another, as soon as possible.
        """
        self._jobs.put(_SeatJob(job, answer))
        if not self._thread.is_alive():
            self._refuse_rest()

    def end(self) -> None:
        """Stop sending commands now; the team does not give up the seat."""
        self._ended = True
        self._jobs.put(None)

    def join(self, timeout_s: float) -> None:
        """Wait until the thread has ended."""
        self._thread.join(timeout_s)

    def _run(self, joined: Answer) -> None:
        access = self._access
        try:
            noted: list[Phrase] = []
            files, wrong = self._files(noted)
            with open_client(access.addresses, authority=access.authority) as session:
                controller = Controller(
                    session,
                    access.court,
                    access.seat,
                    access.token,
                    self._team,
                    **files._asdict(),
                    notify=lambda: self._jobs.put(None),
                    elsewhere=True,
                )
                if self._ended:  # the page has gone: it must not take the seat from another one
                    raise UserError(say("gateway.no-seat"))
                notes = _join(controller, wrong)
                joined({"notes": (*noted, *notes), "index": controller.index}, None)
                self._report(controller)
                self._hold(controller)
        except Exception as error:
            told = error if isinstance(error, UserError | FileRefused) else UserError(FAULT)
            if not self._told:
                joined(None, told)
            else:
                reason = say("hold.files-refused") if isinstance(told, FileRefused) else told.phrase
                self._tell(self._told | {"hold": Hold.REFUSED.value, "reason": reason})
            if told is not error:  # a bug, but the page must get an answer
                raise
        finally:
            self._refuse_rest()

    def _hold(self, controller: Controller) -> None:
        while not self._ended and controller.hold in (Hold.HELD, Hold.LOST):
            try:
                job = self._jobs.get(timeout=REPEAT_S / 2)
            except queue.Empty:
                job = None
            if job is not None:
                self._try(controller, job)
            controller.repeating = self._unheard_s() < LOST_AFTER_S
            controller.poll(time.monotonic())
            self._report(controller)

    def _try(self, controller: Controller, job: _SeatJob) -> None:
        try:
            value = job.do(controller)
        except (UserError, FileRefused) as error:
            job.answer(None, error)
        else:
            job.answer(value, None)

    def _report(self, controller: Controller) -> None:
        """Tell the page the state of its seat, if the state has changed."""
        told: dict[str, Any] = {
            "seat": controller.seat,
            "index": controller.index,
            "hold": controller.hold.value,
            "reason": controller.reason,
            "session": controller.session,
        }
        if told != self._told:
            self._told = told
            self._tell(told)

    def _refuse_rest(self) -> None:
        while True:
            try:
                job = self._jobs.get_nowait()
            except queue.Empty:
                return
            if job is not None:
                hold = Hold(self._told.get("hold", Hold.NOT_JOINED.value))
                why = self._told.get("reason") or hold.phrase
                said = say("refused.not-yours", seat=self._access.seat, why=why)
                job.answer(None, UserError(said))


def _join(controller: Controller, wrong: FileRefused | None) -> tuple[Phrase, ...]:
    """Join the seat, and return the court's notes for the contestant.

    Args:
        controller: the seat's controller.
        wrong: mistakes that this gateway found in the files; None: it found none.

    Raises:
        FileRefused: if the court needs the files now and they have mistakes.
        UserError: if the court refuses for another reason, or does not answer.
    """
    try:
        notes = controller.join()
    except FileRefused as refused:
        raise wrong or refused from None
    if wrong is None:
        return notes
    return (*wrong.notes(), *(note for note in notes if note.code not in _OF_FILES))
