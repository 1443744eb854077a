"""The pages at this gateway that referees of a court have open: one of them may decide."""

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class Referees:
    """The pages that have shown a court's referee token. One of them may decide: the acting page.

    Used from the event loop only. At times no page is the acting page; then none may decide.
    """

    def __init__(self) -> None:
        self._entered: dict[Viewer, tuple[str, str]] = {}
        self._acting: Viewer | None = None

    def enter(self, viewer: Viewer, token: str, by: str, acts: bool) -> None:
        """Add a page that has shown a referee's token.

        Args:
            viewer: the page.
            token: a referee's token of the court.
            by: the referee's name.
            acts: whether it becomes the acting page if none is. A page that only watched before its
                connection broke leaves that to the page that acted.
        """
        self._entered[viewer] = (token, by)
        self._act(self._acting or (viewer if acts else None))

    def take_over(self, viewer: Viewer) -> None:
        """Make a page the acting page, in place of the present one.

        Raises:
            UserError: if the page has not shown a referee's token.
        """
        if viewer not in self._entered:
            raise UserError(say("gateway.enter-first"))
        self._act(viewer)

    def acting(self, viewer: Viewer) -> tuple[str, str]:
        """Return the token and the referee's name with which the acting page decides.

        Raises:
            UserError: if this page is not the acting page.
        """
        if viewer not in self._entered:
            raise UserError(say("gateway.enter-first"))
        if viewer is not self._acting:
            if self._acting is None:
                raise UserError(say("gateway.nobody-referees"))
            raise UserError(say("gateway.other-referee", name=self._entered[self._acting][1]))
        return self._entered[viewer]

    def leave(self, viewer: Viewer) -> None:
        """Remove a page; if it was the acting page, there is no acting page from now on."""
        if self._entered.pop(viewer, None) is None:
            return
        self._act(None if viewer is self._acting else self._acting)

    def state(self, viewer: Viewer) -> bytes:
        """Return the message that tells a referee's page which referee has the acting page."""
        acting = None if self._acting is None else self._entered[self._acting][1]
        body = {"acting": acting, "mine": viewer is self._acting}
        return wire.map_message(MessageKind.REFEREE, body)

    def _act(self, viewer: Viewer | None) -> None:
        self._acting = viewer
        for one in self._entered:
            one.send(self.state(one))
