"""Writes what happens in a match into its record, in whatever form the file has."""

from abc import ABC, abstractmethod
from pathlib import Path

from lacoc_shared import codec
from lacoc_shared.inputs import Input
from lacoc_shared.messages import Event, HealthVerdict, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.schema import KINDS, Result, Touch
from lacoc_shared.words import Phrase, say

CHANNELS = {topic: channel for channel, topic in enumerate(KINDS, start=1)}
"""The channel of each kind of message in the files of a record."""
HEADER, _INPUT, _EVENT, _FRAME, _TOUCH, _SNAPSHOT, _SHEET, _SCENE, _RESULT, _HEALTH = (
    CHANNELS.values()
)


class Recorder(ABC):
    """A file of a match's record that is being written."""

    path: Path
    """The file."""
    sync_trouble: Phrase | None = None
    """Error that the disk reported about data already written; None if there was none."""

    def input(self, beat: int, item: Input) -> None:
        """Write an input of the match."""
        self._write(_INPUT, beat, codec.encode(item))

    def event(self, event: Event) -> None:
        """Write an event of the match, at the event's own beat."""
        self._write(_EVENT, event.beat, codec.encode(event))

    def frame(self, beat: int, encoded: bytes) -> None:
        """Write a frame of the match, in the bytes that were published."""
        self._write(_FRAME, beat, encoded)

    def touch(self, beat: int, touch: Touch) -> None:
        """Write which markers were touched in a tick, and where robots were put back."""
        self._write(_TOUCH, beat, codec.encode(touch))

    def snapshot(self, beat: int, data: bytes) -> None:
        """Write the state of physics after a beat, as bytes for the same model in MuJoCo."""
        self._write(_SNAPSHOT, beat, data)

    def sheet(self, beat: int, sheet: Sheet) -> None:
        """Write a new sheet of the match."""
        self._write(_SHEET, beat, codec.encode(sheet))

    def scene(self, beat: int, scene: Scene) -> None:
        """Write a new scene of the match."""
        self._write(_SCENE, beat, codec.encode(scene))

    def result(self, result: Result) -> None:
        """Write the match's result; a later result replaces it."""
        self._write(_RESULT, result.beats, codec.encode(result))

    def health(self, beat: int, verdict: HealthVerdict) -> None:
        """Write the verdict how well the match has run so far; a later verdict replaces it."""
        self._write(_HEALTH, beat, codec.encode(verdict))

    @abstractmethod
    def flush(self) -> None:
        """Write the data that still wait in memory, for example because the disk was full.

        Raises:
            UserError: if the disk does not take them.
        """

    @abstractmethod
    def end(self) -> None:
        """Write the end of the file, which shows that the match is over."""

    @abstractmethod
    def close(self) -> None:
        """End the file, and wait for the disk. A second call does nothing."""

    @abstractmethod
    def leave(self) -> None:
        """Close the file without its end, because the match is not over and may go on later.

        A packed file (`PackedWriter`) is removed instead.
        """

    @abstractmethod
    def _write(self, channel: int, beat: int, data: bytes) -> None:
        """Write one message into the file, on the channel of its kind."""


def no_record(path: Path, error: OSError) -> UserError:
    """Return the error which says that a file of a record can't be made."""
    if path.exists():
        return UserError(say("record.exists", file=str(path)))
    why = error.strerror or str(error)
    return UserError(say("record.no-folder", folder=str(path.parent), why=why))
