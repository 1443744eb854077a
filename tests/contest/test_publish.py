"""Tests of the published folder, and of the commands that lead to it."""

import csv
import io
import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import small_contest
from small_contest import BOTS, CONTEST, FINAL, SWISS

from lacoc_server.commands.contest.checking import NOT_PROVEN
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.publish import GAMES, STANDINGS
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import Closed, new
from lacoc_shared.mistakes import UserError

Run = Callable[..., tuple[int, str, str]]
NAMES = ["日本", "a/../../b", "..", ".", "a\"b'c", "=1+2", "＝1", "🦀 😀", "C:\\x", "a,b;c", "<b>"]


def files(folder: Path) -> dict[str, bytes]:
    """Return all files in a folder by their path."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.mark.slow
def test_the_folder_has_no_token(copied: Path) -> None:
    """No file of the published folder has a token in its content or its name."""
    where = ContestFolder(copied)
    kept = where.contest.secrets
    secrets = [kept.office, kept.referee("main"), *map(kept.team, BOTS)]
    published = files(small_contest.publish(copied))
    for name, data in published.items():
        assert [one for one in secrets if one.encode() in data or one in name] == []
    assert any(secrets[0].encode() in data for data in files(copied.parent).values())


@pytest.mark.slow
def test_the_folder_can_be_written_again(copied: Path) -> None:
    """Publishing again mends damaged files; it fails if a record has changed or is missing."""
    folder = copied.parent / "published"
    before = files(folder)
    for name in before:
        if not name.startswith("entries"):
            (folder / name).write_bytes(b"x" * len(before[name]))
    small_contest.publish(copied)
    assert files(folder) == before
    record = next((copied.parent / "records").iterdir())
    record.write_bytes(record.read_bytes() + b"x")
    with pytest.raises(UserError, match="has been changed since its game"):
        small_contest.publish(copied)
    record.unlink()
    with pytest.raises(UserError, match="is missing"):
        small_contest.publish(copied)
    assert files(folder) == before


@pytest.mark.slow
def test_a_record_that_is_not_packed_yet_is_published(copied: Path) -> None:
    """A court packs a record when it opens its next match; publishing does not wait for that."""
    folder = copied.parent / "published"
    record = next((copied.parent / "records").iterdir())
    published = folder / "records" / record.name
    wanted = published.read_bytes()
    published.unlink()
    record.rename(record.with_name(f"{record.stem}.0001.live.mcap"))
    small_contest.publish(copied)
    assert published.read_bytes() == wanted


def test_files_of_teams_come_with_the_end_of_entries(tmp_path: Path) -> None:
    """The files of teams are in the published folder only when entries are closed."""
    file = small_contest.enter(tmp_path)
    folder = small_contest.publish(file)
    assert [name for name in files(folder) if name.startswith(("entries", "records"))] == []
    with FactStore(ContestFolder(file).facts) as store:
        store.append(new(Closed))
    small_contest.publish(file)
    entries = {name.split("/")[1] for name in files(folder) if name.startswith("entries")}
    assert len(entries) == len({*BOTS.values()})


def test_a_folder_has_one_contest(tmp_path: Path) -> None:
    """A contest, or what was rehearsed on a copy of it, is not mixed with another one."""
    file = small_contest.enter(tmp_path / "cup", bots={"Ann": "planner", "Bob": "planner"})
    shutil.copytree(file.parent, tmp_path / "rehearsal")
    folder = tmp_path / "out"
    organiser.publish_to(file, folder)
    organiser.enter(tmp_path / "rehearsal" / file.name, "Cy", None, "planner", "")
    organiser.publish_to(tmp_path / "rehearsal" / file.name, folder)
    before = files(folder)
    with pytest.raises(UserError, match=r"out has another contest"):
        organiser.publish_to(file, folder)
    assert files(folder) == before


def test_names_of_teams_are_no_paths(tmp_path: Path) -> None:
    """Strange team names stay as they are, and nothing is written outside the published folder."""
    file = small_contest.enter(
        tmp_path / "in" / "side", CONTEST + SWISS, dict.fromkeys(NAMES, "planner")
    )
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        organiser.prepare(where, store)
        store.append(new(Closed))
    organiser.publish_to(file, tmp_path / "in" / "out")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in"]
    assert sorted(path.name for path in (tmp_path / "in").iterdir()) == ["out", "side"]
    assert [team.name for team in organiser.sheet(file).teams] == NAMES


@pytest.mark.slow
def test_tables_are_for_spreadsheets(played: Path) -> None:
    """Tables are CSV with a byte order mark for Excel; a name like a formula gets a ' before it."""
    rows = {}
    for name in (STANDINGS, GAMES):
        text = (played / "published" / name).read_bytes()
        assert text.startswith(b"\xef\xbb\xbf")
        rows[name] = [*csv.DictReader(io.StringIO(text.decode("utf-8-sig")))]
    teams = {row["team"] for row in rows[STANDINGS]}
    assert teams == {*BOTS} - {"=Dé"} | {"'=Dé"}
    assert {row["stage"] for row in rows[GAMES]} == {"swiss", "final"}
    assert all((played / "published" / "records" / row["record"]).exists() for row in rows[GAMES])


@pytest.mark.slow
@pytest.mark.long
def test_the_commands_from_an_empty_folder_to_standings(
    tmp_path: Path, lacoc: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The documented commands set up, play, publish and verify a contest, in this order."""
    monkeypatch.chdir(tmp_path)
    assert lacoc("contest", "init")[0] == 0
    file = Path("contest.toml")
    text, start = file.read_text("utf-8"), 'settings.match.start = "ready"\n'
    assert start in text
    # The stages of the file as they are, but games of 4 s instead of minutes.
    file.write_text(text.replace(start, FINAL[FINAL.index("settings") :]), "utf-8")
    assert lacoc("contest", "check")[0] == 0
    for team in ("Bees", "Ants"):
        code, said, _ = lacoc("contest", "enter", team, "--bot", "planner")
        assert (code, said[:16]) == (0, f"{team} has entered")
    assert lacoc("contest", "standings", "--json")[0] == 0
    code, said, _ = lacoc("contest", "run", "--headless", "--jobs", "2", "--json")
    end = json.loads(said)
    assert (code, end["kind"], end["played"]) == (0, "end", end["games"])
    assert json.loads(lacoc("contest", "run", "--headless", "--json")[1])["played"] == 0
    sheet = json.loads(lacoc("contest", "standings", "--json")[1])
    assert [team["name"] for team in sheet["teams"]] == ["Bees", "Ants"]
    assert "Bees" in lacoc("contest", "standings")[1]
    assert lacoc("contest", "publish", "out")[0] == 0
    code, said, _ = lacoc("contest", "verify", "out", "--jobs", "1", "--json")
    told = json.loads(said)
    assert (code, told["follows"], told["proven"], told["games"]) == (
        0,
        True,
        end["games"],
        end["games"],
    )


@pytest.mark.slow
@pytest.mark.long
def test_exit_codes_and_languages(
    copied: Path, lacoc: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Verify exits with 0-3, in English or Japanese; other commands that fail exit with 2."""
    folder = copied.parent / "published"
    some = ("contest", "verify", folder, "--jobs", "1", "--sample", "1", "--seed", "1")
    code, said, note = lacoc(*some)
    assert (code, "The standings follow from the facts" in said) == (NOT_PROVEN, True)
    assert "The exit code is 3." in note
    assert "a program of its own" in note
    told = json.loads(lacoc(*some, "--json")[1])
    checked = told["games"] - told["by_bots"] - told["by_people"]
    assert (told["follows"], checked) == (True, len(told["unchecked"]))
    verify = (*some, "--programs")
    code, said, note = lacoc(*verify)
    assert (code, "The standings follow from the facts" in said) == (0, True)
    assert "The records of 1 of" in note
    with monkeypatch.context() as japanese:
        japanese.setenv("LACOC_LANGUAGE", "ja")
        assert "順位は事実と記録から正しく導かれています" in lacoc(*verify)[1]
        withdraw = ("contest", "withdraw", "Ann", "--contest", copied, "--reason", "病気")
        code, said, note = lacoc(*withdraw)  # nobody is there to ask
        assert (code, "Ann が大会から外れ" in said, "--yes" in note) == (0, True, True)
        assert "Ann は大会から外れました" not in said
        code, said, _ = lacoc(*withdraw, "--yes")
        assert (code, "大会から外れました" in said) == (0, True)
    small_contest.publish(copied)
    code, said, note = lacoc(*verify)
    assert code == 0
    assert "Ann has withdrawn. Reason: 病気" in note
    (folder / STANDINGS).write_bytes(b"")
    code, said, _ = lacoc(*verify)
    assert (code, "standings.csv is not what follows" in said) == (1, True)
    told = json.loads(lacoc(*verify, "--json")[1])
    assert [one["code"] for one in told["findings"]] == ["verify.other-sheet"]
    (folder / "facts.json").write_text("{")
    assert lacoc(*verify)[0] == 2
    shutil.rmtree(folder)
    assert lacoc(*verify)[0] == 2
    assert lacoc("contest", "enter", "Zoe", "--contest", copied)[0] == 2
    assert lacoc("contest", "withdraw", "Zoe", "--contest", copied)[0] == 2
    assert lacoc("contest", "run", copied.parent / "none.toml", "--headless")[0] == 2


@pytest.mark.slow
def test_a_reel_finds_the_records(played: Path) -> None:
    """A film of a published folder takes the records of all games that are not void.

    A film of the contest's own folder takes records of the same names, in the same order.
    """
    film_contest = pytest.importorskip("lacoc_client.film.contest")
    published = [game.record for game in film_contest.games(played / "published")]
    own = [game.record for game in film_contest.games(played)]

    rows = csv.DictReader(io.StringIO((played / "published" / GAMES).read_text("utf-8-sig")))
    names = [Path(row["record"]).name for row in rows if row["outcome"] != "void"]
    assert sorted(path.name for path in published) == sorted(names)
    assert [path.name for path in own] == [path.name for path in published]
    assert all(path.is_file() for path in [*published, *own])
