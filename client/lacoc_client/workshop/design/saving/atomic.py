"""Replaces a file in one step: after a failure or a power cut, the old or the new file is whole."""

import errno
import os
import secrets
import shutil
from contextlib import suppress
from pathlib import Path

from lacoc_shared.command.replacing import sync_folder
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def replace_file(path: Path, data: bytes) -> None:
    """Write a file, or replace it; if it is a link, replace the file that it points to.

    Raises:
        UserError: if the file can't be written; then the old file is as it was.
    """
    target = path.resolve()
    written = target.with_name(f".lacoc-{secrets.token_hex(8)}.tmp")
    try:
        # `os.replace` would replace a read-only file.
        if target.exists() and not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        with written.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, written)
        os.replace(written, target)
    except OSError as error:
        with suppress(OSError):
            written.unlink()
        why = error.strerror or str(error)
        raise UserError(say("design.cannot-write", name=path.name, why=why)) from None
    with suppress(OSError):  # the file is written, whatever the folder says
        sync_folder(target.parent)
