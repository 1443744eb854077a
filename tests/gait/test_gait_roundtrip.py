"""Property tests: a written gait reads back unchanged, and wrong bytes raise only FileRefused."""

import io
import math
import zipfile
from collections.abc import Callable

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from lacoc_shared.gait.cells import angle_of, degrees_of, leg_labels, number_text
from lacoc_shared.gait.tables import (
    LocomotionTable,
    PostureTable,
    to_locomotion,
    to_postures,
)
from lacoc_shared.gait.text import MAX_BYTES, read_gait, write_gait
from lacoc_shared.gait.workbook.file import read_workbook, write_workbook
from lacoc_shared.mistakes import FileRefused, Mistake

legs = st.sampled_from([4, 6, 8])
degrees = st.one_of(
    st.integers(-150, 150).map(float),
    st.integers(-1500, 1500).map(lambda tenths: tenths / 10),
    st.floats(-150, 150),
)


def mistakes_of(read: Callable[[bytes, str], object], data: bytes) -> list[Mistake] | None:
    """Return the mistakes for which data are refused; None if the data are read."""
    try:
        read(data, "x")
    except FileRefused as refusal:
        return refusal.mistakes
    return None


def postures(
    legs: int, degrees: st.SearchStrategy[float] = degrees
) -> st.SearchStrategy[tuple[float, ...]]:
    """Draw the angles of a posture [rad], each made from a number of degrees as a file holds it."""
    return st.tuples(*[degrees.map(angle_of)] * (3 * legs))


def posture_tables_of(degrees: st.SearchStrategy[float]) -> st.SearchStrategy[PostureTable]:
    """Draw posture tables whose angles are made from these numbers of degrees."""
    return legs.flatmap(
        lambda n: st.dictionaries(st.integers(0, 9), postures(n, degrees), min_size=1, max_size=10)
    ).map(PostureTable)


posture_tables = posture_tables_of(degrees)
locomotion_tables = legs.flatmap(
    lambda n: st.lists(
        st.lists(postures(n), min_size=1, max_size=4).map(tuple), min_size=1, max_size=4
    )
).map(lambda sequences: LocomotionTable(tuple(sequences)))
encodings = st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp932"])
# Making a whole table is slow. Hypothesis must not blame the code under test for that.
patient = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])


@given(degrees)
@example(22.123456789012345)
@example(-5e-324)
@example(1e-310)
@example(149.99999999999997)
@example(4.985737865549591e-231)
def test_an_angle_is_written_without_loss(value_deg):
    """The number of degrees that is written for an angle reads back as the same bits."""
    angle_rad = angle_of(value_deg)
    written = degrees_of(angle_rad)
    assert angle_of(written) == angle_rad
    assert len(number_text(written)) <= len(number_text(value_deg)) or angle_rad == 0


@given(st.integers(-150_000, 150_000))
def test_a_short_number_stays_as_it_was(thousandths):
    """An angle with at most 3 decimals [deg] is written unchanged: 45, never 45.00000000000001."""
    assert degrees_of(math.radians(thousandths / 1000)) == thousandths / 1000


@pytest.mark.slow
@patient
@given(
    st.one_of(posture_tables, locomotion_tables),
    encodings,
    st.sampled_from(["\n", "\r\n", "\r"]),
    st.sampled_from(["\t", "   "]),
)
def test_a_written_text_reads_back(table, encoding, line_end, gap):
    """Any table that is written as text reads back, in any encoding, with tabs or spaces."""
    labels = leg_labels(table.joints // 3)
    text = write_gait(table, labels).decode().replace("\n", line_end).replace("\t", gap)
    assert read_gait(text.encode(encoding), "x", legs=labels) == table


@pytest.mark.slow
@settings(patient)
@given(posture_tables_of(degrees.map(lambda value: float(f"{value:.15g}"))))
def test_a_written_workbook_reads_back(table):
    """A table whose numbers have at most 15 digits reads back from a workbook."""
    labels = leg_labels(table.joints // 3)
    assert read_workbook(write_workbook(table, labels), "x", legs=labels) == table


@pytest.mark.slow
@patient
@given(posture_tables)
def test_postures_to_locomotion_and_back(table):
    """A posture table that is turned into a locomotion table and back keeps its postures."""
    keys = tuple((digit,) for digit in table.postures)
    back = to_postures(to_locomotion(table, keys))
    assert set(back.postures.values()) == set(table.postures.values())


@given(st.one_of(st.binary(), st.text().map(str.encode), st.text("01 \t\n,.-4Key\"'\0NumofPsure")))
def test_any_bytes_are_read_or_refused(data):
    """Any bytes are read as a gait, or refused with at least one mistake."""
    assert mistakes_of(read_gait, data if isinstance(data, bytes) else data.encode()) != []


changes = st.lists(
    st.tuples(st.integers(0, 700), st.sampled_from([0, 1, 2]), st.binary(min_size=1, max_size=3)),
    min_size=1,
    max_size=5,
)


def changed(data: bytes, edits: list[tuple[int, int, bytes]]) -> bytes:
    """Return the data with some bytes inserted, removed or replaced."""
    for place, kind, new in edits:
        end = place + (0, len(new), len(new))[kind]
        data = data[:place] + (b"" if kind == 1 else new) + data[end:]
    return data


@pytest.mark.slow
@patient
@given(st.one_of(posture_tables, locomotion_tables), encodings, changes)
def test_a_damaged_text_is_read_or_refused(table, encoding, edits):
    """A text with some wrong bytes is read as a gait, or refused with at least one mistake."""
    text = write_gait(table, leg_labels(table.joints // 3)).decode()
    data = changed(text.encode(encoding)[:MAX_BYTES], edits)
    assert mistakes_of(read_gait, data) != []


@settings(patient)
@given(st.binary(max_size=200), st.sampled_from([b"", b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1"]))
def test_any_bytes_are_no_workbook(data, start):
    """Any bytes that are not a workbook raise FileRefused."""
    with pytest.raises(FileRefused):
        read_workbook(start + data, "x")


SAMPLE = write_workbook(PostureTable({0: (0.5,) * 18, 1: (0.25,) * 18}), leg_labels(6))
PARTS = sorted(zipfile.ZipFile(io.BytesIO(SAMPLE)).namelist())


@settings(patient)
@given(st.integers(0, len(SAMPLE)), st.binary(min_size=1, max_size=4), st.booleans())
def test_a_damaged_workbook_is_read_or_refused(place, new, cut):
    """A workbook with damaged bytes is read, or refused with at least one mistake."""
    data = SAMPLE[:place] if cut else SAMPLE[:place] + new + SAMPLE[place + len(new) :]
    assert mistakes_of(read_workbook, data) != []


@pytest.mark.slow
@settings(patient)
@given(st.sampled_from(PARTS), st.data())
def test_a_workbook_with_wrong_parts_is_read_or_refused(part, draw):
    """A workbook with wrong XML in one part is read, or refused with at least one mistake."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(SAMPLE)) as old, zipfile.ZipFile(stream, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == part:
                place = draw.draw(st.integers(0, len(content)))
                text = draw.draw(st.sampled_from([b"", b"<", b"9", b"-1", b'"', b"x", b"&a;"]))
                length = draw.draw(st.integers(0, 6))
                content = content[:place] + text + content[place + length :]
            new.writestr(name, content)
    assert mistakes_of(read_workbook, stream.getvalue()) != []
