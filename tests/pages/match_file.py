"""Plays matches of bots, and packs them as files for the stand (client/web/src/scene/stand)."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from lacoc_arenas import arena as arenas
from lacoc_server.simulate import player, simulate
from lacoc_shared.codec import encode
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Setup


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
    ground = arenas.load(arena, {"match": {"duration_s": seconds, "countdown_s": 1.0}})
    bots = ("planner", "nearest")
    seats = range(len(ground.seats))
    players = [
        player(ground, seat, bots[seat % 2], robots[seat], ("Ants", "Bees")[seat]) for seat in seats
    ]
    setup = Setup(
        match_id="m", court="main", match=1, arena=arena, settings=ground.settings, limits={}
    )
    with tempfile.TemporaryDirectory() as folder:
        simulate(setup, players, Path(folder))
        record = Record.read(Path(folder) / "m.mcap")
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
