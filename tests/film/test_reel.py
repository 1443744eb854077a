"""Tests of the reel of a contest: which records it takes, and where it looks for them."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from lacoc_client.commands.film import _check
from lacoc_client.film import contest, film, moments
from lacoc_client.film.look import Look
from lacoc_client.film.site import served
from lacoc_shared.mistakes import UserError

FILE = '[contest]\nrecordings = "matches"\n[court.main]\n'


def play(folder: Path, sheet: str, records: str) -> None:
    """Write the sheet of a contest with two games, a void one between them, and their records."""
    names = ["one.mcap", "two.mcap", "three.mcap"]
    outcomes = ["left", "void", "draw"]
    games = [{"record": name, "outcome": how} for name, how in zip(names, outcomes, strict=True)]
    (folder / sheet).write_text(json.dumps({"stages": [{"matches": [{"games": games}]}]}))
    (folder / records).mkdir()
    for name in names:
        (folder / records / name).touch()


def test_a_published_folder_has_its_records(tmp_path: Path) -> None:
    """Void games are left out; the order is that of the sheet."""
    play(tmp_path, "contest.json", "records")
    wanted = [tmp_path / "records" / name for name in ("one.mcap", "three.mcap")]
    assert [game.record for game in contest.games(tmp_path)] == wanted


def test_a_contest_file_names_the_folder_of_records(tmp_path: Path) -> None:
    """The file may have any name, and name any folder; the folder alone does not tell which."""
    file = tmp_path / "cup.toml"
    file.write_text(FILE)
    with pytest.raises(UserError, match=r"no cup\.json"):
        contest.games(file)
    with pytest.raises(UserError, match=r"no contest\.json.*a contest file"):
        contest.games(tmp_path)
    with pytest.raises(UserError, match="A film of a contest always shows highlights"):
        _check(file, tmp_path / "reel.mp4", highlights=True, moments=None)
    play(tmp_path, "cup.json", "matches")
    wanted = [tmp_path / "matches" / name for name in ("one.mcap", "three.mcap")]
    assert [game.record for game in contest.games(file)] == wanted
    (tmp_path / "cup.json").rename(tmp_path / "contest.json")
    with pytest.raises(UserError, match=r"one\.mcap.*If the contest file names another folder"):
        contest.games(tmp_path)


def test_a_reel_tells_a_result_that_the_organiser_gave(recorded: Path) -> None:
    """The record has the court's points; where others count in the contest, the card says them."""
    part = film.part(recorded)
    court = moments.final_scores(part.record)
    assert sum(court) > 0
    assert part.decided == ()
    assert replace(part, counted=court).decided == ()
    other = replace(part, counted=(6, 30))
    assert other.decided == (6, 30)
    with served(other.paths, other.decided) as site:
        assert "&decided=6&decided=30" in site.address(Look())
