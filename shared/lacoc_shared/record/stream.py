"""Reads one file of a record, message by message, in the order in which they were written.

A match has 50 messages a second. So this module itself finds them in the bytes of a file, as
`lacoc_shared.record.writer` packs them; `mcap` reads the records of other kinds.
"""

import struct
import zlib
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, DataEnd, Statistics
from mcap.records import Header as FileHeader
from mcap.stream_reader import StreamReader, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC

from lacoc_shared import codec
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import Sheet
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.record.protocol_1 import read_event
from lacoc_shared.record.schema import BEAT_NS, FORMAT, KINDS, PROFILE, Result
from lacoc_shared.record.values import lists_and_maps
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase, say

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
"""The exceptions that reading raises if the bytes are not a record."""


_MAX_BYTES = 1 << 26
"""Largest message or chunk of a record [bytes]. The largest ones that courts write are a scene of
about 30 kB and a chunk of 128 KiB."""
_RECORD_HEAD = struct.Struct("<BQ")
"""Layout of an MCAP record's head: opcode, and length of the content."""
_MESSAGE_HEAD = struct.Struct("<HIQQ")
"""Layout of the head in a message's content: channel, sequence, log time, publish time."""
_CRC_BYTES = 4
_ENDING_BYTES = _RECORD_HEAD.size + 16 + _CRC_BYTES + len(MCAP0_MAGIC)
"""Size of the footer, whose last field is the checksum of the summary, and of the magic bytes after
it [bytes]."""
_UNPACKED_BYTES, _UNPACKED_RATIO = 1 << 22, 50
"""A file may unpack to at most so many bytes, plus so many times its own size. Real matches unpack
to three or four times their size, even if nothing happens at the court."""

_VALUES, _VALUES_RATIO = 500_000, 0.5
"""A file may have at most so many lists and maps, plus so many for each of its bytes. An empty list
is a single byte in a message, and 60 bytes in memory."""
_COUNTED = frozenset(KINDS) - {"/lacoc/frame", "/lacoc/snapshot"}
"""Topics whose messages may have values of any kind."""
_NAME_MOST = 200
"""Longest name of a team in a record [characters]; courts accept shorter ones only."""

_SILENT_MOST_BEATS = 3600 * BEATS_PER_S
"""A court records at least one frame a second. If a file's longer gaps together are more than an
hour, a time is damaged. A program that counts all beats up to such a time would never end."""

TakeBytes = Callable[[str, int, bytes], None]
"""Called with a message's topic, beat and bytes."""
Take = Callable[[str, int, bytes, Any], None]
"""Called with topic, beat, bytes and the decoded message; for a snapshot the bytes take the place
of the message."""


class Stop(NamedTuple):
    """What is wrong with a file of a record; in most cases reading stops there."""

    why: Phrase
    """The fault, as the end of a sentence (`cut.*`)."""
    damaged: bool
    """Whether messages are lost, because the file is damaged or incomplete. False: the file was
    only not closed, as after a kill of the court, or the damage is outside of the messages."""
    at_end: bool = False
    """Whether all messages could be read in spite of the fault."""

    @property
    def loses_nothing(self) -> bool:
        """Whether the fault loses no message, because all of them were read."""
        return self.at_end and not self.damaged


class _AnyHeader(msgspec.Struct):
    """The only field that the header of a record has in every format."""

    format: int


def walk_messages(path: Path, take: Take) -> Stop | None:
    """Decode each whole message of a record's file and pass it to `take`, up to the first fault.

    It is like `walk_bytes`, but bytes that can't be decoded as a message of their topic are a
    fault too.
    """
    try:
        values = _VALUES + path.stat().st_size * _VALUES_RATIO
    except OSError:
        values = 0.0  # `walk_bytes` says what is wrong with the file

    def decoded(topic: str, beat: int, data: bytes) -> None:
        nonlocal values
        if topic in _COUNTED:
            values -= lists_and_maps(data, values)
            if values < 0:
                raise codec.BadMessage("it has more values than a match")
        take(topic, beat, data, _decode(path, topic, data))

    return walk_bytes(path, decoded)


def walk_bytes(path: Path, take: TakeBytes) -> Stop | None:
    """Pass the bytes of each whole message of a record's file to `take`, without decoding them.

    A packed file's messages are in chunks, each with a checksum: nothing in a damaged chunk
    is passed on. Other checksums find damage in the index of the chunks.

    Args:
        path: a segment, or a packed file.
        take: called with each message.

    Returns:
        None if the file was closed and is complete; else its fault: there may have been more
        messages.

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
    beat, silent, whole, count = -1, 0, len(MCAP0_MAGIC), 0
    topics: dict[int, str] = {}
    try:
        for at, end, opcode, source, first, last in _records(data):
            if opcode == Opcode.MESSAGE:
                channel, _, time_ns, _ = _MESSAGE_HEAD.unpack_from(source, first)
                topic = topics[channel]
                before, beat = beat, time_ns // BEAT_NS
                if topic != "/lacoc/header":
                    silent += max(0, beat - max(before, 0) - BEATS_PER_S)
                    if silent > _SILENT_MOST_BEATS:
                        raise codec.BadMessage(f"beat {beat} after beat {before}")
                take(topic, beat, source[first + _MESSAGE_HEAD.size : last])
                count += 1
            elif opcode == Opcode.CHANNEL:
                found = Channel.read(_stream(source[first:last]))
                topics[found.id] = found.topic
            elif opcode == Opcode.DATA_END:
                checksum = DataEnd.read(_stream(source[first:last])).data_section_crc
                if checksum and checksum != zlib.crc32(data[:at]):
                    return _damaged_data(data, end, count)
                return _damaged_index() if _is_index_damaged(data, end) else None
            elif opcode == Opcode.HEADER and _profile(source[first:last]) != PROFILE:
                raise UserError(say("recording.other-mcap", file=str(path)))
            whole = end
    except DAMAGE as error:
        if not _is_cut(data, whole):
            lost, told = len(data) - whole, printable(str(error), 200)
            fault = say("cut.damaged", byte=whole, bytes=len(data), error=told, lost=lost)
            return Stop(fault, damaged=True)
    left = max(0, len(data) - whole) or None
    if _is_packed(data):  # a file is packed whole before it gets its name
        return Stop(say("cut.short", lost=left), damaged=True)
    return Stop(say("cut.no-end", lost=left), damaged=False)


def _damaged_index() -> Stop:
    return Stop(say("cut.index"), damaged=False, at_end=True)


def _damaged_data(data: bytes, at: int, count: int) -> Stop:
    """Return the fault of a file whose data do not fit their checksum, while each chunk does.

    If the damage is in the type of a chunk, the chunk's messages are lost. The number of messages
    in the file's summary shows whether this is so.

    Args:
        data: the file.
        at: byte at which its summary begins.
        count: number of messages that were read.
    """
    if _messages_by_summary(data, at) == count:
        return _damaged_index()
    return Stop(say("cut.between"), damaged=True, at_end=True)


def _messages_by_summary(data: bytes, at: int) -> int | None:
    """Return how many messages a file has, as its summary says; None if that is damaged too."""
    if _is_index_damaged(data, at):
        return None
    reader = StreamReader(BytesIO(data[at:]), skip_magic=True, record_size_limit=len(data))
    try:
        found = (one.message_count for one in reader.records if isinstance(one, Statistics))
        return next(found, None)
    except DAMAGE:
        return None


def _is_index_damaged(data: bytes, at: int) -> bool:
    """Return whether a file's summary, which begins at byte `at`, is damaged or cut off.

    Only a packed file has an index and a checksum in it.
    """
    if not _is_packed(data):
        return False
    if len(data) < at + _ENDING_BYTES or not data.endswith(MCAP0_MAGIC):
        return True
    end = len(data) - len(MCAP0_MAGIC) - _CRC_BYTES
    if data[len(data) - _ENDING_BYTES] != Opcode.FOOTER:
        return True
    checksum = int.from_bytes(data[end : end + _CRC_BYTES], "little")
    return checksum not in (0, zlib.crc32(data[at:end]))


def _is_packed(data: bytes) -> bool:
    """Return whether a file is the one packed file of a record: its messages are in chunks."""
    at = len(MCAP0_MAGIC)
    while at < len(data) and data[at] not in (Opcode.MESSAGE, Opcode.CHUNK):
        at += _RECORD_HEAD.size + int.from_bytes(data[at + 1 : at + 9], "little")
    return data[at : at + 1] == bytes([Opcode.CHUNK])


def _is_cut(data: bytes, at: int) -> bool:
    """Return whether a file ends in the middle of the MCAP record that begins at byte `at`."""
    if data.endswith(MCAP0_MAGIC) and len(data) > at + len(MCAP0_MAGIC):
        return False
    length = int.from_bytes(data[at + 1 : at + _RECORD_HEAD.size], "little")
    return len(data) < at + _RECORD_HEAD.size + length <= at + _MAX_BYTES


class _Found(NamedTuple):
    """Where an MCAP record (a part of an MCAP file) stands in a file, perhaps inside a chunk."""

    at: int
    """Byte of the file at which the record begins, or the chunk that contains it."""
    end: int
    """Byte of the file at which the record ends, or the chunk that contains it."""
    opcode: int
    source: bytes
    """The file, or the unpacked chunk."""
    first: int
    """Byte of `source` at which its content begins."""
    last: int
    """Byte of `source` at which its content ends."""


def _records(data: bytes) -> Iterator[_Found]:
    """Yield the MCAP records of a file, also those in its chunks, up to the size limit of a match.

    Raises:
        McapError: if a chunk is too large, or has a compression that LACOC does not use. If the
            file is damaged, other errors of `DAMAGE`.
    """
    left = _UNPACKED_BYTES + _UNPACKED_RATIO * len(data)
    at = len(MCAP0_MAGIC)
    for opcode, first, last in _split(data, at):
        if opcode == Opcode.CHUNK:
            chunk = Chunk.read(_stream(data[first:last]))
            left -= _unpacked_bytes(chunk)
            if left < 0:
                raise McapError("it unpacks to more than a match has")
            stream, size = get_chunk_data_stream(chunk, validate_crc=True)
            source = stream.read(size)
            for inner, begin, end in [*_split(source)]:  # all of a chunk, or nothing
                if inner in (Opcode.CHANNEL, Opcode.MESSAGE):
                    yield _Found(at, last, inner, source, begin, end)
        else:
            yield _Found(at, last, opcode, data, first, last)
        at = last


def _split(data: bytes, at: int = 0) -> Iterator[tuple[int, int, int]]:
    """Yield the opcode of each MCAP record in bytes, and where its content begins and ends.

    Raises:
        McapError: if a record is not complete.
    """
    while at < len(data):
        if len(data) - at < _RECORD_HEAD.size:
            raise McapError("a record ends in its head")
        opcode, length = _RECORD_HEAD.unpack_from(data, at)
        first = at + _RECORD_HEAD.size
        at = first + length
        if at > len(data):
            raise McapError(f"a record of {length} bytes is longer than the file")
        if opcode == Opcode.MESSAGE and length < _MESSAGE_HEAD.size:
            raise McapError("a message ends in its head")
        yield opcode, first, at


def _profile(header: bytes) -> str:
    return str(FileHeader.read(_stream(header)).profile)


def _stream(content: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(content))


def _unpacked_bytes(chunk: Chunk) -> int:
    """Return a chunk's unpacked size: from its own header or from zstd's, whichever is larger."""
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
        found = codec.decode(data, _AnyHeader, _MAX_BYTES).format
        if found != FORMAT:
            raise UserError(
                say("recording.other-format", file=str(path), found=str(found), reads=FORMAT)
            )
    if topic == "/lacoc/event":
        return read_event(data, _MAX_BYTES)
    kind = KINDS[topic]
    if kind is None:
        return data
    message = codec.decode(data, kind, _MAX_BYTES)
    if any(len(name) > _NAME_MOST for name in _names(message)):
        raise codec.BadMessage("a team's name is too long")
    return message


def _names(message: object) -> tuple[str, ...]:
    match message:
        case JoinSeat(team=team):
            return (team,)
        case Sheet(seats=seats):
            return tuple(seat.team for seat in seats)
        case Result(teams=teams):
            return teams
        case _:
            return ()
