"""The link of an event: the address of the pages, the page that it opens, and a token. Pure.

A browser opens a page without sending the part after `#`; the page then sends the token.
"""

import re
from typing import Self
from urllib.parse import SplitResult, parse_qs, quote, urlsplit

import msgspec

from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

_PAGES = frozenset(
    ("play", "referee", "office", "enter", "watch", "overlay", "replay", "contest", "practice")
)
_FINGERPRINT = re.compile(r"[0-9a-f]{64}")
_MOST = 2000


class Link(msgspec.Struct, frozen=True, kw_only=True):
    """A link with which a person opens the pages of an event, in a browser or with a command."""

    pages: str
    """Address of the pages, without a slash at its end."""
    page: str = ""
    """The page that the link opens, such as "play"; "": the link is only the address of the
    pages."""
    court: str = ""
    """The court that the link names; "": none."""
    token: str = ""
    """The token of a seat, a team, a referee or the organiser; "": whoever has the link can only
    watch."""
    authority: str = ""
    """Fingerprint of the event's own authority (SHA-256, hexadecimal); "": it has none."""

    def __repr__(self) -> str:  # an accidental print must not show the token
        return f"Link(pages={self.pages!r}, page={self.page!r})"

    @property
    def text(self) -> str:
        """The link as the text that a person gets."""
        secret = {"token": self.token, "authority": self.authority}
        end = "&".join(f"{name}={value}" for name, value in secret.items() if value)
        query = f"?court={quote(self.court)}" if self.court else ""
        return f"{self.pages}/{self.page}{query}" + (f"#{end}" if end else "")

    @classmethod
    def read(cls, text: str) -> Self:
        """Read a link from a text.

        Raises:
            UserError: if the text is not a link.
        """
        parts = _parts(text.strip())
        path = parts.path.rstrip("/")
        before, _, last = path.rpartition("/")
        page = last if last in _PAGES else ""
        secret, query = parse_qs(parts.fragment), parse_qs(parts.query)
        authority = _first(secret, "authority").lower()
        if authority and not _FINGERPRINT.fullmatch(authority):
            raise UserError(say("link.bad-fingerprint"))
        return cls(
            pages=f"{parts.scheme}://{parts.netloc}{before if page else path}",
            page=page,
            court=_first(query, "court"),
            token=_first(secret, "token"),
            authority=authority,
        )


def _parts(text: str) -> SplitResult:
    wrong = UserError(say("link.not-a-link", link=printable(text.partition("#")[0], 200)))
    try:
        parts = urlsplit(text[:_MOST])
        port = parts.port
    except ValueError:
        raise wrong from None
    if parts.scheme not in ("http", "https") or not parts.hostname or port == 0 or "@" in text:
        raise wrong
    return parts


def _first(values: dict[str, list[str]], name: str) -> str:
    return next(iter(values.get(name, ())), "")
