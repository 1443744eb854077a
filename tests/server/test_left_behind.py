"""Which match a court goes on with: its own, and only one that it did not end."""

from pathlib import Path

import msgspec
import pytest
from stage import LEFT, QUICK, RIGHT, decide, join, setup

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_server.journal import Journal
from lacoc_server.match import Match
from lacoc_server.recovery import Unfinished, unfinished
from lacoc_server.world import World
from lacoc_shared import decisions as d
from lacoc_shared.inputs import ReadySeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files, pack
from lacoc_shared.record.reader import Record

pytestmark = pytest.mark.slow

OTHELLO = arenas.load("othello", QUICK)
TEN = "20260501-100000"
"""Wall time of a match that comes before those of `LATER`."""
LATER = "20260501-100500"


def held(
    folder: Path, court: str = "main", opened: str = TEN, number: int = 1, arena: str = "othello"
) -> Journal:
    """A match of a court in PLAYING, or in READY where nobody has to start it."""
    made = msgspec.structs.replace(
        setup(arena, QUICK), match_id=f"{opened}-{court}-{number:03d}", court=court, match=number
    )
    journal = Journal(Match(made, World), folder)
    seats = range(len(journal.match.seats))
    journal.beat([join(seat) for seat in seats])
    if len(seats) == 2:
        journal.beat([ReadySeat(LEFT, True), ReadySeat(RIGHT, True)])
        journal.beat([decide(d.Start())])
    for _ in range(50):
        journal.beat()
    return journal


def killed(
    folder: Path, court: str = "main", opened: str = TEN, number: int = 1, arena: str = "othello"
) -> str:
    """A match that was left by its court; returns its id."""
    journal = held(folder, court, opened, number, arena)
    journal.leave()
    return journal.match.setup.match_id


def taken_up(folder: Path, court: str, arena: Arena = OTHELLO) -> str | None:
    left = unfinished(folder, court, arena)
    return left and left.match.setup.match_id


def test_a_court_does_not_take_up_the_match_of_another(tmp_path: Path) -> None:
    """Its name may end in the same way."""
    match_id = killed(tmp_path, "semi-final")
    assert taken_up(tmp_path, "final") is None
    assert taken_up(tmp_path, "semi-final") == match_id


def test_the_packed_match_of_another_court_hides_none(tmp_path: Path) -> None:
    """Nor does a court whose name begins or ends in the same way."""
    match_id = killed(tmp_path, "final")
    for court in ("semi-final", "final-b", "zoo"):
        (tmp_path / f"{LATER}-{court}-002.mcap").touch()
    assert taken_up(tmp_path, "final") == match_id
    (tmp_path / f"{LATER}-final-001.mcap").touch()
    assert taken_up(tmp_path, "final") is None, "a match came after it"


def test_match_1000_goes_on(tmp_path: Path) -> None:
    """The number of a match may have more than three digits; 1000 comes after 999."""
    (tmp_path / f"{TEN}-main-999.mcap").touch()
    match_id = killed(tmp_path, number=1000)
    assert taken_up(tmp_path, "main") == match_id


def test_a_renamed_record_is_told(tmp_path: Path) -> None:
    """Its segments would go on under the name that is in it: refused, and nothing is changed."""
    match_id = killed(tmp_path, "semi-final")
    path = files.segment_path(tmp_path, match_id, 0)
    path.rename(files.segment_path(tmp_path, f"{TEN}-final-001", 0))
    words = rf"It is of match '{match_id}' of court 'semi-final': give its files.*--fresh"
    with pytest.raises(UserError, match=words):
        unfinished(tmp_path, "final", OTHELLO)


@pytest.mark.parametrize(("there", "here"), [("othello", "practice"), ("practice", "othello")])
def test_a_match_of_another_arena_is_refused(there: str, here: str, tmp_path: Path) -> None:
    """Both courts are called main where nobody names them: neither takes over the other's."""
    match_id = killed(tmp_path, arena=there)
    path = files.segment_path(tmp_path, match_id, 0)
    data = path.read_bytes()
    words = rf"was played in arena '{there}', and this court is to play '{here}': start.*--fresh"
    with pytest.raises(UserError, match=words):
        unfinished(tmp_path, "main", arenas.load(here))
    assert path.read_bytes() == data
    assert taken_up(tmp_path, "main", arenas.load(there)) == match_id


def test_a_match_that_its_court_ended_is_over(tmp_path: Path) -> None:
    """Also while its segments wait to be packed, or could not be: docs/operations.md, SIGTERM."""
    journal = held(tmp_path)
    journal.close()
    assert unfinished(tmp_path, "main", OTHELLO) is None
    (segment,) = files.segment_paths(tmp_path, journal.match.setup.match_id)
    whole = segment.read_bytes()
    segment.write_bytes(whole[:-8])
    left = unfinished(tmp_path, "main", OTHELLO)
    assert left is not None, "a full disk did not take the end of it"
    assert left.match.beats == journal.match.beats


def test_a_match_that_went_on_loses_nothing_to_a_packer(tmp_path: Path) -> None:
    """A packer that is late finds the segment that came after those it has."""
    first = held(tmp_path)
    first.leave()
    match_id = first.match.setup.match_id
    left = unfinished(tmp_path, "main", OTHELLO)
    assert isinstance(left, Unfinished)
    second = Journal(left.match, tmp_path, left.segment)
    second.beat(left.inputs)
    out = files.packed_path(tmp_path, match_id)
    before = files.segment_paths(tmp_path, match_id)
    for segments in (before, before[:1]):
        with pytest.raises(UserError):
            pack.pack(segments, out)
    for _ in range(300):
        second.beat()
    second.beat([decide(d.Declare("left"))])
    second.beat([decide(d.Official())])
    second.close()
    assert pack.main(str(tmp_path), match_id) == 0
    record = Record.read(out)
    assert record.last_beat == second.match.beats
    assert record.result is not None
    assert record.result.official == "left"


def test_a_match_that_a_court_took_up_is_not_taken_up_twice(tmp_path: Path) -> None:
    """Its first segment is held by nobody, its second by the running court."""
    killed(tmp_path)
    left = unfinished(tmp_path, "main", OTHELLO)
    assert left is not None
    running = Journal(left.match, tmp_path, left.segment)
    assert unfinished(tmp_path, "main", OTHELLO) is None
    running.leave()
    assert unfinished(tmp_path, "main", OTHELLO) is not None
