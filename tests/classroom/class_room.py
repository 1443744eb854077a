"""A running `lacoc class`, and pages of its students and teacher without a browser."""

import struct
import subprocess
import time
from pathlib import Path
from typing import Any

from lacoc_process import Running
from page_connection import PageConnection
from page_table import SharingPage

from lacoc_client.web.gateway.wire import MessageKind


class ClassRoom:
    """A running `lacoc class`."""

    def __init__(
        self, folder: Path, listen: str = "127.0.0.1:0", *words: str, fresh: bool = False
    ) -> None:
        class_ = ("class", str(folder), "--no-open", "--json", "--listen", listen)
        self._running = Running(*class_, *words, fresh=fresh, stderr=subprocess.DEVNULL)
        self.process, opened = self._running.process, self._running.opened
        self.url, self.code = opened["url"], opened["code"]
        self.key = opened["class"].partition("#key=")[2]

    @property
    def listen(self) -> str:
        """The class's address, at which a test can start the class again."""
        return str(self.url).removeprefix("http://")

    def student(self, name: str, token: str | None = None) -> "StudentPage":
        """Let a student enter, with the token or, without one, with the class code."""
        page = StudentPage(self.url)
        page.enter(name=name, **({"token": token} if token else {"code": self.code}))
        return page

    def teacher(self) -> "TeacherPage":
        """Open the teacher's page."""
        page = TeacherPage(self.url)
        page.ask("hello", key=self.key)
        page.until(lambda: page.told[MessageKind.TOURNAMENT])
        return page

    def close(self) -> None:
        self._running.close()


class StudentPage(SharingPage, PageConnection):
    """A page of /design in a class."""

    def __init__(self, url: str) -> None:
        super().__init__(url, "/design/ws")
        self.hello: dict[str, Any] = {}
        """The reply to hello."""

    def enter(self, **fields: str) -> None:
        """Enter the class, and wait until the page is told the six phases."""
        self.hello = self.ask("hello", **fields)
        self.opens()
        self.until(lambda: self.told[MessageKind.PHASES])

    @property
    def phases(self) -> dict[str, Any]:
        return self.last(MessageKind.PHASES)

    def sample(self) -> dict[str, Any]:
        """Return the sample table."""
        return dict(self.ask("sample")["table"])


class TeacherPage(PageConnection):
    """A page of /class."""

    def __init__(self, url: str) -> None:
        super().__init__(url, "/class/ws")

    @property
    def group(self) -> dict[str, Any]:
        """The newest settings of the class."""
        return self.last(MessageKind.CLASS)

    @property
    def cards(self) -> dict[str, dict[str, Any]]:
        """The newest card of each student."""
        cards: dict[str, dict[str, Any]] = {}
        for message in self.told[MessageKind.CLASS]:
            cards |= {card["name"]: card for card in message["cards"] or ()}
        cards |= {card["name"]: card for card in self.told[MessageKind.CARD]}
        for gone in self.told[MessageKind.GONE]:
            cards.pop(gone["name"], None)
        return cards

    def card(self, name: str) -> dict[str, Any]:
        """Return the newest card of a student; {}: there is none yet."""
        return self.cards.get(name, {})


def until_kept(folder: Path, angle_deg: float) -> None:
    """Wait until a table with this angle, which needs 64 bits or has a fraction, is on the disk."""
    wanted = [struct.pack(">d", angle_deg), struct.pack(">f", angle_deg)]  # as Yjs writes numbers
    deadline_s = time.monotonic() + 60
    while not any(
        one in path.read_bytes() for path in folder.glob("lacoc-*.sqlite*") for one in wanted
    ):
        assert time.monotonic() < deadline_s
        time.sleep(0.05)
