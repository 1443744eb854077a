"""Writes the record of a running match so that a kill of the court loses nothing written.

The file is plain MCAP (https://mcap.dev/spec), unchunked and unbuffered: each message is one system
call. `mcap.writer` would put a buffer before the file. A kill would lose this buffer, and filling
it takes longer than writing to the file. So this module itself packs the messages after the
header, and uses `mcap.records` for all else.
"""

import os
import struct
import threading
import time
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Footer, McapRecord, Message, Statistics
from mcap.records import Header as FileHeader
from mcap.writer import MCAP0_MAGIC

from lacoc_shared import __version__, codec
from lacoc_shared.command.holding import hold
from lacoc_shared.command.replacing import sync_folder
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.recorder import CHANNELS, HEADER, Recorder, no_record
from lacoc_shared.record.schema import BEAT_NS, KINDS, PROFILE, Header
from lacoc_shared.words import say

_ROOM_S = 2.0
"""How long `close` waits for room on a full disk [s]: without its end, a record counts as that of a
match that goes on."""
_LOOK_S = 0.05
SYNC_S = 1.0
"""Time between two writes to the disk (fsync) [s]: a power cut loses at most so much."""

_message_head = struct.Struct("<BQHIQQ").pack
"""Layout of a message's head: opcode, length of the rest, channel, sequence, log time, publish
time."""
_HEAD_BYTES = 22
"""Number of bytes of this head that the length field includes."""


class RecordWriter(Recorder):
    """One segment of a match's record, open for writing.

    If the disk is full, data wait in memory, in order, until `flush` can write them.

    Args:
        folder: folder of the records; made if it does not exist.
        header: the first message of the file; the file is named by it.

    Raises:
        UserError: if the file can't be made, or exists already.
    """

    def __init__(self, folder: Path, header: Header) -> None:
        self.path = files.segment_path(folder, header.match_id, header.segment)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("xb", buffering=0)
        except OSError as error:
            raise no_record(self.path, error) from None
        hold(self._file)
        self._backlog = bytearray()
        self._write_error = ""
        self._counts = [0] * (len(KINDS) + 1)
        self._first_ns = self._last_ns = header.first_beat * BEAT_NS
        self._channels = [
            Channel(
                id=channel,
                topic=topic,
                message_encoding="msgpack" if KINDS[topic] else "",
                metadata={},
                schema_id=0,
            )
            for topic, channel in CHANNELS.items()
        ]
        self._counts[HEADER] = 1
        first = Message(HEADER, self._first_ns, codec.encode(header), self._first_ns, 0)
        # Written in one system call, so that a file with any message also has its header.
        self._put(
            MCAP0_MAGIC
            + _bytes(FileHeader(PROFILE, f"lacoc {__version__}"), *self._channels, first)
        )
        if self._backlog:
            self._file.close()
            self.path.unlink()
            raise UserError(say("record.folder-full", folder=str(folder), why=self._write_error))
        self._dirty = True
        self._ended = False
        self._closing = threading.Event()
        self._syncer = threading.Thread(target=self._sync, name="record sync", daemon=True)
        self._syncer.start()

    def flush(self) -> None:
        """Write the data that wait in memory because the disk was full.

        Raises:
            UserError: if the disk does not take them.
        """
        if self._backlog:
            self._put(b"")
        if self._backlog:
            raise UserError(say("record.no-room", file=self.path.name, why=self._write_error))

    def end(self) -> None:
        """Write the file's summary, because the match is over. A second call does nothing."""
        if not self._ended:
            self._ended = True
            self._put(self._ending())
            self._dirty = True

    def close(self) -> None:
        """End the file, and wait for the disk. A second call does nothing."""
        if not self._closing.is_set():
            self.end()
            until_s = time.monotonic() + _ROOM_S
            while self._backlog and time.monotonic() < until_s:  # the disk is full: room may come
                time.sleep(_LOOK_S)
                self._put(b"")
        self.leave()

    def leave(self) -> None:
        """Close the file without its end, after the disk has what was written.

        A match without an end can continue in a new segment. Data that wait in memory are lost.
        """
        if self._closing.is_set():
            return
        self._closing.set()
        self._syncer.join()
        self._file.close()

    def _write(self, channel: int, beat: int, data: bytes) -> None:
        counts = self._counts
        sequence = counts[channel]
        counts[channel] = sequence + 1
        self._last_ns = time_ns = beat * BEAT_NS
        length = _HEAD_BYTES + len(data)
        self._put(_message_head(Opcode.MESSAGE, length, channel, sequence, time_ns, time_ns) + data)
        self._dirty = True

    def _put(self, data: bytes) -> None:
        """Append data to the file; what the disk does not take is kept for the next call."""
        waiting = self._backlog
        written = 0 if waiting else self._append(data)
        if written < len(data):
            waiting += data[written:]
        if waiting:  # after a partial write, a second write raises the disk's reason
            del waiting[: self._append(waiting)]

    def _append(self, data: bytes | bytearray) -> int:
        """Append as many bytes to the file as the disk takes; return how many were written."""
        try:
            return self._file.write(data)
        except OSError as error:
            self._write_error = error.strerror or str(error)
            return 0

    def _sync(self) -> None:
        """Write the file to the disk (fsync) once a second, on a thread of its own."""
        try:
            sync_folder(self.path.parent)
        except OSError as error:
            self._sync_failed(error)
        while not self._closing.wait(SYNC_S):
            self._sync_once()
        self._sync_once()

    def _sync_once(self) -> None:
        if not self._dirty:
            return
        self._dirty = False
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            self._sync_failed(error)

    def _sync_failed(self, error: OSError) -> None:
        # The error stays: the system may have dropped the data, and then reports no further error.
        self.sync_trouble = say(
            "record.disk-trouble", file=self.path.name, why=error.strerror or str(error)
        )

    def _ending(self) -> bytes:
        """Return the bytes that follow the last message in the file of a match that is over.

        They have no index, because an index lists chunks, and a segment has none.
        """
        end = _bytes(DataEnd(data_section_crc=0))
        start = self._file.tell() + len(self._backlog) + len(end)
        statistics = Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts={
                number: count for number, count in enumerate(self._counts) if count
            },
            chunk_count=0,
            message_count=sum(self._counts),
            message_end_time=self._last_ns,
            message_start_time=self._first_ns,
            metadata_count=0,
            schema_count=0,
        )
        footer = Footer(summary_start=start, summary_offset_start=0, summary_crc=0)
        return end + _bytes(*self._channels, statistics, footer) + MCAP0_MAGIC


def _bytes(*records: McapRecord) -> bytes:
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return bytes(builder.end())
