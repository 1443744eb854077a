"""Finds what the keys of seated robots do: each is tried in physics, on another thread.

Only pages need it, to name the keys. So it is no part of the match, and no record has it.
"""

from collections.abc import Callable
from concurrent.futures import Future
from typing import NamedTuple

from lacoc_server.match.seat import Seat
from lacoc_server.trial.course import Course
from lacoc_server.trial.moves import try_key
from lacoc_server.world.sensed import make_course
from lacoc_shared.gait.tables import Level

_REMEMBERED = 32
"""Number of gaits whose moves are kept; older ones are forgotten."""


class _RobotTrials(NamedTuple):
    """The trials of one robot's keys."""

    found: list[Future[str]]
    """What each key does, in the order of the keys; the last trial may still run."""
    courses: list[Course]
    """Empty, or the compiled floor on which the trials run."""


class KeyTrials:
    """Tries the keys of level B of every seat's robot, one key after another.

    Args:
        aside: calls a function on another thread than the beat's.
    """

    def __init__(self, aside: Callable[[Callable[[], str]], Future[str]]) -> None:
        self._aside = aside
        self._tried: dict[object, _RobotTrials] = {}
        """The trials by the files of robot and gait; those asked for last are at the end."""

    def __call__(self, seat: Seat, may_begin: bool) -> tuple[str, ...]:
        """Return what each key of a seat does (texts `move.*`), up to the first untried key.

        Args:
            seat: the seat.
            may_begin: whether the next trial may begin now: while two robots play, nothing beside
                the match may slow it down.
        """
        join, entry = seat.join, seat.entry
        if join is None or entry is None:
            return ()
        files = join.robot, join.locomotion
        tried = self._tried.pop(files, None) or _RobotTrials([], [])
        self._tried[files] = tried
        if len(self._tried) > _REMEMBERED:
            del self._tried[next(iter(self._tried))]
        known = tuple(future.result() for future in tried.found if future.done())
        keys = entry.gait.keys(Level.LOCOMOTION)
        if may_begin and len(known) == len(tried.found) < len(keys):
            robot, gait, digit = entry.robot, entry.gait, keys[len(known)]

            def walk() -> str:
                try:
                    if not tried.courses:
                        tried.courses.append(make_course(robot))
                    return try_key(tried.courses[0], gait, digit)
                except Exception:  # no beat may fail by it: the key has no name then
                    return ""

            tried.found.append(self._aside(walk))
        if len(known) == len(keys):
            tried.courses.clear()  # the floor's memory
        return known
