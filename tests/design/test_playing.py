"""A court of `lacoc practice` that /design starts with the student's files."""

import urllib.error
import urllib.request

import pytest
from waiting import LIMIT_S, until

from lacoc_client.workshop.design.playing import Playing
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.seat_files import SeatFiles
from lacoc_shared.messages import SentFile


def answers(url: str) -> bool:
    try:
        with urllib.request.urlopen(url.partition("#")[0], timeout=LIMIT_S) as answer:
            return bool(answer.status == 200)
    except urllib.error.URLError:
        return False


@pytest.mark.long(1)
def test_other_kinds_of_files_start_the_court_again() -> None:
    """New numbers go to the page that is open; a robot of the student's own needs a new court."""
    postures, locomotion = sample_gait_files("hexapod")
    playing = Playing()
    try:
        first = playing.open(SeatFiles(None, postures, None))
        assert answers(first)
        assert postures is not None
        changed = SentFile(postures.name, postures.data + b"\n")
        assert playing.open(SeatFiles(None, changed, None)) == first
        second = playing.open(SeatFiles(SentFile(*find_robot("hexapod")), None, locomotion))
        assert answers(second)
        assert second != first
        until(lambda: not answers(first))
    finally:
        playing.close()
    assert not answers(second)
