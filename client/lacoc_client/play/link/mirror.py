"""Copies the contest's sheet and pictures from other pages, for a gateway without any secret."""

import ssl
import threading
import urllib.error
from contextlib import suppress
from http import HTTPStatus
from pathlib import Path
from typing import Self

import msgspec

from lacoc_client.play.link.fetch import FetchedFile, TooLong, fetch
from lacoc_shared.command.replacing import write
from lacoc_shared.contest.file import picture_path

_EVERY_S = 2.0
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
        with suppress(OSError, ValueError):  # also 304: what is here is the newest
            found = self._get("contest.json", _MOST_BYTES, self._tag)
            self._missing = self._pictures_of(found.data)
            self._copy_pictures()
            write(self._path, found.data)
            self._tag = found.tag

    def _copy_pictures(self) -> None:
        """Copy the pictures of teams that are not copied yet.

        Pictures that can't be fetched now are fetched later.
        """
        for files, path in [*self._missing.items()]:
            try:
                found = self._get(f"pictures/{files}.webp", _PICTURE_BYTES)
                path.parent.mkdir(parents=True, exist_ok=True)
                write(path, found.data)
            except TooLong:
                pass
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

    def _get(self, name: str, most_bytes: int, tag: str = "") -> FetchedFile:
        return fetch(f"{self._pages}/{name}", self._context, most_bytes, tag)
