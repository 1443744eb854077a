"""The host of a page of /design: a folder of one's own, or a class."""

from typing import NamedTuple, Protocol

from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.files import FileContent
from lacoc_client.workshop.design.folder import Folder
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.design.playing import Playing
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_shared.messages import SentFile
from lacoc_shared.studio import TrialReply


class Host(Protocol):
    """A place where students design. Only `sample` may be called outside the event loop."""

    robot: SentFile | None
    """The robot file that pages begin with; None: the workshop's."""
    studios: Studios
    folder: Folder | None
    """The folder with the student's files; None: pages have no folder."""
    playing: Playing | None
    """The way to a court; None: pages have none."""

    async def enter(self, hello: requests.Hello, where: str) -> "LetIn":
        """Let a page in.

        Args:
            hello: what the page shows.
            where: address of the page's machine.

        Raises:
            UserError: if the page may not come in, or must show something else.
        """

    def leave(self, student: Student, viewer: Viewer) -> None:
        """Remove a page that has gone."""

    def greet(self, student: Student, viewer: Viewer, lesson: bool) -> None:
        """Send a page all that it needs when it has been let in.

        Args:
            student: whose page it is.
            viewer: the page.
            lesson: whether it is a page of the lesson of one leg.
        """

    def learned(self, student: Student, trial: TrialReply | None = None) -> None:
        """Tell all who must know that a student did something.

        Args:
            student: the student.
            trial: the trial, if that is what the student did.
        """

    async def group(self, student: Student, asked: requests.GroupAsk) -> None:
        """Do what a student asks of the groups.

        Raises:
            UserError: if it can't be done, or there are no groups here.
        """

    def sample(self) -> FileContent:
        """Read the robot's sample postures; empty if the robot has no sample. May block."""


class LetIn(NamedTuple):
    """A page that was let in."""

    student: Student
    """Whose page it is."""
    token: str | None = None
    """Lets this browser in again; None: it needs none."""
