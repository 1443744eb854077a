"""Computes a hash of the software that decides how a match goes; kept results carry it."""

import hashlib
import platform
from functools import cache
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import msgspec

from lacoc_server.world import arithmetic
from lacoc_shared.command import plugins

_PACKAGES = ("lacoc_shared", "lacoc_robots", "lacoc_arenas", "lacoc_server")
_GROUPS = ("lacoc.arenas", "lacoc.robots", "lacoc.bots")
"""Entry points by which other packages bring games, robots and bots."""
_SOURCES = (".py", ".toml", ".xml", ".txt")


@cache
def software() -> str:
    """Return a hash of all software that decides how a game goes.

    This is the source code of LACOC and of the packages with games, robots and bots; the versions
    of MuJoCo, numpy and Python; and the arithmetic of this machine.
    """
    digest = hashlib.blake2b(digest_size=16)
    for name in (*_PACKAGES, *_others()):
        for root in _roots(name):
            digest.update(folder_hash(root).encode())
    parts = [version("mujoco"), version("numpy"), platform.python_version()]
    digest.update(msgspec.json.encode([*parts, dict(arithmetic.here())], order="deterministic"))
    return digest.hexdigest()


def folder_hash(root: Path) -> str:
    """Return a hash of the sources in a folder, or of one file, hexadecimal."""
    digest = hashlib.blake2b(digest_size=16)
    for path in sorted(root.rglob("*")) if root.is_dir() else [root]:
        if path.suffix in _SOURCES and path.is_file():
            digest.update(path.relative_to(root).as_posix().encode() + b"\0")
            digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()


def _others() -> list[str]:
    """Return the names of installed packages that bring more games, robots or bots."""
    entries = [entry for group in _GROUPS for entry in plugins.installed(group).values()]
    return sorted({entry.module.partition(".")[0] for entry in entries} - {*_PACKAGES})


def _roots(package: str) -> list[Path]:
    """Return the folders of a package, or the file of a module; empty if it is not installed."""
    spec = find_spec(package)
    if spec is None:
        return []
    if spec.submodule_search_locations is not None:
        return sorted(map(Path, spec.submodule_search_locations))
    return [Path(spec.origin)] if spec.origin else []
