"""Tests of who watches and what they cheer."""

import json
import urllib.error
import urllib.request
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from page_connection import Refused
from venue import Venue

from lacoc_client.web.gateway.audience import Audience
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.crowd import HEARD_MOST, LOOKS_S, SYMBOLS, Crowd
from lacoc_client.web.gateway.home import Home
from lacoc_client.web.gateway.wire import MessageKind, opened
from lacoc_shared.codec import decode
from lacoc_shared.contest.access import Access

COURTS = {"main": Access(court="main", connect="tcp/127.0.0.1:1")}


class Watcher:
    """A page of an audience that keeps what it is told."""

    is_page, can_act = True, False

    def __init__(self) -> None:
        self.told: list[dict[str, Any]] = []

    def send_if_fast(self, framed: bytes) -> None:
        kind, payload = opened(framed)
        assert kind is MessageKind.CROWD
        self.told.append(decode(payload, dict))


def crowd(*, cheers: bool = True) -> tuple[Crowd, Audience, Watcher]:
    audience, watcher = Audience(), Watcher()
    audience.add(watcher)  # type: ignore[arg-type]
    return Crowd(Courts(Home(COURTS, cheers=cheers))), audience, watcher


@given(st.integers(1, 30_000))
def test_a_share_of_a_crowd_stands_for_all(size: int) -> None:
    """However many pages watch in pieces, few must speak, and the number is right."""
    found, audience, _ = crowd()
    for _ in range(4 * LOOKS_S):  # each second a tenth of the pages looks, and a share speaks
        speaks = size / LOOKS_S * found.share
        for _ in range(round(speaks)):
            found.hear(audience, [])
        found.pass_second()
    assert found.share <= 1
    assert abs(found.watching() - size) <= max(LOOKS_S, 0.2 * size)
    assert size * found.share <= 1.3 * HEARD_MOST + LOOKS_S


def test_pages_that_report_unasked_end_no_count() -> None:
    """Reports that nobody asked for are believed, but their number has an end."""
    found, audience, watcher = crowd()
    for _ in range(200):
        for _ in range(80):
            found.hear(audience, [10])
        found.say(audience, found.watching())
        found.pass_second()
    assert watcher.told[-1]["watching"] < 10**9


def test_cheers_are_counted_by_symbol_and_told_once() -> None:
    """Each second all pages are told how often each symbol was cheered since."""
    found, audience, watcher = crowd()
    for symbol in (0, 2, 2, SYMBOLS, -1):
        found.cheer(audience, symbol)
    found.hear(audience, [0, 3, 0, 10_000])
    found.say(audience, 5)
    found.pass_second()
    found.say(audience, 5)
    assert [one["cheers"] for one in watcher.told] == [[1, 3, 2, LOOKS_S], [0, 0, 0, 0]]
    assert {one["watching"] for one in watcher.told} == {5}


def test_an_organiser_may_have_no_cheers() -> None:
    """Where a contest wants none, none is counted."""
    found, audience, watcher = crowd(cheers=False)
    found.cheer(audience, 0)
    found.hear(audience, [5])
    found.say(audience, 5)
    assert watcher.told[0]["cheers"] == [0, 0, 0, 0]


def here(venue: Venue, picture: str, body: bytes) -> int:
    request = urllib.request.Request(f"{venue.url}/live/{picture}/here", data=body)
    try:
        with urllib.request.urlopen(request) as reply:
            return int(reply.status)
    except urllib.error.HTTPError as error:
        return error.code


@pytest.mark.slow
def test_pages_cheer(open_venue: Venue) -> None:
    """Pages on WebSockets and in pieces cheer, at most once a second; all see how often."""
    with open_venue.page() as one, open_venue.page() as other:
        one.wait(lambda: one.crowd.get("watching") == 2)
        for _ in range(5):
            other.ask("cheer", symbol=1)
        one.wait(lambda: one.cheers[1] == 1)
        with pytest.raises(Refused, match="symbol"):
            other.ask("cheer", symbol=9)
        with urllib.request.urlopen(f"{open_venue.url}/live/court/now.json") as reply:
            assert json.load(reply)["share"] == 1
        assert here(open_venue, "court", b'{"cheers": [0, 0, 2]}') == 204
        one.wait(lambda: one.cheers == [0, 1, 2, 0] and one.crowd["watching"] == 3)
        for wrong in (b"", b"[]", b'{"cheers": [1, 2, 3, 4, 5]}', b'{"cheers": [-1]}', b"x" * 999):
            assert here(open_venue, "court", wrong) == 400
        assert here(open_venue, "none", b'{"cheers": []}') == 204
