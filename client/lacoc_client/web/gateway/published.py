"""Puts the pages into the folder that a contest publishes, so that any web server can show it.

The addresses in the built pages are relative, so the folder can be at any path. Each page has an
HTML file of its own that says which page it is, because another web server does not have the
gateway's routes.
"""

from pathlib import Path
from secrets import token_hex

from lacoc_client.web.gateway.files import NOT_BUILT, PAGES
from lacoc_shared.mistakes import UserError

FILES = {"index.html": "contest", "replay.html": "replay"}
"""The pages of a published folder, by file name."""


def write_pages(folder: Path) -> None:
    """Write the pages of a contest into the folder that it publishes, in place of older pages.

    Args:
        folder: the folder, with contest.json and the folder "records".

    Raises:
        UserError: if the pages are not built.
        OSError: if a file can't be written.
    """
    index = PAGES / "index.html"
    if not index.is_file():
        raise UserError(NOT_BUILT)
    text = index.read_text(encoding="utf-8")
    for path in sorted(PAGES.rglob("*")):
        to = folder / path.relative_to(PAGES)
        if path.is_dir():
            to.mkdir(exist_ok=True)
        elif path != index:
            _write(to, path.read_bytes())
    for name, page in FILES.items():  # last: they name the others
        _write(folder / name, text.replace("<body>", f'<body data-page="{page}">').encode())


def _write(path: Path, data: bytes) -> None:
    """Write a file in one step: whoever reads it meanwhile gets the whole old or new file."""
    if path.is_file() and path.read_bytes() == data:
        return
    part = path.with_name(f".{path.name}.{token_hex(4)}.part")
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
