"""What all /design pages of a gateway share: the folder, the way to a studio, and who is there."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import msgspec

from lacoc_client.design.asker import Asker
from lacoc_client.design.files import FileContent, read_file
from lacoc_client.design.folder import Folder
from lacoc_client.design.learning.diary import Diary
from lacoc_client.gateway import wire
from lacoc_client.gateway.home import new_key
from lacoc_client.gateway.viewer import Viewer
from lacoc_client.gateway.wire import Kind
from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot, sample_gait_files
from lacoc_shared.messages import SentFile

_LOOK_S = 1.0
"""How often the folder is looked at, and pages get a sign of life."""
_SOON_S = 0.1
"""How soon pages are told that a studio has come or gone."""


class Designer:
    """The folder and the studio of a gateway; used from the event loop only.

    Args:
        folder: the files.
        asker: the way to the studio; it is started and closed here.
        robot: the robot that pages begin with, as on the command line; None: the workshop's.

    Raises:
        UserError: if there is no such robot.
    """

    def __init__(self, folder: Folder, asker: Asker, robot: str | None = None) -> None:
        self.folder = folder
        self.asker = asker
        self.robot = SentFile(*find_robot(robot)) if robot else None
        """The robot file that pages begin with; None: the workshop's."""
        self.key = new_key()
        """The page key: without it a page gets nothing."""
        self.diary = Diary(folder.path)
        """What the student of the folder has done."""
        self._robot_name = robot or WORKSHOPS_ROBOT
        self._viewers: dict[Viewer, None] = {}

    def sample(self) -> FileContent:
        """Read the sample postures of the robot, which may have none; may block."""
        postures = sample_gait_files(self._robot_name).postures
        return FileContent() if postures is None else read_file(postures.name, postures.data)

    def add(self, viewer: Viewer) -> None:
        """Add a page, and tell it which files and whether a studio is there."""
        self._viewers[viewer] = None
        viewer.send(self._folder_message(()))
        viewer.send(self._studio_message())
        viewer.send(self._phases_message())

    def tell_phases(self) -> None:
        """Tell all pages how far the student is."""
        self._send(self._phases_message())

    def remove(self, viewer: Viewer) -> None:
        """Remove a page that has gone."""
        self._viewers.pop(viewer, None)

    @asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Look at the folder and for a studio until the block ends, and tell the pages."""
        self.asker.start()
        await self.diary.read()
        looking = asyncio.get_running_loop().create_task(self._look())
        try:
            yield
        finally:
            looking.cancel()
            await self.diary.close()
            await asyncio.to_thread(self.asker.close)

    async def _look(self) -> None:
        loop = asyncio.get_running_loop()
        present, next_s = None, loop.time()
        while True:
            changed: tuple[str, ...] = ()
            is_due = loop.time() >= next_s
            if is_due:
                next_s = loop.time() + _LOOK_S
                changed = await asyncio.to_thread(self.folder.look)
            if changed:
                self._send(self._folder_message(changed))
            if is_due or present != self.asker.studio:
                present = self.asker.studio
                self._send(self._studio_message())
            await asyncio.sleep(_SOON_S)

    def _send(self, message: bytes) -> None:
        for viewer in self._viewers:
            viewer.send(message)

    def _folder_message(self, changed: tuple[str, ...]) -> bytes:
        body = {
            "folder": str(self.folder.path),
            "files": self.folder.files,
            "changed": changed,
        }
        return wire.map_message(Kind.FOLDER, body)

    def _phases_message(self) -> bytes:
        return wire.map_message(Kind.PHASES, msgspec.structs.asdict(self.diary.phases))

    def _studio_message(self) -> bytes:
        present = self.asker.studio is not None
        return wire.map_message(
            Kind.STUDIO, {"present": present, "why": None if present else self.asker.why}
        )
