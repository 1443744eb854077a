"""Forges a record: makes one change that alters its meaning."""

import hashlib
import random
import struct
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from msgspec import structs

from lacoc_server.journal.judge import Judge
from lacoc_shared import decisions as d
from lacoc_shared.codec import decode, encode, pack_states, unpack_states
from lacoc_shared.inputs import Decide, Input, JoinSeat, KeySeat, LeaveSeat, ReadySeat
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Header, Touch
from lacoc_shared.seat import Phase

_MM = 1e-3
_STATE_START = 8 + 8
"""Where the positions begin in a snapshot [bytes]: after the digest and the time."""


class Harmless(Exception):
    """This change can't be made to this record or contest, or means nothing in it."""


@dataclass
class Forger:
    """Forges copies of one record.

    Args:
        honest: the record to forge.
        other: a record of another match with the same robots; sections are taken from it.
    """

    honest: Record
    other: Record

    def forge(self, chance: random.Random) -> tuple[str, Record]:
        """Make a forged copy.

        Returns:
            The name of the forgery, and the copy. Some copies also claim that the record was
            made with another arithmetic (`Header.arithmetic`).
        """
        while True:
            name = chance.choice(sorted(_FORGERIES))
            record = replace(
                self.honest,
                headers=list(self.honest.headers),
                inputs={beat: list(items) for beat, items in self.honest.inputs.items()},
                events=list(self.honest.events),
                frames=list(self.honest.frames),
                touches=dict(self.honest.touches),
                snapshots=list(self.honest.snapshots),
                sheets=list(self.honest.sheets),
                scenes=list(self.honest.scenes),
            )
            try:
                _FORGERIES[name](_Copy(record, self.other, chance))
            except Harmless:
                continue
            if record == self.honest:  # a section may be the same in both matches
                continue
            lie = chance.choice(("", "no arithmetic", "another arithmetic"))
            if lie:
                made_by = {"functions": "0" * 16, "path": "0" * 16}
                arithmetic = {**record.header.arithmetic, **made_by} if "another" in lie else {}
                record.headers = [structs.replace(h, arithmetic=arithmetic) for h in record.headers]
            return f"{name}{lie and f', {lie}'}", record


@dataclass
class _Copy:
    """A record that is being forged."""

    record: Record
    other: Record
    chance: random.Random

    def frame(self, *phases: Phase) -> int:
        """Choose a random frame of these phases; return its index."""
        wanted = phases or (Phase.READY, Phase.PLAYING)
        places = [at for at in range(len(self.record.frames)) if self[at].phase in wanted]
        if not places:
            raise Harmless
        return self.chance.choice(places)

    def __getitem__(self, at: int) -> Frame:
        return decode(self.record.frames[at][1], Frame)

    def change(self, at: int, **changes: Any) -> None:
        """Change fields of a frame."""
        beat, _ = self.record.frames[at]
        self.record.frames[at] = beat, encode(structs.replace(self[at], **changes))

    def after(self, at: int) -> int:
        """Choose a random end, at most 5 s later, for a range of frames that begins at `at`."""
        return min(len(self.record.frames), at + self.chance.randint(2, 250))

    def input(self, *kinds: type) -> tuple[int, int]:
        """Choose a random input; return its beat, and its index in that beat."""
        places = [
            (beat, at)
            for beat, items in self.record.inputs.items()
            for at, item in enumerate(items)
            if isinstance(item, kinds)
        ]
        if not places:
            raise Harmless
        return self.chance.choice(places)

    def event(self) -> int:
        """Choose a random event; return its index."""
        return self.chance.randrange(len(self.record.events))

    def moved(self, poses: bytes, by: tuple[int, float]) -> bytes:
        """Return poses in which the number with the index `by[0]` has grown by `by[1]`."""
        numbers = list(struct.unpack(f"<{len(poses) // 4}f", poses))
        numbers[by[0]] += by[1]
        return struct.pack(f"<{len(numbers)}f", *numbers)

    def move(self, at: int) -> tuple[int, float]:
        """Choose a random number of a frame's poses, and a step of 1 mm or 1 mrad to move it by."""
        count = len(self[at].poses) // 4
        if not count:
            raise Harmless
        return self.chance.randrange(count), self.chance.choice((-_MM, _MM))


def _pose(copy: _Copy) -> None:
    at = copy.frame()
    copy.change(at, poses=copy.moved(copy[at].poses, copy.move(at)))


def _path(copy: _Copy) -> None:
    first = copy.frame()
    by = copy.move(first)
    for at in range(first, copy.after(first)):
        if len(copy[at].poses) == len(copy[first].poses):
            copy.change(at, poses=copy.moved(copy[at].poses, by))


def _input_removed(copy: _Copy) -> None:
    beat, at = copy.input(KeySeat, Decide, ReadySeat, JoinSeat)
    del copy.record.inputs[beat][at]


def _input_added(copy: _Copy) -> None:
    at = copy.frame(Phase.PLAYING)
    beat, seat = copy.record.frames[at][0], copy.chance.randrange(2)
    seq = copy[at].seats[seat].applied_seq + 1
    seat_id = ("left", "right")[seat]
    item: Input = copy.chance.choice(
        (
            KeySeat(seat, seq, 1, copy.chance.randrange(4)),
            LeaveSeat(seat),
            Decide("Kubota", "agreed", d.Adjust(seat_id, 1)),
            Decide("Kubota", "agreed", d.Freeze(seat_id, 2.0)),
            Decide("Kubota", "agreed", d.Restart(seat_id)),
            Decide("Kubota", "agreed", d.Clock(1.0)),
            Decide("Kubota", "agreed", d.Halt()),
        )
    )
    copy.record.inputs.setdefault(beat, []).append(item)


def _input_changed(copy: _Copy) -> None:
    beat, at = copy.input(KeySeat)
    item = copy.record.inputs[beat][at]
    assert isinstance(item, KeySeat)
    key = copy.chance.choice([key for key in range(4) if key != item.key])
    copy.record.inputs[beat][at] = structs.replace(item, key=key)


def _input_moved(copy: _Copy) -> None:
    beat, at = copy.input(KeySeat)
    item = copy.record.inputs[beat].pop(at)
    copy.record.inputs.setdefault(beat + copy.chance.choice((-3, -1, 1, 2)), []).append(item)


def _angle(copy: _Copy) -> None:
    """Change an angle of a posture that a contestant used, so that servos get another command."""
    beat, at = copy.input(JoinSeat)
    join = copy.record.inputs[beat][at]
    assert isinstance(join, JoinSeat)
    file = join.locomotion
    if file is None:
        raise Harmless
    used = {
        (frame.seats[join.seat].key, frame.seats[join.seat].posture)
        for frame in (copy[at] for at in range(len(copy.record.frames)))
        if frame.phase == Phase.PLAYING
    }
    lines = file.data.decode().splitlines()
    rows: list[int] = []
    row, key = 1, 0
    while row < len(lines) and lines[row].strip().isdigit():
        count = int(lines[row])
        rows += [row + 1 + posture for posture in range(count) if (key, posture) in used]
        row, key = row + 1 + count, key + 1
    if not rows:
        raise Harmless
    row = copy.chance.choice(rows)
    cells = lines[row].split("\t")
    column = copy.chance.randrange(len(cells))
    angle = float(cells[column])
    cells[column] = f"{angle - 1 if angle > 0 else angle + 1:g}"
    lines[row] = "\t".join(cells)
    data = "\n".join(lines).encode() + b"\n"
    before = _commanded(copy.record)
    copy.record.inputs[beat][at] = structs.replace(join, locomotion=type(file)(file.name, data))
    if _commanded(copy.record) == before:  # the key was left before its posture was reached
        raise Harmless


def _commanded(record: Record) -> tuple[Any, ...]:
    """Return the angles that a replay commands, until it first differs from the record."""
    try:
        judge = Judge(record, None, {})
        steps = [step for section in judge.sections() for step in section.steps]
    except UserError as error:
        return (str(error),)
    return (judge.difference, *(step.angles for step in steps))


def _score(copy: _Copy) -> None:
    first = copy.frame(Phase.PLAYING)
    seat = copy.chance.randrange(2)
    last = copy.chance.choice((first + 1, len(copy.record.frames)))
    for at in range(first, last):
        seats = list(copy[at].seats)
        seats[seat] = structs.replace(seats[seat], score=seats[seat].score + 1)
        copy.change(at, seats=tuple(seats))
    result = copy.record.result
    if result is not None and last == len(copy.record.frames):
        scores = tuple(score + (at == seat) for at, score in enumerate(result.scores))
        copy.record.results = [structs.replace(result, scores=scores)]


def _result(copy: _Copy) -> None:
    result = copy.record.result
    if result is None:
        raise Harmless
    other = copy.chance.choice([w for w in ("left", "right", "draw") if w != result.official])
    changes: tuple[dict[str, Any], ...] = (
        {"official": other},
        {"computed": other},
        {"scores": (result.scores[0] + 1, *result.scores[1:])},
        {"scores": (99, 0), "beats": result.beats + 1000},
        {"teams": ("Others", *result.teams[1:])},
        {"digest": "00" * 8},
    )
    copy.record.results = [structs.replace(result, **copy.chance.choice(changes))]


def _event_changed(copy: _Copy) -> None:
    at = copy.event()
    event = copy.record.events[at]
    changes: tuple[dict[str, Any], ...] = (
        {"seat": 1 - event.seat if event.seat >= 0 else 0},
        {"kind": "strike" if event.kind != "strike" else "flip"},
        {"clock_ticks": event.clock_ticks + 1},
        {"beat": event.beat + 1},
        {"data": {**event.data, "points": event.data.get("points", 0) + 1}},
    )
    copy.record.events[at] = structs.replace(event, **copy.chance.choice(changes))


def _event_removed(copy: _Copy) -> None:
    del copy.record.events[copy.event()]


def _event_added(copy: _Copy) -> None:
    at = copy.event()
    event = copy.record.events[at]
    late = structs.replace(event, beat=copy.record.last_beat + copy.chance.choice((-9, 1000)))
    copy.record.events.insert(at, copy.chance.choice((event, late)))


def _section(copy: _Copy) -> None:
    """Put in a section of another match: its poses, its touches, and perhaps its last snapshot."""
    starts = [beat for beat, _ in copy.record.snapshots]
    beats = {beat for beat, _ in copy.other.snapshots}
    pairs = [(one, two) for one, two in pairwise(starts) if one in beats and two in beats]
    if not pairs:
        raise Harmless
    first, last = copy.chance.choice(pairs)
    theirs = dict(copy.other.frames)
    for at, (beat, _) in enumerate(copy.record.frames):
        if first < beat <= last and beat in theirs:
            taken = decode(theirs[beat], Frame)
            if len(taken.poses) != len(copy[at].poses):
                raise Harmless
            whole = copy.chance.random() < 0.5
            if whole:
                copy.record.frames[at] = beat, theirs[beat]
            else:
                copy.change(at, poses=taken.poses, digest=taken.digest)
    for beat in range(first + 1, last + 1):
        copy.record.touches.pop(beat, None)
        if beat in copy.other.touches:
            copy.record.touches[beat] = copy.other.touches[beat]
    snapshots = dict(copy.other.snapshots)
    if copy.chance.random() < 0.5:
        copy.record.snapshots = [
            (beat, snapshots[beat] if beat == last else saved)
            for beat, saved in copy.record.snapshots
        ]


def _snapshot(copy: _Copy, seen: bool = False) -> None:
    """Move a robot in a snapshot by 1 mm; if `seen`, also in the frames up to the next snapshot."""
    at = copy.chance.randrange(len(copy.record.snapshots))
    beat, saved = copy.record.snapshots[at]
    frame = decode(dict(copy.record.frames)[beat], Frame)
    numbers = struct.unpack(f"<{len(frame.poses) // 4}f", frame.poses)
    state = list(struct.unpack(f"<{len(saved) // 8 - 1}d", saved[8:]))
    # The poses are the state's positions in another order.
    number = copy.chance.choice((0, 1))
    place = next(i for i, value in enumerate(state) if _float32(value) == numbers[number])
    state[place] += _MM
    packed = struct.pack(f"<{len(state)}d", *state)
    frames = {b: i for i, (b, _) in enumerate(copy.record.frames)}
    before = copy[frames[beat] - 1].digest
    digest = hashlib.sha256(before + packed).digest()[:8]
    copy.record.snapshots[at] = beat, digest + packed
    if not seen:
        return
    following = [b for b, _ in copy.record.snapshots if b > beat]
    end = min(following, default=copy.record.last_beat + 1)
    for b, place in frames.items():
        if beat <= b < end and copy[place].poses:
            poses = copy.moved(copy[place].poses, (number, _MM))
            changes = {"digest": digest} if b == beat else {}
            copy.change(place, poses=poses, **changes)


def _snapshot_and_frames(copy: _Copy) -> None:
    _snapshot(copy, seen=True)


def _float32(value: float) -> float:
    found: float = struct.unpack("<f", struct.pack("<f", value))[0]
    return found


def _speed(copy: _Copy) -> None:
    """Change one of the velocities in a snapshot by 1 cm/s, and the digests to match."""
    at = copy.chance.randrange(len(copy.record.snapshots))
    beat, saved = copy.record.snapshots[at]
    frames = {b: i for i, (b, _) in enumerate(copy.record.frames)}
    poses = len(copy[frames[beat]].poses) // 4
    state = list(struct.unpack(f"<{len(saved) // 8 - 1}d", saved[8:]))
    state[1 + poses + copy.chance.randrange(poses - 2)] += 0.01
    packed = struct.pack(f"<{len(state)}d", *state)
    digest = hashlib.sha256(copy[frames[beat] - 1].digest + packed).digest()[:8]
    copy.record.snapshots[at] = beat, digest + packed
    copy.change(frames[beat], digest=digest)


def _chain(copy: _Copy) -> None:
    """Change the state hash of a snapshot's frame, or of the frame before it."""
    beat, _ = copy.chance.choice(copy.record.snapshots)
    frames = {b: i for i, (b, _) in enumerate(copy.record.frames)}
    at = frames[beat] - copy.chance.randrange(2)
    if copy[at].phase not in (Phase.READY, Phase.PLAYING):
        raise Harmless
    copy.change(at, digest=bytes(byte ^ 1 for byte in copy[at].digest))


def _touch(copy: _Copy) -> None:
    """Add a touch that did not happen, or remove the touches of a beat."""
    at = copy.frame(Phase.PLAYING)
    beat = copy.record.frames[at][0]
    touches = copy.record.touches
    if touches and copy.chance.random() < 0.5:
        beat = copy.chance.choice(sorted(touches))
        touch = touches[beat]
        if not any(touch.touched):
            raise Harmless
        touches[beat] = structs.replace(touch, touched=((),) * len(touch.touched))
        return
    touched: list[tuple[int, ...]] = [(), ()]
    touched[copy.chance.randrange(2)] = (copy.chance.randrange(4),)
    touches[beat] = Touch(tuple(touched), (None, None))


def _board(copy: _Copy) -> None:
    at = copy.frame(Phase.PLAYING)
    states = list(unpack_states(copy[at].markers, len(copy.record.sheets[-1][1].markers)))
    marker = copy.chance.randrange(len(states))
    states[marker] = (states[marker] + 1) % 3
    copy.change(at, markers=pack_states(tuple(states)))


def _frame_removed(copy: _Copy) -> None:
    del copy.record.frames[copy.frame()]


def _clock(copy: _Copy) -> None:
    at = copy.frame(Phase.PLAYING)
    copy.change(at, clock_ticks=copy[at].clock_ticks + 1)


def _setup(copy: _Copy) -> None:
    """Change a setting that the match was made from."""
    header: Header = copy.record.header
    settings = deepcopy(header.setup.settings)
    settings["match"]["duration_s"] += 1
    made = structs.replace(header.setup, settings=settings)
    copy.record.headers[0] = structs.replace(header, setup=made)


def _sheet(copy: _Copy) -> None:
    beat, sheet = copy.record.sheets[-1]
    seats = (structs.replace(sheet.seats[0], team="Others"), *sheet.seats[1:])
    copy.record.sheets[-1] = beat, structs.replace(sheet, seats=seats)


_FORGERIES: dict[str, Callable[[_Copy], None]] = {
    "a pose in a frame": _pose,
    "a path": _path,
    "an input removed": _input_removed,
    "an input added": _input_added,
    "an input changed": _input_changed,
    "an input moved": _input_moved,
    "an angle in a gait file": _angle,
    "a score": _score,
    "the result": _result,
    "an event changed": _event_changed,
    "an event removed": _event_removed,
    "an event added": _event_added,
    "a section of another match": _section,
    "a snapshot": _snapshot,
    "a snapshot and its frames": _snapshot_and_frames,
    "a speed in a snapshot": _speed,
    "the chain of hashes": _chain,
    "a touch": _touch,
    "the board": _board,
    "a frame removed": _frame_removed,
    "the clock": _clock,
    "the setup": _setup,
    "the sheet": _sheet,
}
"""Every kind of forgery by name."""
