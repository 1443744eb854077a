"""A record's files: after a kill, damage or a full disk, all whole messages can still be read."""

import os
import re
import signal
import struct
import subprocess
import sys
import threading
import time
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import msgspec
import pytest
import zstandard
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.writer import MCAP0_MAGIC, Writer

from lacoc_shared import codec
from lacoc_shared.inputs import Input, JoinSeat, KeySeat
from lacoc_shared.messages import Event, Frame, Scene, SentFile, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files, pack
from lacoc_shared.record.reader import NoMatch, Record
from lacoc_shared.record.schema import BEAT_NS, KINDS, PROFILE, Header, Result, Touch
from lacoc_shared.record.stream import walk_bytes
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import render, say

WriteMatch = Callable[..., Path]
MakeHeader = Callable[..., Header]
MakeFrame = Callable[..., Frame]

DATA_END = re.compile(rb"\x0f\x04\0{7}.{4}", re.DOTALL)
"""The end of the data in a file: opcode, length and a checksum of four bytes."""


def words_of(record: Record) -> str:
    """Return in words why a record could not be read to its end; empty if it could."""
    return render(record.cut) if record.cut else ""


@pytest.fixture(scope="module")
def segment(tmp_path_factory: pytest.TempPathFactory, write_match: WriteMatch) -> Path:
    """Write a match with `write_match`; give the path of its closed segment."""
    return write_match(tmp_path_factory.mktemp("segment"))


@pytest.fixture(scope="module")
def packed(tmp_path_factory: pytest.TempPathFactory, write_match: WriteMatch) -> Path:
    """Write a match with `write_match` and pack it; give the path of the packed file."""
    folder = tmp_path_factory.mktemp("packed")
    pack.pack([write_match(folder)], folder / "m.mcap")
    return folder / "m.mcap"


def test_a_key_of_an_older_record_was_not_held() -> None:
    """A key input without the newer fields, from an older record, gets their default values."""
    older = codec.encode(["key", 0, 14, 1, 2])
    assert codec.decode(older, Input) == KeySeat(0, 14, 1, 2, seen=0, held=0, late=0)  # type: ignore[arg-type]


def test_what_is_written_is_read(
    segment: Path, header: MakeHeader, sheet: Sheet, scene: Scene, result: Result, frame: MakeFrame
) -> None:
    """Everything that is written to a record is read back with its type, beat and order."""
    record = Record.read(segment)
    assert record.headers == [header()]
    assert record.sheets == [(0, sheet)]
    assert record.scenes == [(0, scene)]
    assert record.result == result
    assert [beat for beat, _ in record.frames] == list(range(40))
    assert codec.decode(record.frames[12][1], Frame) == frame(12)
    assert record.inputs[13] == [KeySeat(0, 14, 1, 2), KeySeat(1, 14, 1, 3, held=6)]
    assert [event.beat for event in record.events] == [3, 13, 23, 33]
    assert record.touches[3] == Touch(((1,), ()), (None, (0.1, 0.2, 0.3)))
    assert record.snapshots == [(5, bytes(range(256)) * 4), (25, bytes(range(256)) * 4)]
    assert (record.last_beat, record.cut) == (39, None)


def test_a_segment_is_plain_mcap(segment: Path) -> None:
    """The library `mcap` reads a segment with the same messages, counts and times."""
    with segment.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        messages = list(reader.iter_messages())
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.message_count == len(messages)
    assert {channel.topic for channel in summary.channels.values()} == set(KINDS)
    counted = {
        summary.channels[number].topic: count
        for number, count in summary.statistics.channel_message_counts.items()
    }
    assert (counted["/lacoc/frame"], counted["/lacoc/input"]) == (40, 10)
    frames = [m for _, channel, m in messages if channel.topic == "/lacoc/frame"]
    assert [m.log_time for m in frames] == [beat * BEAT_NS for beat in range(40)]
    assert [m.sequence for m in frames] == list(range(40))


@given(share=st.floats(0, 1))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_segment_cut_anywhere_gives_every_whole_message(
    tmp_path: Path, segment: Path, share: float
) -> None:
    """From a segment that is cut anywhere, every whole message is read, and the cut is reported."""
    data = segment.read_bytes()
    cut = data[: round(share * len(data))]
    path = tmp_path / "m.000.live.mcap"
    path.write_bytes(cut)
    whole = _messages(cut)
    if not whole:
        with pytest.raises(UserError, match="there is no match in it"):
            Record.read(path)
        return
    record = Record.read(path)
    assert [data for _, data in record.frames] == whole.get("/lacoc/frame", [])
    assert [codec.encode(i) for items in record.inputs.values() for i in items] == whole.get(
        "/lacoc/input", []
    )
    assert [codec.encode(event) for event in record.events] == whole.get("/lacoc/event", [])
    assert [codec.encode(touch) for touch in record.touches.values()] == whole.get(
        "/lacoc/touch", []
    )
    assert [data for _, data in record.snapshots] == whole.get("/lacoc/snapshot", [])
    assert (record.result is not None) == ("/lacoc/result" in whole)
    assert ("has no end:" in words_of(record)) == (DATA_END.search(cut) is None)


@pytest.mark.parametrize("step", [53, pytest.param(7, marks=pytest.mark.long)])
def test_a_packed_file_cut_anywhere_is_read_or_refused(
    tmp_path: Path, packed: Path, step: int
) -> None:
    """A packed file that is cut anywhere is read or refused with a UserError."""
    data = packed.read_bytes()
    path = tmp_path / "m.mcap"
    for size in range(0, len(data), step):
        path.write_bytes(data[:size])
        try:
            record = Record.read(path)
        except UserError:
            continue
        assert len(record.frames) in (0, 40)
        assert record.frames or record.cut


@given(place=st.floats(0, 1, exclude_max=True), byte=st.integers(0, 255), closed=st.booleans())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_wrong_byte_anywhere_is_read_or_refused(
    tmp_path: Path, segment: Path, packed: Path, place: float, byte: int, closed: bool
) -> None:
    """A record with a wrong byte anywhere is read or refused with a UserError."""
    data = bytearray((packed if closed else segment).read_bytes())
    data[int(place * len(data))] = byte
    path = tmp_path / "m.mcap"
    path.write_bytes(data)
    with suppress(UserError):
        Record.read(path)


def test_a_damaged_closed_file_says_so(tmp_path: Path, segment: Path) -> None:
    """A damaged segment is read up to the damage, is reported as damaged, and can't be packed."""
    data = bytearray(segment.read_bytes())
    at = data.index(codec.encode(KeySeat(0, 24, 1, 2)))  # the input of beat 23
    data[at] ^= 0xFF
    path = tmp_path / "m.000.live.mcap"
    path.write_bytes(data)
    record = Record.read(path)
    assert [beat for beat, _ in record.frames] == list(range(23))
    assert "stops after beat 22, and is damaged at byte" in words_of(record)
    assert record.lost
    assert "Copy it again" in words_of(record)
    with pytest.raises(UserError, match=r"not packed, and its segments are kept.*beat 22"):
        pack.pack([path], tmp_path / "m.mcap")
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == data


def test_a_missing_segment_is_told(
    tmp_path: Path, write_match: WriteMatch, header: MakeHeader, frame: MakeFrame
) -> None:
    """If a segment is missing, the part before it is read, and the missing beats are reported."""
    write_match(tmp_path, close=False)
    late = RecordWriter(tmp_path, header(segment=2, first_beat=60))
    late.frame(60, codec.encode(frame(60)))
    late.close()
    record = Record.read(late.path)
    assert [beat for beat, _ in record.frames] == list(range(40))
    assert "stops after beat 39, and has no end:" in words_of(record)
    assert f"Beats 40 to 59 are missing before {late.path}" in words_of(record)
    with pytest.raises(UserError, match="Beats 40 to 59 are missing"):
        pack.pack(files.segment_paths(tmp_path, "m"), tmp_path / "m.mcap")
    assert len(files.segment_paths(tmp_path, "m")) == 2


@pytest.mark.parametrize("size", [0, 8, 100])
def test_a_segment_without_a_header_holds_nothing(
    size: int, tmp_path: Path, write_match: WriteMatch, header: MakeHeader, frame: MakeFrame
) -> None:
    """A segment without a whole header is skipped, and the match goes on in the next segment."""
    first = write_match(tmp_path, close=False)
    empty = tmp_path / "m.001.live.mcap"
    empty.write_bytes(first.read_bytes()[:size])
    assert Record.read(empty) == Record.read([first])
    third = RecordWriter(tmp_path, header(segment=2, first_beat=40))
    third.frame(40, codec.encode(frame(40)))
    third.close()
    record = Record.read(third.path)
    assert [beat for beat, _ in record.frames] == list(range(41))
    assert record.cut is None
    pack.pack(files.segment_paths(tmp_path, "m"), tmp_path / "m.mcap")
    assert Record.read(tmp_path / "m.mcap") == record


def test_an_unfinished_segment_ends_where_it_stops_making_sense(
    tmp_path: Path, write_match: WriteMatch, header: MakeHeader, frame: MakeFrame
) -> None:
    """A segment with zeros in it, as after a power cut, is read up to the first of them."""
    path = write_match(tmp_path, close=False)
    with path.open("ab") as file:
        file.write(bytes(4096))
    assert len(Record.read(path).frames) == 40
    data = path.read_bytes()
    start = data.rindex(codec.encode(frame(38, markers=b"\x16")))
    path.write_bytes(data[:start] + bytes(100) + data[start + 100 :])
    before = Record.read(path)
    assert [beat for beat, _ in before.frames] == list(range(38))
    assert "stops after beat 37, and is damaged at byte" in words_of(before)
    assert re.search(r"its last 4\d\d\d bytes can't be read", words_of(before))
    with_next = RecordWriter(tmp_path, header(segment=1, first_beat=38))
    with_next.frame(38, codec.encode(frame(38)))
    with_next.close()
    segments = files.segment_paths(tmp_path, "m")
    expected = Record.read(segments)
    pack.pack(segments, tmp_path / "m.mcap")
    assert Record.read(tmp_path / "m.mcap") == expected
    assert [beat for beat, _ in expected.frames] == list(range(39))


_VICTIM = """
import os, sys
from pathlib import Path
import msgspec
from lacoc_shared import codec
from lacoc_shared.messages import Frame
from lacoc_shared.record.schema import Header
from lacoc_shared.record.stream import walk_bytes
from lacoc_shared.record.writer import RecordWriter

header = msgspec.json.decode(sys.argv[2], type=Header)
frame = msgspec.json.decode(sys.argv[3], type=Frame)
writer = RecordWriter(Path(sys.argv[1]), header)
for beat in range(10**9):
    writer.frame(beat, codec.encode(msgspec.structs.replace(frame, beat=beat)))
    os.write(1, b"%d\\n" % beat)
"""


def test_kill_9_loses_nothing_that_was_answered(
    tmp_path: Path, header: MakeHeader, frame: MakeFrame
) -> None:
    """Each beat that a process reported before it was killed is in its record."""
    victim = subprocess.Popen(
        [
            sys.executable,
            "-c",
            _VICTIM,
            str(tmp_path),
            msgspec.json.encode(header()),
            msgspec.json.encode(frame(0)),
        ],
        stdout=subprocess.PIPE,
    )
    assert victim.stdout is not None
    while victim.stdout.readline() != b"500\n":
        assert victim.poll() is None
    victim.send_signal(signal.SIGKILL)
    told = [int(line) for line in victim.stdout.read().split(b"\n")[:-1]]
    victim.wait()
    record = Record.read(tmp_path / "m.000.live.mcap")
    beats = [beat for beat, _ in record.frames]
    assert beats == list(range(len(beats)))
    assert beats[-1] >= max([500, *told])
    assert record.cut


def test_a_restarted_court_goes_on_in_a_new_segment(
    tmp_path: Path, write_match: WriteMatch, header: MakeHeader, frame: MakeFrame
) -> None:
    """From a new segment's first beat on, its messages replace those of the older segment."""
    write_match(tmp_path, close=False)
    second = RecordWriter(tmp_path, header(segment=1, first_beat=33))
    second.input(33, KeySeat(1, 99, 1, 0))
    second.frame(33, codec.encode(frame(33)))
    second.close()
    record = Record.read(tmp_path / "m.001.live.mcap")
    assert [header.segment for header in record.headers] == [0, 1]
    assert [beat for beat, _ in record.frames] == list(range(34))
    assert record.inputs[33] == [KeySeat(1, 99, 1, 0)]
    assert 39 not in record.inputs
    assert [event.beat for event in record.events] == [3, 13, 23]
    assert list(record.touches) == [3, 13, 23]
    assert (record.last_beat, record.cut) == (33, None)
    pack.pack(files.segment_paths(tmp_path, "m"), tmp_path / "m.mcap")
    assert Record.read(tmp_path / "m.mcap") == record


def test_files_that_are_no_record_of_one_match_are_refused(
    tmp_path: Path, write_match: WriteMatch, header: MakeHeader
) -> None:
    """Files that are not one match's record are refused; the message says what is wrong."""
    table = tmp_path / "table.txt"
    table.write_text("1\t2\n")
    empty, begun = tmp_path / "empty.mcap", tmp_path / "begun.mcap"
    empty.touch()
    begun.write_bytes(MCAP0_MAGIC)
    foreign = tmp_path / "foreign.mcap"
    with foreign.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        writer.finish()
    newer = RecordWriter(tmp_path, msgspec.structs.replace(header(match_id="newer"), format=7))
    newer.close()
    late = RecordWriter(tmp_path, header(segment=1, match_id="late", first_beat=5))
    late.close()
    mine = write_match(tmp_path)
    for paths, sentence in (
        (tmp_path / "none.mcap", "There is no record"),
        (tmp_path, "is a folder. Give the path of one"),
        (table, "it is not an MCAP file"),
        (empty, r"empty.mcap is empty \(0 bytes\), so there is no match in it"),
        (begun, "begun.mcap has 8 bytes, but not the whole header"),
        ([empty, begun], "There is no match in the files .*empty.mcap, .*begun.mcap"),
        (foreign, "but not a LACOC record"),
        (newer.path, "has format 7, and this software reads format 1"),
        (late.path, "the segments before it are missing"),
        ([mine, late.path], "belongs to match late"),
        ([mine, mine], "given after segment 0"),
        ([], "give at least one record file"),
    ):
        with pytest.raises(UserError, match=sentence):
            Record.read(paths)


def test_a_record_is_never_overwritten(tmp_path: Path, header: MakeHeader) -> None:
    """A second record of the same match is refused, and so is a folder that can't be made."""
    RecordWriter(tmp_path, header()).close()
    with pytest.raises(UserError, match="never overwritten"):
        RecordWriter(tmp_path, header())
    (tmp_path / "file").touch()
    with pytest.raises(UserError, match="No record can be written to"):
        RecordWriter(tmp_path / "file", header())


def test_a_full_disk_loses_nothing(tmp_path: Path, header: MakeHeader, frame: MakeFrame) -> None:
    """Data that a full disk refuses waits in memory, and is written when there is room."""
    resource = pytest.importorskip("resource")
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    writer = RecordWriter(tmp_path, header())
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (5000, unlimited[1]))
        for beat in range(100):
            writer.frame(beat, codec.encode(frame(beat)))
        with pytest.raises(UserError, match=r"can't be written: File too large\. Make room"):
            writer.flush()
        assert writer.path.stat().st_size == 5000
        resource.setrlimit(resource.RLIMIT_FSIZE, (6000, unlimited[1]))
        with pytest.raises(UserError, match="can't be written"):
            writer.flush()
        assert writer.path.stat().st_size == 6000
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, unlimited[1]))
        with pytest.raises(UserError, match=r"No record can be written to .*File too large"):
            RecordWriter(tmp_path / "next", header(match_id="next"))
        assert list((tmp_path / "next").iterdir()) == []
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
    writer.frame(100, codec.encode(frame(100)))
    writer.flush()
    writer.close()
    record = Record.read(writer.path)
    assert [beat for beat, _ in record.frames] == list(range(101))
    assert record.cut is None


def test_a_match_that_ends_on_a_full_disk_has_its_end(
    tmp_path: Path, header: MakeHeader, frame: MakeFrame, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If there is room a moment later, the record's end is written, not lost."""
    resource = pytest.importorskip("resource")
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    writer = RecordWriter(tmp_path, header())
    writer.frame(0, codec.encode(frame(0)))

    def make_room(_: float) -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)

    monkeypatch.setattr("lacoc_shared.record.writer.time.sleep", make_room)
    try:
        full = writer.path.stat().st_size
        resource.setrlimit(resource.RLIMIT_FSIZE, (full, unlimited[1]))
        writer.close()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
    assert Record.read(writer.path).cut is None


def test_a_disk_that_reports_errors_later_is_heard(
    tmp_path: Path, header: MakeHeader, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An error that the disk reports at `fsync` is kept in the writer's `sync_trouble`."""
    writer = RecordWriter(tmp_path, header())
    asked = threading.Event()

    def refuse(descriptor: int) -> None:
        asked.set()
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(os, "fsync", refuse)
    writer.frame(0, b"")
    writer.close()
    assert asked.is_set()
    assert writer.sync_trouble is not None
    assert writer.sync_trouble.values["why"] == "Input/output error"


def test_closing_twice_is_once(tmp_path: Path, header: MakeHeader) -> None:
    """A record that is closed a second time does not change."""
    writer = RecordWriter(tmp_path, header())
    writer.close()
    data = writer.path.read_bytes()
    writer.close()
    assert writer.path.read_bytes() == data


def _messages(data: bytes) -> dict[str, list[bytes]]:
    """Map each topic to its whole messages in a cut file, found only by the lengths in the file."""
    topics = list(KINDS)
    found: dict[str, list[bytes]] = {}
    at = 8
    while at + 9 <= len(data):
        length = int.from_bytes(data[at + 1 : at + 9], "little")
        if at + 9 + length > len(data):
            break
        if data[at] == 5:
            channel = int.from_bytes(data[at + 9 : at + 11], "little")
            found.setdefault(topics[channel - 1], []).append(data[at + 31 : at + 9 + length])
        at += 9 + length
    return found


def test_a_bomb_is_no_record(segment: Path, tmp_path: Path) -> None:
    """A chunk that unpacks to far more bytes than a match can have is refused as damaged."""
    packed = zstandard.ZstdCompressor().compress(bytes(1 << 28))
    for told in (1 << 28, 100):
        body = struct.pack("<QQQII", 0, 0, told, 0, 4) + b"zstd"
        body += struct.pack("<Q", len(packed)) + packed
        path = tmp_path / "m.mcap"
        data = segment.read_bytes()
        path.write_bytes(data[:8] + struct.pack("<BQ", 6, len(body)) + body + data[-8:])
        with pytest.raises(
            UserError, match=r"Nothing can be read of the match: .*damaged at byte 8"
        ):
            Record.read(path)


@pytest.mark.parametrize("chunked", [False, True])
def test_a_message_without_a_whole_head_is_damage(
    segment: Path, tmp_path: Path, chunked: bool
) -> None:
    """What follows such a message is never taken for its head, and of its chunk nothing is read."""
    data = segment.read_bytes()
    messages = [at for at, opcode in _records_of(data) if opcode == Opcode.MESSAGE]
    first, second, third = messages[:3]
    short = struct.pack("<BQ", Opcode.MESSAGE, 10) + data[first + 9 : first + 19]
    hit = data[first:second] + short + data[second:third]
    if chunked:
        body = struct.pack("<QQQIIQ", 0, 0, len(hit), 0, 0, len(hit)) + hit
        hit = struct.pack("<BQ", Opcode.CHUNK, len(body)) + body
    path = tmp_path / "m.mcap"
    path.write_bytes(data[:first] + hit + data[third:])
    taken: list[tuple[str, int, bytes]] = []
    stop = walk_bytes(path, lambda *message: taken.append(message))
    assert stop is not None
    assert stop.damaged
    assert len(taken) == (0 if chunked else 1)


def _event(number: int, data: dict[str, object]) -> Event:
    said = say("event.flip", team="Bees", marker="c1r1", also=("c1r2", "c1r3"))
    return Event(
        number=number, match=1, beat=number, clock_ticks=0, kind="flip", said=said, data=data
    )


@pytest.mark.long
def test_values_are_counted_before_they_are_made(header: MakeHeader, tmp_path: Path) -> None:
    """A small packed record of 30 million empty maps takes little memory to read, and says why.

    As many real events as a match has in an hour are read.
    """
    writer = RecordWriter(tmp_path, header())
    writer.snapshot(0, os.urandom(700_000))  # so large a file may unpack to 39 MB
    for _ in range(5):
        writer.event(_event(1, {"a": [{}] * 6_000_000}))
    writer.close()
    packed = tmp_path / "m.mcap"
    with packed.open("wb") as file:
        again = Writer(file)
        again.start(PROFILE)
        numbers = {topic: again.register_channel(topic, "msgpack", 0) for topic in KINDS}
        walk_bytes(
            writer.path,
            lambda topic, beat, data: again.add_message(
                numbers[topic], beat * BEAT_NS, data, beat * BEAT_NS
            ),
        )
        again.finish()
    assert packed.stat().st_size < 1_000_000
    tracemalloc.start()
    try:
        record = Record.read(packed)
    finally:
        _, peak_bytes = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert record.events == []
    assert record.cut is not None
    assert record.lost
    assert "it has more values than a match" in words_of(record)
    assert peak_bytes < 200e6

    writer = RecordWriter(tmp_path / "usual", header())
    for number in range(1, 30_001):
        data = {"marker": "c1r1", "also": ["c1r2", "c1r3"], "points": 3}
        writer.event(_event(number, data))
    writer.close()
    pack.pack([writer.path], tmp_path / "usual.mcap")
    assert len(Record.read(tmp_path / "usual.mcap").events) == 30_000


def test_names_in_a_record_have_a_limit(
    header: MakeHeader, sheet: Sheet, result: Result, tmp_path: Path
) -> None:
    """A record with a team's name of 200,000 signs is read up to it, and called damaged."""
    long = "o" + "\u0301" * 200_000
    seats = (msgspec.structs.replace(sheet.seats[0], team=long), *sheet.seats[1:])
    joined = JoinSeat(0, long, SentFile("a", b""), None, None, token_hash="")
    for number, write in enumerate(
        (
            lambda one: one.sheet(3, msgspec.structs.replace(sheet, seats=seats)),
            lambda one: one.input(3, joined),
            lambda one: one.result(msgspec.structs.replace(result, teams=(long, "Bees"))),
        )
    ):
        writer = RecordWriter(tmp_path / str(number), header())
        writer.input(1, KeySeat(0, 1, 1, 2))
        write(writer)
        writer.close()
        record = Record.read(writer.path)
        assert len(record.inputs) == 1
        assert "a team's name is too long" in words_of(record)


def test_many_inputs_in_a_beat_are_read_in_linear_time(header: MakeHeader, tmp_path: Path) -> None:
    """A record with 20,000 inputs in one beat is read within two seconds of CPU time."""
    writer = RecordWriter(tmp_path, header())
    for seq in range(20_000):
        writer.input(3, KeySeat(0, seq, 1, 2))
    writer.close()
    begin_s = time.process_time()
    assert len(Record.read(writer.path).inputs[3]) == 20_000
    assert time.process_time() - begin_s < 2


def test_a_damaged_time_ends_what_is_read(
    header: MakeHeader, frame: MakeFrame, tmp_path: Path
) -> None:
    """A frame whose time is far in the future counts as damage, and the part before it is read."""
    writer = RecordWriter(tmp_path, header())
    for beat in (0, 1, 2**36 // BEATS_PER_S):
        writer.frame(beat, codec.encode(frame(0)))
    record = Record.read(writer.path)
    assert record.last_beat == 1
    assert "stops after beat 1, and is damaged at byte" in words_of(record)
    writer.close()
    record = Record.read(writer.path)
    assert record.last_beat == 1
    assert "stops after beat 1, and is damaged at byte" in words_of(record)


def test_many_gaps_end_what_is_read(header: MakeHeader, tmp_path: Path) -> None:
    """A few messages can't claim that days have passed: no program would count to their end."""
    writer = RecordWriter(tmp_path, header())
    for minutes in range(0, 24 * 60, 10):
        writer.input(minutes * 60 * BEATS_PER_S, KeySeat(0, minutes + 1, 1, 2))
    writer.close()
    record = Record.read(writer.path)
    assert record.last_beat == 3600 * BEATS_PER_S
    assert "is damaged at byte" in words_of(record)


def test_a_header_stands_where_its_segment_begins(header: MakeHeader, tmp_path: Path) -> None:
    """Else the time of a header alone could claim years."""
    late = RecordWriter(tmp_path, header(first_beat=2_000_000_000))
    late.close()
    there, other = (codec.encode(header(first_beat=n * 1_000_000_000)) for n in (2, 1))
    late.path.write_bytes(late.path.read_bytes().replace(there, other))
    with pytest.raises(NoMatch, match="a header of beat 1000000000 in beat 2000000000"):
        Record.read(late.path)


@pytest.mark.parametrize(
    ("topic", "beat"),
    [("frame", 5), ("snapshot", 5), ("sheet", 5), ("scene", 5), ("touch", 5), ("input", 4)],
)
def test_what_no_court_writes_ends_what_is_read(
    topic: str,
    beat: int,
    header: MakeHeader,
    frame: MakeFrame,
    sheet: Sheet,
    scene: Scene,
    tmp_path: Path,
) -> None:
    """A second message of a kind in one beat, or one of an earlier beat, counts as damage.

    Else a forged record could have a sheet that is proven, and another that is read.
    """
    writes: dict[str, Callable[[RecordWriter], None]] = {
        "frame": lambda writer: writer.frame(5, codec.encode(frame(5))),
        "snapshot": lambda writer: writer.snapshot(5, b"state"),
        "sheet": lambda writer: writer.sheet(5, sheet),
        "scene": lambda writer: writer.scene(5, scene),
        "touch": lambda writer: writer.touch(5, Touch(((), ()), (None, None))),
    }
    writer = RecordWriter(tmp_path, header())
    for write in writes.values():
        write(writer)
    writer.input(5, KeySeat(0, 1, 1, 2))
    writer.input(5, KeySeat(0, 2, 1, 3))
    if topic == "input":
        writer.input(beat, KeySeat(0, 3, 1, 2))
    else:
        writes[topic](writer)
    writer.input(6, KeySeat(0, 4, 1, 2))
    writer.close()
    record = Record.read(writer.path)
    assert list(record.inputs) == [5]
    assert record.lost
    assert "stops after beat 5, and is damaged at byte" in words_of(record)
    why = f"beat {beat} after beat 5" if topic == "input" else f"a second {topic} of beat 5"
    assert why in words_of(record)


@pytest.mark.parametrize("part", [0.0, 0.4, 0.8])
def test_a_damaged_packed_file_says_where(part: float, tmp_path: Path, packed: Path) -> None:
    """A damaged packed file is read up to the damaged chunk; the message has the chunk's offset.

    If the first chunk is damaged, the file is refused.
    """
    data = bytearray(packed.read_bytes())
    chunks = [at for at, opcode in _records_of(data) if opcode == Opcode.CHUNK]
    at = chunks[int(part * len(chunks))]
    data[at + 100] ^= 1
    path = tmp_path / "damaged.mcap"
    path.write_bytes(data)
    words = f"is damaged at byte {at} of {len(data)} "
    if at == chunks[0]:
        with pytest.raises(NoMatch, match=f"Nothing can be read of the match: .*{words}"):
            Record.read(path)
        return
    record = Record.read(path)
    assert record.lost
    assert words in words_of(record)


def test_damage_beside_the_chunks_is_told(tmp_path: Path, packed: Path) -> None:
    """Damage in a packed file's index or footer is a flaw: the whole match is read, and not cut."""
    whole = packed.read_bytes()
    places = {opcode: at for at, opcode in _records_of(whole)}
    path = tmp_path / "m.mcap"
    for opcode in (Opcode.MESSAGE_INDEX, Opcode.STATISTICS, Opcode.CHUNK_INDEX, Opcode.FOOTER):
        data = bytearray(whole)
        data[places[opcode] + 20] ^= 1
        path.write_bytes(data)
        record = Record.read(path)
        assert (record.lost, record.cut) == (False, None), opcode
        assert record.flaw is not None
        assert "has a damaged index. Nothing of the match is lost" in render(record.flaw)
        assert len(record.frames) == 40
    path.write_bytes(whole[:-1])
    assert (Record.read(path).lost, Record.read(path).flaw is not None) == (False, True)


def test_damage_that_hides_a_chunk_is_told(
    tmp_path: Path, write_match: WriteMatch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If damage makes a chunk look like something else, the record says that messages are lost.

    It says so too if the number of messages can't be read, because the index is damaged as well.
    """
    monkeypatch.setattr("lacoc_shared.record.packed.CHUNK_BYTES", 1000)
    path = tmp_path / "m.mcap"
    pack.pack([write_match(tmp_path)], path)
    whole = path.read_bytes()
    places = {opcode: at for at, opcode in _records_of(whole)}
    chunks = [at for at, opcode in _records_of(whole) if opcode == Opcode.CHUNK]
    for places_hit in ([chunks[-1]], [chunks[-1], places[Opcode.STATISTICS] + 20]):
        data = bytearray(whole)
        for at in places_hit:
            data[at] ^= 0x40
        path.write_bytes(data)
        record = Record.read(path)
        assert record.lost
        assert "is damaged between its messages, and some of them are lost" in words_of(record)


def test_a_packed_file_that_was_not_copied_whole_is_lost(tmp_path: Path, packed: Path) -> None:
    """The first half of a packed file can't be read, and the message names the possible causes."""
    path = tmp_path / "part.mcap"
    data = packed.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(NoMatch, match="ends too early: it was not copied completely"):
        Record.read(path)


def test_what_a_killed_court_leaves_is_not_lost(tmp_path: Path, segment: Path) -> None:
    """A segment that ends in the middle, as after a kill, is reported as cut but not as lost."""
    path = tmp_path / "m.000.live.mcap"
    data = segment.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    record = Record.read(path)
    assert record.cut
    assert not record.lost


def _records_of(data: bytes) -> Iterator[tuple[int, int]]:
    """Yield the offset and the opcode of each record in an MCAP file."""
    at = len(MCAP0_MAGIC)
    while at < len(data) - len(MCAP0_MAGIC):
        yield at, data[at]
        at += 9 + int.from_bytes(data[at + 1 : at + 9], "little")
