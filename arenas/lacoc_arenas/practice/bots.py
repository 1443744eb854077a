"""A bot for practice: it shows what each key of its gait does."""

from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.seat import BEATS_PER_S

_TICKS_PER_KEY = 4 * BEATS_PER_S


def walk(sheet: Sheet, seat: int) -> Brain:
    """Make a brain that presses each key for four seconds, at level B if it is open, else at A."""
    postures, sequences = sheet.seats[seat].keys
    level = Level.LOCOMOTION if sequences and Level.LOCOMOTION in sheet.levels else Level.POSTURE
    keys = [Key(level, digit) for digit in (sequences if level else postures)]

    def brain(frame: Frame) -> Key | None:
        if not keys:
            return None
        standing = frame.seats[seat]
        wanted = keys[frame.clock_ticks // _TICKS_PER_KEY % len(keys)]
        return None if (standing.level, standing.key) == wanted else wanted

    return brain


BOTS: dict[str, BotFactory] = {"walk": walk}
