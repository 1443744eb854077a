"""The moments of a match that are worth showing, by the change of the score or from a file."""

from collections.abc import Iterable, Sequence
from itertools import groupby, takewhile
from pathlib import Path

import msgspec

from lacoc_shared import codec
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S, Phase, SeatFlag
from lacoc_shared.words import say

TOGETHER_BEATS = BEATS_PER_S
"""Changes of the score within this time count as one moment [beats]."""
_LARGEST_BYTES = 1 << 20
_EXAMPLE = '{"moments": [{"beat": 1234, "swing": 0.4}]}'


class Moment(msgspec.Struct, frozen=True):
    """A moment of a match that is worth showing."""

    beat: int
    swing: float = 0.0
    """How much the moment changed the match; moments with larger swings are chosen first."""


class _MomentsFile(msgspec.Struct):
    """The JSON of a file of moments."""

    moments: list[Moment]


def largest(moments: Iterable[Moment], count: int) -> list[Moment]:
    """Return the `count` moments with the largest swings, in the order of time.

    Of moments with equal swings the earlier ones are chosen.
    """
    ranked = sorted(moments, key=lambda moment: (-moment.swing, moment.beat))
    return sorted(ranked[:count], key=lambda moment: moment.beat)


def by_score(record: Record) -> list[Moment]:
    """Return the moments in which the score changed while the match was played.

    A change by a referee while the match is halted is no moment. The swing of a moment is the
    number of points by which the lead changed, or the score if there is only one seat.

    Raises:
        UserError: if a frame of the record can't be read.
    """
    return of_frames(_frames(record))


def played(record: Record) -> list[int]:
    """Return the beats of all frames in which a recorded match was in play, in order.

    Raises:
        UserError: if a frame of the record can't be read.
    """
    return [beat for beat, frame in _frames(record) if frame.phase == Phase.PLAYING]


def final_scores(record: Record) -> tuple[int, ...]:
    """Return the points at the end of a record, by seat; empty if it has no frame.

    Raises:
        UserError: if a frame of the record can't be read.
    """
    frames = _frames(record)
    return tuple(seat.score for seat in frames[-1][1].seats) if frames else ()


def opening(record: Record, length: int) -> int:
    """Return the beat from which to show the teams, for so many beats before the count-down.

    While a team has not joined there is nobody to show: then it is a later beat.

    Raises:
        UserError: if a frame of the record can't be read.
    """
    return opening_of_frames(_frames(record), length)


def opening_of_frames(frames: Sequence[tuple[int, Frame]], length: int) -> int:
    """Return the beat from which to show the teams; see `opening`.

    Args:
        frames: the frames with their beats, in rising order.
        length: how long the teams are shown [beats].
    """
    before = [*takewhile(lambda one: one[1].phase < Phase.COUNTDOWN, frames)]
    end = before[-1][0] + 1 if before else 0
    together = [
        beat for beat, frame in before if all(seat.flags & SeatFlag.JOINED for seat in frame.seats)
    ]
    return max(end - length, together[0] if together else end)


def _frames(record: Record) -> list[tuple[int, Frame]]:
    try:
        return [(beat, codec.decode(data, Frame)) for beat, data in record.frames]
    except codec.BadMessage as error:
        match, told = record.header.match_id[:80], str(error)[:80]
        raise UserError(say("replay.damaged-copy", match=match, error=told)) from None


def of_frames(frames: Iterable[tuple[int, Frame]]) -> list[Moment]:
    """Return the moments in which the score changed, from a match's frames; see `by_score`.

    Args:
        frames: the frames with their beats, in rising order.
    """
    found: list[Moment] = []
    for phase, played in groupby(frames, key=lambda one: one[1].phase):
        if phase == Phase.PLAYING:
            found += swings(
                [(beat, [seat.score for seat in frame.seats]) for beat, frame in played]
            )
    return found


def swings(scores: Sequence[tuple[int, Sequence[int]]]) -> list[Moment]:
    """Return the moments in which the lead changed.

    Args:
        scores: pairs of a beat and the points by seat; beats in rising order.
    """
    found: list[tuple[int, int, int]] = []  # first beat, lead before, lead after
    before: int | None = None
    for beat, points in scores:
        lead = points[0] - points[1] if len(points) == 2 else sum(points)
        if before is not None and lead != before:
            if found and beat - found[-1][0] <= TOGETHER_BEATS:
                found[-1] = (found[-1][0], found[-1][1], lead)
            else:
                found.append((beat, before, lead))
        before = lead
    return [Moment(beat, abs(after - was)) for beat, was, after in found if after != was]


def from_file(path: Path) -> list[Moment]:
    """Read moments from a file: JSON, `{"moments": [{"beat": 1234, "swing": 0.4}]}`.

    Raises:
        UserError: if the file can't be read, or has no such JSON.
    """
    try:
        if path.stat().st_size > _LARGEST_BYTES:
            most_mib = _LARGEST_BYTES >> 20
            raise UserError(say("film.moments-too-large", file=str(path), most_mib=most_mib))
        return msgspec.json.decode(path.read_bytes(), type=_MomentsFile).moments
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("film.cannot-read", file=str(path), why=why)) from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        told = printable(str(error), 120)
        said = say("film.bad-moments", file=str(path), error=told, example=_EXAMPLE)
        raise UserError(said) from None
