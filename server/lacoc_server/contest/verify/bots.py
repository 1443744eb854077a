"""Check whether an entry's bot pressed the keys of a record: show it the recorded frames again.

This needs no physics, so it is exact on any machine.
"""

from lacoc_arenas import brains
from lacoc_arenas.arena import Arena
from lacoc_server.contest.headless.pool import COURT
from lacoc_server.contest.kept.entries import Entry
from lacoc_shared import __version__
from lacoc_shared.codec import decode
from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase


def may_have_pressed(
    record: Record, arena: Arena, seat: int, entry: Entry, late_ticks: int
) -> bool:
    """Return whether the keys of a seat can be those of an entry's bot.

    True also where this can't be known: people or another bot may have steered the team, the bot
    may be a program of its own (no code of a stranger runs here) or of another version, or the game
    was played at a court, where nobody knows which frames the bot had seen in time.

    Args:
        record: the record of the game.
        arena: its arena.
        seat: the seat.
        entry: the entry.
        late_ticks: how many ticks later than the match the bot started.
    """
    header = record.header
    installed = entry.bot and entry.program is None and not entry.bot.startswith(brains.GHOST)
    same_software = header.versions.get("lacoc") == __version__
    if not installed or not same_software or header.setup.court != COURT:
        return True
    pressed = [
        (beat, one.level, one.key)
        for beat, inputs in sorted(record.inputs.items())
        for one in inputs
        if isinstance(one, KeySeat) and one.seat == seat
    ]
    try:
        return pressed == _keys(record, arena, seat, entry.bot, late_ticks)
    except UserError:  # the bot is not installed here, or breaks
        return True


def _keys(
    record: Record, arena: Arena, seat: int, bot: str, late_ticks: int
) -> list[tuple[int, int, int]]:
    """Return what a bot presses when it sees the frames of a record: beat, level and key.

    Raises:
        UserError: if it is not installed here, or breaks.
    """
    frames = [(beat, decode(encoded, Frame)) for beat, encoded in record.frames]
    sheet = record.sheet_at(next((b for b, one in frames if one.phase == Phase.READY), 0))
    if sheet is None:
        return []
    mind = brains.find_installed(arena, bot)(sheet, seat)
    keys = []
    for beat, frame in frames:
        if frame.phase == Phase.PLAYING and frame.clock_ticks > late_ticks:
            key = mind(frame)
            if key is not None:
                keys.append((beat + 1, int(key.level), key.key))
    return keys
