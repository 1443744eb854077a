"""Installs programs that tests need, where they may: on Debian, as root."""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

_LOCKED_S = 300
"""Longest wait for a program of this machine that installs something [s]."""
_updated = False


def install(package: str) -> None:
    """Try to install a package of Debian; the caller checks whether that worked.

    Only one process of this machine may do so at a time; see `locked`.
    """
    global _updated
    if os.name != "posix" or os.geteuid() != 0 or not shutil.which("apt-get"):
        return
    # Another test may be installing another package, and `update` has a lock without a timeout.
    words = [("install", "--yes", "--no-install-recommends", package)]
    with locked("apt"):
        for one in words if _updated else [("update",), *words]:
            subprocess.run(
                ["apt-get", "-qq", "-o", f"DPkg::Lock::Timeout={_LOCKED_S}", *one],
                check=False,
                timeout=600,
                stdout=subprocess.DEVNULL,
                env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"},
            )
    _updated = True


@contextlib.contextmanager
def locked(name: str) -> Iterator[None]:
    """Let only one test process of this machine into the block at a time; the others wait."""
    path = Path(tempfile.gettempdir()) / f"lacoc-tests-{name}.lock"
    with path.open("a") as file:
        if sys.platform == "win32":
            import msvcrt

            while True:
                try:
                    msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
                    break
                except OSError:
                    time.sleep(0.2)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX)
        yield
