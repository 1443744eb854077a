"""What the organiser of a contest tells all pages: a line, and whether games are called now."""

from pathlib import Path

import msgspec

from lacoc_client.web.gateway.wire import MessageKind, map_message


class _Day(msgspec.Struct, frozen=True):
    paused: bool = False
    until_ms: int = 0
    reason: str = ""


class _Announced(msgspec.Struct, frozen=True):
    text: str = ""


class _Sheet(msgspec.Struct, frozen=True):
    day: _Day = _Day()
    announced: _Announced | None = None


class Notice:
    """What the newest sheet of a contest tells all; used from one thread at a time.

    Args:
        sheet: the sheet, which need not exist yet; None: there is no contest.
    """

    def __init__(self, sheet: Path | None) -> None:
        self._path = sheet
        self._version = 0
        self._told = _Sheet()

    def look(self) -> bool:
        """Read the sheet if it is new; return whether it tells something else than before."""
        if self._path is None:
            return False
        before = self._told
        try:
            version = self._path.stat().st_mtime_ns
            if version != self._version:
                self._told = msgspec.json.decode(self._path.read_bytes(), type=_Sheet)
                self._version = version
        except (OSError, msgspec.MsgspecError):  # it is looked at again
            return False
        return self._told != before

    @property
    def message(self) -> bytes:
        """The message to a page."""
        day, line = self._told.day, self._told.announced
        body = {
            "text": line.text if line is not None else "",
            "paused": day.paused,
            "until_ms": day.until_ms,
            "reason": day.reason,
        }
        return map_message(MessageKind.NOTICE, body)
