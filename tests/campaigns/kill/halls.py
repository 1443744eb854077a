"""Courts in several halls: how fast the office finds them, and how a match survives its machine.

    python -m tests.campaigns.kill.halls --halls 4 --courts 16

Each hall is a network namespace of its own behind a router, and all routers are joined by one cable
(Linux only; needs the right to make network namespaces). The office, its gateway and the bots are
in the first hall; each other hall runs its courts with `lacoc contest courts`. A match is played at
the first court of each hall.

- **Found**: the time from a court that is open to its first answer about where a team plays. It can
  answer only when the office has connected and told it.
- **Lost**: the processes of one hall are killed, all at once. The office opens their courts in its
  own hall, and the matches go on. Measured are the time until then, how much later the page of a
  spectator shows it, and how much of the match was played twice.
"""

import asyncio
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from arguments import arguments
from crowd import Page
from processes import LACOC

from lacoc_client.play.asking import NoCourt, NotNow
from lacoc_client.play.team_way import where
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import Closed, Played, new
from lacoc_shared import codec
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import Frame
from lacoc_shared.network.session import Mail, open_client
from lacoc_shared.record.files import segment_paths
from lacoc_shared.record.matches import court_matches
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S

_OFFICE = 1
"""The hall of the office."""
_PORT, _PAGES = 7447, 8080
_MATCH_S = 90.0
_LOST_AFTER_BEATS = 10 * BEATS_PER_S
"""A hall is lost when this much of its match has been copied."""
_WAIT_S = 300.0
_LOOK_S = 0.01


def main() -> None:
    """Run the benchmark, and print its results; exit with 1 if something was not as promised."""
    options = arguments(__doc__, halls=4, courts=(16, "in all halls together"))
    with tempfile.TemporaryDirectory() as folder, network(options.halls):
        found = play(Path(folder), options.halls, options.courts)
    print(json.dumps(found, indent=1))
    late = max(found["found_s"]) > 2.0 or found["page_later_s"] > 3.0
    sys.exit(late or found["records"] != options.halls)


def ip(*words: str) -> None:
    """Run the `ip` command."""
    subprocess.run(["ip", *words], check=True, capture_output=True)


def address(hall: int) -> str:
    """Return the address of a hall's machine."""
    return f"10.213.{hall}.2"


@contextmanager
def network(halls: int) -> Iterator[None]:
    """Make halls and routers, and connect this process to the cable that joins the routers.

    Hall N is 10.213.N.0/24. Its router has address 1 there, and address N on the cable, which is
    10.213.0.0/24. This process has address 100 on the cable.
    """
    tag = f"l{os.getpid()}"
    spaces = [f"{tag}{kind}{hall}" for hall in range(1, halls + 1) for kind in ("hall", "router")]
    try:
        ip("link", "add", f"{tag}c", "type", "bridge")
        ip("address", "add", "10.213.0.100/24", "dev", f"{tag}c")
        ip("link", "set", f"{tag}c", "up")
        for hall in range(1, halls + 1):
            _connect(tag, hall, halls)
            ip("route", "add", f"10.213.{hall}.0/24", "via", f"10.213.0.{hall}")
        yield
    finally:
        for space in spaces:
            subprocess.run(["ip", "netns", "delete", space], check=False, capture_output=True)
        subprocess.run(["ip", "link", "delete", f"{tag}c"], check=False, capture_output=True)


def _connect(tag: str, hall: int, halls: int) -> None:
    """Make a hall and its router, and connect the router to the cable."""
    inside, router = f"{tag}hall{hall}", f"{tag}router{hall}"
    for space in (inside, router):
        ip("netns", "add", space)
        ip("-n", space, "link", "set", "lo", "up")
    ip("link", "add", f"{tag}p{hall}", "type", "veth", "peer", "name", "far", "netns", router)
    ip("link", "set", f"{tag}p{hall}", "master", f"{tag}c", "up")
    ip("-n", router, "address", "add", f"10.213.0.{hall}/24", "dev", "far")
    ip("-n", router, "link", "set", "far", "up")
    ip("-n", router, "link", "add", "near", "type", "veth", "peer", "name", "door", "netns", inside)
    ip("-n", router, "address", "add", f"10.213.{hall}.1/24", "dev", "near")
    ip("-n", router, "link", "set", "near", "up")
    ip("-n", inside, "address", "add", f"{address(hall)}/24", "dev", "door")
    ip("-n", inside, "link", "set", "door", "up")
    ip("-n", inside, "route", "add", "default", "via", f"10.213.{hall}.1")
    forward = ["ip", "netns", "exec", router, "sysctl", "-qw", "net.ipv4.ip_forward=1"]
    subprocess.run(forward, check=True, capture_output=True)
    for other in range(1, halls + 1):
        if other != hall:
            ip("-n", router, "route", "add", f"10.213.{other}.0/24", "via", f"10.213.0.{other}")


def play(folder: Path, halls: int, courts: int) -> dict[str, Any]:
    """Play a match in each hall, and lose the processes of the last hall on the way."""
    names = [f"court-{number:02d}" for number in range(1, courts + 1)]
    hall_of = {name: index % halls + 1 for index, name in enumerate(names)}
    file = _contest(folder / "hall-1", hall_of, halls)
    records = ContestFolder(file).records
    with FactStore(ContestFolder(file).facts) as store, ExitStack() as stack:
        words = ("contest", "run", str(file), "--entries", "--json")
        words += ("--listen", f"0.0.0.0:{_PAGES}")
        office = stack.enter_context(_inside(_OFFICE, *words))
        assert office.stdout is not None
        office.stdout.readline()
        token = ContestFolder(file).contest.secrets.team("Team 1")
        found_s: dict[str, float] = {}
        waiting = []
        for hall in range(2, halls + 1):
            there = folder / f"hall-{hall}"
            there.mkdir()
            for one in (file, ContestFolder(file).secrets):
                shutil.copy(one, there)
            own = [name for name in names if hall_of[name] == hall]
            words = ("contest", "courts", *own, "--contest", str(there / "contest.toml"))
            process = stack.enter_context(_inside(hall, *words))
            hears = threading.Thread(target=_find, args=(process, own, hall, token, found_s))
            hears.start()
            waiting.append(hears)
        for one in waiting:
            one.join()
        # Only now are the games drawn, so the first court of each hall gets one.
        store.decide(lambda _: [new(Closed)])
        lost = names[halls - 1]
        _until(lambda: _copied_beats(records, lost) > _LOST_AFTER_BEATS)
        told = asyncio.run(_lose(halls, lost, halls))
        # The courts of this hall, with the one that was lost, close their matches with the office.
        _until(lambda: len(_whole(store, records)) == halls - 2)
        stack.close()
        _until(lambda: len(_whole(store, records)) == halls)
        count = len(_whole(store, records))
    return {"found_s": sorted(round(one, 2) for one in found_s.values()), **told, "records": count}


def _whole(store: FactStore, records: Path) -> list[str]:
    """Return the official games whose whole records the office has."""
    played = (fact.record for fact in store.facts() if isinstance(fact, Played))
    return [name for name in played if (records / name).exists()]


def _contest(folder: Path, hall_of: dict[str, int], halls: int) -> Path:
    folder.mkdir()
    text = '[contest]\nname = "Halls"\n'
    for number, (name, hall) in enumerate(hall_of.items()):
        port = _PORT + number
        text += f'[court.{name}]\narena = "othello"\nlisten = ["{address(_OFFICE)}:{port}"]\n'
        if hall != _OFFICE:
            text += f'elsewhere = "{address(hall)}:{port}"\n'
    text += f"""[stage.groups]
format = "round-robin"
groups = {halls}
settings.match = {{ duration_s = {_MATCH_S}, countdown_s = 1.0, start = "ready" }}
"""
    file = folder / "contest.toml"
    file.write_text(text)
    for number in range(1, 2 * halls + 1):
        organiser.enter(file, f"Team {number}", None, "straight", "")
    return file


@contextmanager
def _inside(hall: int, *words: str) -> Iterator[subprocess.Popen[str]]:
    """Run a `lacoc` command in a hall; it ends with the block."""
    command = ["ip", "netns", "exec", f"l{os.getpid()}hall{hall}"]
    process = subprocess.Popen(
        [*command, sys.executable, "-m", LACOC, *words], stdout=subprocess.PIPE, text=True
    )
    try:
        yield process
    finally:
        process.terminate()
        process.communicate(timeout=60)


def _find(
    process: subprocess.Popen[str],
    courts: Sequence[str],
    hall: int,
    token: str,
    found_s: dict[str, float],
) -> None:
    """Note how long after each line of a hall, "court ... is open", its court knows the teams."""
    assert process.stdout is not None
    for line in process.stdout:
        begun_s = time.monotonic()
        name = next(name for name in courts if f" {name} " in line)
        at = next(word.rstrip(".") for word in line.split() if word.startswith("tcp/"))
        at = f"tcp/{address(hall)}:{at.rpartition(':')[2]}"
        with open_client([at]) as session:
            while True:
                with suppress(NoCourt, NotNow):
                    where(session, name, token)
                    break
                time.sleep(_LOOK_S)
        found_s[name] = time.monotonic() - begun_s
        if len(found_s.keys() & {*courts}) == len(courts):
            return


def _copied_beats(records: Path, court: str) -> int:
    """Return how many beats of a court's newest match the office has."""
    name = next(reversed(court_matches(records, court)), None)
    found = segment_paths(records, str(name))
    return len(Record.read(found).frames) if found else 0


async def _lose(hall: int, court: str, halls: int) -> dict[str, Any]:
    """Kill all processes of a hall; measure when the match goes on, and when a page shows it."""
    loop = asyncio.get_running_loop()
    netloc = urlsplit(f"http://{address(_OFFICE)}:{_PAGES}").netloc
    _, page = await loop.create_connection(
        lambda: Page(netloc, 50.0, court), address(_OFFICE), _PAGES
    )
    port = _PORT + halls - 1
    there, here = f"tcp/{address(hall)}:{port}", f"tcp/{address(_OFFICE)}:{port}"
    with open_client([there, here]) as session:
        frames = session.mailbox(KeySpace(court).frame, 100_000)
        await asyncio.sleep(2.0)
        seen = page.frames
        assert seen, "the page shows the match"
        pids = subprocess.run(
            ["ip", "netns", "pids", f"l{os.getpid()}hall{hall}"], capture_output=True, text=True
        ).stdout.split()
        for pid in pids:
            os.kill(int(pid), signal.SIGKILL)
        killed_s = time.monotonic()
        await asyncio.sleep(0.5)  # what was on the way arrives
        before = _decoded(frames)[-1]
        shown = page.frames
        opened_s = await asyncio.to_thread(_opened_s, address(_OFFICE), port)
        while page.frames == shown:
            await asyncio.sleep(_LOOK_S)
        page_s = time.monotonic()
        resumed: list[tuple[float, Frame]] = []
        while not any(frame.clock_ticks > before[1].clock_ticks for _, frame in resumed):
            await asyncio.sleep(_LOOK_S)
            resumed += _decoded(frames)
    first_s, first = resumed[0]
    return {
        "opened_after_s": round(opened_s - killed_s, 2),
        "spectator_later_s": round(first_s - opened_s, 2),
        "page_later_s": round(page_s - opened_s, 2),
        "in_play_after_s": round(resumed[-1][0] - killed_s, 2),
        "played_twice_s": round((before[1].clock_ticks - first.clock_ticks) / BEATS_PER_S, 2),
        "same_match": first.match == before[1].match,
    }


def _decoded(frames: Any) -> list[tuple[float, Frame]]:
    """Return the frames that have come, each with the time of its arrival [s]."""
    found: list[tuple[float, Frame]] = []
    mail: Mail | None
    while (mail := frames.take()) is not None:
        found.append((mail.arrived_s, codec.decode(mail.payload, Frame)))
    return found


def _opened_s(host: str, port: int) -> float:
    """Wait until a court listens at an address; return when that was."""
    end_s = time.monotonic() + _WAIT_S
    while time.monotonic() < end_s:
        with suppress(OSError), socket.create_connection((host, port), 0.2):
            return time.monotonic()
        time.sleep(_LOOK_S)
    raise RuntimeError(f"no court listens at {host}:{port}")


def _until(true: Callable[[], bool]) -> None:
    end_s = time.monotonic() + _WAIT_S
    while not true():
        assert time.monotonic() < end_s, "it did not come true"
        time.sleep(0.2)


if __name__ == "__main__":
    main()
