"""The organiser's message to all pages: a line of text, and whether games are called now."""

from pathlib import Path

from lacoc_client.web.gateway.contest_sheet import NewestSheet, SheetDay, SheetLine
from lacoc_client.web.gateway.wire import MessageKind, map_message


class Notice:
    """The organiser's message to all pages, from the contest's newest sheet; not thread-safe.

    Args:
        sheet: the sheet's file, which need not exist yet; None: there is no contest.
    """

    def __init__(self, sheet: Path | None) -> None:
        self._sheet = None if sheet is None else NewestSheet(sheet)
        self._told: tuple[SheetDay, SheetLine | None] = (SheetDay(), None)

    def look(self) -> bool:
        """Read the contest's sheet if it is new; return whether the message in it has changed."""
        sheet = None if self._sheet is None else self._sheet.take()
        if sheet is None:
            return False
        before, self._told = self._told, (sheet.day, sheet.announced)
        return self._told != before

    @property
    def message(self) -> bytes:
        """The organiser's message, as the bytes that are sent to a page."""
        day, line = self._told
        body = {
            "text": line.text if line is not None else "",
            "paused": day.paused,
            "until_ms": day.until_ms,
            "reason": day.reason,
        }
        return map_message(MessageKind.NOTICE, body)
