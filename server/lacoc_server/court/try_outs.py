"""Lets players try their keys in the lobby: a player's robot walks alone, on another thread.

Each request of a page has all keys since its try-out began. The same keys give the same walk, so
no request needs an earlier one; the kept states only save time. Try-outs are no part of the match,
and no record has them.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import NamedTuple

from lacoc_arenas.arena import Arena
from lacoc_server.match.drive import DriveState, make_drive
from lacoc_server.match.entry import Entry
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Refusal, Scene, TriedKey, TryOutReply, TryOutRequest
from lacoc_shared.seat import WHY_NO, No, Phase
from lacoc_shared.words import say

EVERY_TICKS = 2
"""Ticks from one picture (the robot's pose) to the next."""
_KEPT_TICKS = 25
"""Ticks between two kept states: the next request goes on from a kept state, not from the start."""

_Tried = TryOutReply | Refusal


class _WalkMoment(NamedTuple):
    """The state of a walking robot in a tick, from which the walk can go on."""

    tick: int
    state: DriveState
    physics: bytes


class _LoneRobot:
    """A robot alone on the field of its match; used by one thread.

    Args:
        arena: the field.
        seat: index of the robot's seat.
        entry: the robot with its gait.
    """

    def __init__(self, arena: Arena, seat: int, entry: Entry) -> None:
        self._world = world = World(arena, [entry], seat)
        self._drive = make_drive(entry.robot, entry.gait, arena.match.repeat)
        state = self._drive.begin(arena.match.open_levels[0])
        self._kept = [_WalkMoment(0, state, world.save())]
        self._keys: tuple[TriedKey, ...] = ()

    @property
    def scene(self) -> Scene:
        """The scene of the field with the robot, for drawing."""
        return self._world.scene

    @property
    def scene_hash(self) -> bytes:
        """Hash of the scene."""
        return self._world.scene_hash

    def walk(self, keys: tuple[TriedKey, ...], first: int, until: int) -> tuple[bytes, ...]:
        """Let the robot walk from its start place.

        Args:
            keys: all keys since the beginning.
            first: tick of the first picture.
            until: tick at which the walk ends; no picture is later.

        Returns:
            The pictures (encoded poses), fewer than were asked for if physics stopped.
        """
        same = min((key.tick for key in {*keys} ^ {*self._keys}), default=until)
        self._kept = [one for one in self._kept if one.tick <= same]
        self._keys = keys
        tick, state, physics = next(one for one in reversed(self._kept) if one.tick <= first)
        world, drive = self._world, self._drive
        world.load(physics)
        due = {key.tick: key for key in keys}
        pictures: list[bytes] = []
        while True:
            if tick >= first and (tick - first) % EVERY_TICKS == 0:
                pictures.append(world.poses())
            if tick >= self._kept[-1].tick + _KEPT_TICKS:
                self._kept.append(_WalkMoment(tick, state, world.save()))
            if tick >= until:
                break
            if key := due.get(tick):
                state = drive.press(state, Level(key.level), key.key)
            state = drive.tick(state)
            if world.step([state.angles]) is not None:
                break
            tick += 1
        return tuple(pictures)


class _SeatedRobot(NamedTuple):
    """The robot of a seat, for try-outs."""

    entry: Entry
    made: list[_LoneRobot]
    """Empty, or the robot on a field of its own, made at the first request."""


class TryOuts:
    """Answers players who try their keys while their match is in the lobby.

    Args:
        aside: calls a function on another thread than the beat's, one at a time.
    """

    def __init__(self, aside: Callable[[Callable[[], _Tried]], Future[_Tried]]) -> None:
        self._aside = aside
        self._match: Match
        self._robots: dict[int, _SeatedRobot] = {}
        """The robots that were asked for, by index of the seat."""

    def hold(self, match: Match) -> None:
        """Take note of the court's match; forget the try-outs unless the match is in the lobby."""
        self._match = match
        if match.phase is not Phase.LOBBY:
            self._robots.clear()

    def __call__(self, seat: int, request: TryOutRequest) -> Refusal | Callable[[], _Tried | None]:
        """Begin to let a seat's robot walk; return a refusal, or a function that returns the reply.

        The function returns None until the walk is computed.
        """
        match = self._match
        entry, arena = match.seats[seat].entry, match.arena
        if match.phase is not Phase.LOBBY or entry is None:
            return Refusal(say("refused.try-out-over"))
        why = _why_not(entry, arena.match.open_levels, request.keys)
        if why is not No.NONE:
            return Refusal(WHY_NO[why])
        seated = self._robots.get(seat)
        if seated is None or seated.entry is not entry:
            seated = self._robots[seat] = _SeatedRobot(entry, [])
        made = seated.made

        def walk() -> _Tried:
            try:
                if not made:
                    made.append(_LoneRobot(arena, seat, entry))
                robot = made[0]
                poses = robot.walk(request.keys, request.first, request.until)
            except Exception as error:  # another package's field; no beat may fail by it
                made.clear()
                why = f"{type(error).__name__}: {error!s:.200}"
                return Refusal(say("refused.outlook", why=why))
            return TryOutReply(
                scene=robot.scene_hash,
                drawn=robot.scene if request.drawn else None,
                first=request.first,
                every=EVERY_TICKS,
                poses=poses,
            )

        future = self._aside(walk)
        return lambda: future.result() if future.done() else None


def _why_not(entry: Entry, levels: Sequence[Level], keys: Sequence[TriedKey]) -> No:
    """Return why a match would refuse one of the keys; `No.NONE` if it would accept all."""
    if any(key.level not in levels for key in keys):
        return No.LEVEL_CLOSED
    gait = entry.gait
    if any(gait.sequence(Level(key.level), key.key) is None for key in keys):
        return No.NO_SUCH_KEY
    return No.NONE
