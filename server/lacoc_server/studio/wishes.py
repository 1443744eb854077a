"""Fulfils a student's request to search for gaits: checks it, searches, and makes the reply.

A request asks for the coach (a better gait), a map (the best gait of each cell of a grid), or
variants (six gaits to choose from).
"""

import threading
from collections.abc import Sequence
from enum import StrEnum
from typing import TypeVar

from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.answers import read_files
from lacoc_server.studio.coach.coach import Tell, coach, coached_key, reply_of, task_of
from lacoc_server.studio.coach.improve import Size
from lacoc_server.studio.coach.table import Angles
from lacoc_server.studio.coach.trials import Task, Trials
from lacoc_server.studio.styles.found import map_reply, variants_reply
from lacoc_server.studio.styles.gait_map import map_gaits
from lacoc_server.studio.styles.variants import vary
from lacoc_server.trial.reasons.goal import Goal
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import (
    CoachReply,
    CoachRequest,
    MapReply,
    MapRequest,
    VariantsReply,
    VariantsRequest,
)
from lacoc_shared.words import say

_MOST_S = 120.0
"""Longest search that a request may ask for [s]."""
_MOST_KEPT, _MOST_BEFORE = 2, 60
"""Most parents that a request for variants may have, and most tables that it may list as seen."""

SearchRequest = CoachRequest | MapRequest | VariantsRequest
REQUESTS: dict[str, type[SearchRequest]] = {
    "coach": CoachRequest,
    "map": MapRequest,
    "variants": VariantsRequest,
}
"""The requests for searches, by the last part of their key expressions."""

_Choice = TypeVar("_Choice", bound=StrEnum)


def fulfil(
    request: SearchRequest, workers: Workers, stop: threading.Event, tell: Tell
) -> CoachReply | MapReply | VariantsReply:
    """Search for a better gait, a map of gaits, or six gaits to choose from, as a request asks.

    Args:
        request: the request.
        workers: processes for the trials.
        stop: once it is set, the search ends with what it has found.
        tell: called with the progress of the search.

    Raises:
        FileRefused: with mistakes of the request's files, as `read_files` does.
        UserError: if anything else is wrong with the request.
        WorkerDied: if a process for trials ended.
    """
    goal, size = Goal.FORWARD, None
    if isinstance(request, CoachRequest):
        goal = _chosen("goal", request.goal, Goal)
        size = None if request.size is None else _chosen("size", request.size, Size)
    if not isinstance(request, VariantsRequest) and not 0 <= request.seconds <= _MOST_S:
        said = say("studio.coach-seconds", seconds=request.seconds, most_s=_MOST_S)
        raise UserError(said)
    if request.seed < 0:
        raise UserError(say("studio.negative", field="seed"))
    files = read_files(request.files)
    key = coached_key(files.gait, goal, request.key)
    task = task_of(files.robot, files.gait, key, goal, files.sequences)
    trials = Trials(task, workers, stop)
    match request:
        case CoachRequest():
            found = coach(trials, size, request.seconds, request.seed, tell)
            return reply_of(task, key, found)
        case MapRequest():
            mapped = map_gaits(trials, request.seconds, request.seed, tell)
            return map_reply(task, key, mapped)
    if request.round < 0:
        raise UserError(say("studio.negative", field="round"))
    keep = _tables("keep", task, request.keep, _MOST_KEPT)
    before = _tables("before", task, request.before, _MOST_BEFORE)
    parents = keep or [task.table.angles_deg]
    return variants_reply(
        task, key, vary(trials, parents, before, request.seed, request.round, tell)
    )


def _tables(field: str, task: Task, sent: Sequence[Angles], most: int) -> list[Angles]:
    """Check tables that came with a request.

    Raises:
        UserError: if there are too many tables, if one has another count of angles than the key's
            table, or if an angle is outside its joint's range.
    """
    numbers = len(task.table.angles_deg)
    ranges_deg = task.robot.ranges_deg * len(task.table.rows)
    fits = len(sent) <= most and all(
        len(table) == numbers
        and all(low <= angle <= high for angle, (low, high) in zip(table, ranges_deg, strict=True))
        for table in sent
    )
    if not fits:
        raise UserError(say("studio.wrong-tables", field=field, most=most, numbers=numbers))
    return [tuple(table) for table in sent]


def _chosen(field: str, text: str, kind: type[_Choice]) -> _Choice:
    """Read a field of a request that must be one of a few words.

    Raises:
        UserError: if the text is none of these words.
    """
    try:
        return kind(text)
    except ValueError:
        options = [str(one) for one in kind]
        said = say("studio.coach-choice", field=field, found=text[:40], options=options)
        raise UserError(said) from None
