"""Tells the operator of a stream what its page waits for: only the audience sees the page."""

import re

from lacoc_shared.words import Phrase, say

_STANDS_S = 3.0
"""Pages wait for a moment now and then; a reason is told after this time [s]."""


class PageWaiting:
    """Remembers what the page says that it waits for, so that each reason is told once."""

    def __init__(self) -> None:
        self._text, self._since_s = "", 0.0
        self._told = ""

    def see(self, text: str, now_s: float) -> Phrase | None:
        """Note what the page says now; return what the operator must be told, if anything.

        Args:
            text: the page's sentence; "" if it waits for nothing.
            now_s: the time, by a clock that never goes back [s].
        """
        reason = re.sub(r"\d+", "", text)  # seconds pass
        if reason != self._text:
            self._text, self._since_s = reason, now_s
        if reason == self._told or now_s - self._since_s < _STANDS_S:
            return None
        self._told = reason
        return say("stream.waits", text=text) if text else say("stream.shows")
