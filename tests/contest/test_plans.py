"""Tests of the stages in a contest file: each mistake has one clear sentence."""

import shutil
from pathlib import Path

import pytest
from small_contest import CONTEST

from lacoc_server.commands.contest.setting_up import check
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import note_plans
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import Closed, Drawn, Entered, Planned, Unplanned, new
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.live.run import play_live
from lacoc_shared.command import plugins
from lacoc_shared.mistakes import UserError

GROUPS = '[stage.groups]\nformat = "round-robin"\n'


def folder(tmp_path: Path, stages: str) -> ContestFolder:
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST + stages, "utf-8")
    return ContestFolder(file)


@pytest.mark.parametrize(
    ("stages", "said"),
    [
        ('[stage.a]\nformat = "league"\n', r'There is no format "league"\. Choose double-knockout'),
        ("[stage.a]\n", r"entry \"format\" is missing"),
        ('[stage."A b"]\nformat = "swiss"\n', r"\[stage.A b\]: a stage's name has 1 to 32 small"),
        ('[stage."予選"]\nformat = "swiss"\n', r"\[stage.予選\]: a stage's name"),
        (GROUPS + "title = 5\n", r"title is one text for both languages, or one for each"),
        (GROUPS + "break_s = inf\n", r"groups.*break_s: expected a number of at most"),
        (
            '[stage.a]\nformat = "single-knockout"\nfinal_break_s = inf\n',
            r"stage .a.*final_break_s: expected a number of at most",
        ),
        (GROUPS + "games = 0\n", r"groups.*games: .*at least 1"),
        (
            GROUPS + 'games = "two"\n',
            r"groups.*games: expected a whole number, without quotes, found text",
        ),
        (GROUPS + "teams = -1\n", r"groups.*teams: .*at least 0"),
        (GROUPS + "teams = 1\n", r"stage.groups.*teams = 1 is not possible"),
        (GROUPS + "game = 3\n", r'no entry "game"; a stage has format, after, title, draw, teams'),
        (
            GROUPS + "third_place = true\n",
            r'"round-robin" has no setting "third_place"; it has games, rounds, groups',
        ),
        (GROUPS + "options = { x = 1 }\n", r'has no setting "options"'),
        (GROUPS + 'tie_breaks = ["luck"]\n', r'no tie-break "luck"\. Choose from points'),
        (GROUPS + 'after = "groups"\n', r'comes after "groups", but no stage of this name'),
        (
            '[stage.a]\nformat = "single-knockout"\nteams = 2\nthird_place = true\n',
            r"stage.a.*no match for third place is possible with 2 teams. Remove 'third_place'",
        ),
        (
            GROUPS + 'teams = 3\n[stage.b]\nformat = "single-knockout"\nafter = "groups"\n'
            "third_place = true\n",
            r"stage.b.*third place is possible with 3 teams",
        ),
        (GROUPS + 'draw = "later"\n', r'draw = "later" is not possible; choose at-once or org'),
        (
            GROUPS + 'title.en = "Finals"\n',
            r"title is one text for both languages, or one for each",
        ),
        (GROUPS + 'arena = "chess"\n', r'no arena "chess"'),
        (GROUPS + 'arena = "practice"\n', r'"practice" is not a game for two'),
        (GROUPS + "settings.match.duration = 3\n", r"duration"),
        (
            GROUPS + 'settings = "long"\n',
            r"groups.*settings: expected a table, found text in quotes",
        ),
        ("[stage]\nformat = 3\n", r"stage"),
        (
            GROUPS + "settings.match.duration_s = -1\n",
            r"stage.groups.*match.duration_s: expected a number of at least 0",
        ),
        (
            GROUPS + 'settings.match.duration_s = "60"\n',
            r"stage.groups.*match.duration_s: expected a number, without quotes, found text",
        ),
    ],
)
def test_each_mistake_has_one_sentence(tmp_path: Path, stages: str, said: str) -> None:
    """A mistake in a stage is one line that names the contest file and what is wrong."""
    with pytest.raises(UserError, match=said) as wrong:
        folder(tmp_path, stages)
    assert "contest.toml" in str(wrong.value)
    assert "\n" not in str(wrong.value)


def test_all_wrong_stages_are_named_at_once(tmp_path: Path) -> None:
    """A stage after a wrong one is not blamed for it."""
    final = '[stage.final]\nformat = "single-knockout"\nafter = "groups"\nthird_place = true\n'
    show = '[stage.show]\nformat = "cup"\n'
    with pytest.raises(UserError) as wrong:
        folder(tmp_path, GROUPS + "teams = 1\n" + final + show)
    groups, cup = str(wrong.value).splitlines()
    assert "[stage.groups]" in groups
    assert "[stage.show]" in cup


@pytest.mark.parametrize("form", ["round-robin", "open"])
def test_a_game_in_a_folder_is_for_contests_without_courts(tmp_path: Path, form: str) -> None:
    """A stage's game may be in a folder beside the contest file; `contest run` refuses it."""
    othello = plugins.folder_of(plugins.package("lacoc.arenas", "arena", "othello"))
    shutil.copytree(othello, tmp_path / "mine", ignore=shutil.ignore_patterns("__pycache__"))
    where = folder(tmp_path, f'[stage.a]\nformat = "{form}"\narena = "./mine"\n')

    (found,) = filter(None, (*where.plans, where.open_stage))
    assert Path(tmp_path, found.arena) == tmp_path / "mine"
    with pytest.raises(UserError, match=r"only installed games, not those in folders \(.*mine\)"):
        play_live(where.file, print, print, print)


def test_stages_with_other_levels_are_other_games(tmp_path: Path) -> None:
    """Stages of one arena share a weigh-in only if they open the same levels of control."""
    stages = [
        f'[stage.{name}]\nformat = "swiss"\nsettings.match.{setting}\n'
        for name, setting in (
            ("one", "duration_s = 60.0"),
            ("two", "duration_s = 90.0"),
            ("both", 'levels = ["A", "B"]'),
        )
    ]
    where = folder(tmp_path, "".join(stages))
    assert [len(arena.match.open_levels) for arena in where.games] == [1, 2]


def test_a_stage_that_is_in_the_file_no_more_is_not_played(tmp_path: Path) -> None:
    """A stage that was renamed before its draw is planned under its new name only."""
    where = folder(tmp_path, GROUPS)
    with FactStore(where.facts) as store:
        note_plans(store, where.plans)
        renamed = folder(tmp_path, GROUPS.replace("stage.groups", "stage.league"))
        for _ in range(2):
            note_plans(store, renamed.plans)
        facts = store.facts()
        assert [type(fact) for fact in facts] == [Planned, Unplanned, Planned]
        assert [plan.stage for plan in compute(facts, FORMATS).planned] == ["league"]
        note_plans(store, where.plans)
        assert [plan.stage for plan in compute(store.facts(), FORMATS).planned] == ["groups"]


def test_a_stage_that_is_renamed_keeps_its_place(tmp_path: Path) -> None:
    """Stages are drawn in the order of the file, also if the first one has another name now."""
    cup = '[stage.cup]\nformat = "single-knockout"\nafter = "groups"\n'
    where = folder(tmp_path, GROUPS + cup)
    with FactStore(where.facts) as store:
        note_plans(store, where.plans)
        renamed = (GROUPS + cup).replace("groups", "league")
        for stages in (renamed, renamed, GROUPS + cup):
            note_plans(store, folder(tmp_path, stages).plans)
            names = [plan.stage for plan in compute(store.facts(), FORMATS).planned]
            assert names == ["league" if stages is renamed else "groups", "cup"]


def test_a_plan_can_change_until_the_draw(tmp_path: Path) -> None:
    """A changed plan is a new fact until its stage is drawn; later the change is refused.

    The refusal names the entry, and `lacoc contest check` has the same.
    """
    where = folder(tmp_path, GROUPS)
    with FactStore(where.facts) as store:
        for stages in (GROUPS, GROUPS, f"{GROUPS}games = 3\n"):
            note_plans(store, folder(tmp_path, stages).plans)
        assert [type(fact) for fact in store.facts()] == [Planned, Planned]
        store.append(new(Entered, team="Ann"), new(Entered, team="Bob"), new(Closed))
        store.append(new(Drawn, stage="groups", entries=("Ann", "Bob")))
        last = f'{GROUPS}games = 3\n[stage.last]\nformat = "swiss"\n'
        note_plans(store, folder(tmp_path, last).plans)
        assert [fact.stage for fact in store.facts() if isinstance(fact, Planned)][2:] == ["last"]
        for changed, entry in (
            (last.replace("games = 3", "games = 5"), r"stage\.groups\.games"),
            (last.replace("games = 3", "games = 3\nsettings.match.countdown_s = 1.0"), "settings"),
            (last + "[limits]\nlegs_max = 7\n", r"\[limits"),
        ):
            now = folder(tmp_path, changed)
            refused = rf'Stage "groups" has been drawn, so .*{entry}\] can\'t change'
            with pytest.raises(UserError, match=refused):
                note_plans(store, now.plans)
            with pytest.raises(UserError, match=refused):
                check(now.file)
        check(folder(tmp_path, last).file)
        assert len(store.facts()) == 7


def test_a_stage_has_a_title_for_people(tmp_path: Path) -> None:
    """A title is one text for both languages, or one for each."""
    stages = (
        f'{GROUPS}title = "Cup"\n[stage.last]\nformat = "swiss"\ntitle.en = "A"\ntitle.ja = "B"\n'
    )
    plans = folder(tmp_path, stages).plans
    assert [plan.title for plan in plans] == [{"en": "Cup", "ja": "Cup"}, {"en": "A", "ja": "B"}]
