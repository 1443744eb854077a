"""What an event's pages tell commands: the event's courts and their addresses.

This is public: whoever can open the pages may read it at their path `event.json`.
"""

import ssl
import urllib.error
from collections.abc import Mapping
from typing import NamedTuple

import msgspec

from lacoc_client.play.link.fetch import fetch, trusting_all
from lacoc_shared.contest.link import Link
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import endpoint
from lacoc_shared.network.certificate import fingerprint, only_first
from lacoc_shared.words import Phrase, say

PATH = "event.json"
_MOST_BYTES = 1 << 20


class LinkedEvent(msgspec.Struct, frozen=True, kw_only=True):
    """An event, as its pages describe it to a command that has a link."""

    protocol: int
    name: str = ""
    """Name of the contest; "": the event has no name."""
    courts: Mapping[str, tuple[str, ...]] = {}
    """For each court the addresses at which others find it; none: the court can be reached through
    pages only."""
    authority: str = ""
    """Certificate (PEM) of the event's own authority. "": public authorities signed its
    certificates, or nothing is encrypted."""


class FoundEvent(NamedTuple):
    """An event, found by a link to its pages."""

    link: Link
    event: LinkedEvent

    @property
    def courts(self) -> dict[str, tuple[str, ...]]:
        """The courts of the event that a command can reach, with their addresses.

        Raises:
            UserError: if a command can reach none of them.
        """
        found = {name: at for name, at in self.event.courts.items() if at}
        if not found:
            raise UserError(say("link.only-pages", url=self.link.pages))
        return found


def find(text: str) -> FoundEvent:
    """Read a link, and ask the pages that it leads to about the event.

    Args:
        text: a link, or the address of pages.

    Raises:
        UserError: if it is no link; if its pages do not answer, or can't prove who they are; or if
            they are of another version.
    """
    link = Link.read(text)
    if not link.authority:
        return FoundEvent(link, _read(link, _fetched(link, None)))
    # The pages prove who they are with a certificate of an authority that they name themselves. The
    # link says which authority that is.
    claimed = _read(link, _fetched(link, trusting_all())).authority
    if _fingerprint(link, claimed) != link.authority:
        raise UserError(say("link.other-authority", url=link.pages))
    named = only_first(claimed)  # somebody on the way may have added an authority
    event = _read(link, _fetched(link, ssl.create_default_context(cadata=named)))
    return FoundEvent(link, msgspec.structs.replace(event, authority=named))


def _fingerprint(link: Link, certificate: str) -> str:
    try:
        return fingerprint(certificate)
    except ValueError:
        raise UserError(say("link.other-authority", url=link.pages)) from None


def _fetched(link: Link, context: ssl.SSLContext | None) -> bytes:
    try:
        return fetch(f"{link.pages}/{PATH}", context, _MOST_BYTES).data
    except urllib.error.HTTPError as error:
        why = say("link.status", status=error.code)
        raise UserError(say("link.no-event", url=link.pages, why=why)) from None
    except (OSError, ValueError) as error:  # URLError is an OSError
        raise UserError(say("link.no-pages", url=link.pages, why=_why(error))) from None


def _why(error: Exception) -> Phrase | str:
    reason = getattr(error, "reason", error)
    if isinstance(reason, ssl.SSLCertVerificationError):
        return reason.verify_message
    return str(getattr(reason, "strerror", None) or reason)


def _read(link: Link, data: bytes) -> LinkedEvent:
    try:
        event = msgspec.json.decode(data, type=LinkedEvent)
    except msgspec.MsgspecError:
        why = say("link.not-read")
        raise UserError(say("link.no-event", url=link.pages, why=why)) from None
    if event.protocol != PROTOCOL:
        raise UserError(say("link.version", pages=event.protocol, program=PROTOCOL))
    try:
        courts = {name: tuple(map(endpoint, at)) for name, at in event.courts.items()}
    except UserError as error:
        raise UserError(say("link.no-event", url=link.pages, why=error.phrase)) from None
    return msgspec.structs.replace(event, courts=courts)
