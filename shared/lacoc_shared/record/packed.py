"""The packed file of a finished match: compressed, indexed, with checksums."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from mcap.writer import Writer

from lacoc_shared import __version__, codec
from lacoc_shared.command.holding import hold
from lacoc_shared.command.replacing import sync_folder
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.recorder import CHANNELS, HEADER, Recorder, no_record
from lacoc_shared.record.schema import BEAT_NS, KINDS, PROFILE, Header
from lacoc_shared.words import say

CHUNK_BYTES = 1 << 17
"""Size of a chunk before compression [bytes]: seven seconds of play. If a file is damaged, the
match is lost from the damaged chunk on. Chunks of this size make a file 1 % larger than those of 1
MiB; with 64 KiB it is 6 %."""

_MOST_WAITING = 1000
"""Messages that wait in memory before they are packed together. That takes half as long as to pack
each one between two ticks of physics, after which the processor's caches are cold."""

Message = tuple[str, int, bytes]
"""Topic, beat and bytes of one message of a record."""


class PackedFile:
    """A packed file that is being written; it gets its name when it is complete and on the disk.

    Until then its name ends in ".part", and it is locked. What a killed process left under that
    name is overwritten.

    Args:
        path: the file.

    Raises:
        UserError: if another process is writing it.
        OSError: if it can't be made.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.unfinished = files.unfinished_path(path)
        self._file = self.unfinished.open("ab")
        if not hold(self._file):
            self._file.close()
            raise UserError(say("pack.busy", file=str(self.unfinished)))
        self._file.seek(0)
        self._file.truncate()
        # The checksum of all data finds damage between the chunks, each of which has its own.
        self._writer = Writer(self._file, chunk_size=CHUNK_BYTES, enable_data_crcs=True)
        self._writer.start(profile=PROFILE, library=f"lacoc {__version__}")
        for topic, kind in KINDS.items():
            self._writer.register_channel(topic, "msgpack" if kind else "", 0)
        self._counts = [0] * (len(KINDS) + 1)
        self._has_name = False

    def add(self, channel: int, beat: int, data: bytes) -> None:
        """Add a message.

        Raises:
            OSError: if the disk does not take it.
        """
        time_ns = beat * BEAT_NS
        self._writer.add_message(channel, time_ns, data, time_ns, self._counts[channel])
        self._counts[channel] += 1

    def add_all(self, messages: Sequence[Message]) -> None:
        """Add messages, in order.

        Raises:
            OSError: if the disk does not take them.
        """
        for topic, beat, data in messages:
            self.add(CHANNELS[topic], beat, data)

    def complete(self) -> None:
        """Write the index, and wait until the disk has everything. A second call does nothing.

        Raises:
            OSError: if the disk refuses.
        """
        if not self._file.closed:
            self._writer.finish()
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()

    def name(self) -> None:
        """Complete the file and give it its name. A second call does nothing.

        Raises:
            OSError: if the disk refuses.
        """
        self.complete()
        if not self._has_name:
            self.unfinished.rename(self._path)
            self._has_name = True
            sync_folder(self._path.parent)

    def discard(self) -> None:
        """Remove the file if it has no name yet; do nothing if the disk does not allow it."""
        if self._has_name:
            return
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            self.unfinished.unlink(missing_ok=True)

    def __enter__(self) -> "PackedFile":
        return self

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        """Name the file at the end of the block, or discard it if the block raised an error."""
        try:
            if error is None:
                self.name()
        finally:
            self.discard()


class PackedWriter(Recorder):
    """The packed record of a match that can be played again if something interrupts it.

    A match at a court is recorded by `RecordWriter` instead, which survives a kill.

    Args:
        folder: folder of the record; made if it does not exist.
        header: the header of the messages that the match will write; the file is named by it.
        before: messages of earlier segments, from which the match goes on.

    Raises:
        UserError: if there is such a file already, or it can't be made or written.
    """

    def __init__(self, folder: Path, header: Header, before: Sequence[Message] = ()) -> None:
        self.path = files.packed_path(folder, header.match_id)
        if self.path.exists():
            raise UserError(say("record.exists", file=str(self.path)))
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file = PackedFile(self.path)
        except OSError as error:
            raise no_record(self.path, error) from None
        self._waiting = [(CHANNELS[topic], beat, data) for topic, beat, data in before]
        self._write(HEADER, header.first_beat, codec.encode(header))

    def flush(self) -> None:
        """Write the messages that wait in memory.

        Raises:
            UserError: if the disk does not take them; then the file is removed.
        """
        with self._room():
            for message in self._waiting:
                self._file.add(*message)
        self._waiting.clear()

    def end(self) -> None:
        """Write the index, because the match is over.

        Raises:
            UserError: if the disk does not take it; then the file is removed.
        """
        self.flush()
        with self._room():
            self._file.complete()

    def close(self) -> None:
        """End the file, and give it its name when the disk has everything.

        Raises:
            UserError: if the disk does not take everything; then the file is removed.
        """
        self.end()
        with self._room():
            self._file.name()

    def leave(self) -> None:
        """Remove the file, because the match is not over."""
        self._file.discard()

    def _write(self, channel: int, beat: int, data: bytes) -> None:
        self._waiting.append((channel, beat, data))
        if len(self._waiting) >= _MOST_WAITING:
            self.flush()

    @contextmanager
    def _room(self) -> Iterator[None]:
        """Remove the file if the disk does not take what the `with` block writes, and say why."""
        try:
            yield
        except OSError as error:
            self._file.discard()
            why = error.strerror or str(error)
            raise UserError(say("record.no-room", file=self.path.name, why=why)) from None
