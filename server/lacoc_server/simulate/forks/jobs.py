"""Describes a fork that is to be played, in a form that can be sent to another process."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_arenas.bot import BotFactory
from lacoc_server.simulate.forks.fork import Forked, fork
from lacoc_server.simulate.forks.line import ForkChange, Press, of_bot
from lacoc_server.simulate.forks.origin import ForkSource, read_source
from lacoc_server.simulate.forks.script import Script, of_script
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.schema import ForkChanges, ForkSeat
from lacoc_shared.words import Phrase, say


class ForkJob(msgspec.Struct, frozen=True, kw_only=True):
    """A fork to play."""

    file: str
    """Path of the record."""
    beat: int
    take_back: int | None = None
    restart: tuple[str, ...] = ()
    scripts: dict[str, Script] = {}
    """The key script of each seat that a script plays, by id of the seat."""
    bots: tuple[str, ...] = ()
    """The bot of each seat; `brains.RECORDED`: the seat keeps its recorded keys. Empty: all seats
    keep theirs."""
    variant: int = 0
    """Number that chooses how late the bots press their keys; see `line.of_bot`."""
    seconds: float | None = None
    match_id: str = "fork"
    folder: str | None = None
    """Folder of the fork's record; None: there is none."""
    arena: str | None = None
    """Folder of the arena, if it is not installed."""


def play_fork(job: ForkJob) -> Forked:
    """Play a fork.

    Raises:
        UserError: as `fork.fork` does; or if there is no such seat or bot, or a script has a
            mistake.
    """
    source = opened_record(job.file)
    folder = Path(job.folder) if job.folder else None
    arena = Path(job.arena) if job.arena else None
    return fork(
        source,
        job.beat,
        _change(job, source, arena),
        changes=changes_of(job, source),
        match_id=job.match_id,
        folder=folder,
        seconds=job.seconds,
        arena=arena,
    )


def attempt_fork(job: ForkJob) -> Forked | Phrase:
    """Play a fork; return the phrase of an error that a user can correct, instead of raising it."""
    try:
        return play_fork(job)
    except UserError as error:
        return error.phrase


@lru_cache(maxsize=1)
def opened_record(file: str) -> ForkSource:
    """Read a record, and keep it in memory until another is read: many forks go on from one.

    Raises:
        UserError: as `origin.read_source` does.
    """
    return read_source(Path(file))


def bots_of(source: ForkSource, names: tuple[str, ...], folder: Path | None) -> list[BotFactory]:
    """Find the bots with these names; they must fit the game of the record.

    Raises:
        UserError: if there is no such bot.
    """
    setup = source.record.header.setup
    arena = arenas.from_settings(setup.arena, setup.settings, folder)
    return [brains.find(arena, name) for name in names]


def changes_of(job: ForkJob, source: ForkSource) -> ForkChanges:
    """Return what differs between a fork and its origin, as the fork's own record describes it."""
    bots = dict(zip(source.seats, job.bots, strict=False))
    seats = tuple(
        ForkSeat(seat=seat, bot=_bot_name(bots.get(seat, "")), script=_script_name(job, seat))
        for seat in source.seats
    )
    return ForkChanges(
        seats=seats, take_back=job.take_back, restart=job.restart, variant=job.variant
    )


def _bot_name(bot: str) -> str:
    """Return a bot's name for a record, without the private path of its file."""
    if bot == brains.RECORDED:
        return ""
    ghost = brains.GHOST if bot.startswith(brains.GHOST) else ""
    return ghost + Path(bot.removeprefix(ghost)).name


def _script_name(job: ForkJob, seat: str) -> str:
    return Path(job.scripts[seat].file).name if seat in job.scripts else ""


def _change(job: ForkJob, source: ForkSource, folder: Path | None) -> ForkChange:
    seats = source.seats
    for seat in (*job.restart, *job.scripts):
        if seat not in seats:
            raise UserError(say("fork.no-seat", seat=seat, seats=seats))
    if job.bots and len(job.bots) != len(seats):
        raise UserError(say("fork.players", seats=seats, given=len(job.bots)))
    _check_event(job, source)
    players: dict[int, Callable[[], Press]] = {}
    for index, name in enumerate(job.bots):
        if name != brains.RECORDED:
            (bot,) = bots_of(source, (name,), folder)
            players[index] = of_bot(bot, index, job.variant)
    for seat, script in job.scripts.items():
        if seats.index(seat) in players:
            raise UserError(say("fork.two-players", seat=seat))
        players[seats.index(seat)] = of_script(script, seats.index(seat))
    return ForkChange(job.take_back, job.restart, players)


def _check_event(job: ForkJob, source: ForkSource) -> None:
    """Check that the event that is to be taken back happened before the fork."""
    for event in source.record.events:
        if event.number == job.take_back and event.beat >= job.beat:
            raise UserError(say("fork.event-later", event=event.number, beat=event.beat))
