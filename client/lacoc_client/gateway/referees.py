"""The referees of a court at this gateway: one page acts, the others watch."""

from collections.abc import Callable
from typing import TypeVar

from lacoc_client.gateway import wire
from lacoc_client.gateway.viewer import Viewer
from lacoc_client.gateway.wire import Kind
from lacoc_client.referee import RefereeClient
from lacoc_shared.contest.access import Access
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.words import say

T = TypeVar("T")


def as_referee(access: Access, do: Callable[[RefereeClient], T]) -> T:
    """Call a function with a referee's own connection to a court.

    The connection exists for this call only. Decisions are rare, and so a gateway never keeps a
    connection that can decide.

    Raises:
        UserError: if the court refuses, or does not let the referee in.
    """
    with open_client(access.addresses, authority=access.authority) as session:
        return do(RefereeClient(session, access.court, access.token))


class Referees:
    """The pages that have entered with a referee's token; used from the event loop only."""

    def __init__(self) -> None:
        self._entered: dict[Viewer, tuple[Access, str]] = {}
        self._acting: Viewer | None = None
        self._taken: set[Access] = set()

    def knows(self, access: Access) -> bool:
        """Return whether the court has accepted this token before."""
        return access in self._taken

    def enter(self, viewer: Viewer, access: Access, by: str) -> None:
        """Add a page that has entered with a token; it acts if no other page does."""
        self._entered[viewer] = (access, by)
        self._taken.add(access)
        self._act(self._acting or viewer)

    def take_over(self, viewer: Viewer) -> None:
        """Let a page act in place of another.

        Raises:
            UserError: if the page has not entered.
        """
        if viewer not in self._entered:
            raise UserError(say("gateway.enter-first"))
        self._act(viewer)

    def acting(self, viewer: Viewer) -> tuple[Access, str]:
        """Return the access and the name with which a page decides.

        Raises:
            UserError: if the page does not act.
        """
        if viewer not in self._entered:
            raise UserError(say("gateway.enter-first"))
        if viewer is not self._acting:
            if self._acting is None:
                raise UserError(say("gateway.nobody-referees"))
            raise UserError(say("gateway.other-referee", name=self._entered[self._acting][1]))
        return self._entered[viewer]

    def leave(self, viewer: Viewer) -> None:
        """Remove a page; if it acted, nobody acts."""
        if self._entered.pop(viewer, None) is None:
            return
        self._act(None if viewer is self._acting else self._acting)

    def state(self, viewer: Viewer) -> bytes:
        """Return the message that tells a page who acts."""
        acting = None if self._acting is None else self._entered[self._acting][1]
        body = {"acting": acting, "mine": viewer is self._acting}
        return wire.map_message(Kind.REFEREE, body)

    def _act(self, viewer: Viewer | None) -> None:
        self._acting = viewer
        for one in self._entered:
            one.send(self.state(one))
