"""Packing joins segments into one file, and removes them only if this has all their messages."""

import random
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from mcap.reader import make_reader
from waiting import LIMIT_S

from lacoc_shared import codec
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files, pack
from lacoc_shared.record.packed import Message, PackedFile, PackedWriter
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Header
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import BEATS_PER_S

WriteMatch = Callable[..., Path]
WriteSegments = Callable[[Path], list[Path]]


@pytest.fixture
def write_segments(
    write_match: WriteMatch, header: Callable[..., Header], frame: Callable[..., Frame]
) -> WriteSegments:
    """Give a function that writes two segments of a match whose court was killed after 40 beats."""

    def write(folder: Path) -> list[Path]:
        first = write_match(folder, close=False)
        second = RecordWriter(folder, header(segment=1, first_beat=40))
        second.frame(40, codec.encode(frame(40)))
        second.close()
        return [first, second.path]

    return write


def test_packing_gives_the_same_record(tmp_path: Path, write_match: WriteMatch) -> None:
    """A packed file has the same record, indexed and compressed, and its segments are removed."""
    path = write_match(tmp_path)
    size, record = path.stat().st_size, Record.read(path)
    pack.pack([path], tmp_path / "m.mcap")
    assert [p.name for p in tmp_path.iterdir()] == ["m.mcap"]
    assert Record.read(tmp_path / "m.mcap") == record
    assert (tmp_path / "m.mcap").stat().st_size < size / 2
    with (tmp_path / "m.mcap").open("rb") as file:
        summary = make_reader(file, validate_crcs=True).get_summary()
    assert summary is not None
    assert summary.chunk_indexes[0].compression == "zstd"


def test_a_match_can_be_written_packed_at_once(tmp_path: Path, write_match: WriteMatch) -> None:
    """The file is the one that packing would make, and is there only when the match has ended."""
    pack.pack([write_match(tmp_path / "live")], tmp_path / "live/m.mcap")
    folder = tmp_path / "alone"
    path = write_match(folder, close=False, recorder=PackedWriter)
    assert [*folder.iterdir()] == []
    assert write_match(folder, recorder=PackedWriter) == path == folder / "m.mcap"
    assert [*folder.iterdir()] == [path]
    assert path.read_bytes() == (tmp_path / "live/m.mcap").read_bytes()
    with pytest.raises(UserError, match=r"m\.mcap exists already"):
        write_match(folder, recorder=PackedWriter)


def test_two_processes_write_no_file_together(
    tmp_path: Path, header: Callable[..., Header]
) -> None:
    """A packed file is locked while it is written; what a killed process left is overwritten."""
    (tmp_path / "m.mcap.part").write_bytes(b"half of a match" * 1000)
    writer = PackedWriter(tmp_path, header())
    with pytest.raises(UserError, match=r"m\.mcap\.part is being written"):
        PackedWriter(tmp_path, header())
    writer.close()
    writer.close()
    assert [*tmp_path.iterdir()] == [writer.path]
    assert Record.read(writer.path).header == header()


def test_a_full_disk_ends_a_match_that_is_written_packed(
    tmp_path: Path, header: Callable[..., Header]
) -> None:
    """The message names the file and the reason, and nothing is left on the disk."""
    resource = pytest.importorskip("resource")
    writer = PackedWriter(tmp_path, header())
    for beat in range(100):
        writer.snapshot(beat, random.Random(beat).randbytes(5000))
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, unlimited[1]))
        with pytest.raises(UserError, match=r"m\.mcap can't be written: File too large"):
            writer.close()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
    assert [*tmp_path.iterdir()] == []


def test_damage_loses_only_some_seconds_before_it(
    tmp_path: Path, header: Callable[..., Header]
) -> None:
    """A packed match of a minute can be read at least up to some seconds before a damaged byte."""
    chance = random.Random(1)
    writer = RecordWriter(tmp_path, header())
    beats = 60 * BEATS_PER_S
    for beat in range(beats):
        writer.snapshot(beat, chance.randbytes(320))  # as many bytes as a frame
    writer.close()
    pack.pack([writer.path], tmp_path / "m.mcap")
    with (tmp_path / "m.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunks = summary.chunk_indexes
    data = bytearray((tmp_path / "m.mcap").read_bytes())
    data[chunks[round(0.7 * len(chunks))].chunk_start_offset + 100] ^= 1
    (tmp_path / "m.mcap").write_bytes(data)
    record = Record.read(tmp_path / "m.mcap")
    assert record.lost
    assert 0.5 * beats < record.last_beat < 0.75 * beats


def test_packing_that_was_interrupted_is_repeated(
    tmp_path: Path, write_segments: WriteSegments
) -> None:
    """After a kill, packing can be repeated, whether a half-written file or a segment is left."""
    first, second = write_segments(tmp_path)
    record, data = Record.read(first), second.read_bytes()
    (tmp_path / "m.mcap.part").write_bytes(b"half")
    pack.pack([first, second], tmp_path / "m.mcap")
    second.write_bytes(data)
    pack.pack([second], tmp_path / "m.mcap")
    assert Record.read(tmp_path / "m.mcap") == record
    assert [p.name for p in tmp_path.iterdir()] == ["m.mcap"]


def test_packing_that_fails_keeps_the_segments(tmp_path: Path, write_match: WriteMatch) -> None:
    """If the disk is full, packing leaves the segments and no half-written file."""
    resource = pytest.importorskip("resource")
    path = write_match(tmp_path)
    data = path.read_bytes()
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, unlimited[1]))
        with pytest.raises(UserError, match=r"can't be packed: File too large\. Its segments"):
            pack.pack([path], tmp_path / "m.mcap")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == data


@pytest.mark.slow
def test_packing_in_the_background(tmp_path: Path, write_match: WriteMatch) -> None:
    """A court packs in another process, which prints an error for a match without segments."""
    record = Record.read(write_match(tmp_path))
    assert pack.pack_in_background(tmp_path, ["m"]).wait(LIMIT_S) == 0
    assert Record.read(tmp_path / "m.mcap") == record
    again = subprocess.run(
        [sys.executable, "-m", "lacoc_shared.record.pack", str(tmp_path), "m"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert again.returncode == 2
    assert again.stderr == f"There are no segments of match m in {tmp_path}.\n"


def test_segments_that_the_packed_file_lacks_are_kept(
    tmp_path: Path, write_match: WriteMatch, write_segments: WriteSegments
) -> None:
    """If a packed file lacks a message of the segments, all files are kept."""
    pack.pack([write_match(tmp_path)], tmp_path / "m.mcap")
    segments = write_segments(tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    for some in (segments, segments[1:]):
        with pytest.raises(UserError, match=r"m\.mcap and the segments.*all of them are kept"):
            pack.pack(some, tmp_path / "m.mcap")
        assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize("victim", ["m.mcap", "m.000.live.mcap"])
def test_damage_beside_a_packed_file_removes_nothing(
    victim: str, tmp_path: Path, write_match: WriteMatch
) -> None:
    """Packing again removes no file if the packed file or its source segment is damaged."""
    path = write_match(tmp_path)
    data = path.read_bytes()
    pack.pack([path], tmp_path / "m.mcap")
    path.write_bytes(data)
    damaged = bytearray((tmp_path / victim).read_bytes())
    damaged[len(damaged) // 2] ^= 1
    (tmp_path / victim).write_bytes(damaged)
    with pytest.raises(UserError, match="all of them are kept"):
        pack.pack([path], tmp_path / "m.mcap")
    assert {found.name for found in tmp_path.iterdir()} == {"m.mcap", "m.000.live.mcap"}


def test_what_is_packed_is_held(
    tmp_path: Path, write_segments: WriteSegments, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While segments are being packed they are locked, and no other process can pack them."""
    segments = write_segments(tmp_path)
    held: list[bool] = []
    add_all = PackedFile.add_all

    def watched(file: PackedFile, messages: Sequence[Message]) -> None:
        held.extend(map(files.is_held, segments))
        with pytest.raises(UserError, match="being written or packed by another process"):
            pack.pack(segments, tmp_path / "m.mcap")
        add_all(file, messages)

    monkeypatch.setattr(PackedFile, "add_all", watched)
    pack.pack(segments, tmp_path / "m.mcap")
    assert held == [True, True]
    assert [path.name for path in tmp_path.iterdir()] == ["m.mcap"]


def test_what_is_being_written_is_not_packed(
    tmp_path: Path, write_match: WriteMatch, header: Callable[..., Header]
) -> None:
    """While a court writes a match, its segments can't be packed."""
    write_match(tmp_path, close=False)
    writer = RecordWriter(tmp_path, header(segment=1, first_beat=40))
    segments = files.segment_paths(tmp_path, "m")
    with pytest.raises(UserError, match=r"m\.001\.live\.mcap is being written or packed"):
        pack.pack(segments, tmp_path / "m.mcap")
    writer.close()
    assert sorted(tmp_path.iterdir()) == segments


def test_one_match_that_can_not_be_packed_stops_no_other(
    tmp_path: Path, header: Callable[..., Header], capsys: pytest.CaptureFixture[str]
) -> None:
    """If one of several matches can't be packed, the others are, and the exit code is 2."""
    for match_id in ("a", "b"):
        RecordWriter(tmp_path, header(match_id=match_id)).close()
    assert pack.main(str(tmp_path), "a", "none", "b") == 2
    assert capsys.readouterr().err == f"There are no segments of match none in {tmp_path}.\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mcap", "b.mcap"]
