"""Measures the connection to a court: does it work, how fast is an answer, what gets lost?"""

import time
from collections.abc import Iterator

from lacoc_client.commands.checks.machine import Finding, Status
from lacoc_client.play.asking import fetch
from lacoc_client.play.spectator import Spectator
from lacoc_shared import __version__
from lacoc_shared.contest.access import Access
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, Phase
from lacoc_shared.words import Phrase, say

_REQUESTS = 50
_LONG_TRIP_S = 0.15
_LEAST_HZ = 45.0
_LONG_GAP_S = 0.5
_FIRST_S = 1.0


def link(access: Access, seconds: float, *, planned: bool = False) -> Iterator[Finding]:
    """Check the network connection to a court, as a spectator has it.

    Args:
        access: how to reach the court.
        seconds: how long the court's frames are counted.
        planned: whether the court stands in a contest file; then it need not run yet.
    """
    about = say("doctor.court", court=access.court)
    try:
        with open_client(access.addresses, authority=access.authority) as session:
            view = Spectator(session, access.court)
            yield _version(about, access, view)
            yield _round_trip(session, view)
            yield _frames(view, seconds)
            yield from _record(view)
    except UserError as error:
        if planned and _nobody_listens(error.phrase):
            found = say("doctor.court-not-yet", addresses=access.addresses)
            yield Finding(about, Status.NOTE, found, say("doctor.court-not-yet-todo"))
        else:
            yield Finding(about, Status.PROBLEM, error.phrase, say("doctor.court-todo"))


def _nobody_listens(why: Phrase) -> bool:
    """Return whether every address of a court was reached, and at none of them a program listens.

    Args:
        why: why no connection could be opened.
    """
    reasons = why.values.get("sentences", (why,))
    return isinstance(reasons, tuple) and all(
        isinstance(one, Phrase) and one.code == "connect.nobody" for one in reasons
    )


def _version(about: Phrase, access: Access, view: Spectator) -> Finding:
    sheet = view.sheet
    found = say(
        "doctor.court-found",
        title=sheet.title,
        address=access.connect,
        match=sheet.match,
        version=sheet.version,
    )
    if sheet.version == __version__:
        return Finding(about, Status.OK, found)
    return Finding(about, Status.NOTE, found, say("doctor.version-todo", version=__version__))


def _round_trip(session: Session, view: Spectator) -> Finding:
    about = say("doctor.round-trip", court=view.keys.court)
    times_s = []
    for _ in range(_REQUESTS):
        began_s = time.perf_counter()
        fetch(session, view.keys, view.keys.sheet)
        times_s.append(time.perf_counter() - began_s)
    times_s.sort()
    p50_s, p95_s = times_s[_REQUESTS // 2], times_s[_REQUESTS * 95 // 100]
    found = say(
        "doctor.round-trip-found", requests=_REQUESTS, p50_ms=1000 * p50_s, p95_ms=1000 * p95_s
    )
    if p95_s <= _LONG_TRIP_S:
        return Finding(about, Status.OK, found)
    return Finding(about, Status.NOTE, found, say("doctor.round-trip-todo"))


def _frames(view: Spectator, seconds: float) -> Finding:
    """Measure how many frames a second arrive, and the longest gap between two of them.

    A frame that a newer one replaced before it was read counts as lost too. A frame that is sent
    again is not counted: a court that can't go on sends its last frame again and again.
    """
    about = say("doctor.frames", court=view.keys.court)
    first = view.wait_frame(_FIRST_S)
    if first is None:
        todo = say("doctor.frames-none-todo")
        return Finding(about, Status.PROBLEM, say("doctor.frames-none"), todo)
    count, last, last_s, gap_s = 1, first, view.frame_s, 0.0
    began_s = last_s
    while (now_s := time.monotonic()) - began_s < seconds:
        frame = view.wait_frame(seconds - (now_s - began_s))
        if frame is None:
            break
        if (frame.match, frame.beat) == (last.match, last.beat):
            continue
        gap_s = max(gap_s, view.frame_s - last_s)
        count, last, last_s = count + 1, frame, view.frame_s
    gap_s = max(gap_s, time.monotonic() - last_s)
    took_s = time.monotonic() - began_s
    hz = (count - 1) / took_s
    made = last.beat - first.beat if last.match == first.match else count - 1
    phase = Phase(last.phase).name.lower()
    if count == 1 and view.frame is not first:
        still = say("doctor.frames-still", phase=phase, beat=last.beat)
        return Finding(about, Status.PROBLEM, still, say("doctor.frames-still-todo"))
    missed = max(0, made - (count - 1))
    found = say(
        "doctor.frames-found", hz=hz, phase=phase, missed=missed, made=made, gap_ms=1000 * gap_s
    )
    if hz >= _LEAST_HZ and gap_s <= _LONG_GAP_S:
        return Finding(about, Status.OK, found)
    slow = made * BEAT_S < took_s * _LEAST_HZ / BEATS_PER_S
    todo = say("doctor.frames-slow-court") if slow else say("doctor.frames-slow-network")
    return Finding(about, Status.NOTE, found, todo)


def _record(view: Spectator) -> Iterator[Finding]:
    """Report what is wrong with the court's record, if the court's health says so."""
    end_s = time.monotonic() + _FIRST_S
    while view.health is None and time.monotonic() < end_s:
        view.wait_frame(_FIRST_S)
    if view.health is not None and view.health.record_trouble:
        about = say("doctor.record", court=view.keys.court)
        yield Finding(about, Status.PROBLEM, view.health.record_trouble, say("doctor.record-todo"))
