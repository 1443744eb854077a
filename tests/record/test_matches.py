"""The names that a court gives its matches, and which records in a folder are its own."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from lacoc_shared.record.matches import MatchName, court_matches, is_over, unpacked
from lacoc_shared.record.schema import Header
from lacoc_shared.record.writer import RecordWriter


@pytest.mark.parametrize(
    ("match_id", "court", "number"),
    [
        ("20260501-100000-main-001", "main", 1),
        ("20260501-100000-main-999", "main", 999),
        ("20260501-100000-main-1000", "main", 1000),
        ("20260501-100000-semi-final-012", "semi-final", 12),
        ("20260501-100000-main-001-002", "main-001", 2),
        ("20260501-100000-20260501-100000-a-003", "20260501-100000-a", 3),
    ],
)
def test_a_name_is_read_as_it_was_made(match_id: str, court: str, number: int) -> None:
    """A match's name can be read back, with any hyphens and digits in the court's name."""
    name = MatchName("20260501-100000", number, court)
    assert str(name) == match_id
    assert MatchName.parse(match_id) == name


@pytest.mark.parametrize(
    "match_id",
    ["", "m", "simulated-001", "20260501-100000-main", "20260501-100000-main-01", "main-001",
     "20260501-100000-main-0001", "20260501-100000--001", "20260501-100000-main-001.part",
     "20261399-999999-main-001"],
)  # fmt: skip
def test_what_no_court_made_is_no_match_name(match_id: str) -> None:
    """A name that no court makes is not read as a match's name."""
    assert MatchName.parse(match_id) is None


def test_a_match_that_is_opened_now_has_the_time_in_its_name() -> None:
    """A new match's name has the time in UTC, so that names sort in the order of matches."""
    before = datetime.now(UTC).replace(microsecond=0)
    opened = datetime.strptime(MatchName.new(None, "main", 1).opened, "%Y%m%d-%H%M%S")
    assert before <= opened.replace(tzinfo=UTC) <= before + timedelta(seconds=60)


def test_a_match_is_newer_than_all_before_it_though_the_clock_was_set_back(tmp_path: Path) -> None:
    """A killed court goes on with its newest match by name, so names follow the order of matches.

    Matches of other courts do not count.
    """
    for name in ("20991231-235959-main-007.mcap", "20991231-235959-main-008.000.live.mcap"):
        (tmp_path / name).touch()
    assert str(MatchName.new(tmp_path, "main", 9)) == "21000101-000000-main-009"
    (tmp_path / "21000101-000000-main-009.000.live.mcap").touch()
    assert str(MatchName.new(tmp_path, "main", 1)) == "21000101-000001-main-001"
    assert MatchName.new(tmp_path, "other", 1).opened < "2099"


def test_a_court_that_starts_twice_in_a_second_has_two_matches(tmp_path: Path) -> None:
    """A court that is started twice within a second gives its matches different, sorted names."""
    names = []
    for ending in ("mcap", "000.live.mcap") * 3:
        names.append(MatchName.new(tmp_path, "main", 1))
        (tmp_path / f"{names[-1]}.{ending}").touch()
    assert names == sorted(set(names))


def test_a_court_has_its_own_matches_in_their_order(tmp_path: Path) -> None:
    """A court finds its own matches in order, and none of a court with a similar name."""
    for name in (
        "20260501-100000-final-1000.000.live.mcap",
        "20260501-100000-final-1000.001.live.mcap",
        "20260501-100000-final-999.000.live.mcap",
        "20260501-090000-final-998.mcap",
        "20260501-100000-semi-final-001.000.live.mcap",
        "20260501-100001-semi-final-002.mcap",
        "20260501-100001-final-1001.mcap.part",
        "simulated-001.mcap",
    ):
        (tmp_path / name).touch()
    found = court_matches(tmp_path, "final")
    assert [(name.number, list(segments)) for name, segments in found.items()] == [
        (998, []),
        (999, [0]),
        (1000, [0, 1]),
    ]
    assert court_matches(tmp_path / "none", "final") == {}


def test_a_match_is_over_when_its_court_ended_it(
    tmp_path: Path, header: Callable[..., Header]
) -> None:
    """Only a match that its court ended is over. It counts as unpacked until packing ends."""
    ids = [f"20260501-10000{number}-main-001" for number in range(4)]
    writers = [RecordWriter(tmp_path, header(match_id=match_id)) for match_id in ids[:3]]
    ended, left, cut = writers
    ended.close()
    left.leave()
    cut.close()
    cut.path.write_bytes(cut.path.read_bytes()[:-1])
    (tmp_path / f"{ids[3]}.000.live.mcap").write_bytes(ended.path.read_bytes()[:8])
    found = court_matches(tmp_path, "main")
    assert [is_over(name, segments) for name, segments in found.items()] == [
        True,
        False,
        False,
        False,
    ]
    assert unpacked(tmp_path, "main") == ids[:1]
    (tmp_path / f"{ids[0]}.mcap").touch()
    left.path.unlink()
    assert unpacked(tmp_path, "main") == ids[:1], "packing was interrupted before its end"
