"""Streams matches to a video server, and reads its recording: `python -m benchmarks.stream`.

    python -m benchmarks.stream [--size 854x480] [--fps 30] [--seconds 300]

Two bots play match after match on this machine, `lacoc stream` sends them to nginx, which records
the stream. It prints how many pictures a second and how much sound the recording has, and how far
its clock is from the court's: from the moment in which a page on a WebSocket gets another second to
the picture in which the clock changes. It needs Chromium, nginx and libnginx-mod-rtmp of Debian.
"""

import os
import signal
import subprocess
import tempfile
import threading
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import av
import numpy as np
from arguments import arguments
from lacoc_process import Lacoc, environment
from page_client import PageClient
from ports import free_port
from show import decide
from venue import TOKENS, Venue

from benchmarks.figures import finish
from lacoc_shared.seat import BEATS_PER_S, Phase

_BOTS = {"left": "planner", "right": "nearest"}
_BEGINS_S = 15.0
_CLOCK = (slice(0.035, 0.085), slice(0.455, 0.545))
"""Place of the match clock in a picture: from and to, as shares of the height and of the width."""
_OTHER = 4.0
"""If the pixels of two pictures of the clock differ by more than this on average, the second of one
is not that of the other."""
_NEAR_S = 2.0
_AIM_S = 1.0
_SERVER = """load_module /usr/lib/nginx/modules/ngx_rtmp_module.so;
daemon off; pid {folder}/pid; error_log {folder}/error.log; worker_processes 1;
events {{}}
rtmp {{ server {{ listen 127.0.0.1:{port}; application live {{
  live on; record all; record_path {folder}/got; record_suffix .flv; }} }} }}
"""


def streaming(size: str, fps: int, seconds: float) -> dict[str, Any]:
    """Stream for some seconds; return what the video server got."""
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        got = folder / "got"
        got.mkdir()
        folder.chmod(0o755)  # the server's worker is another user
        got.chmod(0o777)
        port = free_port()
        (folder / "nginx.conf").write_text(_SERVER.format(folder=folder, port=port))
        server = subprocess.Popen(["nginx", "-c", str(folder / "nginx.conf")])
        stack.callback(server.terminate)
        venue = Venue(folder, stack)
        venue.court()
        venue.web()
        for seat, bot in _BOTS.items():
            link = ("--connect", f"tcp/127.0.0.1:{venue.court_port}", "--token", TOKENS[seat])
            stack.callback(Lacoc("bot", bot, *link, stdout=subprocess.DEVNULL).kill)
        referee = venue.referee()
        referee.phase(Phase.READY)
        look = ("--court", "main", "--size", size, "--fps", str(fps))
        where = f"rtmp://127.0.0.1:{port}/live/key"
        stream = Lacoc("stream", where, "--pages", venue.url, *look, env=environment())
        stack.callback(stream.kill)
        time.sleep(_BEGINS_S)
        end_s = time.time() + seconds
        changes_s: list[float] = []
        watching = threading.Thread(target=_watch, args=(venue.page(hz=50), end_s, changes_s))
        watching.start()
        _play(referee, end_s)
        watching.join()
        load = round(os.getloadavg()[0], 1)
        stream.send_signal(signal.SIGINT)
        stream.wait(60)
        (file,) = got.glob("*.flv")
        return {"size": size, "load": load, **_read(file, changes_s)}


def _watch(page: PageClient, end_s: float, changes_s: list[float]) -> None:
    """Note each moment in which a page on a WebSocket gets another second of play."""
    last = None
    while time.time() < end_s:
        frame = page.frame
        if frame is not None and frame.phase == Phase.PLAYING:
            second = frame.clock_ticks // BEATS_PER_S
            if second != last:
                changes_s.append(time.time())
            last = second
        time.sleep(0.005)


def _play(referee: Any, end_s: float) -> None:
    """Start and end match after match, as a referee does."""
    decide(referee, type="start")
    while time.time() < end_s:
        time.sleep(1)
        if referee.frame is not None and referee.frame.phase == Phase.FINISHED:
            time.sleep(3)
            decide(referee, type="official")
            time.sleep(4)
            decide(referee, type="next")
            referee.phase(Phase.READY)
            decide(referee, type="start")


def _read(file: Path, changes_s: list[float]) -> dict[str, Any]:
    """Count pictures and sound of a recording, and compare its clock with the court's."""
    times, shown = [], []
    before: np.ndarray | None = None
    with av.open(str(file)) as container:
        for frame in container.decode(video=0):
            times.append(float(frame.time))
            clock = _clock(frame.to_ndarray(format="gray"))
            if before is not None and np.abs(clock - before).mean() > _OTHER:
                shown.append(times[-1])
            before = clock
    with av.open(str(file)) as container:
        sound_s = sum(one.samples / one.sample_rate for one in container.decode(audio=0))
    # The server writes the last picture when it comes.
    began_s = file.stat().st_mtime - times[-1]
    known = np.array(changes_s)
    late_s = [began_s + at - known[np.abs(known - began_s - at).argmin()] for at in shown]
    late_s = [one for one in late_s if abs(one) < _NEAR_S]
    length_s = times[-1] - times[0]
    return {
        "pictures_a_second": round(len(times) / length_s, 2),
        "length_s": round(length_s, 1),
        "sound_s": round(sound_s, 1),
        "clock_changes": len(late_s),
        "clock_off_p50_s": round(float(np.median(late_s)), 3),
        "clock_off_p95_s": round(float(np.quantile(np.abs(late_s), 0.95)), 3),
    }


def _clock(picture: np.ndarray) -> np.ndarray:
    """Return the part of a picture in which the clock stands."""
    parts = [
        slice(int(part.start * pixels), int(part.stop * pixels))
        for part, pixels in zip(_CLOCK, picture.shape, strict=True)
    ]
    return picture[tuple(parts)].astype(int)


def main() -> None:
    """Stream, print, and exit with 1 if the clock is off by more than a second."""
    options = arguments(__doc__, size="854x480", fps=30, seconds=300.0)
    found = streaming(options.size, options.fps, options.seconds)
    finish(found, found["clock_off_p95_s"] < _AIM_S)


if __name__ == "__main__":
    main()
