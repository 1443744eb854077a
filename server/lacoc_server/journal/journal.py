"""A match with its record: a beat's messages go to the disk before anybody is answered.

The frame of a beat is written after all its other messages except a snapshot. So a beat whose frame
is there is complete. A beat in which nothing happened may have no messages at all. A beat with
messages but no frame comes from a court that was killed in that beat.
"""

import platform
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path

from lacoc_robots.model import MODEL_VERSION
from lacoc_server.match.match import Beat, Match
from lacoc_server.world import arithmetic
from lacoc_server.world.world import MUJOCO_VERSION
from lacoc_shared import __version__
from lacoc_shared.codec import encode
from lacoc_shared.inputs import Input
from lacoc_shared.messages import PROTOCOL, Frame, HealthVerdict
from lacoc_shared.record.recorder import Recorder
from lacoc_shared.record.schema import FORMAT, Header, Setup
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase

SNAPSHOT_TICKS = 250
"""Ticks between two full snapshots, 5 s of physics. The first comes after the first tick."""

Measure = Callable[[Sequence[Input], Beat], HealthVerdict | None]
"""Measures how well a beat was held; returns a verdict on the match when one is due, else None."""


class Journal:
    """Runs a match and writes its record.

    Args:
        match: the match; it may have run some beats already.
        folder: folder of the record; None: no record.
        segment: number of earlier segments of this match's record.
        measure: measures how well the match is held; None for a headless match, in which no beat
            can be late.
        writer: makes the file of the record.

    Raises:
        UserError: if the record can't be created.
    """

    def __init__(
        self,
        match: Match,
        folder: Path | None,
        segment: int = 0,
        measure: Measure | None = None,
        writer: Callable[[Path, Header], Recorder] = RecordWriter,
    ) -> None:
        self.match = match
        self._measure = measure
        self.writer = (
            writer(folder, _header(match.setup, segment, match.beats + 1)) if folder else None
        )
        self._ticks = 0
        self._last: tuple[object, ...] = ()
        self._scene = b""

    def beat(self, inputs: Sequence[Input] = ()) -> tuple[Beat, bytes]:
        """Let one beat pass and record it.

        Returns:
            The results of the beat, and its frame encoded as it is published.
        """
        match, writer = self.match, self.writer
        beat = match.beat(inputs)
        verdict = None if self._measure is None else self._measure(inputs, beat)
        encoded = encode(beat.frame)
        if writer is None:
            return beat, encoded
        number = beat.frame.beat
        for item in inputs:
            writer.input(number, item)
        for event in beat.events:
            writer.event(event)
        if match.physics.scene_hash != self._scene:
            self._scene = match.physics.scene_hash
            writer.scene(number, match.physics.scene)
        if beat.sheet_changed:
            writer.sheet(number, match.sheet())
        if beat.touch is not None:
            writer.touch(number, beat.touch)
        if beat.result is not None:
            writer.result(beat.result)
        if verdict is not None:
            writer.health(number, verdict)
        happened = beat.ticked or inputs or beat.events or beat.sheet_changed
        if self._new(beat.frame) or happened or number % BEATS_PER_S == 0:
            writer.frame(number, encoded)
        if beat.ticked:
            self._ticks += 1
            if self._ticks % SNAPSHOT_TICKS == 1:
                writer.snapshot(number, match.physics.save())
        return beat, encoded

    def flush(self) -> None:
        """Write all messages that still wait in memory to the file.

        Raises:
            UserError: if the disk refuses it.
        """
        if self.writer is not None:
            self.writer.flush()

    @property
    def trouble(self) -> Phrase | None:
        """The error that the disk reported about data already written; None: there was none."""
        return None if self.writer is None else self.writer.sync_trouble

    def close(self) -> None:
        """Finish and close the record, because the match is over."""
        if self.writer is not None:
            self.writer.close()

    def leave(self) -> None:
        """Close the record without marking its end, because the match is not over.

        Then the match can go on in a new segment. A record that is written as one file is removed.
        """
        if self.writer is not None:
            self.writer.leave()

    def _new(self, frame: Frame) -> bool:
        """Return whether phase, seats, markers, poses or clock differ from the frame before."""
        content = (frame.clock_ticks, frame.poses, frame.phase, frame.seats, frame.markers)
        new, self._last = content != self._last, content
        return new


def _header(setup: Setup, segment: int, first_beat: int) -> Header:
    return Header(
        format=FORMAT,
        match_id=setup.match_id,
        segment=segment,
        first_beat=first_beat,
        started=datetime.now(UTC).isoformat(timespec="seconds"),
        versions={
            "lacoc": __version__,
            "protocol": str(PROTOCOL),
            "mujoco": MUJOCO_VERSION,
            "model": str(MODEL_VERSION),
            "machine": platform.machine(),
        },
        arithmetic=dict(arithmetic.here()),
        setup=setup,
    )
