"""Fetches files from the pages of an event: whole, or not at all."""

import ssl
import urllib.request
from http.client import HTTPException, IncompleteRead, InvalidURL, RemoteDisconnected
from typing import NamedTuple

_WAIT_S = 10.0


class TooLong(OSError):
    """Raised for a file that is longer than the caller wants."""


class FetchedFile(NamedTuple):
    """A file as the pages sent it."""

    data: bytes
    tag: str
    """Its ETag, which names this version of the file; "": the pages sent none."""


def fetch(
    url: str,
    context: ssl.SSLContext | None,
    most_bytes: int,
    tag: str = "",
    wait_s: float = _WAIT_S,
) -> FetchedFile:
    """Fetch a file.

    Args:
        url: its address.
        context: how the pages must prove who they are; None: as the system has it.
        most_bytes: the longest file that is taken.
        tag: the ETag of the version that the caller has; the pages then send only another one.
        wait_s: longest silence of the pages [s].

    Raises:
        urllib.error.HTTPError: if the pages refuse, or (304) have no other version.
        TooLong: if the file is longer than `most_bytes`.
        OSError: if no answer comes, only a part of one, or one that is not HTTP.
        ValueError: if the address is wrong.
    """
    asked = urllib.request.Request(url, headers={"If-None-Match": tag} if tag else {})
    try:
        with urllib.request.urlopen(asked, timeout=wait_s, context=context) as answer:
            data = answer.read(most_bytes + 1)
            if len(data) > most_bytes:
                raise TooLong(f"more than {most_bytes} bytes")
            if answer.length:  # bytes that were announced and did not come
                raise OSError("the answer was cut off")
            return FetchedFile(data, answer.headers.get("ETag", ""))
    except InvalidURL as error:
        raise ValueError(str(error)) from None
    except (IncompleteRead, RemoteDisconnected):
        raise OSError("the answer was cut off") from None
    except HTTPException as error:
        raise OSError(f"the answer is not HTTP ({type(error).__name__})") from None


def trusting_all() -> ssl.SSLContext:
    """Return the context for pages that need not prove who they are."""
    context = ssl.create_default_context()
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    return context
