"""Two contestants answer the same frame with a key; one of them has a slow link.

They are programs at the court, or pages (without a browser) at a gateway next to the court.
"""

import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

from contest_tokens import keep_tokens
from lacoc_process import ALONE, Running
from page_client import PageClient
from slow_link import SlowLink
from waiting import LIMIT_S, until

from lacoc_client.play.controller import Controller, SeenFrame
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import decode
from lacoc_shared.decisions import Start
from lacoc_shared.inputs import KeySeat
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import Frame, Health
from lacoc_shared.network.session import open_client
from lacoc_shared.record.files import record_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, Phase

COURT = "main"
SEATS = ("left", "right")
FAST, SLOW = SEATS
EVERY_BEATS = 17
"""Beats from one key to the next; no multiple of the 5 beats between repeats of a command."""
_TOKENS = {who: f"the token of {who}" for who in (*SEATS, "the referee")}
_PING_BEATS = 5
_ANY_PORT = "tcp/127.0.0.1:0"
_CONTEST = """
[court.main]
arena = "{arena}"
listen = ["tcp/127.0.0.1:0"]
input_delay = "{input_delay}"
input_delay_max_ms = {most_ms}
settings.match.duration_s = 3600.0
settings.match.countdown_s = 0.1
"""


class Pair(NamedTuple):
    """A frame that both controllers answered, and when their keys took effect."""

    seen: int
    beats: tuple[int, int]
    """The beat in which each key took effect, the fast seat's first."""
    late: tuple[int, int]


class Trip(NamedTuple):
    """A contestant's round trip."""

    p50_ms: float
    p95_ms: float

    def fits(self, court: "Trip") -> bool:
        """Say whether the court measured this median, within 10 %; it counts in whole beats."""
        return 0.9 * self.p50_ms <= court.p50_ms <= 1.1 * (self.p50_ms + 1000 * BEAT_S)


class Played(NamedTuple):
    """The keys, the last health message and the record of a match between the two contestants."""

    pairs: list[Pair]
    lost: int
    """Frames that only one key answered, because the other key was lost."""
    health: Health
    """The court's last health message."""
    record: Record
    pings: tuple[Trip, ...] = ()
    """Of pages: from the page to the gateway and back, as the pages measured it."""
    shown: tuple[Trip, ...] = ()
    """Of pages: what the court's health, as the slow seat's page had it, says of each seat."""


def _answers(frame: Frame) -> bool:
    return frame.phase == Phase.PLAYING and frame.beat % EVERY_BEATS == 0


def _key(frame: Frame) -> dict[str, int]:
    return {"level": 1, "key": frame.beat // EVERY_BEATS % 4}


class _Player(threading.Thread):
    """A controller that answers each frame whose beat is a multiple of `EVERY_BEATS` with a key."""

    def __init__(self, seat: str, address: str, stopping: threading.Event) -> None:
        super().__init__(name=seat)
        self._stopping = stopping
        self._session = open_client([address], timeout_s=LIMIT_S)
        self.controller = Controller(self._session, COURT, seat, _TOKENS[seat], seat.title())
        # A mailbox of its own, because a controller keeps only the newest frame.
        self._frames = self._session.mailbox(KeySpace(COURT).frame, 1000)
        self.controller.join()
        self.controller.ready()
        self.start()

    def run(self) -> None:
        with self._session:
            while not self._stopping.is_set():
                self._frames.wait(0.05)
                while (mail := self._frames.take()) is not None:
                    frame = decode(mail.payload, Frame)
                    if _answers(frame):
                        self.controller.press(
                            **_key(frame), upon=SeenFrame(frame.match, frame.beat)
                        )
                self.controller.poll(time.monotonic())


class _Page(PageClient):
    """A page that answers the same frames as a `_Player` does, and measures its way by pings."""

    def __init__(self, seat: str, url: str, key: str) -> None:
        self._pinged_s: dict[int, float] = {}
        self.trips_s: list[float] = []
        super().__init__(url, key, hz=BEATS_PER_S)
        self.ask("join", seat=seat, token=_TOKENS[seat], name=seat.title())
        self.ask("ready", ready=True)

    def ping(self) -> Trip:
        """Return the round trips to the gateway."""
        trips_ms = sorted(1000 * trip_s for trip_s in self.trips_s)
        return Trip(trips_ms[len(trips_ms) // 2], trips_ms[len(trips_ms) * 95 // 100])

    def _take(self, kind: MessageKind, payload: bytes) -> None:
        super()._take(kind, payload)
        if kind is not MessageKind.FRAME or self.frame is None:
            return
        if _answers(self.frame):
            self.send("key", **_key(self.frame), **self.shown())
        elif self.frame.beat % _PING_BEATS == 0:
            now_s = time.monotonic()
            self._pinged_s[self.send("ping")] = now_s

    def _take_own(self, kind: MessageKind, body: dict[str, Any]) -> None:
        if (
            kind is MessageKind.REPLY
            and (sent_s := self._pinged_s.pop(body["id"], None)) is not None
        ):
            self.trips_s.append(time.monotonic() - sent_s)
        else:
            super()._take_own(kind, body)


def play(
    folder: Path,
    input_delay: str,
    delay_s: float,
    jitter_s: float,
    *,
    most_ms: int = 400,
    warm_s: float = 12.0,
    seconds: float = 60.0,
) -> Played:
    """Play a match of two programs, one with a slow link, at a court in another process.

    Args:
        folder: for contest file and record.
        input_delay: the contest's `input_delay`.
        delay_s: delay of the slow seat's link, one way.
        jitter_s: jitter of that link, one way.
        most_ms: the contest's `input_delay_max_ms`.
        warm_s: time before the start; links are measured over 10 s.
        seconds: length of play.
    """
    with ExitStack() as stack:
        address = _court(folder, "othello", input_delay, most_ms, stack)
        link = stack.enter_context(SlowLink(address, delay_s, jitter_s))
        stopping = threading.Event()
        players: list[_Player] = []
        stack.callback(lambda: [player.join() for player in players])
        stack.callback(stopping.set)
        for seat, where in ((FAST, address), (SLOW, link.address)):
            players.append(_Player(seat, where, stopping))
        health, end = _match(address, warm_s, seconds)
    return _played(folder, health, end)


def play_on_pages(
    folder: Path,
    arena: str,
    input_delay: str,
    links_s: Sequence[tuple[float, float]],
    *,
    warm_s: float = 12.0,
    seconds: float = 60.0,
) -> Played:
    """Play a match of two pages at one gateway; court and gateway have processes of their own.

    Args:
        folder: for contest file and record.
        arena: the game.
        input_delay: the contest's `input_delay`.
        links_s: delay and jitter, one way, of the fast and of the slow page's link to the gateway.
        warm_s: time before the start; links are measured over 10 s.
        seconds: length of play.
    """
    with ExitStack() as stack:
        address = _court(folder, arena, input_delay, 400, stack)
        contest = folder / "open.toml"  # with the port that the court got
        contest.write_text((folder / "contest.toml").read_text().replace(_ANY_PORT, address))
        where = ("--contest", str(contest), "--listen", "127.0.0.1:0")
        web = _started(stack, "web", "--json", *where)
        pages: list[_Page] = []
        for seat, (delay_s, jitter_s) in zip(SEATS, links_s, strict=True):
            place = web["url"].removeprefix("http://")
            link = stack.enter_context(SlowLink(f"tcp/{place}", delay_s, jitter_s))
            url = link.address.replace("tcp/", "http://")
            pages.append(stack.enter_context(_Page(seat, url, web["key"])))
        health, end = _match(address, warm_s, seconds)
        pings = tuple(page.ping() for page in pages)
        told = pages[-1].health
    assert told is not None
    return _played(folder, health, end)._replace(pings=pings, shown=trips(told))


def trips(health: Health) -> tuple[Trip, ...]:
    """Return the seats' round trips as a court's health message has them."""
    return tuple(
        Trip(seat.round_trip_p50_ms or 0.0, seat.round_trip_p95_ms or 0.0) for seat in health.seats
    )


def _court(folder: Path, arena: str, input_delay: str, most_ms: int, stack: ExitStack) -> str:
    """Start a court that is stopped with the stack; return its address."""
    contest = folder / "contest.toml"
    keep_tokens(contest, {seat: _TOKENS[seat] for seat in SEATS}, _TOKENS["the referee"])
    contest.write_text(_CONTEST.format(arena=arena, input_delay=input_delay, most_ms=most_ms))
    words = (str(contest), "--json", "--recordings", str(folder))
    address: str = _started(stack, ALONE, *words)["locators"][0]
    return address


def _started(stack: ExitStack, *words: str) -> dict[str, Any]:
    """Start a command that is stopped with the stack; return what it says first."""
    running = stack.enter_context(Running(*words))
    running.hush()
    return running.opened


def _match(address: str, warm_s: float, seconds: float) -> tuple[Health, int]:
    """Let a match be played; return the court's last health message, and the last beat."""
    with open_client([address]) as session:
        view = Spectator(session, COURT)
        time.sleep(warm_s)
        RefereeClient(session, COURT, _TOKENS["the referee"]).decide(Start(), "", "the pair")
        until(lambda: view.wait_frame(1.0) and view.frame and view.frame.phase == Phase.PLAYING)
        assert view.frame is not None
        end = int(view.frame.beat + seconds * BEATS_PER_S)
        until(lambda: view.wait_frame(1.0) and view.frame and view.frame.beat > end, seconds * 4)
        assert view.health is not None
        return view.health, end - BEATS_PER_S


def _played(folder: Path, health: Health, end: int) -> Played:
    until(lambda: list(folder.glob("*.mcap")))
    paths = sorted(folder.glob("*.mcap"))
    record = Record.read(record_paths(paths[-1]) if ".live" in paths[-1].name else paths[-1])
    keys: tuple[dict[int, tuple[int, int]], ...] = ({}, {})
    for beat, items in record.inputs.items():
        for item in items:
            if isinstance(item, KeySeat) and item.seen < end:
                keys[item.seat][item.seen] = (beat, item.late)
    fast, slow = keys
    pairs = [
        Pair(seen, (fast[seen][0], slow[seen][0]), (fast[seen][1], slow[seen][1]))
        for seen in sorted(fast.keys() & slow.keys())
    ]
    return Played(pairs, len(fast.keys() ^ slow.keys()), health, record)
