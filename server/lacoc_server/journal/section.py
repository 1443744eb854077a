"""A section of a match: the beats from a snapshot, or from new robots, to the next snapshot.

A section holds everything that its simulation needs, so sections can be simulated side by side. A
simulation reports two comparisons with the record: where bits first differ, and where poses first
differ by more than another arithmetic can explain.
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

FRAME_FIELDS = (
    "match",
    "beat",
    "phase",
    "countdown",
    "clock",
    "seats",
    "board",
    "poses",
    "scene",
    "state-hash",
)
"""Names of the fields of a frame (texts `differs.*`), in the order of `Frame`."""

BOUND = 1e-5
"""Largest distance from the record [m, rad] that another arithmetic may reach in a section."""

_ROUNDING = 2.0**-23
"""Added to the bound, because poses are recorded as float32 [m, rad]."""
_NO_DIGEST = bytes(8)
"""Hash of the physics' state (digest) before the first tick."""


class Difference(NamedTuple):
    """A beat of a record that differs from the beat computed from the inputs."""

    beat: int
    what: tuple[str, ...]
    """Names of the parts that differ (texts `differs.*`)."""


@dataclass(frozen=True)
class Build:
    """What a world (the robots on their field in MuJoCo) is built from."""

    number: int
    """Number of worlds that were built in this match before."""
    setup: Setup
    folder: Path | None
    """Folder of the arena, if it is not installed."""
    entries: tuple[Entry, ...]

    def world(self) -> World:
        """Build the world: the robots on their field in MuJoCo."""
        setup = self.setup
        return World(arenas.from_settings(setup.arena, setup.settings, self.folder), self.entries)


@dataclass(frozen=True)
class Step:
    """A beat of a section: what the match asks of physics, and what is recorded of the beat."""

    beat: int
    places: tuple[tuple[int, Place], ...]
    """Seats whose robots are put at a start place, with the place, in order."""
    angles: tuple[Posture, ...] | None
    """Commanded angles of each seat [rad]; None: no tick passes."""
    fault: Fault | None
    """The fault that stopped physics in this tick; None: there was none."""
    touched: tuple[tuple[int, ...], ...] | None
    """Markers that each seat's robot touches; None: the rules did not ask."""
    poses: bytes | None
    """Poses in the beat's frame; None: it has no frame."""
    digest: bytes
    """Hash of the physics' state in the beat's frame, or in the last frame before the beat."""


@dataclass
class Section:
    """Beats from a snapshot, or from the building of robots, to the next one or the last beat."""

    build: Build
    start: bytes | None
    """The snapshot that the section starts from; None: it starts with the robots as built."""
    digest: bytes
    """Hash of the physics' state in the last frame before the section's first step."""
    steps: list[Step] = field(default_factory=list)
    end: bytes | None = None
    """The snapshot after the last step; None: there is none."""

    @property
    def first_beat(self) -> int:
        """Number of the section's first beat."""
        return self.steps[0].beat

    @property
    def last_beat(self) -> int:
        """Number of the section's last beat."""
        return self.steps[-1].beat


@dataclass
class SectionFinding:
    """Result of simulating a section of a record: how it differs from the record."""

    first_beat: int
    last_beat: int
    bits: Difference | None = None
    """The first difference in any bit; None: all bits are the same."""
    beyond: Difference | None = None
    """The first difference that another arithmetic can't explain; None: there is none."""
    distance: float = 0.0
    """Largest distance from the record, in frames and at the section's end [m, rad]."""

    def differ(self, beat: int, what: str, far: bool) -> None:
        """Note a difference in a beat; only those of the first beat that differs are kept.

        Args:
            beat: the beat.
            what: name of the part that differs (texts `differs.*`).
            far: whether the difference is too large to come from another computer's rounding.
        """
        self.bits = _joined(self.bits, beat, what)
        if far:
            self.beyond = _joined(self.beyond, beat, what)


class Worlds:
    """Keeps the newest world that was built: the robots on their field in MuJoCo.

    The next section of a record often needs the same one.
    """

    def __init__(self) -> None:
        self._number = -1
        self._world: World | None = None
        self._start = b""

    def keep(self, build: Build, world: World) -> None:
        """Keep a world that was just built."""
        self._number, self._world, self._start = build.number, world, world.save()

    def at_start(self, section: Section) -> World:
        """Return the world of a section, in the state in which the section starts.

        Raises:
            ValueError: if the section's snapshot has another length than the model's states.
        """
        if self._world is None or self._number != section.build.number:
            self.keep(section.build, section.build.world())
        assert self._world is not None
        self._world.load(self._start if section.start is None else section.start)
        return self._world


def simulate_section(section: Section, worlds: Worlds, bound: float = BOUND) -> SectionFinding:
    """Simulate a section and compare it with the record.

    Args:
        section: the section to simulate.
        worlds: gives the section's world, which afterwards is in the state of the section's end,
            or of where the simulation stopped.
        bound: largest difference from the record that another arithmetic explains [m, rad]; where
            the difference is larger, the simulation stops.
    """
    found = SectionFinding(section.first_beat, section.last_beat)
    try:
        world = worlds.at_start(section)
    except ValueError:
        found.differ(section.first_beat - 1, "snapshot", far=True)
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


def _step(step: Step, before: bytes, world: World, found: SectionFinding, bound: float) -> None:
    for seat, place in step.places:
        world.place(seat, place)
    ticked = False
    if step.angles is not None:
        fault = world.step(step.angles)
        ticked = fault is None
        if fault != step.fault:
            found.differ(step.beat, "stop", far=True)
    if step.poses is not None:
        poses = world.poses()
        if poses != step.poses:
            apart = _apart(step.poses, poses)
            found.distance = max(found.distance, apart)
            found.differ(step.beat, "poses", far=apart > bound + _ROUNDING)
        if world.digest != step.digest or (not ticked and step.digest != before):
            found.differ(step.beat, "state-hash", far=not ticked and step.digest != before)
    if step.touched is not None and tuple(world.touched()) != step.touched:
        possible = _possible(step.touched, world, bound)
        found.differ(step.beat, "touches", far=not possible)


def _end(
    saved: bytes, step: Step, before: bytes, world: World, found: SectionFinding, bound: float
) -> None:
    """Compare the simulated world with a section's last snapshot, then the snapshot with its frame.

    The frame has the hash of the snapshot's state, so any machine can check the second comparison
    exactly. Afterwards the world has the state of the snapshot.
    """
    if world.save() != saved:
        apart = world.apart(saved)
        found.distance = max(found.distance, apart)
        found.differ(step.beat, "snapshot", far=apart > bound)
    if found.beyond is not None:
        return
    chained = world.follows(saved, before) or step.angles is None
    world.load(saved)
    if not chained or step.digest != saved[:8]:
        found.differ(step.beat, "state-hash", far=True)
    elif step.poses != world.poses():
        found.differ(step.beat, "poses", far=True)


def _apart(recorded: bytes, poses: bytes) -> float:
    """Return the largest difference between two frames' poses [m, rad].

    It is infinite if the frames' sizes differ or a number is not finite.
    """
    if len(recorded) != len(poses):
        return float("inf")
    gaps = np.abs(np.frombuffer(recorded, "<f4").astype(float) - np.frombuffer(poses, "<f4"))
    return float(gaps.max(initial=0.0)) if np.isfinite(gaps).all() else float("inf")


def _possible(recorded: Sequence[Sequence[int]], world: World, bound: float) -> bool:
    """Return whether the recorded touches agree with `world` within `bound` [m].

    A robot that is deeper than `bound` in a marker of `world` must have touched it in the record.
    A robot that is farther than `bound` from a marker of `world` must not have touched it.
    """
    surely, perhaps = world.touched(gap_m=-bound), world.touched(gap_m=bound)
    return len(recorded) == len(surely) and all(
        set(sure) <= set(marked) <= set(maybe)
        for sure, marked, maybe in zip(surely, recorded, perhaps, strict=True)
    )


def _joined(known: Difference | None, beat: int, what: str) -> Difference:
    """Add a part that differs in a beat to the first difference known so far.

    Returns:
        A new difference if `known` is None; `known` with `what` added if it is of the same beat;
        else (the beat is later) `known` unchanged.
    """
    if known is None:
        return Difference(beat, (what,))
    return known if known.beat != beat else Difference(beat, (*known.what, what))
