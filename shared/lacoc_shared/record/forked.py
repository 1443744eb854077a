"""Returns sentences about how a fork was made (`Origin.changes`)."""

from collections.abc import Iterator

from lacoc_shared.record.schema import ForkChanges, ForkSeat
from lacoc_shared.words import Phrase, say


def how(changes: ForkChanges | None) -> Phrase:
    """Return how a fork was made: who steers its robots, and what was decided.

    Args:
        changes: the changes that the fork's record contains; None: it is an older record and
            contains none.
    """
    if changes is None:
        return say("forked.unknown")
    if changes.is_none:
        return say("forked.nothing")
    return say("forked.changed", changes=[*_changes(changes)])


def _changes(changes: ForkChanges) -> Iterator[Phrase]:
    if any(one.bot or one.script for one in changes.seats):
        yield from map(_player, changes.seats)
    if changes.take_back is not None:
        yield say("forked.take-back", event=changes.take_back)
    for seat in changes.restart:
        yield say("forked.restart", seat=seat)
    if changes.variant:
        yield say("forked.variant", variant=changes.variant)


def _player(one: ForkSeat) -> Phrase:
    if one.bot:
        return say("forked.bot", seat=one.seat, bot=one.bot)
    if one.script:
        return say("forked.script", seat=one.seat, script=one.script)
    return say("forked.recorded", seat=one.seat)
