"""Drops files on a page."""

import base64
from collections.abc import Mapping
from pathlib import Path

from playwright.sync_api import Page


def drop(page: Page, files: Mapping[str, bytes]) -> None:
    """Send a page the browser's events of dropped files; `files` maps names to contents."""
    data = page.evaluate_handle(
        """(files) => {
          const data = new DataTransfer();
          for (const [name, text] of files)
            data.items.add(new File([Uint8Array.from(atob(text), c => c.charCodeAt(0))], name));
          return data;
        }""",
        [[name, base64.b64encode(data).decode()] for name, data in files.items()],
    )
    for event in ("dragover", "drop"):
        page.dispatch_event("body", event, {"dataTransfer": data})


def drag_in(page: Page, *paths: Path) -> None:
    """Drag files or folders of this machine onto a page through the browser, as a hand does."""
    data = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
    session = page.context.new_cdp_session(page)
    for kind in ("dragEnter", "dragOver", "drop"):
        at = {"type": kind, "x": 300, "y": 300, "data": data}
        session.send("Input.dispatchDragEvent", at)
