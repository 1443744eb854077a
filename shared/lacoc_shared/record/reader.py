"""Reads a record from its one packed file or its segments, even if they are cut off."""

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from operator import itemgetter
from pathlib import Path
from typing import Any, TypeVar

from lacoc_shared.codec import BadMessage
from lacoc_shared.inputs import Input
from lacoc_shared.messages import Event, HealthVerdict, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.schema import Header, Result, Touch
from lacoc_shared.record.stream import TakeBytes, walk_messages
from lacoc_shared.words import Phrase, say

V = TypeVar("V")


class NoMatch(UserError):
    """Raised when files contain no match that can be read."""


class _Gap(Exception):
    """Raised when beats are missing between two segments of a match."""

    def __init__(self, said: Phrase) -> None:
        super().__init__()
        self.said = said


@dataclass(repr=False)
class Record:
    """Everything that is recorded of a match, sorted by beat."""

    headers: list[Header] = field(default_factory=list)
    """One header for each segment, in order."""
    inputs: dict[int, list[Input]] = field(default_factory=dict)
    """The inputs of each beat, in order."""
    events: list[Event] = field(default_factory=list)
    frames: list[tuple[int, bytes]] = field(default_factory=list)
    """Pairs of a beat and the encoded `Frame`."""
    touches: dict[int, Touch] = field(default_factory=dict)
    snapshots: list[tuple[int, bytes]] = field(default_factory=list)
    """Pairs of a beat and the state of physics after it."""
    sheets: list[tuple[int, Sheet]] = field(default_factory=list)
    scenes: list[tuple[int, Scene]] = field(default_factory=list)
    results: list[Result] = field(default_factory=list)
    """The results so far; each replaces the one before."""
    health: HealthVerdict | None = None
    """The newest verdict about how well the match ran; None: there is none yet, or the match was
    not played in real time."""
    last_beat: int = -1
    """The last beat with any message; -1: there is no message."""
    cut: Phrase | None = None
    """Why reading stopped too early, and at which place; None: the record is complete."""
    flaw: Phrase | None = None
    """Damage that does not change the match, for example in the file's index; None: there is
    none."""

    gap: bool = False
    """Whether reading stopped because the next segment does not continue where the last one ends.
    """
    lost: bool = False
    """Whether a part of the match is lost, because a segment is missing or a file is damaged or
    incomplete. A missing end, as after a kill of the court, does not count."""

    def __repr__(self) -> str:
        match_id = self.headers[0].match_id if self.headers else ""
        segments, frames = len(self.headers), len(self.frames)
        return f"Record({match_id=}, {segments=}, {frames=}, last_beat={self.last_beat})"

    @property
    def header(self) -> Header:
        """The header of the record's first segment."""
        return self.headers[0]

    @property
    def result(self) -> Result | None:
        """The newest result; None if the match has not ended.

        A result of a beat in which the court was killed does not count: nobody was told.
        """
        whole = self.last_whole_beat
        told = (one for one in reversed(self.results) if not self.cut or one.beats <= whole + 1)
        return next(told, None)

    @property
    def last_whole_beat(self) -> int:
        """The last complete beat.

        The court answered nobody in a beat after it: it was killed in that beat.
        """
        sealed = not self.cut or any(beat == self.last_beat for beat, _ in self.frames[-1:])
        return self.last_beat if sealed else self.last_beat - 1

    @property
    def warning(self) -> Phrase | None:
        """A warning for the user of the record: where it ends too early, or its damage.

        None: all is well.
        """
        return self.cut or self.flaw

    @property
    def given_s(self) -> float:
        """How many seconds the referee has added to the time of play.

        Negative: time was taken away.
        """
        given_s = 0.0
        for event in self.events:
            arguments = event.data.get("arguments")
            if event.data.get("decision") == "clock" and isinstance(arguments, dict):
                # Records of protocol 1 have `seconds`, which took time away.
                for name, sign in (("gives_s", 1), ("seconds", -1)):
                    value = arguments.get(name)
                    given_s += sign * value if isinstance(value, int | float) else 0.0
        return given_s

    def sheet_at(self, beat: int) -> Sheet | None:
        """Return the sheet that was valid at a beat; None before the first sheet."""
        return _newest(beat, self.sheets)

    def scene_at(self, beat: int) -> Scene | None:
        """Return the scene that was valid at a beat; None before the first scene."""
        return _newest(beat, self.scenes)

    def until(self, beat: int) -> "Record":
        """Return the record with its messages of beats up to this one only, without `health`."""
        kept = Record(
            headers=[header for header in self.headers if header.first_beat <= beat],
            inputs={number: items for number, items in self.inputs.items() if number <= beat},
            events=[event for event in self.events if event.beat <= beat],
            frames=_until(beat, self.frames),
            touches={number: touch for number, touch in self.touches.items() if number <= beat},
            snapshots=_until(beat, self.snapshots),
            sheets=_until(beat, self.sheets),
            scenes=_until(beat, self.scenes),
            results=[result for result in self.results if result.beats <= beat + 1],
        )
        newest = [*kept.inputs, *kept.touches]
        for items in (kept.frames, kept.snapshots, kept.sheets, kept.scenes):
            newest += [number for number, _ in items[-1:]]
        kept.last_beat = max([*newest, *(event.beat for event in kept.events[-1:])], default=-1)
        return kept

    @classmethod
    def read(cls, paths: Path | Iterable[Path], also: TakeBytes | None = None) -> "Record":
        """Read a record as far as possible.

        A file that was never closed (a killed court, an interrupted copy) or is damaged is read
        up to the last whole message. If beats are missing between two segments, the segments
        before the gap are read. `cut` then says where and why.

        Args:
            paths: a packed file; or one segment, which stands for all segments of its match; or
                several segments, in order.
            also: called with topic, beat and bytes of every message.

        Raises:
            NoMatch: if no file has a complete header.
            UserError: if a file does not exist, is not a record, is of another format or another
                match, or if the beginning is missing.
        """
        if isinstance(paths, Path):
            paths = files.record_paths(paths)
        paths = list(paths)
        record = cls()
        try:
            for path in paths:
                record._read_file(path, also)
        except _Gap as gap:
            record.gap = record.lost = True
            cut = record.cut
            record.cut = say("cut.both", cut=cut, gap=gap.said) if cut else gap.said
        if not record.headers and record.lost and record.cut:
            raise NoMatch(say("recording.nothing", cut=record.cut))
        if not record.headers and paths:
            raise NoMatch(_no_header(paths))
        if not record.headers:
            raise NoMatch(say("recording.no-files"))
        return record

    def _read_file(self, path: Path, also: TakeBytes | None) -> None:
        def take(topic: str, beat: int, data: bytes, message: Any) -> None:
            self._take(path, topic, beat, data, message)
            if also is not None:
                also(topic, beat, data)

        before = len(self.headers)
        stop = walk_messages(path, take)
        if stop and len(self.headers) == before and before:
            return  # the court was killed while it opened this segment: nothing in it counts
        self.lost = stop is not None and stop.damaged
        self.cut = self.flaw = None
        if stop is not None:
            beat = self.last_beat if self.last_beat >= 0 and not stop.at_end else None
            said = say("cut.file", file=str(path), beat=beat, why=stop.why)
            if stop.loses_nothing:
                self.flaw = said
            else:
                self.cut = said

    def _take(self, path: Path, topic: str, beat: int, data: bytes, message: Any) -> None:
        """Add one message of a file to the record.

        Raises:
            BadMessage: if no court writes such a message at this place: it is of an earlier beat,
                or its beat has a message of a kind already that a beat has only once. A forger
                could write two sheets of a beat: one for the proof, one for another reader.
        """
        match topic:
            case "/lacoc/header":
                if beat != message.first_beat:
                    raise BadMessage(f"a header of beat {message.first_beat} in beat {beat}")
                self._begin_segment(path, message)
                return
            case "/lacoc/result":
                self.results.append(message)
                return
            case "/lacoc/health":
                self.health = message
                return
        if not self.headers or beat < max(self.last_beat, self.headers[-1].first_beat):
            raise BadMessage(f"beat {beat} after beat {self.last_beat}")
        match topic:
            case "/lacoc/input":
                self.inputs.setdefault(beat, []).append(message)
            case "/lacoc/event":
                if message.beat != beat:
                    raise BadMessage(f"an event of beat {message.beat} in beat {beat}")
                self.events.append(message)
            case "/lacoc/frame":
                _add_once(topic, self.frames, beat, data)
            case "/lacoc/touch":
                if beat in self.touches:
                    raise BadMessage(f"a second touch of beat {beat}")
                self.touches[beat] = message
            case "/lacoc/snapshot":
                _add_once(topic, self.snapshots, beat, message)
            case "/lacoc/sheet":
                _add_once(topic, self.sheets, beat, message)
            case "/lacoc/scene":
                _add_once(topic, self.scenes, beat, message)
        self.last_beat = beat

    def _begin_segment(self, path: Path, header: Header) -> None:
        if self.headers and header.match_id != self.header.match_id:
            raise UserError(
                say(
                    "recording.other-match",
                    file=str(path),
                    match=header.match_id,
                    first=self.header.match_id,
                )
            )
        if not self.headers and header.first_beat > 0:
            raise UserError(
                say(
                    "recording.no-begin",
                    file=str(path),
                    beat=header.first_beat,
                    match=header.match_id,
                )
            )
        if self.headers and header.segment <= self.headers[-1].segment:
            raise UserError(
                say(
                    "recording.order",
                    file=str(path),
                    segment=header.segment,
                    match=header.match_id,
                    before=self.headers[-1].segment,
                )
            )
        if header.first_beat > self.last_beat + 1:
            first, last = self.last_beat + 1, header.first_beat - 1
            raise _Gap(say("cut.gap", first=first, last=last, file=str(path)))
        self.headers.append(header)
        self._forget_from(header.first_beat)

    def _forget_from(self, beat: int) -> None:
        """Drop the messages of this beat and of later ones, because the next segment repeats them.

        The next segment begins with this beat (`Header.first_beat`).
        """
        if self.last_beat < beat:
            return
        self.last_beat = beat - 1
        while self.results and self.results[-1].beats > beat:
            self.results.pop()
        _drop(self.inputs, beat)
        _drop(self.touches, beat)
        while self.events and self.events[-1].beat >= beat:
            self.events.pop()
        items: list[tuple[int, Any]]
        for items in (self.frames, self.snapshots, self.sheets, self.scenes):
            while items and items[-1][0] >= beat:
                items.pop()


def _no_header(paths: Sequence[Path]) -> Phrase:
    """Return a sentence about files that hold no record, because none has a complete header."""
    if len(paths) > 1:
        return say("recording.no-match", files=[str(path) for path in paths])
    size = paths[0].stat().st_size
    if size == 0:
        return say("recording.empty", file=str(paths[0]))
    return say("recording.no-header", file=str(paths[0]), bytes=size)


def _add_once(topic: str, items: list[tuple[int, V]], beat: int, message: V) -> None:
    if items and items[-1][0] == beat:
        raise BadMessage(f"a second {topic.removeprefix('/lacoc/')} of beat {beat}")
    items.append((beat, message))


def _drop(items: dict[int, V], beat: int) -> None:
    """Drop all entries of this beat and later ones; `items` must be in the order of beats."""
    while items and next(reversed(items)) >= beat:
        items.popitem()


def _newest(beat: int, items: list[tuple[int, V]]) -> V | None:
    until = _until(beat, items)
    return until[-1][1] if until else None


def _until(beat: int, items: list[tuple[int, V]]) -> list[tuple[int, V]]:
    return items[: bisect_right(items, beat, key=itemgetter(0))]
