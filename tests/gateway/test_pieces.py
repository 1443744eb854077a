"""Tests of a match in pieces: how they are cut, and what a gateway answers."""

import gzip
import json
import ssl
import time
import urllib.error
import urllib.request
from email.message import Message
from itertools import count
from pathlib import Path

import proxies
import pytest
import trustme
from hypothesis import given
from hypothesis import strategies as st
from ports import free_port
from venue import Venue
from waiting import until

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.files import PageFile
from lacoc_client.web.gateway.pieces.cutter import PIECE_MS, PIECES_KEPT, Cutter, Piece
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import decode

MORE = 1 << 20


def event(number: int) -> bytes:
    return wire.map_message(MessageKind.EVENT, {"number": number})


def link(log: int, *, connected: bool = True) -> bytes:
    return wire.map_message(MessageKind.LINK, {"court": "a", "connected": connected, "log": log})


def frame(number: int) -> bytes:
    return wire.message(MessageKind.FRAME, bytes([number]))


def programme(court: str) -> bytes:
    return wire.map_message(MessageKind.PROGRAMME, {"court": court})


class Time:
    """A clock that goes on when it is told to."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def opened(file: PageFile | None) -> Piece:
    assert file is not None
    return decode(file.data, Piece, MORE)


@given(st.lists(st.integers(0, 2500), max_size=60))
def test_every_message_is_in_one_piece_at_its_time(gaps_ms: list[int]) -> None:
    """All that was written comes once, in order, in the piece and at the time when it came."""
    clock = Time()
    cutter = Cutter(clock)
    written: list[tuple[int, bytes]] = []
    now_ms = 0
    for number, gap_ms in zip(count(), gaps_ms, strict=False):
        now_ms += gap_ms
        clock.now_s = 100 + (now_ms + 0.5) / 1000
        cutter.write(event(number))
        written.append((now_ms, wire.inside(event(number))))
    clock.now_s += 2
    closed = cutter.closed()
    kept = range(max(0, closed - PIECES_KEPT), closed)
    found = [
        (PIECE_MS * number + ms, message)
        for number in kept
        for ms, message in opened(cutter.find(number)).then
    ]
    assert found == [one for one in written if one[0] >= PIECE_MS * kept.start]


def test_a_piece_starts_with_all_that_a_page_needs() -> None:
    """Each piece begins with the newest message of each kind and all events of the log."""
    clock = Time()
    cutter = Cutter(clock)

    def starts(*written: bytes) -> list[bytes]:
        for framed in written:
            cutter.write(framed)
        clock.now_s += 2
        return list(opened(cutter.find(cutter.closed() - 1)).start)

    def inside(*framed: bytes) -> list[bytes]:
        return [wire.inside(one) for one in framed]

    sheet = wire.message(MessageKind.SHEET, b"s")
    first = starts(frame(1), link(1), event(1), sheet, event(2), frame(2))
    assert first == inside(link(1), sheet, event(1), event(2), frame(2))
    assert starts(link(2), event(3)) == inside(link(2), sheet, event(3), frame(2))
    assert starts(link(2, connected=False)) == inside(link(2, connected=False), sheet, event(3))
    told = programme("west")
    assert starts(told, link(1)) == inside(told, link(1)), "nothing of the other court is left"


def test_only_the_newest_pieces_are_kept() -> None:
    """Old pieces are forgotten; a long silence costs no more than the pieces that are kept."""
    clock = Time()
    cutter = Cutter(clock)
    cutter.write(event(1))
    assert (cutter.closed(), cutter.find(0)) == (0, None)
    clock.now_s += 1
    assert cutter.closed() == 1
    assert opened(cutter.find(0)).then
    clock.now_s += 1_000_000
    assert cutter.closed() == 1_000_001
    assert cutter.find(1_000_001 - PIECES_KEPT - 1) is None
    assert opened(cutter.find(1_000_000)).start == (wire.inside(event(1)),)
    assert cutter.find(1_000_001) is None
    assert cutter.find(-1) is None


def ask(venue: Venue, path: str) -> tuple[int, Message, bytes]:
    """Ask the gateway; return status, headers and data."""
    request = urllib.request.Request(
        f"{venue.url}/live/{path}", headers={"Accept-Encoding": "gzip"}
    )
    try:
        with urllib.request.urlopen(request) as reply:
            data = reply.read()
            packed = reply.headers["Content-Encoding"] == "gzip"
            return reply.status, reply.headers, gzip.decompress(data) if packed else data
    except urllib.error.HTTPError as error:
        return error.code, error.headers, b""


@pytest.mark.parametrize(
    "picture",
    [
        "court/main",
        *(pytest.param(one, marks=pytest.mark.long) for one in ("court", "director", "aside")),
    ],
)
def test_a_gateway_serves_pieces(open_venue: Venue, picture: str) -> None:
    """A court and both pictures of the director come in pieces that a cache may keep for ever."""
    status, headers, data = ask(open_venue, f"{picture}/now.json")
    assert (status, headers["Cache-Control"]) == (200, "public, max-age=1")
    run = json.loads(data)["run"]
    assert json.loads(data)["room"]

    def closed() -> int:
        return int(json.loads(ask(open_venue, f"{picture}/now.json")[2])["closed"])

    until(lambda: closed() > 2)
    status, headers, data = ask(open_venue, f"{picture}/{run}/1")
    assert (status, headers["Cache-Control"]) == (200, "public, max-age=31536000, immutable")
    assert ask(open_venue, f"{picture}/{run}/1")[2] == data
    piece = decode(data, Piece, MORE)
    kinds = [MessageKind(message[0]) for message in piece.start]
    directed = [MessageKind.PROGRAMME] if picture in ("director", "aside") else []
    begins = [MessageKind.WELCOME, MessageKind.NOTICE, *directed, MessageKind.LINK]
    assert kinds[: len(begins)] == begins
    assert {MessageKind.SHEET, MessageKind.SCENE, MessageKind.FRAME} <= {*kinds}
    assert MessageKind.FRAME in [MessageKind(message[0]) for _, message in piece.then]


def test_what_there_is_not_is_told_for_a_second(open_venue: Venue) -> None:
    """A crowd that comes too early, or asks nonsense, asks the gateway once a second."""
    run = json.loads(ask(open_venue, "court/now.json")[2])["run"]
    for path in (f"court/{run}/999999", f"court/{run}/{'9' * 5000}", "court/other/0", "none/x/0"):
        status, headers, _ = ask(open_venue, path)
        assert (status, headers["Cache-Control"]) == (404, "public, max-age=1"), path
    assert [ask(open_venue, f"{one}/now.json")[0] for one in ("none", "court/none")] == [404, 404]


@pytest.mark.long
def test_a_cache_goes_on_without_the_gateway(venue: Venue, tmp_path: Path) -> None:
    """While the gateway is away, nginx answers with the pieces that it has, and says which."""
    (folder := tmp_path / "proxy").mkdir()
    port, name = free_port(), "localhost"
    pair = proxies.issue(tmp_path, trustme.CA(), name)
    venue.court()
    web = venue.web("--pages", f"https://{name}:{port}/lacoc", "--proxy", "127.0.0.1")
    trusting = ssl._create_unverified_context()

    def cached(path: str) -> bytes:
        url = f"https://{name}:{port}/lacoc/live/court/{path}"
        with urllib.request.urlopen(url, context=trusting) as reply:
            return bytes(reply.read())

    with proxies.nginx(folder, pair, name, port, f"127.0.0.1:{venue.web_port}"):
        until(lambda: json.loads(cached("now.json"))["closed"] > 1)
        run = json.loads(cached("now.json"))["run"]
        piece = cached(f"{run}/0")
        web.kill()
        time.sleep(2.5)  # longer than the answer may be kept
        assert json.loads(cached("now.json"))["run"] == run
        assert cached(f"{run}/0") == piece
        with pytest.raises(urllib.error.HTTPError, match="502"):
            cached(f"{run}/1")
