"""A record played again: verified by physics, or taken up where it ended.

Both feed the recorded inputs to a new match. `verify` steps the physics again and
compares all that was recorded, bit for bit. `resume` lets the recorded poses stand for
physics up to the newest snapshot, and only from there on steps: the rules judge on
exactly the poses that frames carry, so the match that comes out is the same; it is held
against the record too. A last beat without its frame (`journal`) was not answered: both
leave it out.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from msgspec.structs import replace

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_server.match.entry import Entry
from lacoc_server.match.match import Beat, Match
from lacoc_server.match.physics import Fault, MakePhysics
from lacoc_server.world.world import MUJOCO_VERSION, World
from lacoc_shared.codec import decode, encode
from lacoc_shared.gait.tables import Posture
from lacoc_shared.messages import Event, Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.protocol_1 import fault_of, same_events, same_result
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Result, Touch

_NAMES = (
    "match",
    "beat",
    "phase",
    "countdown",
    "clock",
    "seats",
    "board",
    "poses",
    "scene",
    "state hash",
)


@dataclass(frozen=True)
class Verdict:
    """What a verification found."""

    beats: int
    """Beats that were simulated again."""
    frames: int
    """Frames that were compared."""
    differs_at: int | None = None
    """First beat that differs; None: all are the same."""
    text: str = "same"


class _Again:
    """A record's match, made again beat by beat and held against it."""

    def __init__(self, record: Record, make_physics: MakePhysics, folder: Path | None) -> None:
        self._record = record
        self.frames = dict(record.frames)
        self._events: dict[int, list[Event]] = {}
        for event in record.events:
            self._events.setdefault(event.beat, []).append(event)
        with _fits_together(record):
            self.match = Match(record.header.setup, make_physics, folder)

    def beat(self, number: int) -> tuple[Beat, list[str]]:
        """Let one beat pass.

        Returns:
            What the beat made, and what of it the record has otherwise.

        Raises:
            UserError: if the record's messages do not fit together.
        """
        record = self._record
        with _fits_together(record):
            beat = self.match.beat(record.inputs.get(number, ()))
        differs: list[str] = []
        recorded = self.frames.get(number)
        if recorded is not None and encode(beat.frame) != recorded:
            differs += _differences(decode(recorded, Frame), beat.frame)
        if not same_events(record, self._events.get(number, []), beat.events):
            differs.append("its events")
        if beat.touch != record.touches.get(number):
            differs.append("what the robots touched")
        return beat, differs


@contextmanager
def _fits_together(record: Record) -> Iterator[None]:
    """Say it in words where a record's messages contradict each other: it may be damaged."""
    try:
        yield
    except (ValueError, ArithmeticError, LookupError, TypeError, AssertionError) as error:
        raise UserError(
            f"The messages of the record of match {record.header.match_id!r:.80} do not fit "
            f"together ({type(error).__name__}: {error!s:.80}): it is damaged."
        ) from None


def verify(record: Record, folder: Path | None = None) -> Iterator[int | Verdict]:
    """Simulate a record again and compare.

    Args:
        record: what to verify.
        folder: of its arena, if that is not installed.

    Yields:
        The number of each beat (for a progress bar), and last the `Verdict`.

    Raises:
        UserError: if its arena is not installed, another MuJoCo made it, or it is damaged in a
            way that no match can be made of it.
    """
    _same_physics(record)
    again = _Again(record, World, folder)
    match, snapshots = again.match, dict(record.snapshots)
    sheets, scenes = dict(record.sheets), dict(record.scenes)
    last = _last_beat(record)
    compared = 0
    result: Result | None = None
    for number in range(last + 1):
        beat, differs = again.beat(number)
        result = beat.result or result
        compared += number in again.frames
        if (saved := snapshots.get(number)) is not None and _state(match) != saved:
            differs.append("the snapshot")
        if number in sheets and not _same_sheet(sheets[number], match.sheet()):
            differs.append("the sheet")
        if number in scenes and scenes[number] != match.physics.scene:
            differs.append("the scene")
        if number == last and not _same_result(record, result, last):
            differs.append("the result")
        if differs:
            text = f"beat {number} differs: {', '.join(differs)}"
            yield Verdict(number + 1, compared, number, text)
            return
        yield number
    yield Verdict(last + 1, compared)


@dataclass
class _Cursor:
    """Where a re-judged match is in its record."""

    record: Record
    frames: dict[int, bytes]
    faults: dict[int, Event]
    beat: int = 0
    live: bool = False
    """From here on physics is stepped."""
    frame: Frame | None = field(default=None)

    def move(self, beat: int) -> None:
        self.beat = beat
        if (encoded := self.frames.get(beat)) is not None:
            self.frame = decode(encoded, Frame)


class _Recorded:
    """Recorded poses behind the protocol of physics, until the cursor says live."""

    def __init__(self, arena: Arena, entries: Sequence[Entry], cursor: _Cursor) -> None:
        self.world = World(arena, entries)
        self.scene, self.scene_hash = self.world.scene, self.world.scene_hash
        self.model_hash = self.world.model_hash
        self._cursor = cursor
        self._seats = len(entries)

    @property
    def digest(self) -> bytes:
        frame = self._cursor.frame
        return self.world.digest if self._cursor.live or frame is None else frame.digest

    def place(self, seat: int, place: Place) -> None:
        if self._cursor.live:
            self.world.place(seat, place)

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        if self._cursor.live:
            return self.world.step(angles)
        fault = self._cursor.faults.get(self._cursor.beat)
        return None if fault is None else Fault(fault.seat, fault_of(fault))

    def poses(self) -> bytes:
        frame = self._cursor.frame
        if self._cursor.live or frame is None or not frame.poses:
            return self.world.poses()
        return frame.poses

    def touched(self) -> Sequence[tuple[int, ...]]:
        if self._cursor.live:
            return self.world.touched()
        touch: Touch | None = self._cursor.record.touches.get(self._cursor.beat)
        return touch.touched if touch else ((),) * self._seats


def resume(record: Record, at: int | None = None, folder: Path | None = None) -> Match:
    """Take a match up where its record ends.

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
    snapshots = {beat: saved for beat, saved in record.snapshots if at is None or beat <= at}
    newest = max(snapshots, default=-1)
    cursor = _Cursor(
        record,
        dict(record.frames),
        {event.beat: event for event in record.events if event.kind == "fault"},
        live=newest < 0,
    )
    again = _Again(record, lambda arena, entries: _Recorded(arena, entries, cursor), folder)
    match = again.match
    for number in range(_last_beat(record) + 1):
        cursor.move(number)
        _, differs = again.beat(number)
        if differs:
            raise UserError(
                f"Beat {number} comes out otherwise than it is recorded ({', '.join(differs)}): "
                f"the record is damaged, or this is not the software that wrote it "
                f"({_versions(record)})."
            )
        if number == newest and isinstance(match.physics, _Recorded):
            with _fits_together(record):
                match.physics.world.load(snapshots[number])
            cursor.live = True
    if isinstance(match.physics, _Recorded):
        match.staging.physics = match.physics.world
    match.staging.make_physics = World
    return match


def _same_physics(record: Record) -> None:
    here, there = MUJOCO_VERSION, record.header.versions.get("mujoco", "?")
    if here != there:
        raise UserError(
            f"This record was made with MuJoCo {there}, and here is {here}: a replay is exact only "
            f"with the same. Install it: pip install mujoco=={there}"
        )


def _versions(record: Record) -> str:
    return ", ".join(f"{what} {version}" for what, version in record.header.versions.items())


def _state(match: Match) -> bytes:
    return match.physics.save() if isinstance(match.physics, World) else b""


def _same_result(record: Record, again: Result | None, last: int) -> bool:
    """Whether a recorded result is the one."""
    recorded = record.result
    if recorded is None or recorded.beats > last + 1:  # of a beat that was not answered
        return True
    return again is not None and same_result(record, recorded, again)


def _same_sheet(recorded: Sheet, again: Sheet) -> bool:
    """Whether a recorded sheet is the one; it also says which software wrote it."""
    return replace(recorded, version=again.version, protocol=again.protocol) == again


def _last_beat(record: Record) -> int:
    """The last beat that counts."""
    sealed = not record.cut or any(beat == record.last_beat for beat, _ in record.frames[-1:])
    return record.last_beat if sealed else record.last_beat - 1


def _differences(recorded: Frame, again: Frame) -> list[str]:
    return [
        name
        for name, old, new in zip(
            _NAMES,
            (getattr(recorded, f) for f in recorded.__struct_fields__),
            (getattr(again, f) for f in again.__struct_fields__),
            strict=True,
        )
        if old != new
    ]
