"""Replaces a file in one step: whoever reads it meanwhile gets the whole old or new file."""

import os
from collections.abc import Callable
from pathlib import Path


def write(path: Path, content: bytes, *, secret: bool = False) -> None:
    """Write a file in place of an older one; a secret file can at no time be read by other users.

    Raises:
        OSError: if it can't be written.
    """

    def write_part(part: Path) -> None:
        with open(part, "xb", opener=_for_its_owner if secret else None) as file:
            file.write(content)

    replace(path, write_part)


def replace(path: Path, write_part: Callable[[Path], object]) -> None:
    """Replace a file: `write_part` writes a new file beside it, which then gets its path."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    part.unlink(missing_ok=True)  # of a killed program that had this number
    try:
        write_part(part)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _for_its_owner(name: str, flags: int) -> int:
    return os.open(name, flags, 0o600)
