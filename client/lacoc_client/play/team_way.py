"""Finds at which court a team plays: asks a court with the team's token, again and again."""

import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

from msgspec.structs import replace

from lacoc_client.play.asking import NoCourt, NotNow, Patience, ask
from lacoc_client.play.spectator import Spectator
from lacoc_shared.contest.access import Access
from lacoc_shared.keyspace import EVERY_COURT, KeySpace
from lacoc_shared.messages.office import Where, Whereabouts
from lacoc_shared.network.session import NotConnected, Session, open_client
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, say

_SOON_S, _LATER_S = 0.5, 2.0
"""Time between two questions to the court [s]: the first while the team may be called at any
moment, the second otherwise."""
_LATER_FROM_S = 30
_GONE_S = 5.0
_OUT_S = 20.0
"""How long a team whose matches are all played still asks a court that does not answer [s]."""


def where(session: Session, court: str, token: str) -> Whereabouts:
    """Ask a court where the team with a token plays.

    Args:
        session: a connection to the court.
        court: the court's name.
        token: the team's token.

    Raises:
        NoCourt: if the court does not answer.
        NotNow: if the court does not know yet where the team plays.
        UserError: if no team has this token.
    """
    keys = KeySpace(court)
    return ask(session, keys, keys.where, Where(token=token), Whereabouts, repeatable=True)


class TeamWay:
    """Finds the seats where a team plays, from court to court; used as a context manager.

    Args:
        access: how to reach any court of the event, and the token.
        any_court: whether nobody named a court; then any court at the address is asked.
        patience: how long to wait for the first answer.
        tell: called with a sentence about what comes next for the team, whenever it changes.
        stopping: returns whether somebody asked the program to end.

    Raises:
        UserError: if there is no such court, or the token opens nothing.
    """

    def __init__(
        self,
        access: Access,
        *,
        any_court: bool,
        patience: Patience,
        tell: Callable[[Phrase], None],
        stopping: Callable[[], bool],
    ) -> None:
        self._access = access
        self._any_court = any_court
        self._tell = tell
        self._stopping = stopping
        self._said: Phrase | None = None
        self._news: Phrase | None = None
        self._past = ""
        """Id of the call whose match the team has already played; "": none."""
        self._session = patience.until(
            lambda: open_client(access.addresses, authority=access.authority)
        )
        try:
            self._court = self._court_there(access.court)
            self._newest = self._first(patience)
            self._heard_s = time.monotonic()
            self._tell_news()
        except BaseException:
            self._session.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._session.close()

    @property
    def team(self) -> str:
        """The team's name."""
        return self._newest.team

    def next(self) -> Whereabouts | None:
        """Wait until the team can take a seat, and return where; None: it will not be called again.

        Raises:
            UserError: if the token is not valid any more.
            KeyboardInterrupt: if the program is asked to end.
        """
        while True:
            there = self._newest
            if there.state == "over":
                self._say(there.said)
                return None
            if there.state == "out" and time.monotonic() - self._heard_s > _OUT_S:
                return None  # the event has closed without another word
            if there.open:
                return there
            if there.state == "court" and there.call != self._past:
                self._say(there.said)
                return there
            if there.state in ("waits", "out"):  # a decision may bring a team back
                self._say(there.said)
            self._rest(_LATER_S if (there.about_s or 0) > _LATER_FROM_S else _SOON_S)
            self._look()

    def played(self, call: str) -> None:
        """Note that the match of this call is over; `next` then waits for another call."""
        self._past = call
        self._look()

    def again(self) -> None:
        """Wait a moment, then ask the court again where the team plays."""
        self._rest(_SOON_S)
        self._look()

    def access(self, there: Whereabouts) -> Access:
        """Return address, seat and token with which the team takes its seat at a court."""
        own = self._access
        if there.address:
            own = Access(court=there.court, connect=there.address, authority=own.authority)
        return replace(own, court=there.court).of_seat(there.seat, self._access.token)

    def _first(self, patience: Patience) -> Whereabouts:
        """Ask the court where the team plays, until it answers for the first time.

        If the user gave no time to wait, wait as long as the contest's office still starts.
        """
        while True:
            try:
                return patience.until(self._ask)
            except NotNow as error:
                if patience.wait_s is not None:
                    raise
                self._say(error.phrase)
                self._rest(_SOON_S)

    def _ask(self) -> Whereabouts:
        try:
            return where(self._session, self._court, self._access.token)
        except NoCourt:
            # The connection may lead to another court of the event now; that one is asked next.
            self._court = self._court_there(self._court)
            raise

    def _court_there(self, court: str) -> str:
        """Return the court to ask: the given one; if that is gone and any will do, another one."""
        if not self._any_court:
            return court
        there = [key.split("/")[1] for key in self._session.present(EVERY_COURT)]
        return court if court in there else next(iter(there), court)

    def _look(self) -> None:
        try:
            self._newest = self._ask()
            self._heard_s = time.monotonic()
            self._tell_news()
        except (NotConnected, NoCourt, NotNow) as error:
            self.tell_trouble(error)

    def tell_trouble(self, error: NotConnected | NoCourt | NotNow) -> None:
        """Tell the team why it has to wait.

        If a court of a contest is away, its office starts it again, so the team need not do
        anything.
        """
        self._say(error.phrase if isinstance(error, NotNow) else say("team.court-away"))

    def _tell_news(self) -> None:
        news = self._newest.news
        if news is not None and news != self._news:
            self._tell(news)
        self._news = news

    def _say(self, what: Phrase) -> None:
        if what != self._said:
            self._said = what
            self._tell(what)

    def _rest(self, for_s: float) -> None:
        end_s = time.monotonic() + for_s
        while (left_s := end_s - time.monotonic()) > 0:
            if self._stopping():
                raise KeyboardInterrupt
            time.sleep(min(left_s, 0.1))


def call_is_over(view: Spectator, call: str) -> bool:
    """Return whether the match of a call is over: official, void, or another one has begun."""
    frame, sheet = view.frame, view.sheet
    if sheet.call != call:
        return True
    return frame is not None and frame.match == sheet.match and frame.phase >= Phase.OFFICIAL


def is_gone(view: Spectator) -> bool:
    """Return whether a court has been silent so long that the team asks again where it plays."""
    return view.silent_s(time.monotonic()) > _GONE_S
