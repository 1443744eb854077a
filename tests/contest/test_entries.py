"""Tests of entries: the files of a team, weighed in and frozen under their hash."""

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import msgspec
import pytest
import small_contest
from small_contest import CONTEST, FINAL, IDLE, SWISS

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot, robot_folder
from lacoc_robots.seat_files import gaits_in
from lacoc_server.commands.contest import playing
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.entries import EntryFolder, gather_entry, weigh
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.decided import decided
from lacoc_server.contest.league.facts import (
    AnyFact,
    Closed,
    Disqualified,
    Entered,
    EntriesOpened,
    FilesChanged,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_shared.gait.text import read_gait
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import LANGUAGES, render, say

Run = Callable[..., tuple[int, str, str]]
ENTRY = gather_entry(None, "planner", "hexapod").entry
SAMPLE = robot_folder("hexapod")


@dataclass
class Cup:
    """A contest that begins without teams."""

    file: Path

    def enter(self, team: str, bot: str = "planner", reason: str = "") -> str:
        """Enter a team; return the code of the answer."""
        return organiser.enter(self.file, team, None, bot, reason).code

    def out(self, team: str, *, disqualified: bool = False) -> None:
        """Take a team out."""
        organiser.take_out(self.file, team, "ill", disqualified=disqualified)

    @property
    def facts(self) -> tuple[AnyFact, ...]:
        """Read all facts."""
        with FactStore(ContestFolder(self.file).facts) as store:
            return store.facts()


@pytest.fixture
def cup(tmp_path: Path) -> Cup:
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST + SWISS + FINAL, "utf-8")
    return Cup(file)


def test_a_team_that_withdrew_may_come_back_until_entries_close(cup: Cup) -> None:
    """While entries are open a withdrawn team enters again, with the same files or others.

    After that, and if it was disqualified, it is told that it can't.
    """
    for team in ("Ants", "Bees", "Crabs"):
        cup.enter(team)
    for bot in ("planner", "straight"):
        cup.out("Bees")
        assert cup.enter("Bees", bot) == "contest.entered-back"
        contest = compute(cup.facts, FORMATS)
        assert [(team.name, team.gone) for team in contest.teams] == [
            ("Ants", False),
            ("Bees", False),
            ("Crabs", False),
        ]
        assert contest.unused == ()
        assert contest.teams[1].bot == bot
    assert cup.enter("Bees", "straight") == "contest.entered-same"
    cup.out("Crabs", disqualified=True)
    cup.out("Ants")
    with FactStore(ContestFolder(cup.file).facts) as store:
        store.append(new(Closed))
    before = cup.facts
    for team in ("Ants", "Crabs"):
        with pytest.raises(UserError) as refused:
            cup.enter(team, reason="late")
        assert refused.value.phrase.code == "contest.gone-for-good"
    assert cup.facts == before


@pytest.mark.parametrize(
    "change",
    [
        {"robot": b"x"},
        {"postures": b"x"},
        {"postures": None},
        {"locomotion": b"x"},
        {"bot": "nearest"},
        {"program": b""},
    ],
)
def test_each_part_changes_the_hash(change: dict[str, object]) -> None:
    """Another file or bot gives an entry another hash; the same files give the same one."""
    assert msgspec.structs.replace(ENTRY, **change).hash != ENTRY.hash
    assert gather_entry(None, "planner", "hexapod").entry.hash == ENTRY.hash


def test_frozen_files_that_were_changed_are_found(tmp_path: Path) -> None:
    """An entry that is saved twice has one folder; a changed or missing file is found."""
    folder = EntryFolder(tmp_path)
    entry = msgspec.structs.replace(ENTRY, bot="idle", program=IDLE.encode())
    assert folder.save(entry) == folder.save(entry) == entry.hash
    assert [path.name for path in tmp_path.iterdir()] == [entry.hash]
    assert folder.load(entry.hash) == entry
    for path in sorted((tmp_path / entry.hash).iterdir()):
        before = path.read_bytes()
        path.write_bytes(before + b" ")
        with pytest.raises(UserError, match=r"not those that were frozen|can't be read"):
            folder.load(entry.hash)
        path.unlink()
        with pytest.raises(UserError, match=r"not those that were frozen|can't be read"):
            folder.load(entry.hash)
        path.write_bytes(before)
    assert folder.load(entry.hash) == entry
    with pytest.raises(UserError, match="name is not a hash"):
        folder.load("../entries")


def test_every_mistake_of_every_file_is_told(tmp_path: Path) -> None:
    """If several files of an entry are wrong, the refusal has mistakes of more than one file."""
    own = tmp_path / "own"
    own.mkdir()
    (own / "robot.toml").write_text("legs = 3\n")
    (own / "Loco-data.txt").write_text("x\ny\n")
    (own / "LocoTra-data.txt").write_text("z\n")
    with pytest.raises(FileRefused) as refused:
        weigh(gather_entry(own, "", "hexapod"), [arenas.load("othello")], {})
    assert len(refused.value.mistakes) > 2
    assert len({mistake.file for mistake in refused.value.mistakes}) > 1


@pytest.mark.parametrize(("book_s", "taken"), [(1001, "Loco-data.xlsx"), (999, "Loco-data.txt")])
def test_of_a_workbook_and_a_text_the_newer_is_taken(
    tmp_path: Path, book_s: int, taken: str
) -> None:
    """`contest enter` takes the gait files of a folder that `lacoc play` takes there."""
    for name in ("Loco-data.txt", "LocoTra-data.txt"):
        (tmp_path / name).write_bytes((SAMPLE / name).read_bytes())
        os.utime(tmp_path / name, (1000, 1000))
    other = (SAMPLE / "Loco-data.txt").read_bytes().replace(b"45", b"44")
    (tmp_path / "Loco-data.txt").write_bytes(other)
    os.utime(tmp_path / "Loco-data.txt", (1000, 1000))
    (tmp_path / "Loco-data.xlsx").write_bytes((SAMPLE / "Loco-data.xlsx").read_bytes())
    os.utime(tmp_path / "Loco-data.xlsx", (book_s, book_s))

    handed = gather_entry(tmp_path, "", "hexapod")

    assert handed.taken == (taken, "LocoTra-data.txt")
    assert [path.name for path in gaits_in(tmp_path)] == [*handed.taken]
    table = read_gait(handed.entry.postures or b"", "")
    from_book = read_gait((SAMPLE / "Loco-data.txt").read_bytes(), "")
    assert (table == from_book) == (taken == "Loco-data.xlsx")
    newer = [note.code for note in handed.notes]
    assert newer == (["play.older-sequences"] if taken == "Loco-data.xlsx" else [])
    weigh(handed, [arenas.load("othello")], {})


def test_a_workbook_alone_is_enough(tmp_path: Path) -> None:
    """A folder with nothing but a workbook enters; level B is the sample's (README)."""
    (tmp_path / "Loco-data.xlsx").write_bytes((SAMPLE / "Loco-data.xlsx").read_bytes())
    handed = gather_entry(tmp_path, "", "hexapod")
    entry = weigh(handed, [arenas.load("othello")], {})
    assert handed.made
    assert (handed.taken, handed.notes) == (("Loco-data.xlsx",), ())
    assert read_gait(entry.locomotion or b"", "") == read_gait(ENTRY.locomotion or b"", "")


def test_a_broken_workbook_is_a_mistake_among_the_others(tmp_path: Path) -> None:
    """A cut-off workbook is a mistake of the team's file; other files' mistakes come with it."""
    book = (SAMPLE / "Loco-data.xlsx").read_bytes()
    (tmp_path / "Loco-data.xlsx").write_bytes(book[: len(book) // 2])
    (tmp_path / "LocoTra-data.txt").write_bytes(ENTRY.locomotion or b"")
    for games in ([arenas.load("othello")], []):
        with pytest.raises(FileRefused) as refused:
            weigh(gather_entry(tmp_path, "", "hexapod"), games, {})
        (mistake,) = refused.value.mistakes
        assert (mistake.file, mistake.found) == ("Loco-data.xlsx", say("gait.damaged"))

    (tmp_path / "LocoTra-data.txt").write_text("z\n")
    (tmp_path / "robot.toml").write_text("legs = 3\n")
    with pytest.raises(FileRefused) as refused:
        weigh(gather_entry(tmp_path, "", "hexapod"), [arenas.load("othello")], {})
    files = [mistake.file for mistake in refused.value.mistakes]
    assert set(files) == {"Loco-data.xlsx", "LocoTra-data.txt", "robot.toml"}
    assert files.count("Loco-data.xlsx") == 1


def test_a_folder_without_a_gait_is_told_what_belongs_there(tmp_path: Path) -> None:
    """The words for a missing folder or gait name the files, and no sign that `enter` lacks."""
    with pytest.raises(UserError, match=r"Loco-data\.xlsx") as no_gait:
        gather_entry(tmp_path, "", "hexapod")
    with pytest.raises(UserError, match="no folder") as no_folder:
        gather_entry(tmp_path / "nowhere", "", "hexapod")
    for error in (no_gait, no_folder):
        assert all("@" not in render(error.value.phrase, language) for language in LANGUAGES)


def test_the_command_tells_which_files_it_took(
    cup: Cup, capsys: pytest.CaptureFixture[str]
) -> None:
    """`lacoc contest enter` prints the files that it takes, also if one of them has mistakes."""
    folder = cup.file.parent / "own"
    folder.mkdir()
    book = (SAMPLE / "Loco-data.xlsx").read_bytes()
    (folder / "Loco-data.xlsx").write_bytes(book)
    (folder / "LocoTra-data.xlsx").write_bytes(book)
    playing.enter("Ann", folder, contest=cup.file)
    told = " ".join("".join(capsys.readouterr()).split())
    assert "Files taken from the folder: Loco-data.xlsx." in told
    assert "LocoTra-data.xlsx is not used" in told
    assert "level B is made from Loco-data.xlsx" in told
    assert "Ann has entered" in told

    (folder / "Loco-data.xlsx").write_bytes(book[:1000])
    with pytest.raises(FileRefused):
        playing.enter("Ann", folder, contest=cup.file)
    assert "Files taken from the folder: Loco-data.xlsx." in "".join(capsys.readouterr())


@pytest.mark.parametrize(
    ("source", "said"),
    [("def bot(:\n", r"bot\.py:1"), ("x = 1\n", r"bot\.py"), ("\0", "null")],
)
def test_a_bot_with_a_mistake_is_refused(cup: Cup, source: str, said: str) -> None:
    """An unknown bot is refused, and so is a program that is no Python or has no function `bot`."""
    program = cup.file.with_name("bot.py")
    program.write_text(source)
    with pytest.raises(UserError, match=said):
        cup.enter("Ann", str(program))
    with pytest.raises(UserError, match="nobody"):
        cup.enter("Ann", "nobody")
    assert not cup.facts


def test_two_teams_have_the_same_files(cup: Cup) -> None:
    """Two teams can enter the same files; the contest keeps them only once."""
    assert cup.enter("Ann") == cup.enter(" Bob ") == "contest.entered"
    assert [fact.team for fact in cup.facts] == ["Ann", "Bob"]
    assert len([*(cup.file.parent / "entries").iterdir()]) == 1


@pytest.mark.parametrize("team", ["", "   ", "x" * 25, "a\x07b", "a\u202eb", "a\0b", "\u3164"])
def test_a_name_that_cannot_be_shown_is_refused(cup: Cup, team: str) -> None:
    """A team's name that is empty, too long or has invisible characters is refused."""
    with pytest.raises(UserError, match="1 to 24"):
        cup.enter(team)


@pytest.mark.parametrize("team", ["bees", "BEES", "Ｂｅｅｓ", "ｂees"])
def test_a_name_that_looks_like_another_is_refused(cup: Cup, team: str) -> None:
    """Names that differ only in case or width are one name; the message says what to do."""
    assert cup.enter("Bees") == "contest.entered"
    before = cup.facts
    with pytest.raises(UserError, match=r'To change its files, enter "Bees"\.') as wrong:
        cup.enter(team, bot="nearest")
    assert wrong.value.phrase == say("contest.name-alike", team=team, there="Bees")
    assert cup.facts == before
    assert cup.enter("Bees", bot="nearest") == "contest.entered-again"
    assert cup.enter("Bees 2") == "contest.entered"


def test_a_name_typed_with_a_combining_accent_is_the_same_team(cup: Cup) -> None:
    """A name is the same whether its accent is part of a letter or a character of its own."""
    cup.enter("Café")
    assert cup.enter("Cafe\u0301", "nearest") == "contest.entered-again"


def test_after_the_deadline_only_a_reason_helps(cup: Cup) -> None:
    """After the deadline no team can enter, and files change only with a reason."""
    cup.enter("Ann")
    assert cup.enter("Ann", "nearest") == "contest.entered-again"
    assert cup.enter("Ann", "nearest") == "contest.entered-same"
    text = cup.file.read_text("utf-8")
    now = datetime.now(UTC)
    end = f'name = "Cup"\nentries_close = {now + timedelta(hours=1):%Y-%m-%dT%H:%M:%SZ}'
    cup.file.write_text(text.replace('name = "Cup"', end), "utf-8")
    assert cup.enter("Bob") == "contest.entered"
    end = f'name = "Cup"\nentries_close = {now - timedelta(hours=1):%Y-%m-%dT%H:%M:%SZ}'
    cup.file.write_text(text.replace('name = "Cup"', end), "utf-8")
    with pytest.raises(UserError, match="If Cy may enter nevertheless, give a reason"):
        cup.enter("Cy")
    with pytest.raises(UserError, match="--reason"):
        cup.enter("Bob", "nearest")
    assert cup.enter("Bob", "nearest", reason="broken file") == "contest.entered-again"
    last = cup.facts[-1]
    assert isinstance(last, FilesChanged)
    assert last.reason == "broken file"
    assert cup.enter("Cy", reason="the train was late") == "contest.entered"
    last = cup.facts[-1]
    assert isinstance(last, Entered)
    assert last.reason == "the train was late"
    contest = compute(cup.facts, FORMATS)
    assert [team.name for team in contest.teams] == ["Ann", "Bob", "Cy"]
    assert [fact.id for fact in contest.decisions] == [cup.facts[-2].id, last.id]
    assert sum(isinstance(fact, Closed) for fact in cup.facts) == 1


def test_the_club_of_a_team_can_change(cup: Cup) -> None:
    """Entering again with another club changes it, with the same files or others.

    Without a club it stays as it was, also if the team left meanwhile. After the end of entries the
    change needs a reason, and is a decision.
    """

    def enter(bot: str, club: str | None, reason: str = "") -> tuple[str, str]:
        code = organiser.enter(cup.file, "Bees", None, bot, reason, club=club).code
        (team,) = compute(cup.facts, FORMATS).teams
        return code, team.club

    assert enter("planner", None) == ("contest.entered", "")
    assert enter("planner", "Tokyo") == ("contest.entered-club", "Tokyo")
    assert enter("nearest", None) == ("contest.entered-again", "Tokyo")
    assert enter("nearest", "Tokyo") == ("contest.entered-same", "Tokyo")
    assert enter("planner", "Kyoto") == ("contest.entered-again", "Kyoto")
    cup.out("Bees")
    assert enter("planner", None) == ("contest.entered-back", "Kyoto")
    with FactStore(ContestFolder(cup.file).facts) as store:
        store.append(new(Closed))
    with pytest.raises(UserError, match="--reason"):
        enter("planner", "")
    assert enter("planner", "", "a mistake") == ("contest.entered-club", "")
    decision = decided(compute(cup.facts, FORMATS))[-1]
    assert render(decision.what) == "The entry of Bees was changed after entries were closed"


def test_entries_that_were_opened_stay_open(cup: Cup) -> None:
    """Also after a restart without the option; once they are closed, nothing opens them again."""
    with FactStore(ContestFolder(cup.file).facts) as store:
        assert not organiser.keep_open(store, False)
        assert organiser.keep_open(store, True)
        assert organiser.keep_open(store, False)
        assert organiser.keep_open(store, True)
        store.append(new(Closed))
        assert organiser.keep_open(store, True)
    assert [type(fact) for fact in cup.facts] == [EntriesOpened, Closed]


def test_a_team_leaves_once(cup: Cup) -> None:
    """A team can withdraw once and be disqualified later; one that never entered can't leave."""
    cup.enter("Ann")
    for _ in range(2):
        cup.out("Ann")
    for _ in range(2):
        cup.out("Ann", disqualified=True)
    assert [type(fact) for fact in cup.facts[1:]] == [Withdrawn, Disqualified]
    with pytest.raises(UserError, match=r"Zoe has not entered\. Teams: Ann"):
        cup.out("Zoe")


def test_a_contest_needs_two_teams_and_a_stage(cup: Cup) -> None:
    """Without two teams, or without a stage, the message says how to go on."""
    with pytest.raises(UserError, match=r"0 teams have entered.*lacoc contest enter"):
        small_contest.play(cup.file)
    cup.file.write_text(CONTEST, "utf-8")
    with pytest.raises(UserError, match=r"plans no stage.*\[stage.groups\]"):
        small_contest.play(cup.file)


def test_an_own_robot_is_in_the_entry(tmp_path: Path) -> None:
    """A folder's entry has the folder's robot file, or the contest's robot if there is none."""
    own = tmp_path / "own"
    own.mkdir()
    (own / "Loco-data.txt").write_bytes(ENTRY.locomotion or b"")
    assert gather_entry(own, "", "hexapod").entry.robot == find_robot("hexapod")[1]
    (own / "robot.toml").write_bytes(find_robot("long-legs")[1])
    assert gather_entry(own, "", "hexapod").entry.robot == find_robot("long-legs")[1]


def test_standings_before_the_draw_list_who_has_entered(
    cup: Cup, lacoc: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before the draw `standings` names the teams that take part, and those that wait."""
    code, said, _ = lacoc("contest", "standings", cup.file)
    assert (code, said) == (0, "Not drawn yet. 0 teams have entered:\n")
    cup.enter("Bees")
    cup.enter("Ants", bot="")
    cup.enter("Wasps")
    cup.out("Wasps")
    with Applications(ContestFolder(cup.file).applications) as applications:
        applications.put("Moths", ENTRY)
    with monkeypatch.context() as japanese:
        japanese.setenv("LACOC_LANGUAGE", "ja")
        assert "登録済みのチームは 2 チームです" in lacoc("contest", "standings", cup.file)[1]
    assert lacoc("contest", "standings", cup.file)[:2] == (
        0,
        "Not drawn yet. 2 teams have entered:\n  Bees (bot planner)\n  Ants\n"
        "  Moths (waits for your approval on the page /office)\n",
    )
    sheet = json.loads(lacoc("contest", "standings", cup.file, "--json")[1])
    assert [team["name"] for team in sheet["teams"]] == ["Bees", "Ants", "Wasps"]


@pytest.mark.parametrize(
    ("line", "missing"),
    [
        ("import helper", "helper"),
        ("from helper.parts import walk", "helper"),
        ("from .helper import walk", r"\.helper"),
        ("if True:\n    import helper", "helper"),
        ("import math, lacoc_arenas.steering", None),
        ("try:\n    import helper\nexcept ImportError:\n    helper = None", None),
    ],
)
def test_a_program_that_needs_another_file_is_refused(
    tmp_path: Path, line: str, missing: str | None
) -> None:
    """A bot's program is one file; a module beside it would not be there. Nothing of it runs."""
    (tmp_path / "helper.py").write_text("raise SystemExit\n")
    bot = tmp_path / "my_bot.py"
    bot.write_text(f"{line}\ndef bot(sheet, seat):\n    return lambda frame: None\n")
    handed = gather_entry(None, str(bot), "hexapod")
    if missing is None:
        assert weigh(handed, [], {}).program == bot.read_bytes()
        return
    says = rf"^The bot my_bot\.py needs the module {missing} \(my_bot\.py:\d\), which is not"
    with pytest.raises(UserError, match=says):
        weigh(handed, [], {})
