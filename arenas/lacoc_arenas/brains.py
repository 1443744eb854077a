"""Find a bot by name: a game's own bot, an installed bot, a bot file, or the ghost of a record."""

import hashlib
import sys
from collections import deque
from contextlib import chdir
from pathlib import Path
from types import ModuleType
from typing import Any

from lacoc_arenas.arena import Arena
from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_arenas.checked_bot import checked, loaded
from lacoc_shared.codec import decode
from lacoc_shared.command import plugins
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import JoinSeat, KeySeat
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

GROUP = "lacoc.bots"
GHOST = "ghost:"
RECORDED = "-"
"""Stands in place of a bot's name where a recorded match goes on: the seat is steered by its
recorded keys."""


def find(arena: Arena, name: str) -> BotFactory:
    """Find a bot by its name, for an arena.

    Args:
        arena: the arena, with bots of its own.
        name: a bot of the arena; an installed bot (entry-point group `lacoc.bots`); a Python
            file with a function `bot(sheet, seat)`; or "ghost:RECORD.mcap:SEAT", which presses
            the keys of a recorded match again.

    Returns:
        The bot. If it breaks or returns something that is not a key, it raises UserError with
        the line of its own code.

    Raises:
        UserError: if there is no such bot (the message lists the bots there are), or if the
            bot's file has a mistake.
    """
    return checked(name, _find(arena, name))


def find_installed(arena: Arena, name: str) -> BotFactory:
    """Find a bot of the arena or an installed bot; the name may come from a stranger.

    No file is opened, so no code of a file runs. Arguments and result are as in `find`.

    Raises:
        UserError: if there is no such bot.
    """
    return checked(name, _installed(arena, name))


def of_program(name: str, source: bytes) -> BotFactory:
    """Make a bot from the Python source of a bot file; the result is as in `find`.

    Args:
        name: name of the file, for messages.
        source: Python source with a function `bot(sheet, seat)`.

    Raises:
        UserError: if the source has a mistake.
    """
    return checked(name, _from_source(name, source))


def _find(arena: Arena, name: str) -> BotFactory:
    if name.startswith(GHOST):
        record, seat = open_ghost(name)
        return lambda sheet, index: ghost(record, seat)
    if name.endswith(".py") and name not in arena.bots:
        return _from_file(name)
    return _installed(arena, name)


def _installed(arena: Arena, name: str) -> BotFactory:
    if name in arena.bots:
        return arena.bots[name]
    installed = plugins.installed(GROUP)
    if name in installed:
        factory: BotFactory = installed[name].load()
        return factory
    raise UserError(
        say("bot.none", name=name, arena=arena.name, own=[*arena.bots], installed=[*installed])
    )


def open_ghost(name: str) -> tuple[Record, int]:
    """Read the record of a ghost and find its seat.

    Args:
        name: "ghost:RECORD.mcap", followed by ":SEAT" if the record has two seats.

    Raises:
        UserError: if there is no such record or seat.
    """
    path, seat = ghost_file(name)
    record = Record.read(path)
    seats = [entry["id"] for entry in record.header.setup.settings["seat"]]
    if not seat and len(seats) == 1:
        return record, 0
    if seat not in seats:
        raise UserError(say("bot.whose-ghost", name=name, seats=seats))
    return record, seats.index(seat)


def ghost_file(name: str) -> tuple[Path, str]:
    """Return the path of a ghost's record and the id of the ghost's seat; "": none is named."""
    path, _, seat = name.removeprefix(GHOST).partition(".mcap:")
    return Path(f"{path}.mcap" if seat else path), seat


def ghost_join(record: Record, seat: int) -> JoinSeat:
    """Return how a ghost's seat was taken last: team, robot and gait files.

    Raises:
        UserError: if nobody joined this seat.
    """
    joins = [
        item
        for items in record.inputs.values()
        for item in items
        if isinstance(item, JoinSeat) and item.seat == seat
    ]
    if not joins:
        raise UserError(say("bot.nobody", seat=seat))
    return joins[-1]


def ghost(record: Record, seat: int) -> Brain:
    """Make a brain that presses keys of a record again, each at its recorded clock time.

    Keys that were refused, for example those before play, had no effect and are left out.
    """
    keys: deque[tuple[int, Key]] = deque()
    frame_of = {beat: decode(encoded, Frame) for beat, encoded in record.frames}
    for beat in sorted(record.inputs):
        frame = frame_of.get(beat)
        if frame is None or frame.seats[seat].applied_beat != beat:
            continue
        for item in record.inputs[beat]:
            if isinstance(item, KeySeat) and item.seat == seat:
                keys.append((frame.clock_ticks, Key(Level(item.level), item.key)))

    def brain(frame: Frame) -> Key | None:
        # A key returned for this frame takes effect in the next tick.
        if keys and frame.phase == Phase.PLAYING and frame.clock_ticks + 1 >= keys[0][0]:
            return keys.popleft()[1]
        return None

    return brain


def _from_file(name: str) -> BotFactory:
    path = Path(name).expanduser()
    try:
        source = path.read_bytes()
    except OSError:
        raise UserError(say("bot.no-file", path=str(path))) from None
    return _from_source(str(path), source)


def _from_source(name: str, source: bytes) -> BotFactory:
    """Run the Python source of a bot; tracebacks name its file `name`.

    Raises:
        UserError: if it fails, or has no function `bot`.
    """
    digest = hashlib.blake2b(name.encode(errors="replace") + source, digest_size=6)
    module: Any = ModuleType(f"lacoc_bot_{digest.hexdigest()}")
    module.__file__ = name
    # `dataclasses` looks there for the module of a class, also while the bot plays.
    sys.modules[module.__name__] = module

    def load() -> None:
        with chdir("."):  # the bot may go to another folder
            exec(compile(source, name, "exec", dont_inherit=True), module.__dict__)

    try:
        loaded(name, load)
        if not callable(getattr(module, "bot", None)):
            raise UserError(say("bot.no-function", path=name))
    except UserError:
        sys.modules.pop(module.__name__, None)
        raise
    factory: BotFactory = module.bot
    return factory
