"""A record played again: verified by physics, or taken up where it ended.

The games are judged on the recorded poses, over the whole match (`judge`). Physics is simulated
from each snapshot to the next (`section`): in this way it is exact with the same arithmetic, and
with another one it has no time to get far from the record.
"""

import os
import signal
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from lacoc_robots.model import MODEL_VERSION
from lacoc_server.journal.judge import Judge, fits_together
from lacoc_server.journal.section import BOUND, Finding, Section, Worlds, simulate
from lacoc_server.journal.verdict import Kind, Verdict, conclude
from lacoc_server.match.match import Match
from lacoc_server.world.world import MUJOCO_VERSION, World
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import say

_SECTIONS_PER_PROCESS = 4
"""To start a process takes as long as to simulate two or three sections."""


def verify(
    record: Record,
    folder: Path | None = None,
    bound: float = BOUND,
    processes: int | None = None,
) -> Iterator[int | Verdict]:
    """Judge a record again, simulate its sections again, and compare.

    Args:
        record: what to verify.
        folder: of its arena, if that is not installed.
        bound: how far from the record another arithmetic may end a section [m, rad].
        processes: how many simulate side by side; 1: this one; None: one for each core.

    Yields:
        How many beats were simulated so far (for a progress bar), and last the `Verdict`.

    Raises:
        UserError: if its arena is not installed, another MuJoCo made it, or it is damaged in a
            way that no match can be made of it.
    """
    _same_physics(record)
    judge = Judge(record, folder, dict(record.snapshots))
    findings: list[Finding] = []
    beats = 0
    for finding in _simulated(judge, bound, _processes(record, processes)):
        findings.append(finding)
        beats += finding.last_beat - finding.first_beat + 1
        yield beats
    yield conclude(
        record.headers,
        judge.beats,
        judge.frames,
        [judge.difference],
        findings,
        judge.other_model,
        bound,
    )


@dataclass(frozen=True)
class Resumed:
    """A match that goes on."""

    match: Match
    distance: float | None = None
    """How far this machine's arithmetic is from the record after its newest snapshot [m, rad];
    None: every bit is the same."""


def resume(record: Record, at: int | None = None, folder: Path | None = None) -> Resumed:
    """Take a match up where its record ends.

    Up to the newest snapshot the recorded poses stand for physics, and only from there on it is
    simulated. Another arithmetic gets no farther from the record than `BOUND` on this way.

    Args:
        record: of a court that was killed; may be cut anywhere.
        folder: of its arena, if that is not installed.
        at: take up physics from the newest snapshot at or before this beat; None: from the
            newest that there is.

    Returns:
        The match after its last recorded beat, with its physics ready to go on.

    Raises:
        UserError: if its arena is not installed, another MuJoCo made it, or the match that comes
            out is not the recorded one, because it is damaged or other software wrote it.
    """
    _same_physics(record)
    judge = Judge(
        record,
        folder,
        {beat: saved for beat, saved in record.snapshots if at is None or beat <= at},
    )
    for _ in judge.sections():
        pass
    match, section = judge.match, judge.section
    findings: list[Finding] = []
    physics = match.physics
    if section is not None:
        with fits_together(record):
            world = judge.worlds.at_start(section)
        if section.steps:
            findings.append(simulate(section, judge.worlds))
            world.digest = section.steps[-1].digest
        # What was published stays, whatever other last bits are computed here.
        world.scene, world.scene_hash = physics.scene, physics.scene_hash
        world.model_hash = physics.model_hash
        physics = world
    verdict = conclude(record.headers, judge.beats, judge.frames, [judge.difference], findings)
    if not verdict.same:
        raise UserError(say("resume.differs", verdict=verdict.said, versions=_versions(record)))
    match.take_up(physics, World)
    return Resumed(match, None if verdict.kind is Kind.SAME else verdict.distance)


def _simulated(judge: Judge, bound: float, processes: int) -> Iterator[Finding]:
    """Simulate the sections of a match while it is judged."""
    if processes <= 1:
        worlds = Worlds()
        for section in judge.sections():
            yield simulate(section, worlds, bound)
        return
    with ProcessPoolExecutor(processes, get_context("spawn"), _begin) as pool:
        waiting: deque[Future[Finding]] = deque()
        for section in judge.sections():
            waiting.append(pool.submit(_simulate, section, bound))
            while waiting and waiting[0].done():
                yield waiting.popleft().result()
        for future in waiting:
            yield future.result()


def _processes(record: Record, wanted: int | None) -> int:
    if wanted is None:
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
        wanted = min(cores or 1, len(record.snapshots) // _SECTIONS_PER_PROCESS)
    return wanted


_worlds = Worlds()
"""Of a process that simulates sections."""


def _begin() -> None:
    """Begin a process that simulates sections; Ctrl-C is for the one that started it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _simulate(section: Section, bound: float) -> Finding:
    return simulate(section, _worlds, bound)


def _same_physics(record: Record) -> None:
    here, there = MUJOCO_VERSION, record.header.versions.get("mujoco", "?")
    if here != there:
        raise UserError(say("replay.other-mujoco", there=there, here=here))
    model = record.header.versions.get("model", "1")  # older software did not write it
    if model != str(MODEL_VERSION):
        raise UserError(
            say(
                "replay.other-model",
                there=model,
                here=str(MODEL_VERSION),
                lacoc=record.header.versions.get("lacoc", "?"),
            )
        )


def _versions(record: Record) -> str:
    return ", ".join(f"{what} {version}" for what, version in record.header.versions.items())
