"""Who acts as referee at a court through this gateway: one page, the others watch."""

from lacoc_client.gateway import wire
from lacoc_client.gateway.viewer import Viewer
from lacoc_client.gateway.wire import Kind
from lacoc_client.referee import RefereeClient
from lacoc_shared.mistakes import UserError


class Referees:
    """The pages that have entered with a referee's token; used from the event loop only."""

    def __init__(self) -> None:
        self._entered: dict[Viewer, tuple[RefereeClient, str]] = {}
        self._acting: Viewer | None = None

    def enter(self, viewer: Viewer, client: RefereeClient, by: str) -> None:
        """A page has shown a token; it acts if nobody does."""
        self._entered[viewer] = (client, by)
        self._act(self._acting or viewer)

    def take_over(self, viewer: Viewer) -> None:
        """Let this page act.

        Raises:
            UserError: if it has not entered.
        """
        if viewer not in self._entered:
            raise UserError("Enter with the referee's token first.")
        self._act(viewer)

    def acting(self, viewer: Viewer) -> tuple[RefereeClient, str]:
        """What a page decides with, and in whose name.

        Raises:
            UserError: if it does not act.
        """
        if viewer not in self._entered:
            raise UserError("Enter with the referee's token first.")
        if viewer is not self._acting:
            acting = "Nobody" if self._acting is None else self._entered[self._acting][1]
            raise UserError(f"{acting} acts as referee now: take over first.")
        return self._entered[viewer]

    def leave(self, viewer: Viewer) -> None:
        """A page has gone."""
        if self._entered.pop(viewer, None) is None:
            return
        self._act(None if viewer is self._acting else self._acting)

    def state(self, viewer: Viewer) -> bytes:
        """What a page is told."""
        acting = None if self._acting is None else self._entered[self._acting][1]
        body = {"acting": acting, "mine": viewer is self._acting}
        return wire.map_message(Kind.REFEREE, body)

    def _act(self, viewer: Viewer | None) -> None:
        self._acting = viewer
        for one in self._entered:
            one.send(self.state(one))
