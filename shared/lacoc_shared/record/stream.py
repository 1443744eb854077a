"""Reads one file of a record, message by message, in the order they were written."""

import struct
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import zstandard
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, DataEnd, McapRecord, Message
from mcap.records import Header as FileHeader
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC

from lacoc_shared import codec
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.protocol_1 import read_event
from lacoc_shared.record.schema import BEAT_NS, FORMAT, KINDS, PROFILE
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import say

DAMAGE = (
    McapError,
    codec.BadMessage,
    struct.error,
    zstandard.ZstdError,
    ValueError,
    KeyError,
    MemoryError,
    OverflowError,
)
"""What bytes that are no record raise where they are read."""


_MAX_BYTES = 1 << 26
"""A longer message or chunk is no record's: the longest message, a scene, has some 30 kB, and a
chunk 1 MiB."""
_RECORD_HEAD_BYTES = 9
"""A record's opcode and length."""
_UNPACKED_BYTES, _UNPACKED_RATIO = 1 << 22, 50
"""A file unpacks to no more than this and so many times its own size: a match, and also a court
where nothing happens, packs to a third or a quarter."""

_LONGEST_GAP_BEATS = 3600 * BEATS_PER_S
"""A court records a frame every second; a gap longer than an hour is a damaged time, and whoever
counts the beats up to it would not come back."""

TakeBytes = Callable[[str, int, bytes], None]
"""Called with a message's topic, beat and bytes."""
Take = Callable[[str, int, bytes, Any], None]
"""The same, and what the bytes mean (a snapshot's: the bytes)."""


class Stop(NamedTuple):
    """Where a file can't be read any further, and why."""

    text: str
    """What is wrong with it, as the end of a sentence."""
    damaged: bool
    """Whether it is damaged or not whole; False: it was never closed, as by a killed court."""


class _Format(msgspec.Struct):
    """The one entry that a header of any format has."""

    format: int


def walk(path: Path, take: Take) -> Stop | None:
    """Give every whole message of a file to `take`, up to where it stops or is damaged.

    See `walk_bytes`. Bytes that are not the message of their topic are damage too.
    """
    return walk_bytes(
        path, lambda topic, beat, data: take(topic, beat, data, _decode(path, topic, data))
    )


def walk_bytes(path: Path, take: TakeBytes) -> Stop | None:
    """Give the bytes of every whole message of a file to `take`, whatever they mean.

    A packed file's messages are in chunks, each with a checksum: of a damaged chunk nothing is
    given.

    Args:
        path: a segment, or a packed file.
        take: gets the messages.

    Returns:
        None if the file was closed and is whole; else what is wrong with it: it may have held
        more.

    Raises:
        UserError: if it can't be read, is not a record, or is of another format.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("recording.unreadable", file=str(path), why=why)) from None
    if data[: len(MCAP0_MAGIC)] != MCAP0_MAGIC[: len(data)]:
        raise UserError(say("recording.not-mcap", file=str(path)))
    beat, whole = -1, len(MCAP0_MAGIC)
    topics: dict[int, str] = {}
    file = BytesIO(data)
    try:
        for record in _records(file, len(data)):
            if isinstance(record, Message):
                topic = topics[record.channel_id]
                beat = _next_beat(beat, record.log_time // BEAT_NS, topic)
                take(topic, beat, record.data)
            elif isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, DataEnd):
                return None
            elif isinstance(record, FileHeader) and record.profile != PROFILE:
                raise UserError(say("recording.other-mcap", file=str(path)))
            whole = file.tell()
    except DAMAGE as error:
        if not _is_cut(data, whole):
            text = (
                f"is damaged at byte {whole} of {len(data)} ({error}); its last "
                f"{len(data) - whole} bytes can't be read. Copy it again from where it was made."
            )
            return Stop(text, damaged=True)
    left = max(0, len(data) - whole)
    rest = f"; its last {left} bytes can't be read" if left else ""
    return Stop(
        f"has no end there: it was never closed, not copied whole, or is damaged{rest}.",
        damaged=_is_packed(data),  # a file is packed whole before it gets its name
    )


def _is_packed(data: bytes) -> bool:
    """Whether a file's messages are in chunks."""
    at = len(MCAP0_MAGIC)
    while at < len(data) and data[at] not in (Opcode.MESSAGE, Opcode.CHUNK):
        at += _RECORD_HEAD_BYTES + int.from_bytes(data[at + 1 : at + 9], "little")
    return data[at : at + 1] == bytes([Opcode.CHUNK])


def _is_cut(data: bytes, at: int) -> bool:
    """Whether a file ends in the middle of the record that begins at a byte."""
    if data.endswith(MCAP0_MAGIC) and len(data) > at + len(MCAP0_MAGIC):
        return False
    length = int.from_bytes(data[at + 1 : at + _RECORD_HEAD_BYTES], "little")
    return len(data) < at + _RECORD_HEAD_BYTES + length <= at + _MAX_BYTES


def _next_beat(before: int, beat: int, topic: str) -> int:
    """The beat of a message.

    Raises:
        BadMessage: if it can't come after the one before it.
    """
    if topic != "/lacoc/header" and beat > max(before, 0) + _LONGEST_GAP_BEATS:
        raise codec.BadMessage(f"beat {beat} after beat {before}")
    return beat


def _records(file: BytesIO, size: int) -> Iterator[McapRecord]:
    """The records of a file, also those in its chunks; no more than a match may have.

    Raises:
        McapError: if a chunk is larger than it may be, or packed in a way that records are not.
            Much else, if the file is damaged.
    """
    left = _UNPACKED_BYTES + _UNPACKED_RATIO * size
    reader = StreamReader(file, validate_crcs=True, record_size_limit=size, emit_chunks=True)
    for record in reader.records:
        if not isinstance(record, Chunk):
            yield record
            continue
        left -= _unpacked_bytes(record)
        if left < 0:
            raise McapError("it unpacks to more than a match has")
        yield from breakup_chunk(record, validate_crc=True)


def _unpacked_bytes(chunk: Chunk) -> int:
    """What unpacking a chunk takes: whoever wrote it says so, and zstd believes its own word."""
    size = len(chunk.data)
    if chunk.compression == "zstd":
        size = max(chunk.uncompressed_size, zstandard.frame_content_size(chunk.data))
    elif chunk.compression:
        raise McapError(f"a chunk is packed by {chunk.compression!r:.20}")
    if size > _MAX_BYTES:
        raise McapError(f"a chunk unpacks to {size} bytes")
    return size


def _decode(path: Path, topic: str, data: bytes) -> Any:
    if topic == "/lacoc/header":
        found = codec.decode(data, _Format, _MAX_BYTES).format
        if found != FORMAT:
            raise UserError(
                say("recording.other-format", file=str(path), found=str(found), reads=FORMAT)
            )
    if topic == "/lacoc/event":
        return read_event(data, _MAX_BYTES)
    kind = KINDS[topic]
    return data if kind is None else codec.decode(data, kind, _MAX_BYTES)
