"""What pages can fetch in pieces of a second: the director's two pictures, and each court."""

import asyncio
import time
from dataclasses import dataclass

from lacoc_client.web.gateway.audience import Audience
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.pieces.cutter import Cutter
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.welcome import welcome
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

DIRECTOR, ASIDE, COURT = "director", "aside", "court"
"""Names of the pictures: the director's first and second one, and `court`, after which a court's
name may follow."""
UNASKED_S = 60.0
"""If nobody asks for a picture for this time, it is cut no longer [s]."""


@dataclass
class _CutPicture:
    cutter: Cutter
    viewer: Viewer
    asked_s: float


class Pictures:
    """Begins and stops to make pieces of pictures; used from the event loop only.

    A picture is a court, or one of the two pictures that the director fills.

    Args:
        courts: the courts of the gateway.
    """

    def __init__(self, courts: Courts) -> None:
        self._courts = courts
        self._cut: dict[str, _CutPicture] = {}

    def find(self, name: str) -> Cutter:
        """Return the object that makes the pieces of a picture; make it if there is none.

        Args:
            name: `director`, `aside`, `court` (the first court) or `court/NAME`.

        Raises:
            UserError: if there is no such picture.
        """
        found = self._known(name)
        if found is None:
            found = self._cut[name] = self._begin(name)
        return found.cutter

    def known(self, name: str) -> Cutter | None:
        """Return the object that makes the pieces of a picture; None if there is none now."""
        found = self._known(name)
        return None if found is None else found.cutter

    def audience(self, name: str) -> Audience | None:
        """Return the pages that see the court which a picture shows.

        None: no pieces of this picture are made now.
        """
        found = self._cut.get(name)
        if found is None:
            return None
        if name in (DIRECTOR, ASIDE):
            return self._courts.programme.seen_by(found.viewer)
        return self._courts.find(name.partition("/")[2] or None)[0].audience

    async def forget(self) -> None:
        """Stop making pieces of pictures that nobody asks for; runs until it is cancelled."""
        while True:
            await asyncio.sleep(UNASKED_S / 4)
            old_s = time.monotonic() - UNASKED_S
            for name in [name for name, one in self._cut.items() if one.asked_s < old_s]:
                self._courts.dismiss(self._cut.pop(name).viewer)

    def _known(self, name: str) -> _CutPicture | None:
        found = self._cut.get(name)
        if found is not None:
            found.asked_s = time.monotonic()
        return found

    def _begin(self, name: str) -> _CutPicture:
        cutter = Cutter(time.monotonic)
        viewer = Viewer(cutter)
        viewer.is_page = False
        courts = self._courts
        kind, _, court = name.partition("/")
        if name in (DIRECTOR, ASIDE):
            viewer.send(welcome(courts.home, None))
            viewer.send(courts.notice.message)
            courts.programme.add(viewer, name == ASIDE)
        elif kind == COURT:
            feed, _ = courts.find(court or None)
            viewer.send(welcome(courts.home, feed.court))
            viewer.send(courts.notice.message)
            feed.add(viewer)
        else:
            raise UserError(say("gateway.no-page"))
        courts.pages.add(viewer)
        return _CutPicture(cutter, viewer, time.monotonic())
