"""What software decides how a match goes; results are kept under its hash."""

import hashlib
import platform
from functools import cache
from importlib import resources
from importlib.metadata import version
from pathlib import Path

import msgspec

from lacoc_server.world import arithmetic

_PACKAGES = ("lacoc_shared", "lacoc_robots", "lacoc_arenas", "lacoc_server")
_SOURCES = (".py", ".toml", ".xml", ".txt")


@cache
def software() -> str:
    """Return a hash of all software that decides how a game goes: ours, MuJoCo, numpy, Python."""
    digest = hashlib.blake2b(digest_size=16)
    for name in _PACKAGES:
        root = Path(str(resources.files(name)))
        for path in sorted(root.rglob("*")):
            if path.suffix in _SOURCES and path.is_file():
                digest.update(path.relative_to(root).as_posix().encode() + b"\0")
                digest.update(path.read_bytes() + b"\0")
    parts = [version("mujoco"), version("numpy"), platform.python_version()]
    digest.update(msgspec.json.encode([*parts, dict(arithmetic.here())], order="deterministic"))
    return digest.hexdigest()
