"""Weighs in robots and gaits at a court's door.

The court's loop reads the files; another thread tries whether the robots stand.
"""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Self, TypeVar

from lacoc_robots.stand_test import try_standing
from lacoc_robots.standing import standing_postures
from lacoc_server.match.entry import JoinCheck, weigh_in
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import Join
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import Phrase

T = TypeVar("T")

_REMEMBERED = 32
"""Number of stand tests whose results are kept; older ones are forgotten."""


class Weighing:
    """Weighs in the files of requests to join a match; used as a context manager.

    A stand test takes some tens of milliseconds, longer than a beat. So it runs on a separate
    thread, one at a time. Its result is kept: who joins again with the same robot need not wait.

    Args:
        join_check: reads the files.
    """

    def __init__(self, join_check: JoinCheck) -> None:
        self._join_check = join_check
        self._worker = ThreadPoolExecutor(1, "weighing")
        self._tests: dict[object, Future[list[Mistake]]] = {}
        """Stand tests by everything that their result depends on; the newest last."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._worker.shutdown(cancel_futures=True)

    def __call__(
        self, join: Join, held: JoinSeat | None = None
    ) -> tuple[Join, tuple[Phrase, ...]] | None:
        """Weigh in the files of a request to join.

        Args:
            join: the request as it arrived.
            held: the request with which the seat was taken; None: nobody has the seat.

        Returns:
            The request with its robot file filled in, and notes on which files are used; None while
            the robot is being tried: call again in the next beat.

        Raises:
            FileRefused: with the mistakes of all files (`weigh_in`), or with what the robot did
                when it should stand.
        """
        join_check = self._join_check
        whole, notes = join_check(join, held)
        file = whole.robot
        assert file is not None, "the check of a join fills the robot file in"
        levels = join_check.levels
        entry = weigh_in(file, whole.postures, whole.locomotion, join_check.limits, levels)
        robot, gait = entry.robot, entry.gait
        postures = tuple(standing_postures(gait, levels, robot.start_posture))
        mistakes = self._tried(
            (robot, postures, file.name), lambda: try_standing(robot, gait, levels, file.name)
        )
        if mistakes:
            raise FileRefused(mistakes)
        return None if mistakes is None else (whole, notes)

    def aside(self, do: Callable[[], T]) -> "Future[T]":
        """Call a function on the thread of the stand tests, after the calls that wait there."""
        return self._worker.submit(do)

    def _tried(self, key: object, test: Callable[[], list[Mistake]]) -> list[Mistake] | None:
        future = self._tests.pop(key, None) or self._worker.submit(test)
        self._tests[key] = future
        if len(self._tests) > _REMEMBERED:
            del self._tests[next(iter(self._tests))]
        return future.result() if future.done() else None
