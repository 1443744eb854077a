"""Finds what third parties add, by entry point; a game or a robot also by its folder."""

import functools
import hashlib
import importlib.util
import sys
from collections.abc import Mapping
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import MappingProxyType, ModuleType

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def installed(group: str) -> Mapping[str, EntryPoint]:
    """Return all entries of a group (such as "lacoc.arenas") by name, in alphabetical order."""
    return _installed(group, tuple(sys.path))


@functools.cache  # reading the installed packages takes 30 ms, and a match asks several times
def _installed(group: str, path: tuple[str, ...]) -> Mapping[str, EntryPoint]:
    entries = sorted(entry_points(group=group), key=lambda entry: entry.name)
    return MappingProxyType({entry.name: entry for entry in entries})


def package(group: str, what: str, name: str) -> ModuleType:
    """Import the package of an arena or a robot, by its installed name or its folder.

    Args:
        group: the entry-point group.
        what: the word for such a package in error messages, such as "arena".
        name: an installed name; if there is none of this name, the path of a folder.

    Raises:
        UserError: if there is no such package; the message lists the installed ones.
    """
    if name not in installed(group) and (folder := Path(name).expanduser()).is_dir():
        return package_of_folder(folder)
    module = _loaded(group, name)
    if module is None:
        known = [*installed(group)]
        raise UserError(
            say("command.not-installed-folder", what=what, name=name[:200], installed=known)
        )
    return module


def installed_package(group: str, what: str, name: str) -> ModuleType:
    """Import an installed package, for a name that comes from a file or a court.

    The path of a folder is refused: otherwise code would run only because a file or a court names
    it.

    Raises:
        UserError: if no such package is installed; the message lists the installed ones.
    """
    module = _loaded(group, name)
    if module is None:
        known = [*installed(group)]
        raise UserError(say("command.not-installed", what=what, name=name[:200], installed=known))
    return module


def _loaded(group: str, name: str) -> ModuleType | None:
    entry = installed(group).get(name)
    return None if entry is None else entry.load()


def package_of_folder(folder: Path) -> ModuleType:
    """Import a folder as a package with a unique name, so that its files can import each other.

    The name depends on the Python files of the folder: changed code is imported as a new package.
    """
    folder = folder.resolve()
    files = [file for file in sorted(folder.rglob("*.py")) if file.is_file()]
    code = repr([(str(file), file.read_bytes()) for file in files] or str(folder))
    name = f"lacoc_folder_{hashlib.blake2b(code.encode(), digest_size=6).hexdigest()}"
    if name in sys.modules:
        return sys.modules[name]
    init = folder / "__init__.py"
    spec = importlib.util.spec_from_file_location(
        name, init if init.exists() else None, submodule_search_locations=[str(folder)]
    )
    if spec is None:
        spec = importlib.util.spec_from_loader(name, loader=None, is_package=True)
        assert spec is not None
        spec.submodule_search_locations = [str(folder)]
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        if spec.loader is not None:
            spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def folder_of(module: ModuleType) -> Path:
    """Return the folder of an imported package."""
    return Path(next(iter(module.__path__)))
