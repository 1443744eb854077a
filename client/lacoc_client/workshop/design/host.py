"""The host of a page of /design: the folder of one person, or a class."""

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
    """What a page of /design belongs to. Only `sample` may be called outside the event loop."""

    robot: SentFile | None
    """The robot file that pages begin with; None: the workshop's."""
    studios: Studios
    folder: Folder | None
    """The folder with the student's files; None: pages have no folder."""
    playing: Playing | None
    """Takes tables to a court, to practise there; None: pages can't do this."""

    async def enter(self, hello: requests.Hello, where: str) -> "LetIn":
        """Let a page in, if it shows the right key, code or token.

        Args:
            hello: the page key, token, or class code and name that the page shows.
            where: address of the page's machine.

        Raises:
            UserError: if the page may not come in, or must show something else first.
        """

    def leave(self, student: Student, viewer: Viewer) -> None:
        """Remove a page that was closed or has lost its connection."""

    def greet(self, student: Student, viewer: Viewer, lesson: bool) -> None:
        """Send a page everything that it needs after it was let in.

        Args:
            student: the student whose page it is.
            viewer: the page.
            lesson: whether it is a page of the lesson of one leg.
        """

    def learned(self, student: Student, trial: TrialReply | None = None) -> None:
        """Tell the pages that show a student's progress that the student did something.

        Args:
            student: the student.
            trial: the trial's reply, if the student let the robot walk.
        """

    async def group(self, student: Student, asked: requests.GroupAsk) -> None:
        """Do what a student asks about groups, such as join one.

        Raises:
            UserError: if it can't be done, or there are no groups here.
        """

    def sample(self) -> FileContent:
        """Read the robot's sample postures; empty if it has no sample. May wait for the disk."""


class LetIn(NamedTuple):
    """A page that was let in."""

    student: Student
    """The student whose page it is."""
    token: str | None = None
    """The token with which this browser may come in again; None: it needs no token."""
