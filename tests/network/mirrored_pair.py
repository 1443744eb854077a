"""Two controllers answer the same frame with a key; one of them has a slow link."""

import json
import subprocess
import threading
import time
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

from lacoc_process import Lacoc
from slow_link import SlowLink
from waiting import LIMIT_S, until

from lacoc_client.controller import Controller
from lacoc_client.referee import RefereeClient
from lacoc_shared.codec import decode
from lacoc_shared.decisions import Start
from lacoc_shared.inputs import KeySeat
from lacoc_shared.keyspace import Keys
from lacoc_shared.messages import Frame, Health
from lacoc_shared.network.session import open_client
from lacoc_shared.record.files import record_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S, Phase

COURT = "main"
SEATS = ("left", "right")
FAST, SLOW = SEATS
EVERY_BEATS = 17
"""Beats from one key to the next; no multiple of the 5 beats between repeats of a command."""
_TOKENS = {who: f"the token of {who}" for who in (*SEATS, "the referee")}
_CONTEST = """
[court.main]
arena = "othello"
listen = ["tcp/127.0.0.1:0"]
input_delay = "{input_delay}"
input_delay_max_ms = {most_ms}
settings.match.duration_s = 3600.0
settings.match.countdown_s = 0.1
seat.left.token = "the token of left"
seat.right.token = "the token of right"
referee.token = "the token of the referee"
"""


class Pair(NamedTuple):
    """A frame that both controllers answered, and when their keys took effect."""

    seen: int
    beats: tuple[int, int]
    """The beat in which each key took effect, the fast seat's first."""
    late: tuple[int, int]


class Played(NamedTuple):
    """The keys, the last health message and the record of a match between the two controllers."""

    pairs: list[Pair]
    lost: int
    """Frames that only one key answered, because the other key was lost."""
    health: Health
    """The court's last health message."""
    record: Record


class _Player(threading.Thread):
    """A controller that answers each frame whose beat is a multiple of `EVERY_BEATS` with a key."""

    def __init__(self, seat: str, address: str, stopping: threading.Event) -> None:
        super().__init__(name=seat)
        self._stopping = stopping
        self._session = open_client([address], timeout_s=LIMIT_S)
        self.controller = Controller(self._session, COURT, seat, _TOKENS[seat], seat.title())
        # A mailbox of its own, because a controller keeps only the newest frame.
        self._frames = self._session.mailbox(Keys(COURT).frame, 1000)
        self.controller.join()
        self.controller.ready()
        self.start()

    def run(self) -> None:
        with self._session:
            while not self._stopping.is_set():
                self._frames.wait(0.05)
                while (mail := self._frames.take()) is not None:
                    frame = decode(mail.payload, Frame)
                    if frame.phase == Phase.PLAYING and frame.beat % EVERY_BEATS == 0:
                        self.controller.press(1, frame.beat // EVERY_BEATS % 4, frame)
                self.controller.poll(time.monotonic())


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
    """Play a match of two controllers, one with a slow link, at a court in another process.

    Args:
        folder: for contest file and record.
        input_delay: the contest's `input_delay`.
        delay_s: delay of the slow seat's link, one way.
        jitter_s: jitter of that link, one way.
        most_ms: the contest's `input_delay_max_ms`.
        warm_s: time before the start; links are measured over 10 s.
        seconds: length of play.
    """
    contest = folder / "contest.toml"
    contest.write_text(_CONTEST.format(input_delay=input_delay, most_ms=most_ms))
    words = ("serve", "--json", "--contest", str(contest), "--recordings", str(folder))
    stopping = threading.Event()
    with ExitStack() as stack:
        court = stack.enter_context(Lacoc(*words, stdout=subprocess.PIPE, text=True))
        stack.callback(court.terminate)
        assert court.stdout is not None
        address = json.loads(court.stdout.readline())["locators"][0]
        threading.Thread(target=court.stdout.read, daemon=True).start()  # so the pipe never fills
        link = stack.enter_context(SlowLink(address, delay_s, jitter_s))
        session = stack.enter_context(open_client([address]))
        players: list[_Player] = []
        stack.callback(lambda: [player.join() for player in players])
        stack.callback(stopping.set)
        for seat, where in ((FAST, address), (SLOW, link.address)):
            players.append(_Player(seat, where, stopping))
        view = players[0].controller.view
        time.sleep(warm_s)
        RefereeClient(session, COURT, _TOKENS["the referee"]).decide(Start(), "", "the pair")
        until(lambda: view.frame and view.frame.phase == Phase.PLAYING)
        end = view.frame.beat + seconds * BEATS_PER_S if view.frame else 0
        until(lambda: view.frame and view.frame.beat > end, seconds * 4)
        health = view.health
        assert health is not None
    until(lambda: list(folder.glob("*.mcap")))
    paths = sorted(folder.glob("*.mcap"))
    record = Record.read(record_paths(paths[-1]) if ".live" in paths[-1].name else paths[-1])
    return _played(record, health, int(end) - BEATS_PER_S)


def _played(record: Record, health: Health, end: int) -> Played:
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
