"""The inputs of a match without a network, beat by beat.

A script is a generator: it yields the inputs of the next beat, and is sent the frame of that beat.
`simulate` plays a match with it. A check of a record sends it the recorded frames instead, and so
learns which inputs the record must have.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

from lacoc_arenas.bot import BotFactory
from lacoc_shared.decisions import Abort, Official, Start
from lacoc_shared.inputs import Decide, Input, JoinSeat, KeySeat, ReadySeat
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEATS_PER_S, Phase
from lacoc_shared.words import Phrase, say

P = ParamSpec("P")
T = TypeVar("T")

AUTHOR = "simulate"
"""Author of the decisions in a match without a referee."""
SETTLE_BEATS = BEATS_PER_S
"""Robots stand in READY until this beat of the match; then the match is started."""

Inputs = list[Input]


class BotFailed(UserError):
    """A team's bot raised an error, took too long, or returned neither a key nor None."""

    CODE = "simulate.bot-failed"
    """The code of the phrase of every `BotFailed`."""


def failed(team: str, why: Phrase) -> BotFailed:
    """Make the error which says that a team's bot failed, and why."""
    return BotFailed(say("simulate.bot-failed", team=team, why=why))


@dataclass(frozen=True)
class Player:
    """A player of a seat: files and a bot."""

    join: JoinSeat
    """The request to join the match, with the files; its `seat` is the player's seat."""
    bot: BotFactory
    late_ticks: int = 0
    """Ticks of PLAYING that pass before the brain sees its first frame. Players who meet again get
    another number, so that their next match differs.
    """


def whole_match(
    players: Sequence[Player], sheet: Callable[[], Sheet]
) -> Generator[Inputs, Frame, None]:
    """Yield the inputs of each beat of a match, up to the decision that closes it.

    Args:
        players: one for each seat.
        sheet: returns the match's sheet; it is called when play begins.

    Raises:
        BotFailed: if a bot fails.
    """
    frame = yield from opening([player.join for player in players])
    if frame.phase == Phase.PLAYING:
        frame = yield from _play(frame, players, sheet())
    yield [closing(Phase(frame.phase))]


def opening(joins: Sequence[JoinSeat]) -> Generator[Inputs, Frame, Frame]:
    """Yield the inputs of each beat until play begins: teams join, are ready, the match starts.

    Args:
        joins: for each seat, the request of its team to join, with its files.

    Returns:
        The newest frame. Its phase is PLAYING, unless MuJoCo reported a fault, or a robot did not
        stay on its start place.
    """
    yield [*joins]
    frame = yield [ReadySeat(join.seat, True) for join in joins]
    while frame.phase == Phase.READY and frame.beat < SETTLE_BEATS:
        frame = yield []
    if frame.phase == Phase.READY:
        frame = yield [Decide(AUTHOR, "", Start())]
    while frame.phase == Phase.COUNTDOWN:
        frame = yield []
    return frame


def _play(frame: Frame, players: Sequence[Player], sheet: Sheet) -> Generator[Inputs, Frame, Frame]:
    """Yield the keys of all players while play goes on; return the first frame after it."""
    minds = [_asked(player, player.bot, sheet, player.join.seat) for player in players]
    seqs = [0] * len(players)
    while frame.phase == Phase.PLAYING:
        keys: Inputs = []
        for index, (player, mind) in enumerate(zip(players, minds, strict=True)):
            late = frame.clock_ticks <= player.late_ticks
            key = None if late else _asked(player, mind, frame)
            if key is not None:
                seqs[index] += 1
                keys.append(KeySeat(player.join.seat, seqs[index], int(key.level), key.key))
        frame = yield keys
    return frame


def _asked(player: Player, bot: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Call a player's bot or brain; if it fails, raise `BotFailed` with the team's name."""
    try:
        return bot(*arguments, **named)
    except UserError as error:
        raise failed(player.join.team, error.phrase) from error


def closing(phase: Phase) -> Decide:
    """Return the decision that closes a match.

    It makes the result official if play has ended in `phase`; else it makes the match void.
    """
    if phase is Phase.FINISHED:
        return Decide(AUTHOR, "", Official())
    halted = phase is Phase.HALTED
    reason = say("reason.physics-stopped") if halted else say("reason.ended-early")
    return Decide(AUTHOR, reason, Abort())
