"""Measures how long a film takes for its length: `python -m benchmarks.film --seconds 180`.

It plays a match, films it twice with 1280 x 720 pixels and 30 pictures a second, and compares the
decoded pictures. It needs Chromium and the extra "film".
"""

import hashlib
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import av
from arguments import arguments
from bot_matches import bot_match
from processes import children_s

from benchmarks.figures import finish
from lacoc_client.film import film
from lacoc_client.film.look import Look, Quality

FPS = 30
BROWSERS = 2
CORES = 2
"""The aim is for a machine of so many cores, without a graphics card."""


def filming(seconds: float = 20.0, quality: Quality = Quality.SMOOTH) -> dict[str, Any]:
    """Film a match of some seconds twice.

    Returns:
        `pictures`; `length_s` of the film; `took_s`, and `ratio`, which is `took_s` divided by
        `length_s`, of the first film; `cpu_ratio`: half of the processor time of browsers and
        encoder, divided by `length_s`, which would be the ratio on two cores that do nothing else;
        `same`: whether both films have the same pictures; `bytes`; `cores` and `load`.
    """
    found: dict[str, Any] = {"cores": os.cpu_count(), "load": round(os.getloadavg()[0], 2)}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        settings = {"match": {"duration_s": seconds}}
        record = bot_match(folder, "othello", ("planner", "nearest"), settings)
        hashes = []
        for number in range(2):
            out = folder / f"{number}.mp4"
            used_s, begin_s = [0.0], time.perf_counter()
            own_s, before_s = time.process_time(), children_s()

            def note(done: int, known: int, used_s: list[float] = used_s) -> None:
                # Near the end: a browser that has ended has no time any more.
                if done % FPS == 0 or done > known - BROWSERS:
                    used_s[0] = max(used_s[0], children_s())

            look = Look(overlay=True, quality=quality)
            count = film.make([film.part(record)], out, look, FPS, BROWSERS, note)
            took_s, length_s = time.perf_counter() - begin_s, count / FPS
            busy_s = used_s[0] - before_s + time.process_time() - own_s
            hashes.append(_decoded(out, count))
            if not number:
                found |= {
                    "pictures": count,
                    "length_s": length_s,
                    "took_s": took_s,
                    "ratio": took_s / length_s,
                    "cpu_ratio": busy_s / CORES / length_s,
                    "bytes": out.stat().st_size,
                }
    return found | {"same": hashes[0] == hashes[1]}


def _decoded(path: Path, count: int) -> str:
    """Return the hash of a film's decoded pictures."""
    hashed, pictures = hashlib.blake2b(), 0
    with av.open(str(path)) as opened:
        for picture in opened.decode(video=0):
            hashed.update(picture.to_ndarray().tobytes())
            pictures += 1
    assert pictures == count
    return hashed.hexdigest()


if __name__ == "__main__":
    found = filming(arguments(__doc__, seconds=20.0).seconds)
    finish(found, found["same"])
