"""Lets one machine open a thousand connections while a school plays from behind one address.

    python -m tests.campaigns.flood.school [--strangers 1000] [--players 35]

One gateway serves all courts. Loopback addresses stand for machines. Half of the strangers'
connections ask for WebSockets, half hold a part of a request, and whatever is closed is opened
again. It prints how many players have a seat, play, and see a key of theirs take effect, how many
frames each of them gets, and how many connections the strangers hold. It exits with 1 if not all
play.
"""

import json
import socket
import statistics
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, suppress
from pathlib import Path

from arguments import arguments
from contest_tokens import keep_tokens
from lacoc_process import ALONE, Running
from page_client import PageClient
from ports import free_port
from venue import REFEREE, TOKENS
from websockets.sync.client import connect

from lacoc_shared.gait.tables import Level
from lacoc_shared.seat import Phase

_STRANGER, _SCHOOL, _STAFF = "127.0.0.66", "127.0.0.77", "127.0.0.99"
_FOR_S = 10.0
_OPEN_S = 60.0
_THREADS = 50


class Strangers:
    """One machine that opens connections, and opens them again when they are closed.

    Args:
        port: the gateway's.
        most: how many connections it wants.
    """

    def __init__(self, port: int, most: int) -> None:
        self._port = port
        self._ending = threading.Event()
        self.tried = 0
        each = most // _THREADS
        self._held: list[list[socket.socket]] = [[] for _ in range(_THREADS)]
        for held in self._held:
            threading.Thread(target=self._keep, args=(held, each), daemon=True).start()

    @property
    def held(self) -> int:
        """How many connections are open now."""
        return sum(map(len, self._held))

    def end(self) -> None:
        self._ending.set()

    def _keep(self, held: list[socket.socket], most: int) -> None:
        while not self._ending.is_set():
            held[:] = [one for one in held if _is_open(one)]
            if len(held) >= most:
                self._ending.wait(0.1)
                continue
            self.tried += 1
            with suppress(Exception):  # it is refused, one way or another
                held.append(self._socket() if self.tried % 2 else self._half())

    def _socket(self) -> socket.socket:
        address = f"ws://127.0.0.1:{self._port}/ws"
        return connect(address, source_address=(_STRANGER, 0), open_timeout=2).socket

    def _half(self) -> socket.socket:
        one = socket.create_connection(("127.0.0.1", self._port), 5, (_STRANGER, 0))
        one.sendall(b"GET /play HTTP/1.1\r\nHost: 127.0.0.1\r\n")
        return one


def _is_open(one: socket.socket) -> bool:
    try:
        return one.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT) != b""
    except BlockingIOError:
        return True
    except OSError:
        return False


def school(strangers: int, players: int) -> dict[str, object]:
    """Let the school play while the strangers hold what they can; return what came of it."""
    courts = [f"court-{number}" for number in range((players + 1) // 2)]
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        file, port = Path(name) / "contest.toml", free_port()
        file.write_text(
            "".join(
                f'[court.{court}]\narena = "othello"\nlisten = ["tcp/127.0.0.1:{free_port()}"]\n'
                for court in courts
            )
        )
        keep_tokens(file, TOKENS, REFEREE, courts)
        words = ("--json", "--seconds", "600")
        for court in courts:
            court_words = (ALONE, str(file), "--court", court, *words)
            stack.enter_context(Running(*court_words, cwd=name))
        where = ("--contest", str(file), "--listen", f"127.0.0.1:{port}")
        stack.enter_context(Running("web", "--json", *where, cwd=name))

        def page(court: str, token: str, machine: str) -> PageClient:
            options = {"source_address": (machine, 0), "open_timeout": _OPEN_S}
            url = f"http://127.0.0.1:{port}"
            opened = PageClient(url, court=court, token=token, hz=50, **options)
            return stack.enter_context(opened)

        crowd = Strangers(port, strangers)
        stack.callback(crowd.end)
        time.sleep(_FOR_S)
        begun_s = time.monotonic()
        pages = []
        for number in range(2 * len(courts)):
            court, seat = courts[number // 2], ("left", "right")[number % 2]
            machine = _SCHOOL if number < players else _STAFF
            pages.append(one := page(court, TOKENS[seat], machine))
            one.ask("join", seat=seat, token=TOKENS[seat], name=f"Player {number}")
            one.ask("ready", ready=True)
        seated_s = time.monotonic() - begun_s
        for court in courts:
            referee = page(court, REFEREE, _STAFF)
            referee.wait(lambda referee=referee: referee.link.get("connected"))
            referee.ask("enter", token=REFEREE, by="Kim")
            referee.phase(Phase.READY)
            referee.ask("decide", decision={"type": "start"}, reason="")
        for one in pages:
            one.phase(Phase.PLAYING)
        sequences = [one.press(int(Level.LOCOMOTION), 2) for one in pages]
        for one, seq in zip(pages, sequences, strict=True):
            one.wait_own(lambda own, seq=seq: own.applied_seq >= seq)
        before = [len(one.frames) for one in pages]
        time.sleep(_FOR_S)
        frames = [len(one.frames) - was for one, was in zip(pages, before, strict=True)]
        rates = [count / _FOR_S for count in frames[:players]]
        return {
            "players": sum(not one.closed.is_set() for one in pages[:players]),
            "seated_s": round(seated_s, 1),
            "frames_hz_least": round(min(rates), 1),
            "frames_hz_median": round(statistics.median(rates), 1),
            "strangers_tried": crowd.tried,
            "strangers_hold": crowd.held,
        }


def main() -> None:
    """Print what came of it."""
    options = arguments(__doc__, strangers=1000, players=35)
    found = school(options.strangers, options.players)
    print(json.dumps(found))
    sys.exit(found["players"] != options.players)


if __name__ == "__main__":
    main()
