"""Reads the keys of a trial as a person types them: "2", or "1:3, A4:1.5, 2"."""

import math
import re
from collections.abc import Iterator

from lacoc_server.trial.walk import Press
from lacoc_shared.gait.tables import Gait, Level
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import say

FORWARD = 2
"""The sample's key for forward (workshop Fig. 4-2)."""

_KEY = re.compile(r"(?P<level>[AaBb]?)(?P<digit>[0-9])(:(?P<seconds>[0-9.]+))?", re.ASCII)
_LONGEST_S = 60.0


def forward_key(gait: Gait) -> tuple[Level, int]:
    """Return the level and the digit of the key to try if the person names none.

    A gait without level B is tried with the last key of level A. A gait with level B is tried with
    `FORWARD`, or with its first key if it has no such key. The key is tried
    even if it does nothing yet, because its author wants to see that.
    """
    if gait.locomotion is None:
        return Level.POSTURE, gait.keys(Level.POSTURE)[-1]
    has_forward = len(gait.locomotion.sequences) > FORWARD
    return Level.LOCOMOTION, FORWARD if has_forward else 0


def parse_keys(text: str, gait: Gait, first_tick: int) -> list[Press]:
    """Read keys that a person typed.

    Args:
        text: keys in order, separated by commas. Each key is a digit. A letter before the digit
            names the key's level ("A4"). Each key but the last has its time behind it ("1:3" is
            key 1 for 3 s). The last key stays pressed to the end.
        gait: the gait that has the keys.
        first_tick: tick in which the first key is pressed.

    Raises:
        UserError: if the text is not of this form, if a time is over 60 s, or if the gait has no
            such key.
    """
    presses: list[Press] = []
    tick = first_tick
    words = [word.strip() for word in text.split(",")]
    for index, word in enumerate(words):
        found = _KEY.fullmatch(word)
        seconds = _seconds(found["seconds"]) if found else None
        is_last = index == len(words) - 1
        if found is None or seconds is None or (found["seconds"] is None) != is_last:
            raise UserError(say("trial.wrong-keys", found=word))
        digit = int(found["digit"])
        level = _level(found["level"], digit, gait)
        presses.append(Press(tick, level, digit))
        tick += max(1, round(seconds * BEATS_PER_S))
    return presses


def _seconds(text: str | None) -> float | None:
    """Read a time [s]; no text is 0. None if the text is no time, or the time is too long."""
    try:
        seconds = float(text or 0)
    except ValueError:
        return None
    return seconds if math.isfinite(seconds) and seconds <= _LONGEST_S else None


def _level(letter: str, digit: int, gait: Gait) -> Level:
    """Return the level that a key's letter names.

    Without a letter it is level B if level B has the key, else level A.

    Raises:
        UserError: if the gait has no such key.
    """
    wanted = {"": (Level.LOCOMOTION, Level.POSTURE), "A": (Level.POSTURE,)}
    for level in wanted.get(letter.upper(), (Level.LOCOMOTION,)):
        if gait.sequence(level, digit) is not None:
            return level
    there = list(_names(gait))
    raise UserError(say("trial.no-key", key=f"{letter.upper()}{digit}", keys=there))


def _names(gait: Gait) -> Iterator[str]:
    for level in Level:
        for digit in gait.keys(level):
            yield f"{'AB'[level]}{digit}"
