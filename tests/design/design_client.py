"""A client of /design without a browser, for tests."""

from typing import Any

from page_connection import PageConnection, Refused
from page_table import SharingPage

from lacoc_client.web.gateway.wire import MessageKind

__all__ = ["DesignClient", "Refused"]


class DesignClient(SharingPage, PageConnection):
    """A page's connection to `lacoc design`.

    Args:
        url: address of the gateway.
        key: the page key; None: the page sends no hello.
    """

    def __init__(self, url: str, key: str | None) -> None:
        super().__init__(url, "/design/ws")
        self.hello: dict[str, Any] = {}
        """The reply to hello."""
        if key is not None:
            self.hello = self.ask("hello", key=key)
            self.opens()
            self.until(lambda: self.folder and self.studio and self.phases)

    @property
    def folder(self) -> dict[str, Any]:
        return self.last(MessageKind.FOLDER)

    @property
    def folders(self) -> list[dict[str, Any]]:
        return self.told[MessageKind.FOLDER]

    @property
    def studio(self) -> dict[str, Any]:
        return self.last(MessageKind.STUDIO)

    @property
    def phases(self) -> dict[str, Any]:
        return self.last(MessageKind.PHASES)

    @property
    def progress(self) -> list[dict[str, Any]]:
        return self.told[MessageKind.PROGRESS]
