"""The link of a seat whose player is on a page: the court hears of the frames that the page showed.

The page's requests, the seat's thread, the controller and the court's doors are real.
"""

import asyncio
import time
from collections.abc import Callable
from typing import Any

import pytest
from aside import run_async
from court_stub import TOKENS, CourtStub
from waiting import LIMIT_S, until

from lacoc_client.play.controller import Controller, SeenFrame
from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.answers import Answers
from lacoc_client.web.gateway.page_seat import PageSeat
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_shared.contest.access import Access
from lacoc_shared.inputs import HeardSeat, JoinSeat, KeySeat, SilentSeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import Session
from lacoc_shared.seat import FRESH_BEATS


class _Socket:
    """A page's WebSocket whose page answers every ping, whatever its tab does."""

    drained: Callable[[], None]
    keeps_up = True

    def __init__(self) -> None:
        self.written: list[bytes] = []

    @property
    def heard_s(self) -> float:
        return time.monotonic()

    def watch_closely(self) -> None:
        return

    def write(self, framed: bytes) -> None:
        self.written.append(framed)


def _beat(court: CourtStub) -> int:
    """Return a beat whose frame was sent already."""
    beats: list[int] = []
    court.in_a_beat(lambda: beats.append(court.beat))
    until(lambda: beats)
    return beats[0] - 1


def test_the_court_gets_the_frame_that_the_page_showed(court: CourtStub) -> None:
    """A key and a sign of life of a page name the page's frames, however new the gateway's are."""

    async def steer() -> None:
        socket: Any = _Socket()
        viewer = Viewer(socket)
        seat = PageSeat(viewer, Answers(viewer, print), None, lambda *_, **__: None)

        async def hears(condition: Callable[[], Any]) -> None:
            async with asyncio.timeout(LIMIT_S):
                while not condition():
                    await asyncio.sleep(0.005)

        way = Access(court="main", connect=court.address)
        ask = wire.JoinAsk(id=1, seat="left", token=TOKENS["left"], name="Ants")
        seat.join(ask, way, lambda *_: None)
        await hears(lambda: court.beat > 60)
        await hears(lambda: court.network.seat_health(0.0)[0].session)
        seat.steer(wire.SawAsk(id=2, match=1, beat=17))
        await hears(lambda: court.named() == (1, 17))
        seat.steer(wire.KeyAsk(id=3, level=1, key=2, match=1, beat=31))
        await hears(court.keys)
        key = next(one for one in court.inputs if isinstance(one, KeySeat))
        assert (key.key, key.seen) == (2, 31)
        assert court.named() == (1, 31)
        seat.leave()

    run_async(steer)
    assert court.refused["left"] == {}


def test_a_page_that_gives_a_seat_up_at_once_still_gets_the_answer_to_its_join(
    court: CourtStub,
) -> None:
    """A join that was ended before the court was asked is refused; no page waits for ever."""

    async def answers() -> list[object]:
        viewer = Viewer(_Socket())  # type: ignore[arg-type]
        seat = PageSeat(viewer, Answers(viewer, print), None, lambda *_, **__: None)
        told: list[object] = []
        ask = wire.JoinAsk(id=1, seat="left", token=TOKENS["left"], name="Ants")
        way = Access(court="main", connect=court.address)
        seat.join(ask, way, lambda value, error: told.append(value or error))
        seat.leave()
        async with asyncio.timeout(LIMIT_S):
            while not told:
                await asyncio.sleep(0.005)
        return told

    (answer,) = run_async(answers)
    assert isinstance(answer, UserError)
    assert not any(isinstance(one, JoinSeat) for one in court.inputs)


@pytest.mark.slow
def test_repeats_name_no_frame_that_the_player_did_not_see(
    court: CourtStub, session: Session
) -> None:
    """A player elsewhere who shows no sign of life looks neither far nor near, and then stands.

    The controller gets new frames all the while, and repeats the command; none of it is refused.
    """
    one = Controller(session, "main", "left", TOKENS["left"], "Ants", elsewhere=True)
    one.join()
    until(lambda: one.wait_frame(0.05) and court.beat > 30)
    assert court.named() == (0, 0)
    shown = _beat(court)
    one.saw(SeenFrame(1, shown))
    until(lambda: one.wait_frame(0.05) and court.named() == (1, shown))
    heard = court.network.doors()[0].heard
    until(lambda: one.wait_frame(0.05) and court.beat > shown + FRESH_BEATS)
    assert court.network.doors()[0].heard > heard
    assert court.named() == (1, shown)
    until(lambda: one.wait_frame(0.05) and SilentSeat(0) in court.inputs)
    assert court.refused["left"] == {}
    one.press(1, 2, SeenFrame(1, _beat(court)))
    until(lambda: one.wait_frame(0.05) and HeardSeat(0) in court.inputs)
    assert court.keys() == [(1, 2)]


def test_an_older_frame_takes_nothing_back(court: CourtStub, session: Session) -> None:
    """If a page's picture goes back a little, its signs of life are not refused as stale."""
    one = Controller(session, "main", "left", TOKENS["left"], "Ants", elsewhere=True)
    one.join()
    until(lambda: one.wait_frame(0.05) and court.beat > 40)
    for beat in (30, 28):
        heard = court.network.doors()[0].heard
        one.saw(SeenFrame(1, beat))
        until(lambda heard=heard: court.network.doors()[0].heard > heard)  # type: ignore[misc]
    assert court.named() == (1, 30)
    assert court.refused["left"] == {}
