"""Checks a game that was played without a network: its record must be what `simulate` writes.

The generator of a simulated match's inputs is given the recorded frames. It must yield exactly the
recorded inputs: joins, the start of play, each key, and the decision at the end. So a forger can
add no other input. This needs no physics, and is exact on any machine.
"""

from collections.abc import Sequence
from typing import NamedTuple

from msgspec.structs import replace

from lacoc_arenas import brains
from lacoc_arenas.arena import Arena
from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_server.contest.headless.pool import bot_of
from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_server.simulate.headless import Seated, simulate
from lacoc_server.simulate.inputs import Player, whole_match
from lacoc_shared import __version__
from lacoc_shared.codec import decode
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import Phrase, say


class Side(NamedTuple):
    """The team, entry and bot of a seat, as the facts say."""

    team: str
    entry: ContestEntry
    steer: str
    """The bot that steered the team if its entry has none; "": the facts name none."""


class InputCheck(NamedTuple):
    """The result of a check of a game's inputs."""

    wrong: tuple[Phrase, ...] = ()
    """Inputs that a game without a network can't have."""
    unchecked: tuple[Phrase, ...] = ()
    """Why the keys of a team could not be checked."""


class _NoSheet(Exception):
    """Play begins in the record, but the record has no sheet that says who plays."""


def check_inputs(
    record: Record, arena: Arena, sides: Sequence[Side], late_ticks: int, *, programs: bool
) -> InputCheck:
    """Check that the inputs of a record are those that `simulate` would give to the match.

    Args:
        record: the record of the game.
        arena: its arena.
        sides: who played, by seat.
        late_ticks: how many ticks after the start of play the bots began.
        programs: whether to run the programs of bots that are in entries.
    """
    version = record.header.versions.get("lacoc", "?")
    others = [_recorded(record, seat) for seat in range(len(sides))]
    beat = _first_difference(record, _players(sides, others, late_ticks))
    if beat is not None:
        if version != __version__:
            return InputCheck(unchecked=(say("unchecked.inputs", there=version, here=__version__),))
        return InputCheck(wrong=(say("verify.of-inputs", beat=beat),))
    wrong: list[Phrase] = []
    unchecked: list[Phrase] = []
    for seat, side in enumerate(sides):
        try:
            bots = [*others]
            bots[seat] = _bot(arena, side, programs)
            beat = _first_difference(record, _players(sides, bots, late_ticks))
        except UserError as error:
            unchecked.append(error.phrase)
            continue
        if beat is None:
            continue
        if version == __version__:
            wrong.append(say("verify.of-bot", team=side.team))
        else:
            why = say("unchecked.version", team=side.team, there=version, here=__version__)
            unchecked.append(why)
    return InputCheck(tuple(wrong), tuple(unchecked))


def ends_alike(
    record: Record, arena: Arena, sides: Sequence[Side], late_ticks: int, *, programs: bool
) -> bool:
    """Play a game again on this machine with its bots.

    Return whether it ends with the recorded result.

    Raises:
        UserError: if a bot is not installed here, or breaks.
    """
    bots = [_bot(arena, side, programs) for side in sides]
    again = simulate(record.header.setup, _players(sides, bots, late_ticks))
    there = record.result
    return there is not None and (again.teams, again.scores, again.official) == (
        there.teams,
        there.scores,
        there.official,
    )


def _players(sides: Sequence[Side], bots: Sequence[BotFactory], late_ticks: int) -> list[Player]:
    return [
        Player(side.entry.join(seat, side.team), bot, late_ticks)
        for seat, (side, bot) in enumerate(zip(sides, bots, strict=True))
    ]


def _bot(arena: Arena, side: Side, programs: bool) -> BotFactory:
    """Find the bot of a team.

    Raises:
        UserError: if the bot is not installed here, if nothing names it, or if it is a program and
            programs must not run.
    """
    entry, team = side.entry, side.team
    if entry.program is not None and not programs:
        raise UserError(say("unchecked.program", team=team))
    name = entry.bot or side.steer
    if not name:
        raise UserError(say("unchecked.steer", team=team))
    try:
        if entry.program is not None:
            return bot_of(arena, Seated(entry.join(0, team), name, entry.program))
        return brains.find_installed(arena, name)
    except UserError as error:
        raise UserError(say("unchecked.bot", team=team, why=error.phrase)) from None


def _recorded(record: Record, seat: int) -> BotFactory:
    """Return a bot that presses the recorded keys of a seat, each at its recorded beat."""
    keys = {
        beat: one
        for beat, inputs in record.inputs.items()
        for one in inputs
        if isinstance(one, KeySeat) and one.seat == seat and one.level in (0, 1)
    }

    def brain(frame: Frame) -> Key | None:
        found = keys.get(frame.beat + 1)
        return None if found is None else Key(Level(found.level), found.key)

    def bot(sheet: Sheet, index: int) -> Brain:
        return brain

    return bot


def _first_difference(record: Record, players: Sequence[Player]) -> int | None:
    """Return the first beat whose inputs differ from those of `simulate`; None: all are equal.

    Raises:
        UserError: if a bot breaks.
    """
    frames = dict(record.frames)
    frame: Frame | None = None
    beat = -1

    def sheet() -> Sheet:
        found = record.sheet_at(beat)
        if found is None:
            raise _NoSheet
        return found

    script = whole_match(players, sheet)
    inputs = next(script)
    while True:
        beat += 1
        if record.inputs.get(beat, []) != inputs:
            return beat
        if beat in frames:
            frame = decode(frames[beat], Frame)
        elif frame is None:
            return beat
        else:  # a beat in which nothing happened has no frame
            frame = replace(frame, beat=beat)
        try:
            inputs = script.send(frame)
        except StopIteration:
            return None if record.last_beat == beat else beat + 1
        except _NoSheet:
            return beat
        if beat > record.last_beat:
            return beat
