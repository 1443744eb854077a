"""A record's match, judged again on the recorded poses.

In the match, the rules judged exactly the poses that frames carry. So judging them again is exact
on any machine and needs no physics. The requests of the match to physics are cut into sections,
which are simulated separately. If a record was cut off and its last beat has no frame, that beat
does not count: the court answered nobody in it (`journal`).
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import msgspec
from msgspec.structs import replace

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_server.journal.journal import SNAPSHOT_TICKS
from lacoc_server.journal.section import FRAME_FIELDS, Build, Difference, Section, Step, Worlds
from lacoc_server.match.entry import Entry
from lacoc_server.match.match import Beat, Match
from lacoc_server.match.physics import Fault, Physics
from lacoc_server.world import arithmetic
from lacoc_server.world.world import World
from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.gait.tables import Posture
from lacoc_shared.messages import Event, Frame, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.protocol_1 import fault_of, same_events, same_result
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Header, Result
from lacoc_shared.words import say

_SCENE_BOUND = 1e-9
"""Largest difference of a number between two scenes that differ only by the machines that built
them; most of these numbers are lengths [m].
"""


class RecordedPhysics:
    """Answers a match from the record in place of physics, and notes what the match asks for.

    Args:
        world: the robots as this machine builds them; it is not stepped.
        record: the recorded messages of the present beat.
        scene: recorded scene; None: the scene of `world`.
        model_hash: recorded hash of the model; None: the hash of `world`.
    """

    def __init__(
        self, world: World, record: "Recorded", scene: Scene | None, model_hash: str | None
    ) -> None:
        self.world = world
        self.scene = scene or world.scene
        self.scene_hash = message_hash(encode(scene)) if scene else world.scene_hash
        self.model_hash = model_hash or world.model_hash
        self._record = record
        self._places: list[tuple[int, Place]] = []
        self._angles: tuple[Posture, ...] | None = None
        self._asked = False

    @property
    def digest(self) -> bytes:
        """Hash of physics' state in the newest recorded frame; before the first: in `world`."""
        frame = self._record.frame
        return frame.digest if frame else self.world.digest

    def place(self, seat: int, place: Place) -> None:
        """Note that the match puts a seat's robot at a start place."""
        self._places.append((seat, place))

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        """Note the commanded angles; return the recorded fault, if there is one."""
        self._angles = tuple(angles)
        return self._record.fault

    def save(self) -> bytes:
        """Return the recorded snapshot of this beat; empty if it has none."""
        return self._record.snapshot or b""

    def poses(self) -> bytes:
        """Return the poses in the newest recorded frame; if it has none, those of `self.world`."""
        frame = self._record.frame
        return frame.poses if frame and frame.poses else self.world.poses()

    def touched(self) -> Sequence[tuple[int, ...]]:
        """Return the recorded touches of this beat, and note that the match asked for them."""
        self._asked = True
        return self._record.touched

    def take(self) -> Step | None:
        """Return this beat's requests to physics and its frame; None if it has neither.

        Then forget the requests, so that the requests of the next beat can be noted.
        """
        record, frame = self._record, self._record.frame
        places, angles, asked = tuple(self._places), self._angles, self._asked
        self._places, self._angles, self._asked = [], None, False
        here = record.has_frame
        if not (places or angles or here):
            return None
        return Step(
            record.beat,
            places,
            angles,
            record.fault,
            record.touched if asked else None,
            frame.poses if frame and here else None,
            frame.digest if frame else b"",
        )


class Recorded:
    """The recorded messages of one beat; `move` goes to another beat."""

    def __init__(self, record: Record) -> None:
        self.seats = 0
        """Number of robots on the field."""
        self.beat = -1
        self.has_frame = False
        """Whether this beat has a frame of its own."""
        self.frame: Frame | None = None
        """The newest frame so far."""
        self.fault: Fault | None = None
        self._frames = dict(record.frames)
        self._touches = record.touches
        self._snapshots = dict(record.snapshots)
        self._faults = {event.beat: event for event in record.events if event.kind == "fault"}

    def move(self, beat: int) -> None:
        """Go to another beat: from now on, return what is recorded of that beat."""
        self.beat = beat
        self.has_frame = beat in self._frames
        if self.has_frame:
            self.frame = decode(self._frames[beat], Frame)
        fault = self._faults.get(beat)
        self.fault = None if fault is None else Fault(fault.seat, fault_of(fault))

    @property
    def touched(self) -> tuple[tuple[int, ...], ...]:
        """For each seat the markers that its robot touched in this beat."""
        touch = self._touches.get(self.beat)
        return touch.touched if touch else ((),) * self.seats

    @property
    def snapshot(self) -> bytes | None:
        """The snapshot after this beat; None: there is none."""
        return self._snapshots.get(self.beat)


class Judge:
    """Judges a record's match again.

    Args:
        record: the record to judge.
        folder: folder of its arena, if the arena is not installed.
        snapshots: snapshots by beat; they cut the match into the sections to simulate.

    Raises:
        UserError: if the record does not describe a match, or the arena is not installed and no
            folder was named.
    """

    def __init__(self, record: Record, folder: Path | None, snapshots: Mapping[int, bytes]) -> None:
        self.worlds = Worlds()
        """Keeps the world that was built last."""
        self.section: Section | None = None
        """The section that is being filled: the beats since a snapshot, or since robots were built.
        It has no steps just after the snapshot. None: no robot is on the field.
        """
        self.difference: Difference | None = None
        """The first difference, at which judging stops; None: none was found so far."""
        self.other_model: Difference | None = None
        """The first beat in which this machine builds a model whose bits differ from the recorded
        model; None: no model differed so far.
        """
        self.beats = self.frames = 0
        """Number of beats judged, and of frames compared."""
        self._record = record
        self._folder = folder
        self._snapshots = snapshots
        self._frames = dict(record.frames)
        self._sheets, self._scenes = dict(record.sheets), dict(record.scenes)
        self._events: dict[int, list[Event]] = {}
        for event in record.events:
            self._events.setdefault(event.beat, []).append(event)
        self._result: Result | None = None
        self._scene = b""
        self._begins = {header.first_beat for header in record.headers}
        self._unsaved_ticks = SNAPSHOT_TICKS
        """Ticks since the newest snapshot; so many at first that one may follow at once."""
        self._builds = 0
        self._beat = -1
        with fits_together(record):
            self._recorded = Recorded(record)
            self.match = Match(record.header.setup, self._make, folder)
        self.match.survives_rules = True  # as at the court

    def sections(self) -> Iterator[Section]:
        """Judge beat by beat, up to the first difference from the record.

        Yields:
            Each section that has beats, once its last beat is judged.

        Raises:
            UserError: if the record's messages contradict each other.
        """
        last = self._record.last_whole_beat
        for number in range(last + 1):
            before = self.section
            differs = self._judge(number)
            if number == last:
                differs += self._differs_at_the_end(last)
            if before is not self.section and before is not None and before.steps:
                yield before
            if (section := self.section) is not None and number in self._snapshots:
                section.end = self._snapshots[number]
                self.section = Section(section.build, section.end, section.end[:8])
                if section.steps:
                    yield section
            if differs:
                self.difference = Difference(number, tuple(differs))
                break
        if last < 0 and (differs := [*self._differs_at_the_end(last)]):
            self.difference = Difference(0, tuple(differs))
        if self.section is not None and self.section.steps:
            yield self.section

    def _judge(self, number: int) -> list[str]:
        """Judge one beat; return its differences from the record, by name (texts `differs.*`).

        Raises:
            UserError: if the arena's code breaks here and did not break in the recorded match; or
                the record's messages contradict each other.
        """
        record = self._record
        self._beat = number
        with fits_together(record):
            self._recorded.move(number)
            beat = self.match.beat(record.inputs.get(number, ()))
            differs = list(self._differences(number, beat))
            if differs and (broken := [one.said for one in beat.events if one.kind == "rules"]):
                raise UserError(*broken)
            physics = self.match.physics
            step = None
            if not isinstance(physics, RecordedPhysics):
                self.section = None
            elif (step := physics.take()) is not None and self.section is not None:
                self.section.steps.append(step)
            ticked = step is not None and step.angles is not None
            if not self._may_save(number, ticked):
                differs.append("snapshot")
        self.beats = number + 1
        self.frames += number in self._frames
        return differs

    def _may_save(self, number: int, ticked: bool) -> bool:
        """Return whether a court can have saved physics in a beat, if the record says that it did.

        It saves physics after a tick; elsewhere a section would begin with a state that no step
        leads to. It does not save it often: with another arithmetic each section may deviate a
        little, and many little deviations would be a way.

        Args:
            number: the beat.
            ticked: whether a tick passes in it.
        """
        if number in self._begins:  # the court was opened again, and counts from there
            self._unsaved_ticks = SNAPSHOT_TICKS
        self._unsaved_ticks += ticked
        if number not in self._snapshots:
            return True
        may_save = ticked and self._unsaved_ticks >= SNAPSHOT_TICKS
        self._unsaved_ticks = 0
        return may_save

    def _make(self, arena: Arena, entries: Sequence[Entry]) -> Physics:
        """Begin the section that starts with newly built robots, without a snapshot.

        Returns:
            Physics that answers the match from the record. Without robots there is no section, and
            the world that is returned has only the field, in which nothing moves.
        """
        world = World(arena, entries)
        scene, model_hash = self._other_model(world)
        if not entries:
            if scene is not None:
                world.scene, world.scene_hash = scene, message_hash(encode(scene))
            return world
        setup = self._record.header.setup
        build = Build(self._builds, setup, self._folder, tuple(entries))
        self._builds += 1
        self.worlds.keep(build, world)
        self.section = Section(build, None, world.digest)
        self._recorded.seats = len(entries)
        return RecordedPhysics(world, self._recorded, scene, model_hash)

    def _other_model(self, world: World) -> tuple[Scene | None, str | None]:
        """Check whether another kind of machine compiled the recorded model from the same robots.

        The numbers of two such models may differ in their last bits.

        Returns:
            The recorded scene and the recorded hash of the model if another kind of machine made
            them, else (None, None). Each is also None if the record has none for this beat.
        """
        beat = max(0, self._beat)
        made_by = header_at(self._record, beat).arithmetic.get("model")
        if made_by in (None, arithmetic.here()["model"]):
            return None, None
        events = self._events.get(beat, ())
        models = [event.data["model"] for event in events if "model" in event.data]
        scene = self._scenes.get(beat)
        if scene is not None and not _near(scene, world.scene):
            return None, None
        if models in ([], [world.model_hash]) and scene in (None, world.scene):
            return None, None
        self.other_model = self.other_model or Difference(beat, ("model",))
        return scene, str(models[0]) if models else None

    def _differences(self, number: int, beat: Beat) -> Iterator[str]:
        """Yield the names of the differences between a judged beat and its record."""
        record, match = self._record, self.match
        recorded = self._frames.get(number)
        events = self._events.pop(number, [])
        if any(
            event.data.get("model", match.physics.model_hash) != match.physics.model_hash
            for event in events
        ):
            yield "model"
        if recorded is not None and encode(beat.frame) != recorded:
            yield from _frame_differences(decode(recorded, Frame), beat.frame)
        happened = beat.ticked or beat.events or beat.sheet_changed or number in record.inputs
        if recorded is None and happened:
            yield "frame-missing"
        if not same_events(record.header, events, beat.events):
            yield "events"
        if beat.touch != record.touches.get(number):
            yield "touches"
        sheet = self._sheets.get(number)
        if (sheet or beat.sheet_changed) and not _same_sheet(sheet, match.sheet()):
            yield "sheet"
        scene = self._scenes.get(number)
        if scene or match.physics.scene_hash != self._scene:
            self._scene = match.physics.scene_hash
            if scene != match.physics.scene:
                yield "scene-message"
        self._result = beat.result or self._result

    def _differs_at_the_end(self, last: int) -> Iterator[str]:
        """Yield the names of the differences between the whole judged match and its record."""
        record = self._record
        if not _same_result(record, self._result):
            yield "result"
        # The court may have been killed in the next beat; then that beat has messages.
        killed_in = last + 1 if record.last_beat > last else None
        if any(number != killed_in for number in self._events):
            yield "events-of-no-beat"


@contextmanager
def fits_together(record: Record) -> Iterator[None]:
    """In the block, raise a `UserError` if messages of the record contradict each other."""
    try:
        yield
    except (ValueError, ArithmeticError, LookupError, TypeError, AssertionError) as error:
        match, what = record.header.match_id[:80], f"{type(error).__name__}: {error!s:.80}"
        raise UserError(say("replay.damaged", match=match, error=what)) from None


def header_at(record: Record, beat: int) -> Header:
    """Return the header of the segment that a beat is in."""
    return next(
        (header for header in reversed(record.headers) if header.first_beat <= beat), record.header
    )


def _same_result(record: Record, again: Result | None) -> bool:
    """Return whether the recorded result and the judged one are equal.

    A result that the court never sent is not compared. Its beat has an event too.
    """
    if any(result.beats > record.last_beat + 1 for result in record.results):
        return False
    recorded = record.result
    if recorded is None:  # a beat of an earlier segment may have had it, unanswered
        return again is None or len(record.headers) > 1
    return again is not None and same_result(record.header, recorded, again)


def _same_sheet(recorded: Sheet | None, again: Sheet) -> bool:
    """Return whether the recorded sheet and the judged one are equal, apart from versions.

    Sheets of earlier versions have no `rule`; it is then not compared.
    """
    if recorded is None:
        return False
    rule = recorded.rule or again.rule
    return replace(recorded, version=again.version, protocol=again.protocol, rule=rule) == again


def _frame_differences(recorded: Frame, again: Frame) -> list[str]:
    return [
        name
        for name, old, new in zip(
            FRAME_FIELDS,
            (getattr(recorded, f) for f in recorded.__struct_fields__),
            (getattr(again, f) for f in again.__struct_fields__),
            strict=True,
        )
        if old != new
    ]


def _near(one: object, other: object) -> bool:
    """Return whether two scenes, or parts of them, are equal.

    A float may differ by up to `_SCENE_BOUND`.
    """
    if isinstance(one, msgspec.Struct) and type(one) is type(other):
        return all(_near(getattr(one, f), getattr(other, f)) for f in one.__struct_fields__)
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_near, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) <= _SCENE_BOUND
    return one == other
