"""The host of one person who designs alone: the person's folder, studio and open pages."""

import asyncio
import hmac
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.home import new_key
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.files import FileContent, read_file
from lacoc_client.workshop.design.folder import Folder
from lacoc_client.workshop.design.host import LetIn
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.rules import FREE
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.design.playing import Playing
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot, sample_gait_files
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import TrialReply
from lacoc_shared.words import say

EVIDENCE_FILE = "lacoc-evidence.sqlite"
"""Name of the file in the folder that keeps the student's progress."""

_LOOK_S = 1.0
"""Time between two looks for changed files, and between two signs of life to pages [s]."""
_SOON_S = 0.1
"""Time after which pages are told that a studio has come or gone [s]."""


class Designer:
    """The host of the pages of one person: a folder and a studio.

    Args:
        folder: the folder with the person's files.
        studios: the connection to the studio; this class starts and closes it.
        robot: the robot that pages begin with, as on the command line; None: the workshop's.

    Raises:
        UserError: if there is no such robot.
    """

    def __init__(
        self,
        folder: Folder,
        studios: Studios,
        robot: str | None = None,
    ) -> None:
        self.folder: Folder | None = folder
        self.playing: Playing | None = Playing()
        self.studios = studios
        self.robot = SentFile(*find_robot(robot)) if robot else None
        self.key = new_key()
        """The page key; a page that does not show it is refused."""
        self._folder = folder
        self._keeper = Keeper(folder.path / EVIDENCE_FILE)
        self._student = Student("", Diary(self._keeper), lambda: FREE)
        self._robot_name = robot or WORKSHOPS_ROBOT

    async def enter(self, hello: requests.Hello, where: str) -> LetIn:
        """Let in a page that shows the page key; see `Host.enter`."""
        key = hello.key.encode("utf-8", "surrogatepass")
        if not hmac.compare_digest(key, self.key.encode()):
            raise UserError(say("design.wrong-key"))
        return LetIn(self._student)

    def greet(self, student: Student, viewer: Viewer, lesson: bool) -> None:
        """Send a page the messages that it shows first; see `Host.greet`."""
        student.greet(viewer, lesson)
        viewer.send(self._folder_message(()))
        viewer.send(studio_message(self.studios))
        viewer.send(student.phases_message())

    def leave(self, student: Student, viewer: Viewer) -> None:
        """Remove a page that has gone; see `Host.leave`."""
        student.leave(viewer)

    def learned(self, student: Student, trial: TrialReply | None = None) -> None:
        """Tell all pages how far the student is in the phases; see `Host.learned`."""
        student.tell()

    async def group(self, student: Student, asked: requests.GroupAsk) -> None:
        """Refuse every request about groups: there are none for a person who designs alone."""
        raise UserError(say("groups.not-here"))

    def sample(self) -> FileContent:
        """Read the robot's sample postures from its file; empty if the robot has no sample."""
        return sample_postures(self._robot_name)

    @asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Watch folder and studio until the `async with` block ends; tell pages what changes."""
        self.studios.start()
        await self._student.diary.read()
        self._student.open_kept()
        looking = asyncio.get_running_loop().create_task(self._look())
        try:
            yield
        finally:
            looking.cancel()
            if self.playing is not None:
                await asyncio.to_thread(self.playing.close)
            await self._keeper.close()
            await asyncio.to_thread(self.studios.close)

    async def _look(self) -> None:
        loop = asyncio.get_running_loop()
        present, next_s = 0, loop.time()
        while True:
            changed: tuple[str, ...] = ()
            is_due = loop.time() >= next_s
            if is_due:
                next_s = loop.time() + _LOOK_S
                changed = await asyncio.to_thread(self._folder.look)
            if changed:
                self._student.send(self._folder_message(changed))
            if is_due or present != self.studios.present:
                present = self.studios.present
                self._student.send(studio_message(self.studios))
            await asyncio.sleep(_SOON_S)

    def _folder_message(self, changed: tuple[str, ...]) -> bytes:
        return folder_message(str(self._folder.path), self._folder, changed)


def sample_postures(robot: str) -> FileContent:
    """Read a robot's sample postures; empty if it has no sample. May wait for the disk."""
    postures = sample_gait_files(robot).postures
    return FileContent() if postures is None else read_file(postures.name, postures.data)


def folder_message(path: str, folder: Folder | None, changed: tuple[str, ...] = ()) -> bytes:
    """Return the message with the files of a folder; without a folder it lists no files.

    Args:
        path: path of the folder, for the page; "": there is no folder.
        folder: the folder; None: there is no folder.
        changed: names of the files that have changed.
    """
    files = folder.files if folder is not None else ()
    return wire.map_message(
        MessageKind.FOLDER, {"folder": path, "files": files, "changed": changed}
    )


def studio_message(studios: Studios) -> bytes:
    """Return the message that says whether there is a studio."""
    return wire.map_message(
        MessageKind.STUDIO, {"present": studios.present > 0, "why": studios.why}
    )
