"""Makes level B from level A: joins postures into the sequences of a locomotion table."""

from collections.abc import Sequence

from lacoc_shared.gait.cells import MAX_KEYS, MAX_POSTURES_PER_KEY
from lacoc_shared.gait.tables import SAMPLE_KEYS, LocomotionTable, PostureTable, to_locomotion
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def join_postures(table: PostureTable, name: str, keys: Sequence[Sequence[int]]) -> LocomotionTable:
    """Join postures (level A) into the sequences of a locomotion table (level B).

    Args:
        table: the postures.
        name: name of their file, for error messages.
        keys: for each digit key from 0 on, the digits of the postures of its sequence.

    Raises:
        UserError: if there is no key, there are too many keys or postures, a key has no posture, or
            a posture is not in the file.
    """
    longest = max(map(len, keys), default=0)
    if not 1 <= len(keys) <= MAX_KEYS or longest > MAX_POSTURES_PER_KEY:
        raise UserError(
            say(
                "sequences.too-many",
                keys=len(keys),
                longest=longest,
                most_keys=MAX_KEYS,
                most_postures=MAX_POSTURES_PER_KEY,
            )
        )
    for digit, sequence in enumerate(keys):
        if not sequence:
            raise UserError(say("sequences.empty", key=digit))
        for posture in sequence:
            if posture not in table.postures:
                there = ", ".join(map(str, sorted(table.postures)))
                raise UserError(
                    say(
                        "sequences.no-posture",
                        key=digit,
                        posture=posture,
                        file=name,
                        postures=there,
                    )
                )
    return to_locomotion(table, tuple(map(tuple, keys)))


def sample_sequences(table: PostureTable) -> LocomotionTable | None:
    """Join postures into the sample gait's sequences; None if the table lacks a posture."""
    used = {posture for sequence in SAMPLE_KEYS for posture in sequence}
    return to_locomotion(table, SAMPLE_KEYS) if used <= table.postures.keys() else None
