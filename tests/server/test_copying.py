"""Tests of the parts in which a court's records reach the office."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.contest.kept.copying import continues
from lacoc_server.court.copying import next_part
from lacoc_shared.keyspace import COPY_PART_BYTES
from lacoc_shared.messages.office import Copied
from lacoc_shared.record.files import packed_path, segment_path

MATCH = "20260501-100000-blue-002"


@given(
    st.lists(st.lists(st.integers(0, 2 * COPY_PART_BYTES), max_size=4), min_size=1, max_size=3),
    st.binary(min_size=1, max_size=9),
    st.data(),
)
def test_parts_make_the_files(grown: list[list[int]], pattern: bytes, data: st.DataObject) -> None:
    """However segments grow between two questions, the parts put together are the segments.

    Args:
        grown: for each segment, by how many bytes it grows each time.
        pattern: what the segments are filled with, again and again.
        data: decides how often the office asks before a segment grows.
    """
    with TemporaryDirectory() as folder:
        copies: dict[str, bytes] = {}

        def ask() -> bool:
            have = {name: len(copy) for name, copy in copies.items()}
            part = next_part(Path(folder), MATCH, have)
            assert len(part.data) <= COPY_PART_BYTES
            if part.file:
                assert part.offset == have.get(part.file, 0)
                assert continues(MATCH, have, part)
                copies[part.file] = copies.get(part.file, b"") + part.data
            return bool(part.file)

        for number, growths in enumerate(grown):
            path = segment_path(Path(folder), MATCH, number)
            path.touch()
            for growth in growths:
                with path.open("ab") as file:
                    file.write((pattern * growth)[:growth])
                for _ in range(data.draw(st.integers(0, 3))):
                    ask()
        while ask():
            pass
        written = {path.name: path.read_bytes() for path in Path(folder).iterdir()}
        assert copies == {name: content for name, content in written.items() if content}
        assert not next_part(Path(folder), MATCH, {}).is_whole


def test_a_packed_record_is_whole(tmp_path: Path) -> None:
    """As soon as a record is packed, only the packed file counts."""
    packed = packed_path(tmp_path, MATCH)
    packed.write_bytes(b"packed")
    segment_path(tmp_path, MATCH, 0).write_bytes(b"a segment that will be removed")
    assert next_part(tmp_path, MATCH, {}).data == b"packed"
    assert next_part(tmp_path, MATCH, {packed.name: 6}) == Copied(is_whole=True)


@pytest.mark.parametrize(
    ("file", "offset"),
    [
        ("20260501-100000-blue-002.000.live.mcap", 4),
        ("20260501-100000-blue-003.000.live.mcap", 0),
        ("20260501-100000-blue-003.mcap", 0),
        ("../20260501-100000-blue-002.mcap", 0),
        ("../20260501-100000-blue-002.000.live.mcap", 0),
        ("/tmp/20260501-100000-blue-002.mcap", 0),
        ("contest.toml", 0),
        ("", 0),
    ],
)
def test_what_does_not_continue_the_record_is_not_written(file: str, offset: int) -> None:
    """A part of another record, of another file, from another folder, or with a gap is dropped."""
    have = {"20260501-100000-blue-002.000.live.mcap": 3}
    assert not continues(MATCH, have, Copied(file=file, offset=offset, data=b"x"))
