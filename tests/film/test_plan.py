"""Which pictures a film has: exactly as many as its length says, and none twice."""

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.film import moments, plan
from lacoc_client.film.film import FilmPart
from lacoc_client.film.moments import Moment
from lacoc_client.film.plan import Shot
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S, Phase, SeatFlag

ENDS = st.tuples(st.integers(0, 2000), st.integers(0, 9000)).map(
    lambda ends: (ends[0], ends[0] + ends[1])
)


@given(ENDS, st.integers(1, 60))
def test_a_shot_has_a_picture_each_interval(ends: tuple[int, int], fps: int) -> None:
    """Pictures are evenly spaced from the first beat on, as many as fit up to the last beat."""
    first, last = ends
    pictures = plan.pictures(plan.whole(first, last), fps)

    assert len(pictures) == (last - first) * fps // BEATS_PER_S + 1
    assert [picture.cut for picture in pictures] == [True] + [False] * (len(pictures) - 1)
    assert pictures[0].beat == first
    assert last - BEATS_PER_S / fps < pictures[-1].beat <= last + 1e-6
    for index, picture in enumerate(pictures):
        assert picture.beat == pytest.approx(first + index * BEATS_PER_S / fps)


@given(ENDS, st.lists(st.integers(-100, 12_000), max_size=8), st.none() | st.integers(-100, 12_000))
def test_shots_are_in_order_and_within_the_match(
    ends: tuple[int, int], beats: list[int], opening: int | None
) -> None:
    """Shots lie in the match, do not touch, and show each moment; the last ends with the match."""
    first, last = ends
    shots = plan.highlights([Moment(beat) for beat in beats], first, last, opening=opening)

    assert all(first <= shot.first <= shot.last <= last for shot in shots)
    assert all(one.last + 1 < other.first for one, other in pairwise(shots))
    assert shots[-1].last == last
    for beat in [*beats, *([] if opening is None else [opening])]:
        shown = any(shot.first <= beat <= shot.last for shot in shots)
        assert shown or not first <= beat <= last


def test_near_moments_are_one_shot() -> None:
    """Two moments 5 s apart are one shot, and one a minute later is another."""
    shots = plan.highlights([Moment(1000), Moment(1250), Moment(4250)], 0, 9000)
    assert shots == [Shot(800, 1400), Shot(4050, 4400), Shot(8800, 9000)]


@pytest.mark.parametrize(
    ("scores", "found"),
    [
        ([(0, (0, 0)), (9, (0, 0))], []),
        ([(0, (0, 0)), (9, (10, 0)), (90, (10, 30))], [(9, 10), (90, 30)]),
        ([(0, (0, 0)), (9, (10, 0)), (30, (10, 10))], []),  # within a second: they cancel out
        ([(0, (0, 0)), (9, (1, 0)), (40, (3, 0)), (100, (4, 0))], [(9, 3), (100, 1)]),
        ([(0, (5,)), (9, (7,))], [(9, 2)]),
        ([(0, (20, 16)), (9, (22, 14))], [(9, 4)]),  # a flip counts for one and against the other
    ],
)
def test_a_swing_is_the_change_of_the_lead(
    scores: list[tuple[int, tuple[int, ...]]], found: list[tuple[int, int]]
) -> None:
    """A moment begins at its first change, and has all changes of the second after that."""
    assert [(moment.beat, moment.swing) for moment in moments.swings(scores)] == found


def test_the_largest_are_chosen_and_shown_in_order() -> None:
    """Of equal swings the earlier one is chosen; the chosen ones are in the order of time."""
    given = [Moment(300, 1), Moment(100, 2), Moment(200, 5), Moment(400, 2)]
    assert [moment.beat for moment in moments.largest(given, 2)] == [100, 200]


def test_moments_of_a_record_are_when_its_score_changed(recorded: Path) -> None:
    """A real match has a moment, and each of its moments is at the beat at which a flag fell."""
    record = Record.read(recorded)
    found = moments.by_score(record)
    beats = {event.beat for event in record.events if event.kind == "strike"}

    assert found
    assert {moment.beat for moment in found} <= beats


def test_a_correction_during_a_halt_is_no_moment() -> None:
    """Only play gives moments: points that change while the match is halted are none."""
    phases = [Phase.PLAYING] * 2 + [Phase.HALTED, Phase.COUNTDOWN] + [Phase.PLAYING] * 2
    scores = [0, 3, 3, 9, 9, 10]
    frames: list[tuple[int, Any]] = [
        (100 * index, SimpleNamespace(phase=phase, seats=[SimpleNamespace(score=score)]))
        for index, (phase, score) in enumerate(zip(phases, scores, strict=True))
    ]
    assert moments.of_frames(frames) == [Moment(100, 3), Moment(500, 1)]


@pytest.mark.parametrize("text", ["", "[]", '{"moments": [{"beat": "x"}]}', '{"moments": 3}', "\0"])
def test_a_file_without_moments_is_refused(tmp_path: Path, text: str) -> None:
    """The error names the file, and shows what a right file is like or how large it may be."""
    file = tmp_path / "m.json"
    file.write_text(text)
    with pytest.raises(UserError, match=r'm\.json.*"beat": 1234'):
        moments.from_file(file)
    with pytest.raises(UserError, match=r"none\.json"):
        moments.from_file(tmp_path / "none.json")
    file.write_bytes(b" " * ((1 << 20) + 1))
    with pytest.raises(UserError, match=r"m\.json.*at most 1 MiB"):
        moments.from_file(file)
    file.write_text('{"moments": [{"beat": 12, "swing": 0.5, "why": "a fork"}]}')
    assert moments.from_file(file) == [Moment(12, 0.5)]


def test_moments_outside_of_the_match_take_no_place() -> None:
    """They are not chosen before smaller ones inside; if none is inside, that is said."""
    outside = tuple(Moment(beat, 9.0) for beat in (1, 2, 5000, 6000, 7000))
    part = FilmPart(cast(Any, None), (), count=5, chosen=(*outside, Moment(1000, 0.1)))
    alone = FilmPart(cast(Any, None), (), count=5, chosen=(Moment(1000, 0.1),))
    assert part.shots(500, 2000) == alone.shots(500, 2000)
    with pytest.raises(UserError, match="500 to 2000"):
        FilmPart(cast(Any, None), (), count=5, chosen=outside).shots(500, 2000)


@pytest.mark.parametrize(
    ("joined", "begin"),
    [([], 0), ([2] * 9, 5), ([0, 1, 2, 2, 2, 2, 2, 2, 2], 5), ([0] * 7 + [1, 2], 8), ([0] * 9, 9)],
    ids=["no lobby", "long together", "together", "just together", "never"],
)
def test_a_reel_shows_two_teams_before_the_count_down(joined: list[int], begin: int) -> None:
    """Its opening begins so long before the count-down, but not while a team has not come."""
    seats = [
        [SimpleNamespace(flags=SeatFlag.JOINED if seat < count else 0) for seat in range(2)]
        for count in joined
    ]
    phases = [Phase.LOBBY] * len(joined) + [Phase.COUNTDOWN, Phase.PLAYING, Phase.OFFICIAL]
    frames: list[tuple[int, Any]] = [
        (beat, SimpleNamespace(phase=phase, seats=seats[beat] if beat < len(seats) else []))
        for beat, phase in enumerate(phases)
    ]
    assert moments.opening_of_frames(frames, 4) == begin
