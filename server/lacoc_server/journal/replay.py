"""A record played again: verified by physics, or continued where it ended.

The rules judge the recorded poses of the whole match again (`judge`). Physics is simulated in
sections, each from one snapshot, or from newly built robots, to the next snapshot. So the poses
that another kind of machine computes can't drift far from the record.
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
from lacoc_server.journal.section import BOUND, Section, SectionFinding, Worlds, simulate_section
from lacoc_server.journal.verdict import Verdict, VerdictKind, conclude
from lacoc_server.match.match import Match
from lacoc_server.world.world import MUJOCO_VERSION, World
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import say

_SECTIONS_PER_PROCESS = 4
"""Least number of sections for each process, whose start takes as long as two or three sections."""


def verify(
    record: Record,
    folder: Path | None = None,
    bound: float = BOUND,
    processes: int | None = None,
) -> Iterator[int | Verdict]:
    """Prove a record: judge its match again, simulate its physics again, and compare.

    Args:
        record: the record to verify.
        folder: folder of its arena, if the arena is not installed.
        bound: largest distance from the record that another arithmetic may reach in a section [m,
            rad].
        processes: number of processes that simulate; 1: only this one; None: at most one for each
            core, and fewer for a short record.

    Yields:
        The number of beats simulated so far (for a progress bar); at the end the `Verdict`.

    Raises:
        UserError: if the arena is not installed, if another version of MuJoCo or of the robots'
            model made the record, or if it is too damaged to describe a match.
    """
    _same_physics(record)
    judge = Judge(record, folder, dict(record.snapshots))
    findings: list[SectionFinding] = []
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
class ResumedMatch:
    """A match rebuilt from its record, which can go on."""

    match: Match
    distance: float | None = None
    """Largest distance of the poses that this machine computed from the recorded ones, after the
    newest snapshot [m, rad]; None: every bit is the same.
    """


def resume(record: Record, at: int | None = None, folder: Path | None = None) -> ResumedMatch:
    """Continue a match where its record ends.

    Up to the newest snapshot the recorded poses take the place of physics; only the rest is
    simulated. In that rest, poses of another arithmetic may differ by at most `BOUND`.

    Args:
        record: record of a court that was killed; it may be cut anywhere.
        folder: folder of its arena, if the arena is not installed.
        at: simulate from the newest snapshot at or before this beat; None: from the newest of all.

    Returns:
        The match after its last recorded beat, with its physics ready to go on.

    Raises:
        UserError: if the arena is not installed, or another version of MuJoCo or of the robots'
            model made the record. Also if the resulting match differs from the record: the record
            is damaged, or other software wrote it.
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
    findings: list[SectionFinding] = []
    physics = match.physics
    if section is not None:
        with fits_together(record):
            world = judge.worlds.at_start(section)
        if section.steps:
            findings.append(simulate_section(section, judge.worlds))
            world.digest = section.steps[-1].digest
        # Keep what was published, even if this machine computes other last bits.
        world.scene, world.scene_hash = physics.scene, physics.scene_hash
        world.model_hash = physics.model_hash
        physics = world
    verdict = conclude(record.headers, judge.beats, judge.frames, [judge.difference], findings)
    if not verdict.same:
        raise UserError(say("resume.differs", verdict=verdict.said, versions=_versions(record)))
    match.take_up(physics, World)
    return ResumedMatch(match, None if verdict.kind is VerdictKind.SAME else verdict.distance)


def _simulated(judge: Judge, bound: float, processes: int) -> Iterator[SectionFinding]:
    """Simulate each section of a record once `judge` has judged it; yield the findings in order."""
    if processes <= 1:
        worlds = Worlds()
        for section in judge.sections():
            yield simulate_section(section, worlds, bound)
        return
    with ProcessPoolExecutor(processes, get_context("spawn"), _begin) as pool:
        waiting: deque[Future[SectionFinding]] = deque()
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
"""The newest world of this process, kept from one section to the next."""


def _begin() -> None:
    """Make this process, which simulates sections, ignore Ctrl-C: its parent handles it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _simulate(section: Section, bound: float) -> SectionFinding:
    return simulate_section(section, _worlds, bound)


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
