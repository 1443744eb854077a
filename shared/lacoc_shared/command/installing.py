"""Says which command installs missing packages, from the place where this LACOC came from.

LACOC may not be in an index of packages. Its installation may record that it came from a folder, a
file or a repository; then its extras are installed from there too. If no place is recorded, or the
place is gone, the packages of the extra are named one by one.
"""

import os
import shlex
import shutil
import sys
from importlib.metadata import Distribution, distribution
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit

import msgspec

_NAME = "lacoc"
EXTRA_OF = {
    "av": "film",
    "cmaes": "server",
    "cryptography": "server",
    "distributed": "cluster",
    "gymnasium": "rl",
    "mujoco": "server",
    "pettingzoo": "rl",
    "playwright": "film",
}
"""Mapping from each module that the base install leaves out to the extra with its package."""


def missing(extra: str) -> bool:
    """Return whether a module of an extra is not installed; import none of them."""
    return any(
        find_spec(module) is None for module, of_extra in EXTRA_OF.items() if of_extra == extra
    )


def command(*extras: str) -> str:
    """Return the command that installs extras of LACOC into this environment.

    Args:
        *extras: names of the extras.
    """
    return of(*_wanted(distribution(_NAME), extras))


def of(*packages: str) -> str:
    """Return the command that installs packages into this environment.

    Args:
        *packages: the packages, as pip names them.
    """
    return " ".join([*_installer(), *map(_quoted, packages)])


class _Info(msgspec.Struct):
    editable: bool = False


class _Vcs(msgspec.Struct):
    vcs: str
    commit_id: str = ""


class _DirectUrl(msgspec.Struct):
    """The file direct_url.json, which an installer writes for a package that came from no index."""

    url: str
    dir_info: _Info | None = None
    vcs_info: _Vcs | None = None


def _wanted(lacoc: Distribution, extras: tuple[str, ...]) -> list[str]:
    """List the arguments for pip: LACOC with extras, or the packages of the extras."""
    text = lacoc.read_text("direct_url.json")
    try:
        origin = None if text is None else msgspec.json.decode(text, type=_DirectUrl)
    except msgspec.DecodeError:
        origin = None
    listed = ",".join(extras)
    if origin is None:
        return _packages(lacoc, extras)
    if origin.vcs_info is not None:
        at = f"@{origin.vcs_info.commit_id}" if origin.vcs_info.commit_id else ""
        return [f"{_NAME}[{listed}] @ {origin.vcs_info.vcs}+{origin.url}{at}"]
    where = urlsplit(origin.url)
    if where.scheme != "file":
        return [f"{_NAME}[{listed}] @ {origin.url}"]
    from urllib.request import url2pathname  # brings the whole of HTTP

    path = url2pathname(where.path)
    if not Path(path).exists():
        return _packages(lacoc, extras)
    editable = ["--editable"] if origin.dir_info is not None and origin.dir_info.editable else []
    return [*editable, f"{path}[{listed}]"]


def _packages(lacoc: Distribution, extras: tuple[str, ...]) -> list[str]:
    """List the packages of extras, as LACOC's metadata names them."""
    from packaging.requirements import Requirement

    needed = map(Requirement, lacoc.requires or ())
    return [
        f"{one.name}{one.specifier}"
        for one in needed
        if one.marker is not None
        and not one.marker.evaluate({"extra": ""})
        and any(one.marker.evaluate({"extra": extra}) for extra in extras)
    ]


def _installer() -> list[str]:
    """Return the words with which a command line calls the installer of this environment."""
    if find_spec("pip") is None:  # such an environment was made by uv
        return ["uv", "pip", "install", "--python", _quoted(sys.executable)]
    found = shutil.which("pip")
    if found is not None and Path(found).parent == Path(sys.executable).parent:
        return ["pip", "install"]
    return [_quoted(sys.executable), "-m", "pip", "install"]


def _quoted(word: str) -> str:
    """Quote a word for the shell of this system, if it is necessary."""
    if word == "--editable":
        return word
    if os.name == "nt":
        return f'"{word}"' if set(word) & set(" <>[];,&|^") else word
    return shlex.quote(word)
