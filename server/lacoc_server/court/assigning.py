"""Prepares matches that the office assigns to a court on another thread than that of the beats.

A match is *prepared* when its arena is loaded and the files of its teams are weighed in. To open it
then takes as long as to open any other match.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_robots.limits import Limits
from lacoc_robots.stand_test import try_standing
from lacoc_server.doors.inbox import MISTAKES_TOLD
from lacoc_server.doors.openings import frozen_join
from lacoc_server.match.entry import JoinCheck, weigh_in
from lacoc_server.world.world import World
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import PROTOCOL, Join, Refusal
from lacoc_shared.messages.office import Assign, Assigned, AssignedSeat
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import say


@dataclass(frozen=True)
class Prepared:
    """An assigned match, ready to be opened."""

    arena: Arena
    limits: dict[str, float]
    assigned: Assigned
    """What the office assigned, with the robot file of each team filled in."""


class Preparation:
    """Prepares assigned matches for an `OfficeDesk`.

    Args:
        arena: name or folder of the court's own arena.
        settings: entries of the contest file that replace those of this arena.
        seats: names of the court's seats, in the arena's order.
        join_check: fills in the files that a team does not have.
        aside: calls a function on another thread than the beat's.
    """

    def __init__(
        self,
        arena: str,
        settings: Mapping[str, Any],
        seats: Sequence[str],
        join_check: JoinCheck,
        aside: "Callable[[Callable[[], Prepared | Refusal]], Future[Prepared | Refusal]]",
    ) -> None:
        self._arena = arena
        self._settings = settings
        self._seats = list(seats)
        self._join_check = join_check
        self._aside = aside

    def __call__(self, assign: Assign) -> Callable[[], Prepared | Refusal | None]:
        """Begin to prepare a match; return a function that returns None until it is prepared."""
        future = self._aside(lambda: self._prepare(assign))
        return lambda: future.result() if future.done() else None

    def _prepare(self, assign: Assign) -> Prepared | Refusal:
        try:
            arena, limits = self._load(assign), Limits.of(assign.limits)
            found = [seat.id for seat in arena.seats]
            if found != self._seats:
                return Refusal(say("refused.assigned-seats", found=found, seats=self._seats))
            World(arena, ())  # what is wrong with the field must not appear in a beat
            levels = arena.match.open_levels
            join_check = replace(self._join_check, limits=limits, levels=levels)
            seats = []
            for seat in assign.seats:
                checked = _weighed(seat, join_check)
                if isinstance(checked, Refusal):
                    return checked
                seats.append(checked)
        except UserError as error:
            return Refusal(say("refused.assigned-arena", why=error.phrase))
        except Exception as error:  # code of another package; a beat must not fail because of it
            why = f"{type(error).__name__}: {error!s:.200}"
            return Refusal(say("refused.assigned-arena", why=why))
        assigned = msgspec.structs.replace(assign.assigned, seats=tuple(seats))
        return Prepared(arena, assign.limits, assigned)

    def _load(self, assign: Assign) -> Arena:
        looks = {seat.id: seat.look for seat in assign.seats}
        if assign.arena:
            return arenas.load_installed(assign.arena, assign.arena_settings, looks)
        return arenas.load(self._arena, arenas.merge(self._settings, assign.arena_settings), looks)


def staying(joins: Iterable[JoinSeat], assigned: Assigned, seats: Sequence[str]) -> list[JoinSeat]:
    """Return the request to join of each team that keeps its seat in the next match.

    The request has the files that the office assigned; in an open seat it is unchanged.

    Args:
        joins: the requests to join of the match before.
        assigned: the next match.
        seats: names of the seats, in the arena's order.
    """
    kept = ((join, assigned.seat(seats[join.seat])) for join in joins)
    return [
        frozen_join(join.seat, seat, join.token_hash) if seat.team else join
        for join, seat in kept
        if seat is not None and join.token_hash in seat.token_hashes
    ]


def _weighed(seat: AssignedSeat, join_check: JoinCheck) -> AssignedSeat | Refusal:
    """Weigh in the files of a team; return its seat with the robot file filled in.

    An open seat is returned unchanged: its files are weighed in when somebody joins.
    """
    if not seat.team:
        return seat
    robot, postures, locomotion = seat.files
    join = Join(
        protocol=PROTOCOL,
        token="",
        name=seat.team,
        robot=robot,
        postures=postures,
        locomotion=locomotion,
    )
    try:
        whole, _ = join_check(join)
        assert whole.robot is not None, "the check of a join fills the robot file in"
        files = whole.robot, whole.postures, whole.locomotion
        entry = weigh_in(*files, join_check.limits, join_check.levels)
        mistakes = try_standing(entry.robot, entry.gait, join_check.levels, whole.robot.name)
        if mistakes:
            raise FileRefused(mistakes)
    except FileRefused as refused:
        said = say("refused.assigned-files", team=seat.team, count=len(refused.mistakes))
        return Refusal(said, tuple(refused.mistakes[:MISTAKES_TOLD]))
    return msgspec.structs.replace(
        seat, robot=whole.robot, postures=whole.postures, locomotion=whole.locomotion
    )
