"""Replace a file in one step: whoever reads it meanwhile finds the old or the new one, whole."""

import os
from collections.abc import Callable
from pathlib import Path


def write(path: Path, content: bytes) -> None:
    """Write a file in place of an older one.

    Raises:
        OSError: if it can't be written.
    """
    replace(path, lambda part: part.write_bytes(content))


def replace(path: Path, write_part: Callable[[Path], object]) -> None:
    """Write a file beside a path with `write_part`; it gets the path when it is whole."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        write_part(part)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
