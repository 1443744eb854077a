"""Plays matches of bots, and packs them as files for the stand (client/web/src/scene/stand)."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from bot_matches import bot_match

from lacoc_arenas import arena as arenas
from lacoc_shared.codec import encode
from lacoc_shared.record.reader import Record


def match_file(arena: str, seconds: float, robots: Sequence[str] = ("hexapod", "hexapod")) -> bytes:
    """Play a match and pack what a court would have published.

    Args:
        arena: an installed arena.
        seconds: length of play [s].
        robots: names of the seats' robots.

    Returns:
        msgpack of {sheet, scene, frames}; each message in it is msgpack by itself. The scene is
        the last one, which contains the robots; all frames belong to this scene.
    """
    settings = {"match": {"duration_s": seconds, "countdown_s": 1.0}}
    bots = ("planner", "nearest")[: len(arenas.load(arena).seats)]
    with tempfile.TemporaryDirectory() as folder:
        record = Record.read(
            bot_match(Path(folder), arena, bots, settings, robots=robots, teams=("Ants", "Bees"))
        )
    last = record.last_beat
    sheet, scene = record.sheet_at(last), record.scene_at(last)
    assert sheet is not None
    begin = next(beat for beat, _ in reversed(record.scenes))
    return encode(
        {
            "sheet": encode(sheet),
            "scene": encode(scene),
            "frames": [data for beat, data in record.frames if beat >= begin],
        }
    )
