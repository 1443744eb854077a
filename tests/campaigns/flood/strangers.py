"""Attacks an event as a stranger could who has the event code and every link of spectators.

    python -m tests.campaigns.flood.strangers --minutes 60

An office with open entries, its pages, and a court on the same machine with a match of two bots.
Strangers hand in mutated files and bombs, send any bytes to the pages and the court, hold half
requests, and ask for any path. Meanwhile the organiser looks at the office twice a second and turns
strangers down once a minute, honest teams enter, and the match goes on. It prints how long the
office took to answer, whom it refused, the slow beats of the match, and the most memory that each
process took. It exits with 1 if an answer took a second or more, an honest team was refused, or a
process grew without a bound.
"""

import json
import random
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

import msgpack
import psutil
from arguments import arguments
from court_process import CourtProcess
from lacoc_process import contest_run
from ports import free_port
from processes import LACOC
from websockets.sync.client import connect
from workbook_bombs import with_formats, with_formulas, with_sheets, with_text

from lacoc_robots.library import find_robot, robot_folder, sample_gait_files

_COMMAND = (sys.executable, "-m", LACOC)
_LOOK_S, _ENTER_S, _DECLINE_S = 0.5, 5.0, 60.0
_SLOW_S = 1.0
_GROWN_BYTES = 1 << 30
_PATHS = ("/", "/watch", "/recordings", "/contest.json", "/assets/x.js", "/../etc/passwd", "/ws")


class Attack:
    """The strangers, and what honest people saw meanwhile."""

    def __init__(self, opened: dict[str, str], court: str, until_s: float) -> None:
        self._url = opened["url"]
        self._code = opened["code"]
        self._key = opened["office"].partition("token=")[2]
        self._court = court
        self._until_s = until_s
        self.answers_s: list[float] = []
        """How long the office took to answer the organiser."""
        self.honest: Counter[str] = Counter()
        self.sent: Counter[str] = Counter()
        _, locomotion = sample_gait_files("hexapod")
        assert locomotion is not None
        book = robot_folder("hexapod") / "Loco-data.xlsx"
        self._files = {
            "robot": ("robot.toml", find_robot("hexapod")[1]),
            "postures": (book.name, book.read_bytes()),
            "locomotion": (locomotion.name, locomotion.data),
        }

    def run(self) -> None:
        """Let all of them act until the time is up."""
        acts: list[Callable[[random.Random], None]] = [self._hand_in, self._page, self._hold]
        acts += [self._court_bytes, self._path, self._hand_in]
        threads = [
            threading.Thread(target=self._repeat, args=(act, number))
            for number, act in enumerate(acts)
        ]
        threads += [threading.Thread(target=one) for one in (self._organiser, self._teams)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    def _goes_on(self) -> bool:
        return time.monotonic() < self._until_s

    def _repeat(self, act: Callable[[random.Random], None], number: int) -> None:
        dice = random.Random(number)
        while self._goes_on():
            with suppress(Exception):  # whatever the other side does to a stranger
                act(dice)
            self.sent[act.__name__] += 1

    def _asked(self, request: dict[str, object], source: str, timeout_s: float = 60.0) -> object:
        """Send a request to the desk from an address of this machine; return the reply."""
        address = f"{self._url.replace('http', 'ws')}/office/ws"
        with connect(address, compression=None, max_size=None, source_address=(source, 0)) as page:
            page.send(msgpack.packb({"id": 1, "do": "desk", "request": request}))
            while True:
                message = page.recv(timeout_s)
                assert isinstance(message, bytes)
                body = msgpack.unpackb(message[1:])
                if body.get("id") == 1:
                    return body

    def _organiser(self) -> None:
        """Look at the office as its page does, and turn strangers down now and then."""
        known, declined_s = "", time.monotonic()
        while self._goes_on():
            began_s = time.monotonic()
            asked = {"do": "overview", "secret": self._key, "known": known}
            reply = self._asked(asked, "127.0.0.1")
            self.answers_s.append(time.monotonic() - began_s)
            assert isinstance(reply, dict)
            view = reply["value"]["view"]
            known = known if view is None else view["version"]
            if view is not None and began_s - declined_s > _DECLINE_S:
                declined_s = began_s
                waiting = [one["team"] for one in view["teams"] if one["state"] == "waits"]
                strangers = [name for name in waiting if name.startswith("Stranger")]
                if strangers:
                    turned = {"do": "decline", "secret": self._key, "teams": strangers}
                    self._asked(turned, "127.0.0.1")
            time.sleep(_LOOK_S)

    def _teams(self) -> None:
        number = 0
        while self._goes_on():
            number += 1
            files = {
                name: {"name": file, "data": data} for name, (file, data) in self._files.items()
            }
            del files["robot"]
            team = f"Honest {number}"
            request = {"do": "apply", "secret": self._code, "team": team, "files": files}
            reply = self._asked(request, f"127.0.1.{1 + number % 200}")
            self.honest["in" if isinstance(reply, dict) and reply.get("ok") else str(reply)] += 1
            self._asked(
                {"do": "approve", "secret": self._key, "teams": [team]}
                if number % 40
                else {"do": "decline", "secret": self._key, "teams": [team]},
                "127.0.0.1",
            )
            time.sleep(_ENTER_S)

    def _hand_in(self, dice: random.Random) -> None:
        name = dice.choice([*self._files])
        file, data = self._files[name]
        how = dice.random()
        if how < 0.4:
            name, file, data = "postures", "Loco-data.xlsx", self._bomb(dice)
        elif how < 0.9:
            changed = bytearray(data)
            for _ in range(dice.randint(1, 20)):
                changed[dice.randrange(len(changed))] = dice.randrange(256)
            data = bytes(changed)
        else:
            data = dice.randbytes(dice.randrange(60_000))
        files = {name: {"name": file, "data": data}}
        team = f"Stranger {dice.random()}"
        request = {"do": "apply", "secret": self._code, "team": team[:24], "files": files}
        self._asked(request, f"127.0.2.{dice.randint(1, 250)}")

    def _bomb(self, dice: random.Random) -> bytes:
        _, book = self._files["postures"]
        return dice.choice(
            (
                lambda: with_formulas(book, dice.randrange(6_000_000), dice.randrange(25_000)),
                lambda: with_text(book, dice.randrange(200_000), dice.randrange(24_000)),
                lambda: with_formats(book, dice.randint(1, 900), dice.randrange(40_000)),
                lambda: with_sheets(book, dice.randrange(200)),
            )
        )()

    def _page(self, dice: random.Random) -> None:
        path = dice.choice(("/ws", "/office/ws"))
        address = f"{self._url.replace('http', 'ws')}{path}"
        with connect(address, compression=None, source_address=("127.0.0.3", 0)) as page:
            for _ in range(50):
                page.send(dice.randbytes(dice.randrange(3000)))

    def _hold(self, dice: random.Random) -> None:
        host, _, port = self._url.removeprefix("http://").partition(":")
        with ExitStack() as stack:
            for _ in range(40):
                half = socket.create_connection((host, int(port)), 5, ("127.0.0.4", 0))
                stack.enter_context(half)
                half.sendall(b"GET /watch HTTP/1.1\r\nHost: x"[: dice.randrange(30)])
            time.sleep(2)

    def _court_bytes(self, dice: random.Random) -> None:
        host, _, port = self._court.removeprefix("tcp/").rpartition(":")
        with ExitStack() as stack:
            for _ in range(100):
                one = socket.create_connection((host, int(port)), 5, ("127.0.0.5", 0))
                stack.enter_context(one)
                one.sendall(dice.randbytes(dice.choice((2, 200, 5000))))
            time.sleep(1)

    def _path(self, dice: random.Random) -> None:
        path = dice.choice(_PATHS) + "./" * dice.randrange(20) + dice.choice(("", "x", "%00", "?a"))
        with urllib.request.urlopen(self._url + path, timeout=5) as answer:
            answer.read(1 << 20)


def _memory(peaks: dict[str, int], ended: threading.Event) -> None:
    """Note the most memory of each process that this one started."""
    while not ended.wait(0.2):
        for one in psutil.Process().children(recursive=True):
            with suppress(psutil.Error):
                words = [word for word in one.cmdline() if word[:1] not in "-/"]
                name = " ".join(words[-3:])[-40:]
                peaks[name] = max(peaks.get(name, 0), one.memory_info().rss)


def main() -> int:
    """Attack, and print what honest people saw."""
    minutes = arguments(__doc__, minutes=5.0).minutes
    peaks: dict[str, int] = {}
    ended = threading.Event()
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        file = folder / "contest.toml"
        subprocess.run([*_COMMAND, "contest", "init", str(file)], check=True, stdout=-3)
        text = file.read_text().replace("0.0.0.0:7447", f"127.0.0.1:{free_port()}")
        file.write_text(text)
        office = stack.enter_context(contest_run(file, "--entries", fresh=True))
        office.hush()
        seconds = str(60 * minutes + 120)
        place = stack.enter_context(CourtProcess(folder, "--seconds", seconds, fresh=True))
        place.hush()
        place.bots("planner", "planner")
        watching = threading.Thread(target=_memory, args=(peaks, ended))
        watching.start()
        where = ("--connect", place.address, "--token", place.referee)
        subprocess.run([*_COMMAND, "referee", "start", "--wait", "60", *where], check=True)
        attack = Attack(office.opened, place.address, time.monotonic() + 60 * minutes)
        attack.run()
        asked = [*_COMMAND, "referee", "status", "--json", "--connect", place.address]
        status = json.loads(subprocess.run(asked, check=True, capture_output=True).stdout)
        ended.set()
        watching.join()
    answers_s = sorted(attack.answers_s)
    health = status["health"]
    print(f"strangers did {dict(attack.sent)}")
    print(f"honest teams {dict(attack.honest)}")
    print(
        f"the office answered {len(answers_s)} times: median {answers_s[len(answers_s) // 2]:.3f},"
        f" 99 % {answers_s[int(0.99 * len(answers_s))]:.3f}, longest {answers_s[-1]:.3f} s"
    )
    print(f"the match: {health['slow_beats']} slow beats, worst {health['worst_late_ms']:.0f} ms")
    for one, peak in sorted(peaks.items(), key=lambda item: -item[1]):
        print(f"{peak / 1e6:6.0f} MB  {one}")
    refused = set(attack.honest) - {"in"}
    return int(bool(refused) or answers_s[-1] >= _SLOW_S or max(peaks.values()) > _GROWN_BYTES)


if __name__ == "__main__":
    raise SystemExit(main())
