"""Lets a crowd of any size watch a match in pieces through a proxy, with real pages among it.

    python -m tests.campaigns.flood.crowd [--proxy nginx] [--seconds 60] [--pages 20]

`nginx` has the documented lines, and keeps pieces: it is asked as 100, 1,000 and 10,000 watchers
ask, a piece a second each. `caddy` keeps nothing, and has 500 watchers. It prints, for each size,
how many requests a second came to the proxy and to the gateway, how evenly the court's frames came
to a page on a WebSocket, and what the real pages in pieces showed: pictures, gaps of more than half
a second, and how far behind the court they were. It exits with 1 if a page had a gap or went back,
or was more than 4 s behind.
"""

import itertools
import json
import re
import ssl
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import proxies
import trustme
from arguments import arguments
from page_client import PageClient
from page_node import NODE_OF_PAGES
from ports import free_port
from show import playing
from venue import Venue

_NAME = "localhost"
_SIZES = {"nginx": (100, 1_000, 10_000), "caddy": (500,)}
_CONNECTIONS = 400
_BEFORE_S = 15.0
_MOST_BEHIND_S = 4.0
_CROWD = Path(__file__).with_name("crowd.mjs")
_ASKS = """
local began, first = {began}, {first}
function delay() return {delay_ms} end
function request()
  return wrk.format("GET", "{path}/{run}/" .. (first + os.time() - began))
end
"""
"""Each connection asks for a piece that is whole, as pages do, a few times a second or many."""


def crowd(proxy: str, seconds: int, pages: int) -> list[dict[str, Any]]:
    """Let crowds watch a match, one after another; return what each came to."""
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        authority, port = trustme.CA(), free_port()
        authority.cert_pem.write_to_path(folder / "authority.pem")
        pair = proxies.issue(folder, authority, _NAME)
        below = "/lacoc" if proxy == "nginx" else ""
        base = f"https://{_NAME}:{port}{below}"
        venue = Venue(folder, stack)
        venue.court("--seconds", "3600")
        metrics = f"127.0.0.1:{free_port()}"
        venue.web("--pages", base, "--proxy", "127.0.0.1", "--metrics", metrics)
        (place := folder / "proxy").mkdir()
        gateway = f"127.0.0.1:{venue.web_port}"
        run = {"nginx": proxies.nginx, "caddy": proxies.caddy}[proxy]
        stack.enter_context(run(place, pair, _NAME, port, gateway))
        playing(venue)
        seat = venue.page(hz=50)
        picture = f"{base}/live/court"
        watching = _pages(stack, picture, pages, seconds * len(_SIZES[proxy]) + 40, folder)
        time.sleep(_BEFORE_S)
        before = _evenness(seat, _BEFORE_S)
        found = []
        for size in _SIZES[proxy]:
            was = _asked(metrics)
            began_s = time.monotonic()
            answered = _load(picture, size, seconds, folder)
            took_s = time.monotonic() - began_s
            found.append(
                {
                    "watchers": size,
                    **answered,
                    "gateway_hz": round((_asked(metrics) - was) / took_s, 1),
                    "frames": _evenness(seat, seconds),
                    "frames_before": before,
                }
            )
        told = json.loads(watching.communicate(timeout=300)[0])
        found.append(_shown(told, seat.frames, time.time() - time.monotonic()))
        return found


def _pages(
    stack: ExitStack, picture: str, pages: int, seconds: int, folder: Path
) -> subprocess.Popen[str]:
    """Start pages in Node."""
    words = [*NODE_OF_PAGES, _CROWD, picture, str(pages), str(seconds)]
    environment = {"NODE_EXTRA_CA_CERTS": str(folder / "authority.pem"), "PATH": "/usr/bin:/bin"}
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=environment)
    stack.callback(process.kill)
    return process


def _load(picture: str, size: int, seconds: int, folder: Path) -> dict[str, Any]:
    """Ask as so many watchers; return how many answers came, and how many were no piece."""
    with urllib.request.urlopen(f"{picture}/now.json", context=_trusts(folder)) as reply:
        now = json.load(reply)
    script = folder / "asks.lua"
    script.write_text(
        _ASKS.format(
            began=int(time.time()),
            first=now["closed"] - 3,
            run=now["run"],
            path=re.sub(r"https://[^/]+", "", picture),
            delay_ms=max(1, 1000 * _CONNECTIONS // size),
        )
    )
    words = ["-t1", f"-c{_CONNECTIONS}", f"-d{seconds}s", "-s", str(script), "--timeout", "10s"]
    said = subprocess.check_output([proxies.program("wrk"), *words, picture], text=True)
    wrong = re.search(r"Non-2xx or 3xx responses: (\d+)", said)
    rate = re.search(r"Requests/sec:\s+([\d.]+)", said)
    assert rate is not None, said
    return {"asked_hz": round(float(rate[1])), "refused": int(wrong[1]) if wrong else 0}


def _trusts(folder: Path) -> ssl.SSLContext:
    return ssl.create_default_context(cafile=folder / "authority.pem")


def _evenness(seat: PageClient, seconds: float) -> dict[str, float]:
    """Return how the court's frames came to a page on a WebSocket in the last seconds."""
    since_s = time.monotonic() - seconds
    times = [at_s for at_s, _ in seat.frames if at_s >= since_s]
    gaps_ms = sorted(1000 * (b - a) for a, b in itertools.pairwise(times))
    return {
        "hz": round(len(times) / seconds, 1),
        "gap_ms_99": round(gaps_ms[int(0.99 * len(gaps_ms))], 1),
        "gap_ms_most": round(gaps_ms[-1], 1),
    }


def _shown(
    pages: list[dict[str, Any]], frames: list[tuple[float, int]], epoch_s: float
) -> dict[str, Any]:
    """Return what the pages showed, against when the court's frames came on the WebSocket."""
    came_s = {beat: epoch_s + at_s for at_s, beat in frames}
    behind_s = sorted(
        shown_ms / 1000 - came_s[beat]
        for page in pages
        for beat, shown_ms in page["shown"]
        if beat in came_s
    )
    return {
        "pages": len(pages),
        "frames_least": min(page["frames"] for page in pages),
        "gaps": sum(page["gaps"] for page in pages),
        "backwards": sum(page["backwards"] for page in pages),
        "begins": [page["begins"] for page in pages],
        "behind_s_median": round(statistics.median(behind_s), 2),
        "behind_s_most": round(behind_s[-1], 2),
    }


def _asked(metrics: str) -> float:
    """Return how many requests for pieces came to the gateway."""
    with urllib.request.urlopen(f"http://{metrics}/metrics") as reply:
        found = re.search(r"^lacoc_gateway_pieces_asked_total (\S+)$", reply.read().decode(), re.M)
    assert found is not None
    return float(found[1])


def main() -> None:
    """Print what came of it."""
    options = arguments(__doc__, proxy="nginx", seconds=60, pages=20)
    found = crowd(options.proxy, options.seconds, options.pages)
    for one in found:
        print(json.dumps(one))
    pages = found[-1]
    bad = pages["gaps"] or pages["backwards"] or pages["behind_s_most"] > _MOST_BEHIND_S
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()
