"""Tests of how files come from an event's pages: whole, or not at all."""

import socket
import threading
import urllib.error
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

from lacoc_client.play.link import event
from lacoc_client.play.link.fetch import TooLong, fetch
from lacoc_client.play.link.mirror import SheetMirror
from lacoc_shared.mistakes import UserError

Pages = Callable[[bytes], str]
OK = b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\nETag: t\r\nConnection: close\r\n\r\n"
CUT = OK % 9 + b"{}"
NO_HTTP = b"220 mail.example.org ESMTP\r\n"


@pytest.fixture
def pages(request: pytest.FixtureRequest) -> Pages:
    """Return a function that serves raw bytes as the answer to every request."""

    def serve(raw: bytes) -> str:
        listener = socket.create_server(("127.0.0.1", 0))
        request.addfinalizer(lambda: _close(listener))

        def answer() -> None:
            while True:
                try:
                    connection, _ = listener.accept()
                except OSError:
                    return
                with connection:
                    connection.recv(4096)
                    connection.sendall(raw)

        threading.Thread(target=answer, daemon=True).start()
        return f"http://127.0.0.1:{listener.getsockname()[1]}"

    return serve


def _close(listener: socket.socket) -> None:
    with suppress(OSError):  # macOS and Windows shut no listener down
        listener.shutdown(socket.SHUT_RDWR)
    listener.close()


def test_a_whole_file_has_its_tag(pages: Pages) -> None:
    """A file of the greatest length is taken, a longer one is not."""
    url = pages(OK % 4 + b"data")
    assert fetch(url, None, 4) == (b"data", "t")
    with pytest.raises(TooLong):
        fetch(url, None, 3)


@pytest.mark.parametrize("raw", [CUT, NO_HTTP, b""])
def test_half_an_answer_is_none(pages: Pages, raw: bytes) -> None:
    """A connection that breaks, and a server that speaks no HTTP, are errors of the network."""
    with pytest.raises(OSError, match=r"cut off|not HTTP|closed"):
        fetch(pages(raw), None, 99)


def test_the_same_version_is_told_by_its_status(pages: Pages) -> None:
    """Pages that have no other version answer 304, which is an error here."""
    with pytest.raises(urllib.error.HTTPError, match="304"):
        fetch(pages(b"HTTP/1.1 304 Not Modified\r\nConnection: close\r\n\r\n"), None, 99, "t")


@pytest.mark.parametrize("raw", [CUT, NO_HTTP])
def test_a_broken_answer_ends_no_copying(pages: Pages, tmp_path: Path, raw: bytes) -> None:
    """The copy of a sheet stays as it is; the next answer is taken."""
    copy = tmp_path / "contest.json"
    mirror = SheetMirror(pages(raw), "", copy)
    mirror._copy_sheet()
    assert not copy.exists()
    mirror._pages = pages(OK % 2 + b"{}")
    mirror._copy_sheet()
    assert copy.read_bytes() == b"{}"


def test_a_link_to_something_else_is_told(pages: Pages) -> None:
    """A port at which no pages listen is an error for people, and no traceback."""
    with pytest.raises(UserError, match="not HTTP"):
        event.find(f"{pages(NO_HTTP)}/play#token=x")
