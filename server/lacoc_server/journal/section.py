"""A section of a match: what physics does from one snapshot to the next.

A section holds all that its simulation needs, so that sections can be simulated side by side. How
a simulation compares with the record is told twice: where its bits first differ, and where it is
first farther away than another arithmetic can be the reason for.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lacoc_arenas import arena as arenas
from lacoc_arenas.game import Place
from lacoc_server.match.entry import Entry
from lacoc_server.match.physics import Fault
from lacoc_server.world.world import World
from lacoc_shared.gait.tables import Posture
from lacoc_shared.record.schema import Setup

BOUND = 1e-5
"""Within this distance [m, rad] of the record another arithmetic ends a section."""

_ROUNDING = 2.0**-23
"""A recorded pose is rounded to float32."""
_NO_DIGEST = bytes(8)
"""Before the first tick."""


class Difference(NamedTuple):
    """Where a record differs from what its inputs give."""

    beat: int
    what: tuple[str, ...]


@dataclass(frozen=True)
class Build:
    """What robots on a field are built from."""

    number: int
    """Counts the builds of a match from 0."""
    setup: Setup
    folder: Path | None
    """Of the arena, if it is not installed."""
    entries: tuple[Entry, ...]

    def world(self) -> World:
        """Build them."""
        setup = self.setup
        return World(arenas.from_settings(setup.arena, setup.settings, self.folder), self.entries)


@dataclass(frozen=True)
class Step:
    """A beat of a section: what the match wants of physics, and what the record has of it."""

    beat: int
    places: tuple[tuple[int, Place], ...]
    """Seats whose robots are put at a start place, in order."""
    angles: tuple[Posture, ...] | None
    """For each seat the commanded angles [rad]; None: no tick passes."""
    fault: Fault | None
    """What stopped physics in this tick."""
    touched: tuple[tuple[int, ...], ...] | None
    """For each seat the markers it touches; None: the rules did not ask."""
    poses: bytes | None
    """The frame's; None: this beat has no frame."""
    digest: bytes
    """The frame's, or the last before it."""


@dataclass
class Section:
    """The beats after a snapshot, up to the next."""

    build: Build
    start: bytes | None
    """The snapshot that it starts from; None: robots as they are built."""
    digest: bytes
    """The last recorded before the section's first step."""
    steps: list[Step] = field(default_factory=list)
    end: bytes | None = None
    """The snapshot after the last step; None: there is none."""

    @property
    def first_beat(self) -> int:
        """Its first beat."""
        return self.steps[0].beat

    @property
    def last_beat(self) -> int:
        """Its last beat."""
        return self.steps[-1].beat


@dataclass
class Finding:
    """What the simulation of a section found."""

    first_beat: int
    last_beat: int
    bits: Difference | None = None
    """Where the first bits differ; None: all are the same."""
    beyond: Difference | None = None
    """Where it is first too far from the record; None: nowhere."""
    distance: float = 0.0
    """How far it is from the record at most, in frames and at its end [m, rad]."""

    def differ(self, beat: int, what: str, far: bool) -> None:
        """Note that something differs in a beat, and whether it is too far."""
        self.bits = _joined(self.bits, beat, what)
        if far:
            self.beyond = _joined(self.beyond, beat, what)


class Worlds:
    """Keeps the newest world that was built: sections of one build follow each other."""

    def __init__(self) -> None:
        self._number = -1
        self._world: World | None = None
        self._start = b""

    def keep(self, build: Build, world: World) -> None:
        """Keep a world that was just built."""
        self._number, self._world, self._start = build.number, world, world.save()

    def at_start(self, section: Section) -> World:
        """Give the world of a section, in the state in which the section starts.

        Raises:
            ValueError: if its snapshot is not of its model.
        """
        if self._world is None or self._number != section.build.number:
            self.keep(section.build, section.build.world())
        assert self._world is not None
        self._world.load(self._start if section.start is None else section.start)
        return self._world


def simulate(section: Section, worlds: Worlds, bound: float = BOUND) -> Finding:
    """Simulate a section and compare it with the record.

    Args:
        section: what to simulate.
        worlds: where its world comes from; afterwards the world is as the section's end.
        bound: how far another arithmetic may be [m, rad].
    """
    found = Finding(section.first_beat, section.last_beat)
    try:
        world = worlds.at_start(section)
    except ValueError:
        found.differ(section.first_beat - 1, "the snapshot", far=True)
        return found
    before = digest = section.digest
    for step in section.steps:
        before, digest = digest, step.digest
        _step(step, before, world, found, bound)
        if found.beyond is not None:
            return found
    if section.end is not None:
        _end(section.end, section.steps[-1], before, world, found, bound)
    return found


def _step(step: Step, before: bytes, world: World, found: Finding, bound: float) -> None:
    for seat, place in step.places:
        world.place(seat, place)
    ticked = False
    if step.angles is not None:
        fault = world.step(step.angles)
        ticked = fault is None
        if fault != step.fault:
            found.differ(step.beat, "a stop of physics", far=True)
    if step.poses is not None:
        poses = world.poses()
        if poses != step.poses:
            apart = _apart(step.poses, poses)
            found.distance = max(found.distance, apart)
            found.differ(step.beat, "poses", far=apart > bound + _ROUNDING)
        if world.digest != step.digest or (not ticked and step.digest != before):
            found.differ(step.beat, "state hash", far=not ticked and step.digest != before)
    if step.touched is not None and tuple(world.touched()) != step.touched:
        possible = _possible(step.touched, world, bound)
        found.differ(step.beat, "what the robots touched", far=not possible)


def _end(
    saved: bytes, step: Step, before: bytes, world: World, found: Finding, bound: float
) -> None:
    """Compare the end with its snapshot, and the snapshot with its own frame.

    A snapshot holds the state whose hash is in the frame, so that much can be told anywhere.
    """
    if world.save() != saved:
        apart = world.apart(saved)
        found.distance = max(found.distance, apart)
        found.differ(step.beat, "the snapshot", far=apart > bound)
    if found.beyond is not None:
        return
    chained = world.follows(saved, before) or step.angles is None
    world.load(saved)
    if not chained or step.digest != saved[:8]:
        found.differ(step.beat, "state hash", far=True)
    elif step.poses != world.poses():
        found.differ(step.beat, "poses", far=True)


def _apart(recorded: bytes, poses: bytes) -> float:
    """Measure how far two frames' poses are apart; infinite if they are not of the same robots."""
    if len(recorded) != len(poses):
        return float("inf")
    gaps = np.abs(np.frombuffer(recorded, "<f4").astype(float) - np.frombuffer(poses, "<f4"))
    return float(gaps.max(initial=0.0)) if np.isfinite(gaps).all() else float("inf")


def _possible(recorded: Sequence[Sequence[int]], world: World, bound: float) -> bool:
    """Say whether robots that are a bound away from here can have touched these markers."""
    surely, perhaps = world.touched(gap_m=-bound), world.touched(gap_m=bound)
    return len(recorded) == len(surely) and all(
        set(sure) <= set(marked) <= set(maybe)
        for sure, marked, maybe in zip(surely, recorded, perhaps, strict=True)
    )


def _joined(known: Difference | None, beat: int, what: str) -> Difference:
    """Add what differs in a beat to the first difference that is known."""
    if known is None:
        return Difference(beat, (what,))
    return known if known.beat != beat else Difference(beat, (*known.what, what))
