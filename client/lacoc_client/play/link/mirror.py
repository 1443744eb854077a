"""Copies the contest's sheet and pictures from other pages, for a gateway without any secret."""

import ssl
import threading
import urllib.error
import urllib.request
from http import HTTPStatus
from http.client import HTTPResponse
from pathlib import Path
from typing import Self, cast

import msgspec

from lacoc_shared.command.replacing import write
from lacoc_shared.contest.file import picture_path

_EVERY_S = 2.0
_WAIT_S = 10.0
_MOST_BYTES = 16 << 20
_PICTURE_BYTES = 256 << 10
"""A team's picture is not copied if it is longer than this; a usual picture has some 10 kB."""


class _TeamOfSheet(msgspec.Struct, frozen=True):
    files: str = ""
    picture: bool = False


class _TeamsOfSheet(msgspec.Struct, frozen=True):
    """The part of a sheet that says which teams have a picture."""

    teams: tuple[_TeamOfSheet, ...] = ()


class SheetMirror:
    """Copies the newest sheet of a contest from its pages into a file; a context manager.

    The pictures of the teams on the sheet are copied first, to the paths of `picture_path`. Each is
    copied once, because it is named by its hash and never changes. While the pages do not answer,
    the copies stay as they are.

    Args:
        pages: address of the pages.
        authority: certificate (PEM) of the pages' own authority; "": none.
        path: the file for the copy of the sheet.
    """

    def __init__(self, pages: str, authority: str, path: Path) -> None:
        self._pages = pages
        self._context = ssl.create_default_context(cadata=authority) if authority else None
        self._path = path
        self._tag = ""
        self._missing: dict[str, Path] = {}
        """Paths of the pictures of teams that are still to be copied, by the hash of the team's
        files."""
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="mirror", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()

    def _run(self) -> None:
        while True:
            self._copy_sheet()
            self._copy_pictures()
            if self._ended.wait(_EVERY_S):
                return

    def _copy_sheet(self) -> None:
        try:
            with self._get("contest.json", self._tag) as answer:
                data = answer.read(_MOST_BYTES)
                tag = answer.headers.get("ETag", "")
            self._missing = self._pictures_of(data)
            self._copy_pictures()
            write(self._path, data)
            self._tag = tag
        except (OSError, ValueError):  # also 304: what is here is the newest
            return

    def _copy_pictures(self) -> None:
        """Copy the pictures of teams that are not copied yet.

        Pictures that can't be fetched now are fetched later.
        """
        for files, path in [*self._missing.items()]:
            try:
                with self._get(f"pictures/{files}.webp") as answer:
                    data = answer.read(_PICTURE_BYTES + 1)
                if len(data) <= _PICTURE_BYTES:
                    path.parent.mkdir(parents=True, exist_ok=True)
                    write(path, data)
            except urllib.error.HTTPError as error:
                if error.code != HTTPStatus.NOT_FOUND:
                    return
            except (OSError, ValueError):
                return
            del self._missing[files]

    def _pictures_of(self, sheet: bytes) -> dict[str, Path]:
        try:
            teams = msgspec.json.decode(sheet, type=_TeamsOfSheet).teams
        except msgspec.MsgspecError:  # no sheet of this version
            return {}
        paths = {team.files: picture_path(self._path, team.files) for team in teams if team.picture}
        return {files: path for files, path in paths.items() if path and not path.exists()}

    def _get(self, name: str, tag: str = "") -> HTTPResponse:
        """Request a file from the pages by its path.

        Args:
            name: path of the file.
            tag: the ETag of this machine's copy; the pages then send only a newer file.
        """
        asked = urllib.request.Request(f"{self._pages}/{name}", headers={"If-None-Match": tag})
        found = urllib.request.urlopen(asked, timeout=_WAIT_S, context=self._context)
        return cast("HTTPResponse", found)
