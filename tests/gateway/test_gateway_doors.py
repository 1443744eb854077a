"""Tests of whom a gateway lets in, and that bad input disturbs nobody else."""

import http.client
import json
import os
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgpack
import pytest
from page_client import PageClient, Refused, refusal
from venue import REFEREE, TOKENS, Venue
from waiting import LIMIT_S, until
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.home import ACTING_MOST
from lacoc_client.web.gateway.page import TRY_LATER
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.seat import BEATS_PER_S, Phase
from lacoc_shared.words import Phrase

pytestmark = pytest.mark.slow

ACTS: list[tuple[str, dict[str, Any]]] = [
    ("join", {"seat": "left", "token": TOKENS["left"], "name": "Ants"}),
    ("ready", {"ready": True}),
    ("leave", {}),
    ("key", {"level": 1, "key": 2, "match": 1, "beat": 2}),
    ("saw", {"match": 1, "beat": 2}),
    ("enter", {"token": REFEREE, "by": "Kim"}),
    ("take_over", {}),
    ("decide", {"decision": {"type": "abort"}, "reason": "x"}),
]


def get(venue: Venue, path: str, **headers: str) -> tuple[int, http.client.HTTPMessage, bytes]:
    """Fetch a path exactly as written, dots included; return status, headers and body."""
    connection = http.client.HTTPConnection("127.0.0.1", venue.web_port, timeout=LIMIT_S)
    try:
        connection.putrequest("GET", path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name.replace("_", "-"), value)
        connection.endheaders()
        response = connection.getresponse()
        return response.status, response.headers, response.read()
    finally:
        connection.close()


@pytest.mark.parametrize(
    "host",
    [
        "127.0.0.1:{port}",
        "localhost:{port}",
        "LOCALHOST",
        "[::1]:{port}",
        "192.168.7.9:80",
        "pages.example:{port}",
        "pages.example.",
        socket.gethostname(),
    ],
)
def test_the_names_of_this_machine_are_known(open_venue: Venue, host: str) -> None:
    """A request's host may be an IP address, localhost, this machine's name or the public one."""
    status, _, _ = get(open_venue, "/recordings", Host=host.format(port=open_venue.web_port))
    assert status == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "127.0.0.1.evil.example",
        "",
        "evil.example:80@127.0.0.1",
        "[::1]evil.example",
        "[::1].evil.example:80",
        "[evil.example]",
    ],
)
def test_a_foreign_name_is_refused(open_venue: Venue, host: str) -> None:
    """A foreign host name that points to this machine (DNS rebinding) is refused."""
    status, _, body = get(open_venue, "/recordings", Host=host)
    assert status in (400, 403)
    if status == 403:
        assert b"--pages" in body
    with (
        pytest.raises(InvalidStatus),
        connect(
            f"ws://evil.example:{open_venue.web_port}/ws",
            sock=socket.create_connection(("127.0.0.1", open_venue.web_port)),
        ),
    ):
        pass


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "http://127.0.0.1", "http://127.0.0.1:1", "file://", "x"],
)
def test_a_page_of_another_site_gets_no_socket(open_venue: Venue, origin: str) -> None:
    """A page of another site, known by its origin, can't open a WebSocket."""
    with (
        pytest.raises(InvalidStatus) as caught,
        connect(
            f"ws://127.0.0.1:{open_venue.web_port}/ws",
            origin=origin,  # type: ignore[arg-type]
        ),
    ):
        pass
    assert caught.value.response.status_code == 403


def test_the_own_page_gets_a_socket(open_venue: Venue) -> None:
    """A page of the gateway's own origin can open a WebSocket."""
    origin = f"http://127.0.0.1:{open_venue.web_port}"
    with PageClient(open_venue.url, origin=origin) as page:
        assert page.welcome["court"] == "main"


def test_a_slash_at_the_end_leads_to_the_page(open_venue: Venue) -> None:
    """The addresses on a page are relative, so it is shown without a slash."""
    status, headers, _ = get(open_venue, "/play/?court=main")
    assert (status, headers["Location"]) == (307, "../play?court=main")


def test_without_a_token_a_page_only_watches(open_venue: Venue) -> None:
    """A page that shows no token can neither steer nor decide."""
    with PageClient(open_venue.url) as page:
        for do, fields in ACTS:
            if do not in ("join", "enter"):
                seated = do not in ("take_over", "decide")
                with refusal("gateway.no-seat" if seated else "gateway.enter-first"):
                    page.ask(do, **fields)
        assert page.ask("ping", t=1.5)["t"] == 1.5


@pytest.mark.parametrize("token", ["", "wrong", "\u00e4" * 20, TOKENS["right"]])
def test_only_a_token_that_the_court_accepts_opens_a_seat(open_venue: Venue, token: str) -> None:
    """Whatever a page says of itself, the court decides about its token."""
    with PageClient(open_venue.url, key="x" * 22, token=token) as page:
        with pytest.raises(Refused):
            page.ask("join", seat="left", token=token, name="Ants")
        with pytest.raises(Refused):
            page.ask("enter", token=token, by="Kim")


def test_a_ping_says_how_far_the_court_is(open_venue: Venue) -> None:
    """Whoever pings hears how long the court takes to answer the gateway."""
    with PageClient(open_venue.url) as page:
        until(lambda: page.ask("ping")["court_ms"])


@pytest.mark.parametrize(("do", "fields"), ACTS, ids=[do for do, _ in ACTS])
def test_watch_comes_first(open_venue: Venue, do: str, fields: dict[str, Any]) -> None:
    """A page must ask to watch a court before it can act."""
    with (
        PageClient(open_venue.url, watch=False) as page,
        refusal("gateway.which-court"),
    ):
        page.ask(do, **fields)


def test_wrong_tokens_are_refused_and_can_not_be_guessed(open_venue: Venue) -> None:
    """Wrong tokens, seats and names are refused with different reasons; tries are limited."""
    with PageClient(open_venue.url, open_venue.key) as page:
        with refusal("refused.wrong-token"):
            page.ask("join", seat="left", token=TOKENS["right"], name="Ants")
        with refusal("refused.no-referee-token"):
            page.ask("enter", token=TOKENS["left"], by="Kim")
        with refusal("court.no-seat"):
            page.ask("join", seat="middle", token=TOKENS["left"], name="Ants")
        with refusal("gateway.no-token"):
            page.ask("join", seat="left", token=None, name="Ants")
        with refusal("refused.who-decides"):
            page.ask("enter", token=REFEREE, by=" ")
        said: set[str] = set()
        for _ in range(20):
            with pytest.raises(Refused) as caught:
                page.ask("enter", token="guess", by="Kim")
            said.add(caught.value.why.code)
        assert said == {"refused.no-referee-token", "gateway.too-many-tries"}
        assert page.referee == {"acting": None, "mine": False}


def test_wrong_files_come_back_as_mistakes(open_venue: Venue) -> None:
    """A join with wrong files is refused with a list of the mistakes (rules 2)."""
    wrong = {"name": "mine.txt", "data": b"Num of Posture\t1\n0 Key\t1\t2\tthree\n"}
    with PageClient(open_venue.url, open_venue.key) as page:
        with refusal("refused.mistakes") as caught:
            page.ask("join", seat="left", token=TOKENS["left"], name="Ants", postures=wrong)
        assert caught.value.mistakes[0]["file"] == "mine.txt"
        assert {"found", "expected"} <= set(caught.value.mistakes[0])


def test_an_unknown_court_is_said(open_venue: Venue) -> None:
    """A page that asks for an unknown court is refused, and learns the names of all courts."""
    with PageClient(open_venue.url, watch=False) as page:
        with refusal("gateway.no-court"):
            page.ask("watch", court="centre")
        assert page.welcome["courts"] == ["main"]
        assert page.welcome["court"] is None
        page.ask("watch")
        page.wait(lambda: page.frame)


@pytest.mark.parametrize(
    ("do", "fields", "is_too_long"),
    [
        ("dance", {}, False),
        ("watch", {"hz": "fast"}, False),
        ("watch", {"key": "k" * 201}, False),
        ("rate", {}, False),
        ("key", {"level": 2, "key": 1, "match": 1, "beat": 2}, False),
        ("key", {"level": 0, "key": 11, "match": 1, "beat": 2}, False),
        ("key", {"level": 0, "key": True, "match": 1, "beat": 2}, False),
        ("key", {"level": 0, "key": 1}, False),
        ("key", {"level": 0, "key": 1, "match": 1, "beat": -1}, False),
        ("saw", {"match": 2**54, "beat": 2}, False),
        ("decide", {"decision": {"type": "win"}, "reason": ""}, False),
        ("decide", {"decision": {"type": "abort"}, "reason": "x" * 5000}, True),
        ("ping", {"t": "x" * 5000}, True),
    ],
)
def test_what_is_not_understood_is_refused(
    open_venue: Venue, do: str, fields: dict[str, Any], is_too_long: bool
) -> None:
    """A request that makes no sense is refused, and the connection stays open."""
    with PageClient(open_venue.url, open_venue.key) as page:
        with refusal("gateway.bad-message") as caught:
            page.ask(do, **fields)
        error = caught.value.why.values["error"]
        assert isinstance(error, Phrase) == is_too_long
        page.ask("ping", t=1)


@pytest.mark.parametrize(
    "garbage",
    [b"", b"\xc1", b"\x93\x01\x02", msgpack.packb({"do": "ping"}), b"\x81" * 3000, "text"],
)
def test_garbage_ends_a_connection_and_nothing_else(
    open_venue: Venue, garbage: bytes | str
) -> None:
    """Bytes that no page sends end the connection on which they came, and no other."""
    with PageClient(open_venue.url) as page, PageClient(open_venue.url) as other:
        page.socket.send(garbage)
        page.wait(page.closed.is_set)
        other.ask("ping", t=1)


def test_a_message_without_end_is_cut_off(open_venue: Venue) -> None:
    """A message longer than any join ends its connection; a join with a large file is refused."""
    with PageClient(open_venue.url, open_venue.key) as page:
        page.socket.send(bytes(wire.JOIN_BYTES + 1))
        page.wait(page.closed.is_set)
    files = {"name": "x.txt", "data": bytes(60_000)}
    with PageClient(open_venue.url, open_venue.key) as page, pytest.raises(Refused):
        page.ask("join", seat="left", token=TOKENS["left"], name="A", postures=files)


@pytest.mark.parametrize("path", ["/", "/play", "/practice", "/referee", "/watch", "/replay"])
def test_pages_are_safe_from_other_sites(open_venue: Venue, path: str) -> None:
    """Headers keep other sites from embedding a page, and browsers from showing an old one."""
    status, headers, _ = get(open_venue, path)
    assert status in (200, 503)  # 503: not built
    policy = headers["Content-Security-Policy"]
    assert "default-src 'self'" in policy
    assert "frame-ancestors 'none'" in policy
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert headers["Cache-Control"] == ("no-cache" if status == 200 else "no-store")
    if status == 200:
        assert get(open_venue, path, **{"If-None-Match": headers["ETag"]})[0] == 304


def test_the_overlay_may_be_embedded(open_venue: Venue) -> None:
    """Other sites may embed the overlay, because it takes no input."""
    _, headers, _ = get(open_venue, "/overlay")
    assert "frame-ancestors *" in headers["Content-Security-Policy"]


@pytest.fixture(scope="module")
def records(open_venue: Venue) -> Iterator[Path]:
    """Give the folder of the venue's recordings; a secret file lies outside it."""
    folder = open_venue.folder / "recordings"
    (folder / "first match.mcap").write_bytes(b"first")
    os.utime(folder / "first match.mcap", (1_700_000_000, 1_700_000_000))
    (folder / "second.mcap").write_bytes(b"0123456789")
    (folder / "notes.txt").write_text("mine")
    (open_venue.folder / "secret.mcap").write_bytes(b"secret")
    yield folder
    for name in ("first match.mcap", "second.mcap", "notes.txt"):
        (folder / name).unlink()


def test_recordings_are_listed_and_fetched(open_venue: Venue, records: Path) -> None:
    """Recordings are listed with the newest first, and can be fetched whole or in part."""
    _, headers, body = get(open_venue, "/recordings")
    listed = json.loads(body)
    assert headers["Cache-Control"] == "public, max-age=1"
    assert [entry["name"] for entry in listed] == ["second.mcap", "first match.mcap"]
    assert listed[0]["bytes"] == 10
    assert get(open_venue, "/recordings", **{"If-None-Match": headers["ETag"]})[0] == 304
    _, headers, body = get(open_venue, "/recordings/first%20match.mcap")
    assert (body, headers["Cache-Control"][-9:]) == (b"first", "immutable")
    again = {"If-None-Match": headers["ETag"]}
    assert get(open_venue, "/recordings/first%20match.mcap", **again)[0] == 304
    status, _, body = get(open_venue, "/recordings/second.mcap", Range="bytes=2-4")
    assert (status, body) == (206, b"234")


@pytest.mark.parametrize(
    "path",
    [
        "/recordings/../secret.mcap",
        "/recordings/..%2fsecret.mcap",
        "/recordings/%2e%2e/secret.mcap",
        "/recordings/..%5csecret.mcap",
        "/recordings/notes.txt",
        "/recordings/nothing.mcap",
        "/recordings/%00.mcap",
        "/recordings//etc/passwd",
        "/assets/../../page_client.py",
        "/assets/..%2f..%2fcontroller.py",
        "/assets/%2fetc%2fpasswd",
        "/assets/%00",
        "/..%2fcontroller.py",
        "/%2e%2e",
        "/.",
    ],
)
def test_no_path_leads_out(open_venue: Venue, records: Path, path: str) -> None:
    """A path that leads to no recording and no file of the pages gets a 404."""
    status, _, body = get(open_venue, path)
    assert status == 404
    assert b"secret" not in body


def test_pages_beyond_the_most_are_sent_away(venue: Venue) -> None:
    """A page beyond the limit is sent away and told why; when a page leaves, another may come."""
    venue.court()
    venue.web("--viewers", "2")
    first, second = venue.page(), venue.page()
    third = venue.page(watch=False)
    with refusal("gateway.full"):
        third.ask("watch")
    third.wait(third.closed.is_set)
    assert third.code() == TRY_LATER
    second.close()
    deadline_s = time.monotonic() + LIMIT_S
    while True:
        fourth = venue.page(watch=False)
        try:
            fourth.ask("watch")
            break
        except Refused:
            assert time.monotonic() < deadline_s
    first.ask("ping", t=1)


def test_a_full_hall_keeps_nobody_from_the_seats(venue: Venue) -> None:
    """When all spectators' places are taken, pages with the page key can still connect."""
    venue.court()
    venue.web("--viewers", "1")
    venue.page()
    contestant = venue.contestant("left")
    contestant.close()
    contestant = venue.contestant("left")
    referee = venue.referee()
    with refusal("gateway.full"):
        referee.ask("watch")
    contestant.ask("watch", token=TOKENS["left"])  # the page keeps its own place


@pytest.mark.long
def test_pages_of_contestants_have_a_bound_too(venue: Venue) -> None:
    """Pages whose token is right have a limit of their own, and take no spectator's place."""
    venue.court()
    venue.web()
    venue.contestant("left")
    for _ in range(ACTING_MOST - 1):
        venue.page(token=TOKENS["left"], hz=1)
    one_more = venue.page(watch=False)
    with refusal("gateway.full-acting"):
        one_more.ask("watch", token=TOKENS["left"])
    one_more.wait(one_more.closed.is_set)
    assert one_more.code() == TRY_LATER
    venue.page()


@pytest.mark.long(minutes=0.3)
def test_a_token_that_is_shown_to_no_court_keeps_no_place(venue: Venue) -> None:
    """In a full hall a page with a token is let in, and goes if it does not show it in time."""
    venue.court()
    venue.web("--viewers", "1")
    venue.page()
    idle = venue.page(token="guess")
    with refusal("gateway.full"):
        venue.page()
    idle.wait(idle.closed.is_set)
    assert idle.code() == TRY_LATER


def why_not(page: PageClient, number: int) -> str:
    """Return why a request was refused; "" if it was not refused."""
    try:
        page.reply(number)
    except Refused as refused:
        return str(refused)
    return ""


def test_a_match_is_not_sent_again_and_again(open_venue: Venue) -> None:
    """A page that asks to watch a hundred times gets the whole match only a few times.

    The page then goes on watching, and may ask again a second later.
    """
    with PageClient(open_venue.url, watch=False) as page:
        begin_s = time.monotonic()
        said = [why_not(page, number) for number in [page.send("watch") for _ in range(100)]]
        took_s = time.monotonic() - begin_s
        assert set(said) == {"", "Too many tries. Wait a few seconds."}
        assert 5 <= said.count("") <= 6 + took_s
        assert page.order.count(MessageKind.SCENE) <= said.count("")
        page.wait(lambda: page.frame)
        time.sleep(1.1)  # the limit is a number of requests in a time
        page.ask("watch")


@pytest.mark.long
def test_a_flood_of_one_page_does_not_disturb_a_seat(venue: Venue) -> None:
    """While other pages flood the gateway, most keys of a contestant take effect within 8 beats."""
    venue.court()
    venue.web()
    left, right = venue.contestant("left"), venue.contestant("right")
    referee = venue.referee()
    referee.phase(Phase.READY)
    referee.ask("decide", decision={"type": "start"}, reason="")
    left.phase(Phase.PLAYING)
    right.phase(Phase.PLAYING)
    flooding = [venue.page(), venue.page(venue.key), right]
    end_s = time.monotonic() + 4
    ping = msgpack.packb({"id": 1, "do": "ping", "t": 1})
    key = msgpack.packb({"id": 1, "do": "key", "level": 1, "key": 3, "match": 1, "beat": 1})

    def flood(page: PageClient, message: bytes) -> None:
        while time.monotonic() < end_s:
            page.socket.send(message)

    threads = [
        threading.Thread(target=flood, args=(page, message), daemon=True)
        for page, message in zip(flooding, (ping, ping, key), strict=True)
    ]
    for thread in threads:
        thread.start()
    waits_beats = []
    while time.monotonic() < end_s:
        for digit in (1, 2):
            assert left.frame is not None
            pressed = left.frame.beat
            seq = left.press(level=1, key=digit)
            left.wait_own(lambda own, seq=seq: own.applied_seq >= seq)  # type: ignore[misc]
            waits_beats.append(left.frame.beat - pressed)
    assert sorted(waits_beats)[len(waits_beats) // 2] < 8
    assert max(waits_beats) < BEATS_PER_S
    assert referee.frame is not None
    assert not any(event.kind == "silent" and event.seat == 0 for event in referee.events)
