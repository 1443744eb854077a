"""Tests of the parts of a gateway that need no court."""

import asyncio
import contextlib
import gzip
import os
import re
import socket
import threading
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast, get_args
from urllib.request import urlopen

import msgpack
import msgspec
import pytest
from aside import run_async
from hypothesis import given
from hypothesis import strategies as st
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket
from waiting import LIMIT_S
from websockets.sync.client import connect

from lacoc_client.play.asking import NoAnswer, NoCourt, NotNow
from lacoc_client.play.controller import Hold
from lacoc_client.web.gateway import home, page_seat, page_socket, published, server, wire
from lacoc_client.web.gateway.answers import Answers
from lacoc_client.web.gateway.browser import open_browser
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.crowd import Crowd
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_client.web.gateway.files import NOT_BUILT, PageFiles
from lacoc_client.web.gateway.guard import Guard
from lacoc_client.web.gateway.page import Page
from lacoc_client.web.gateway.page_seat import PageSeat
from lacoc_client.web.gateway.recordings import Recordings
from lacoc_client.web.gateway.rules_route import rules_route
from lacoc_client.web.gateway.site import PATHS, sheet_route
from lacoc_client.web.gateway.threads import Threads
from lacoc_client.web.gateway.viewer import Frames, Viewer
from lacoc_shared.codec import encode
from lacoc_shared.contest.access import Access
from lacoc_shared.keyspace import EVENTS_LISTED
from lacoc_shared.messages import Event
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.event_log import EventLog
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import say

PAGE = (Path(__file__).parents[2] / "docs" / "gateway.md").read_text(encoding="utf-8")


def rows(title: str) -> list[list[str]]:
    """Return the cells of the table in a section of docs/gateway.md, without the table's head."""
    match = re.search(rf"^## {title}\n(.*?)(?=^##|\Z)", PAGE, re.MULTILINE | re.DOTALL)
    assert match
    lines = [line for line in match[1].splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no pipes by name")
def test_only_regular_files_are_recordings(tmp_path: Path) -> None:
    """A link or a pipe in the folder of recordings is neither listed nor served, nor its odds."""
    (tmp_path / "secret").write_bytes(b"{}")
    folder = tmp_path / "recordings"
    folder.mkdir()
    (folder / "true.mcap").write_bytes(b"")
    (folder / "link.mcap").symlink_to(tmp_path / "secret")
    os.mkfifo(folder / "pipe.mcap")
    (folder / "true.odds.json").symlink_to(tmp_path / "secret")
    recordings = Recordings(folder, list)
    try:
        assert [one.name for one in recordings.listed()] == ["true.mcap"]
        assert recordings.find("true.mcap") == folder / "true.mcap"
        assert recordings.find("link.mcap") is recordings.find("pipe.mcap") is None
        assert recordings.odds("true.mcap") is None
        (folder / "true.odds.json").unlink()
        (folder / "true.odds.json").write_bytes(b"{}")
        assert recordings.odds("true.mcap") == b"{}"
    finally:
        recordings.close()


def test_the_document_has_every_kind() -> None:
    """docs/gateway.md has the number and name of each kind of message to a page."""
    found = [(int(number), name.upper()) for number, name, _ in rows("Gateway to page")]
    assert found == [(kind.value, kind.name) for kind in wire.MessageKind]


def test_the_document_has_every_request_with_its_fields() -> None:
    """docs/gateway.md has each request of a page with all its fields."""
    found = {do.strip("`"): set(re.findall(r"`(\w+)`", f)) for do, f, _ in rows("Page to gateway")}
    expected = {
        str(kind.__struct_config__.tag): {field.name for field in msgspec.structs.fields(kind)}
        - {"id"}
        for kind in get_args(wire.Asked)
    }
    assert found == expected


def test_the_document_has_every_path_and_hold() -> None:
    """docs/gateway.md names each path of a page, and each state of a page's hold on its seat."""
    assert re.findall(r"`([^`]+)`", rows("Paths")[0][0]) == list(PATHS)
    for hold in set(Hold) - {Hold.NOT_JOINED}:
        assert f"`{hold.value}`" in PAGE


@given(st.binary(max_size=300))
def test_no_bytes_of_a_page_break_the_reader(data: bytes) -> None:
    """Reading any bytes from a page returns a request or raises only `Unreadable`."""
    with contextlib.suppress(wire.Unreadable):
        wire.read(data)
    wire.read_id(data)


@given(
    st.dictionaries(
        st.sampled_from(["id", "do", "seat", "token", "level", "key", "hz", "decision", "court"]),
        st.none() | st.integers(-(2**63), 2**64 - 1) | st.floats() | st.text() | st.binary(),
    )
)
def test_no_map_of_a_page_breaks_the_reader(fields: dict[str, Any]) -> None:
    """Reading any map with fields of requests returns a request or raises only `Unreadable`."""
    data = msgpack.packb(fields, unicode_errors="surrogatepass")
    with contextlib.suppress(wire.Unreadable):
        wire.read(data)
    wire.read_id(data)


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (UserError("no"), set()),
        (NotNow("later"), {"again"}),
        (NoCourt("nobody"), set()),
        (NoAnswer("perhaps"), {"unanswered"}),
        (wire.TokenRefused("no"), {"token_refused"}),
    ],
)
def test_a_refusal_says_what_a_page_can_do(error: UserError, told: set[str]) -> None:
    """A refusal says whether to ask again, whether the token is wrong, or that no answer came."""
    body = msgpack.unpackb(wire.refusal(7, error)[3:])
    assert {name for name, value in body.items() if value is True} == told
    assert (body["id"], body["error"]) == (7, msgspec.to_builtins(error.phrase))


@pytest.mark.parametrize("size", [0, 1, 124, 125, 126, 65_534, 65_535, 70_000])
def test_a_message_is_a_websocket_frame(size: int) -> None:
    """A message becomes a WebSocket frame, whose length has one of RFC 6455's three forms."""
    framed = wire.message(wire.MessageKind.EVENT, bytes(size))
    assert framed[0] == 0x82
    length, head = framed[1], 2
    if length == 126:
        length, head = int.from_bytes(framed[2:4]), 4
        assert length >= 126
    elif length == 127:
        length, head = int.from_bytes(framed[2:10]), 10
        assert length >= 65_536
    assert length == size + 1 == len(framed) - head
    assert framed[head] == wire.MessageKind.EVENT


class Wire:
    """A page's socket that keeps what is written; if `keeps_up` is False, it is too slow."""

    def __init__(self) -> None:
        self.written: list[bytes] = []
        self.keeps_up = True
        self.drained: Any = None

    def write(self, framed: bytes) -> None:
        self.written.append(framed)

    def watch_closely(self) -> None:
        return


def test_a_viewer_has_one_slot() -> None:
    """While a page is too slow, only the newest frame waits for it."""
    socket = Wire()
    viewer = Viewer(socket)  # type: ignore[arg-type]
    viewer.rate(50)
    socket.keeps_up = False
    for number in range(20):
        viewer.offer(b"%d" % number, number * 0.02)
    viewer.send_if_fast(b"health")
    assert socket.written == []
    viewer.send(b"event")
    socket.drained()
    assert socket.written == [b"event", b"19"]
    socket.drained()
    assert socket.written == [b"event", b"19"]
    assert viewer.frames == Frames(sent=1, dropped=19)


@pytest.mark.parametrize(
    ("hz", "expected"),
    [(50, 500), (25, 250), (10, 100), (1, 10), (0, 10), (-3, 10), (1e9, 500), (float("nan"), 500)],
)
def test_a_viewer_gets_its_rate(hz: float, expected: int) -> None:
    """A page gets its rate of frames in spite of jitter; an invalid rate is made a valid one."""
    socket = Wire()
    viewer = Viewer(socket)  # type: ignore[arg-type]
    viewer.rate(hz)
    for beat in range(500):
        viewer.offer(b"%d" % beat, 100 + beat * 0.02 + (beat * 7 % 5 - 2) * 0.002)
    assert len(socket.written) == pytest.approx(expected, rel=0.02, abs=1)


def test_a_page_hears_nothing_of_the_seat_it_had_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """After a page joins again, it gets no more messages from the thread of its earlier join."""
    tells: list[Any] = []

    class Thread:
        def __init__(self, *args: Any) -> None:
            tells.append(args[4])

        def end(self) -> None:
            return

    async def told() -> list[str]:
        socket = Wire()
        viewer = Viewer(socket)  # type: ignore[arg-type]
        seat = PageSeat(viewer, Answers(viewer, print), None, lambda *_, **__: None)
        for _ in range(2):
            seat.join(
                wire.JoinAsk(id=1, seat="left", token="one"),
                Access(court="main", connect="127.0.0.1:1"),
                lambda *_: None,
            )
        for tell, hold in zip(tells, ("replaced", "held"), strict=True):
            tell({"seat": "left", "hold": hold, "reason": None})
        await asyncio.sleep(0)  # what threads tell goes through the loop
        return [msgpack.unpackb(framed[3:])["hold"] for framed in socket.written]

    monkeypatch.setattr(page_seat, "SeatThread", Thread)
    assert run_async(told) == ["held"]


TRY = wire.TryAsk(id=1, keys=(), first=0, until=0)


class TryingThread:
    """A seat's thread whose court answers no question about keys before `released` is set."""

    def __init__(self) -> None:
        self.released = threading.Event()

    def do(self, job: Any, answer: Any) -> None:
        asks = SimpleNamespace(try_out=lambda *_: lambda: self.released.wait(LIMIT_S))
        answer(job(asks), None)


def test_a_page_tries_keys_one_after_another() -> None:
    """Who asks again before the answer has come is told to ask later; after it the page may ask."""
    threads, thread = Threads(2), TryingThread()

    async def asks() -> bool:
        viewer = Viewer(Wire())  # type: ignore[arg-type]
        seat = PageSeat(viewer, Answers(viewer, print), None, lambda *_, **__: None)
        seat._thread = cast("Any", thread)
        first = asyncio.ensure_future(seat.try_out(TRY, threads))
        await asyncio.sleep(0)
        refused = asyncio.ensure_future(seat.try_out(TRY, threads))
        await asyncio.sleep(0)
        thread.released.set()
        with pytest.raises(NotNow):
            await refused
        return bool(await first and await seat.try_out(TRY, threads))

    assert run_async(asks)
    threads.close()


def test_players_who_try_keys_hold_up_no_referee() -> None:
    """While many pages wait for a slow court, a decision goes to its court at once."""
    thread = TryingThread()

    async def decides() -> None:
        courts = Courts(home.Home(courts={}))
        for _ in range(40):
            socket = SimpleNamespace(state=SimpleNamespace(socket=Wire()), client=None)
            page = Page(cast("Any", socket), courts, Crowd(courts))
            page._feed, page._referees = cast("Any", (object(), object()))
            page._seat._thread = cast("Any", thread)
            await page._answer(TRY)
        for _ in range(10):
            await asyncio.sleep(0)  # now all of them wait for a thread, or have one
        try:
            await asyncio.wait_for(courts.threads.run(lambda: None), LIMIT_S / 2)
        finally:
            thread.released.set()
            await courts.close()

    run_async(decides)


def event(number: int, text: str = "", match: int = 1, beat: int = 0) -> Event:
    return Event(
        number=number,
        match=match,
        beat=beat,
        clock_ticks=0,
        kind="phase",
        said=say("plain.text", text=text),
    )


def test_a_log_that_begins_again() -> None:
    """A repeated event changes nothing; a different one replaces the log from its number on."""
    log: EventLog[str] = EventLog()
    assert [log.add(event(n, "old"), f"old {n}") for n in (1, 2, 3)] == [True] * 3
    assert [log.add(event(n, "old"), "again") for n in (1, 2, 3)] == [False] * 3
    assert (list(log), log.number) == (["old 1", "old 2", "old 3"], 0)
    assert log.add(event(2, "new"), "new 2")
    assert (list(log), log.number) == (["old 1", "new 2"], 1)
    assert log.add(event(3, "new"), "new 3")
    assert log.number == 1
    assert log.add(event(1, "next", match=2), "next 1")
    assert (list(log), log.number) == (["next 1"], 2)


def test_a_log_is_held_against_what_the_court_says() -> None:
    """`differs` notices if a log lacks an event of the court, or has one that the court lacks.

    An event that is newer than the court's report is no difference.
    """
    log: EventLog[str] = EventLog()
    assert not log.differs(1, 0, 0)
    assert log.differs(1, 500, 3)
    for number in (1, 2, 3):
        log.add(event(number, "a", beat=number), f"live {number}")
    said = [(1, 2, 3), (1, 2, 2), (1, 3, 2), (1, 9999, 3), (1, 9999, 4), (2, 0, 1), (1, 0, 0)]
    assert [log.differs(*one) for one in said] == [False, False, True, False, True, True, False]
    log.add(event(5, "a"), "live 5")
    assert log.differs(1, 0, 0)


def test_the_courts_list_stands_for_the_log() -> None:
    """The court's list replaces the log; `restore` returns the events that the log did not have."""
    log: EventLog[str] = EventLog()
    for number in (4, 5):
        log.add(event(number, "a"), f"live {number}")
    whole = [(event(n, "a"), f"listed {n}") for n in range(1, 7)]
    assert [one.number for one in log.restore(whole)] == [1, 2, 3, 6]
    assert (list(log), log.number) == ([f"listed {n}" for n in range(1, 7)], 1)
    assert (log.restore(whole), log.number) == ([], 1)
    assert [one.number for one in log.restore([(event(1, "b"), "b 1")])] == [1]
    assert (list(log), log.number) == (["b 1"], 2)
    assert (log.restore([]), list(log), log.number) == ([], [], 3)


def test_events_that_come_before_an_older_list_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """An event that comes while a list without it is under way is taken in after the list."""
    threads = Threads(1)
    feed = CourtFeed(Access(court="main", connect="tcp/127.0.0.1:1"), threads)

    async def listed(key: str) -> bytes:
        feed._take_event(encode(event(2)))
        return encode((event(1),))

    async def known() -> int:
        await feed._fetch_log()
        feed._take_event(encode(event(3)))
        return len(feed.picture.log)

    monkeypatch.setattr(feed, "_ask", listed)
    assert run_async(known) == 3
    threads.close()


def test_the_newest_of_a_very_long_log_are_kept() -> None:
    """A log keeps only its newest events, as a court does, and still counts as complete."""
    log: EventLog[int] = EventLog()
    for number in range(1, 3 * EVENTS_LISTED):
        log.add(event(number, "a"), number)
    assert list(log) == [*range(2 * EVENTS_LISTED, 3 * EVENTS_LISTED)]
    assert not log.differs(1, 0, 3 * EVENTS_LISTED - 1)
    assert log.add(event(1, "next", match=2), 1)
    assert (list(log), log.differs(2, 0, 1)) == ([1], False)


def test_what_a_court_does_not_list_any_more_is_not_missed() -> None:
    """Events that are so old that a court no longer lists them do not count as missing."""
    log: EventLog[str] = EventLog()
    log.add(event(90, "a"), "live 90")
    assert log.restore([(event(n, "a"), f"listed {n}") for n in range(50, 91)])
    assert not log.differs(1, 0, 90)
    log.add(event(92, "a"), "live 92")
    assert log.differs(1, 0, 0)
    log.add(event(1, "b", match=2), "next 1")
    assert not log.differs(2, 0, 1)


@pytest.mark.parametrize(
    "where", ["", "here", "127.0.0.1", ":80", "127.0.0.1:99999", "no.such.name.example:0", "[::1"]
)
def test_a_wrong_place_to_listen_is_said(where: str) -> None:
    """A gateway refuses a wrong address to listen at, and the error says so."""
    with pytest.raises(UserError, match=r"not a place to listen|can't listen"):
        server.listen(where)


def test_a_port_that_is_in_use_is_said() -> None:
    """If a gateway's port is in use, the error asks for another port."""
    with server.listen("127.0.0.1:0") as opened:
        address = opened.url
        with pytest.raises(UserError, match="choose another port"):
            server.listen(address.removeprefix("http://"))


def test_small_messages_do_not_wait_for_the_one_before() -> None:
    """Nagle's algorithm, which once delayed frames by 40 ms, is off in a gateway's connections."""

    async def asked() -> bool:
        found: asyncio.Future[int] = asyncio.get_running_loop().create_future()

        def accepted(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            raw = writer.get_extra_info("socket")
            found.set_result(raw.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
            writer.close()

        with server.listen("127.0.0.1:0") as opened:
            async with await asyncio.start_server(accepted, sock=opened.socket):
                _, writer = await asyncio.open_connection(*opened.socket.getsockname())
                writer.close()
                return bool(await found)

    assert run_async(asked)


def test_no_page_key_is_like_another() -> None:
    """Page keys are random and too long to be guessed."""
    keys = {home.new_key() for _ in range(100)}
    assert len(keys) == 100
    assert min(map(len, keys)) >= 22


def test_browsers_without_a_screen_are_not_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a screen no browser is opened: a text browser would take over the terminal."""
    monkeypatch.setattr("sys.platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    assert open_browser("http://127.0.0.1:1/") is False


@given(st.text(), st.text())
def test_no_header_breaks_the_guard(host: str, origin: str) -> None:
    """Random host and origin headers are refused without an exception."""
    guard = Guard(None, PublicAddress.of("https://pages.example"))  # type: ignore[arg-type]
    headers = [
        (b"host", host.encode("latin-1", "replace")),
        (b"origin", origin.encode("latin-1", "replace")),
    ]
    assert guard._why_not({"type": "websocket", "scheme": "ws", "headers": headers})


def test_a_sheet_is_sent_only_if_it_has_changed(tmp_path: Path) -> None:
    """A page that has the newest sheet gets 304; else it gets the sheet, gzipped if it can be."""
    path = tmp_path / "contest.json"
    endpoint = cast(Route, sheet_route(path)).endpoint

    def ask(**headers: str) -> Response:
        scope = {"type": "http", "path": "/contest.json", "headers": []}
        scope["headers"] = [
            (name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()
        ]
        return run_async(lambda: endpoint(Request(scope)))

    assert ask().status_code == 404
    path.write_text("[1]" * 1000)
    first = ask()
    assert first.body == path.read_bytes()
    same = ask(if_none_match=first.headers["etag"])
    assert (same.status_code, same.body) == (304, b"")
    path.write_text("[2]" * 1000)
    os.utime(path, ns=(1, 1))
    newer = ask(if_none_match=first.headers["etag"], accept_encoding="gzip, br")
    assert newer.status_code == 200
    assert gzip.decompress(bytes(newer.body)) == path.read_bytes()
    assert newer.headers["etag"] != first.headers["etag"]


def test_pages_that_are_not_built_can_not_be_published(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever publishes a contest without built pages is told how to build them."""
    monkeypatch.setattr(published, "PAGES", tmp_path)
    with pytest.raises(UserError) as refused:
        published.write_pages(tmp_path)
    assert refused.value.phrase == NOT_BUILT


@pytest.mark.parametrize(
    "part", [b"", b"GET / HT", b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n"]
)
def test_half_a_request_is_given_up(monkeypatch: pytest.MonkeyPatch, part: bytes) -> None:
    """A connection that never sends a whole request is closed; a whole one is answered."""
    monkeypatch.setattr(page_socket, "REQUEST_S", 0.05)

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            while (await receive()).get("more_body"):
                pass
            await PlainTextResponse("whole")(scope, receive, send)

    opened, ended = server.listen("127.0.0.1:0"), threading.Event()
    thread = threading.Thread(target=server.serve, args=(app, opened, ended.is_set))
    thread.start()
    try:
        with socket.create_connection(opened.socket.getsockname(), LIMIT_S) as half:
            half.sendall(part)
            with contextlib.suppress(ConnectionResetError):
                assert half.recv(1) == b""
        monkeypatch.setattr(page_socket, "REQUEST_S", LIMIT_S)
        with socket.create_connection(opened.socket.getsockname(), LIMIT_S) as whole:
            whole.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            assert whole.recv(100).startswith(b"HTTP/1.1 200")
    finally:
        ended.set()
        thread.join()


def test_a_page_stays_connected_longer_than_a_request(monkeypatch: pytest.MonkeyPatch) -> None:
    """The limit of a request ends no WebSocket, however long it is open."""
    monkeypatch.setattr(page_socket, "REQUEST_S", 0.5)

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            page = WebSocket(scope, receive, send)
            await page.accept()
            await page.send_text(await page.receive_text())

    opened, ended = server.listen("127.0.0.1:0"), threading.Event()
    thread = threading.Thread(target=server.serve, args=(app, opened, ended.is_set))
    thread.start()
    try:
        with connect(f"ws://127.0.0.1:{opened.socket.getsockname()[1]}/") as page:
            time.sleep(0.8)
            page.send("still here")
            assert page.recv(LIMIT_S) == "still here"
    finally:
        ended.set()
        thread.join()


def test_a_file_is_kept_once_however_it_is_asked_for(tmp_path: Path) -> None:
    """The gateway keeps a file under its real path, not under each spelling of a path."""
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "x.js").write_text("let x;")
    files = PageFiles(tmp_path)
    spellings = ["assets/x.js", "assets/./x.js", "assets/././x.js", "assets/../assets/x.js"]
    found = {id(files.find(name)) for name in spellings}
    assert len(found) == 1
    assert len(files._files) == 1


@pytest.mark.parametrize(
    ("language", "begins"),
    [("en", b"# The rules"), ("ja", "# 競技ルール".encode()), ("xx", b"# The rules")],
)
def test_all_rules_can_be_read_without_the_internet(language: str, begins: bytes) -> None:
    """A gateway gives the rules as a text, in the reader's language if they are translated."""
    opened, ended = server.listen(server.LOOPBACK), threading.Event()
    serving = threading.Thread(
        target=server.serve, args=(Starlette(routes=[rules_route()]), opened, ended.is_set)
    )
    serving.start()
    try:
        with urlopen(f"{opened.url}/rules/{language}", timeout=LIMIT_S) as answer:
            text = answer.read()
    finally:
        ended.set()
        serving.join(LIMIT_S)
    assert answer.headers.get_content_type() == "text/plain"
    assert text.startswith(begins)
