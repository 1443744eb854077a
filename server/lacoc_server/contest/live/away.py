"""Courts on other machines: the office keeps a copy of their records, and can stand in for them.

While a court plays elsewhere, its record is copied here. If the court is not heard for some
seconds while it has a game, its machine may be gone: the office opens the court here, and the game
goes on from the copy. From then on the court stays here, also when the office is started again. If
its machine comes back, the court there is told to end, so that there is one court of this name.
"""

import time
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import AbstractContextManager, ExitStack
from typing import Generic, Self, TypeVar

from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.stand_ins import stand_in, stand_ins
from lacoc_server.contest.league.facts import Played
from lacoc_server.contest.league.timetable.calling import is_open_call
from lacoc_server.contest.live import venue
from lacoc_server.contest.live.court_link import CourtLink
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.live.record_copy import RecordCopy
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import is_open
from lacoc_shared.network.session import NotConnected, Session, open_client
from lacoc_shared.words import Phrase, say

T = TypeVar("T")

_GONE_S = 10.0
"""If a court was not heard for this long [s], the office opens it on its own machine. The court's
machine may restart it sooner."""
_CONNECT_S = 0.2
"""Time between two attempts to connect [s]."""
_AGAIN_S = 2.0
"""Time between two attempts to open a court here, or to end it on the other machine [s]."""


class RetryPause:
    """A timer that says when the next attempt to do something is due.

    Args:
        length_s: shortest time between two attempts [s].
    """

    def __init__(self, length_s: float) -> None:
        self._length_s = length_s
        self._next_s = 0.0

    def over(self) -> bool:
        """Return whether the next attempt is due; if so, begin the pause after it."""
        now_s = time.monotonic()
        if now_s < self._next_s:
            return False
        self._next_s = now_s + self._length_s
        return True


class Attempts(Generic[T]):
    """Calls a function on another thread, and calls it again if it gives no result.

    An attempt begins only when somebody calls `take`. A `take` after a result begins anew.

    Args:
        do: returns the result, or None if it has to be tried again.
        pause_s: time between the beginnings of two attempts [s].
        aside: runs `do` on another thread.
    """

    def __init__(self, do: Callable[[], T | None], pause_s: float, aside: Executor) -> None:
        self._do = do
        self._pause = RetryPause(pause_s)
        self._aside = aside
        self._running: Future[T | None] | None = None
        self.has_failed = False
        """Whether an attempt has given no result."""

    def take(self) -> T | None:
        """Return the result, or None if there is none yet; begin an attempt if it is time."""
        if self._running is None:
            if self._pause.over():
                self._running = self._aside.submit(self._do)
            return None
        if not self._running.done():
            return None
        ended, self._running = self._running, None
        result = ended.result()
        self.has_failed |= result is None
        return result


class AwayCourt:
    """A court of another machine, as the office sees it; used as a context manager.

    Args:
        where: the contest.
        name: the court's name.
        link_to: makes the office's connection to a court, from a session and the court's name.
        open_here: returns a context manager that runs the court on this machine, and gives its
            address.
        tell: called with a phrase for people: the court goes on at the office's machine, or can't
            be opened there.
    """

    def __init__(
        self,
        where: ContestFolder,
        name: str,
        link_to: Callable[[Session, str], CourtLink],
        open_here: Callable[[str], AbstractContextManager[str]],
        tell: Callable[[Phrase], None],
    ) -> None:
        self.name = name
        self._where = where
        self._entry = where.contest.courts[name]
        self._authority = where.contest.public.read_authority()
        self._link_to = link_to
        self._open_here = open_here
        self._tell = tell
        self._copy = RecordCopy(where.records, name)
        self._there: CourtLink | None = None
        """The connection to the court on the other machine; None: there was none yet."""
        self._heard_s = time.monotonic()
        self._is_here = name in stand_ins(where.stand_ins)
        self._is_open_here = False
        self._may_close = RetryPause(_AGAIN_S)
        self._aside = aside = ThreadPoolExecutor(2, f"court {name}")
        self._connects = Attempts(self._connected, _CONNECT_S, aside)
        self._opens = Attempts(self._open, _AGAIN_S, aside)
        self._opened = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._aside.shutdown(cancel_futures=True)
        self._opened.close()

    @property
    def is_copied(self) -> bool:
        """Whether nothing is left to copy, as far as the office knows, or the court runs here."""
        return self._is_here or self._copy.is_whole

    def step(self, office: Office, *, closing: bool = False) -> None:
        """Look at the court once, without waiting.

        Copy its record; if the court is gone with a game, open it on the office's machine.

        Args:
            office: the office.
            closing: whether the contest is over, and the court must close its last match so that it
                can be copied.

        Raises:
            UserError: if a part of a record can't be written.
        """
        if self._there is None:
            self._connect(office)
        if self._is_here:
            if not self._is_open_here:
                self._go_on_here(office)
            self._end_elsewhere()
            return
        if self._there is not None and self._there.is_there:
            self._heard_s = time.monotonic()
            self._look(self._there, closing)
        if self._there is not None:
            self._copy.step(self._there)
        is_gone = time.monotonic() - self._heard_s > _GONE_S
        if is_gone and any(call.court == self.name for call in office.contest.running):
            stand_in(self._where.stand_ins, self.name)
            self._is_here = True
            self._tell(say("away.goes-on-here", court=self.name, at=self._entry.elsewhere))

    def _connect(self, office: Office) -> None:
        """Begin to connect to the court's own machine if a try is due; use what a try has opened.

        This never waits; `step` calls it again and again.
        """
        link = self._connects.take()
        if link is None:
            return
        self._there = link
        if not self._is_here:
            for record in (fact.record for fact in office.facts if isinstance(fact, Played)):
                self._copy.want(record.removesuffix(".mcap"))
            office.connect(self.name, link, self._entry.elsewhere)

    def _connected(self) -> CourtLink | None:
        """Return a connection to the court on its own machine; None: the court does not answer."""
        if not is_open(self._entry.elsewhere):
            return None
        try:
            session = self._opened.enter_context(
                open_client([self._entry.elsewhere], authority=self._authority)
            )
        except NotConnected:  # it has gone again
            return None
        return self._link_to(session, self.name)

    def _look(self, link: CourtLink, closing: bool) -> None:
        """Have the record of the court's newest match copied.

        If `closing`, have that match closed.
        """
        sheet = link.sheet
        if sheet is None or not sheet.call:
            return
        self._copy.want(sheet.match_id)
        if closing and not is_open_call(sheet.call) and self._may_close.over():
            link.withdraw(sheet.call, official=True)

    def _go_on_here(self, office: Office) -> None:
        """Open the court on this machine; if that fails, try again.

        A court that could not be opened counts as silent, so another court can have its game.
        """
        if not self._opens.has_failed:
            office.expect(self.name)
        opened = self._opens.take()
        if opened is None:
            return
        address, link = opened
        self._is_open_here = True
        office.connect(self.name, link, venue.told_address(self._where.contest, self.name, address))

    def _open(self) -> tuple[str, CourtLink] | None:
        """Open the court on this machine.

        Return its address and a connection, or None if it fails.
        """
        try:
            with ExitStack() as stack:
                address = stack.enter_context(self._open_here(self.name))
                session = stack.enter_context(open_client([address], authority=self._authority))
                self._opened.push(stack.pop_all())
        except UserError as error:
            self._tell(say("away.can-not-open", court=self.name, why=error.phrase))
            return None
        return address, self._link_to(session, self.name)

    def _end_elsewhere(self) -> None:
        """If the court on the other machine comes back, tell it to end: it runs on this one now."""
        if self._there is None:
            return
        self._there.poll()
        if self._there.is_there and self._may_close.over():
            self._there.retire()
