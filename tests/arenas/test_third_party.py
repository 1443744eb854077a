"""Arenas of other people: the guide's game is played, and mistakes in an arena are reported."""

import inspect
import os
import re
import shutil
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace

import msgspec
import pytest

from lacoc_arenas import arena, brains
from lacoc_arenas.game import Game, GameEvent, NoSuchState, Place, RobotView
from lacoc_shared.command import plugins
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import MarkerInfo
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import Phase
from lacoc_shared.words import render

mujoco = pytest.importorskip("mujoco")
field = pytest.importorskip("lacoc_arenas.field")
simulation = pytest.importorskip("lacoc_server.simulate")
scenes = pytest.importorskip("lacoc_server.world.scene")
headless = pytest.importorskip("lacoc_server.simulate.headless")
inputs = pytest.importorskip("lacoc_server.simulate.inputs")
journals = pytest.importorskip("lacoc_server.journal.journal")
replay = pytest.importorskip("lacoc_server.journal.replay")
matches = pytest.importorskip("lacoc_server.match.match")
world = pytest.importorskip("lacoc_server.world.world")
reader = pytest.importorskip("lacoc_shared.record.reader")

GUIDE = (Path(__file__).parents[2] / "docs" / "write-an-arena.md").read_text(encoding="utf-8")
"""The guide for writing an arena. The game is cut out of it and played unchanged."""
PARTS = dict(re.findall(r"^`(\w+\.\w+)`:\n\n```\w+\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL))


@pytest.fixture
def race(tmp_path: Path) -> Path:
    """Give a folder with the game that docs/write-an-arena.md builds."""
    folder = tmp_path / "race_of_another"
    folder.mkdir()
    assert set(PARTS) == {"arena.toml", "rules.py", "field.py", "bots.py"}
    for name, text in PARTS.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def play_race(ground: arena.Arena) -> None:
    spec = mujoco.MjSpec()
    ground.build_field(spec)
    assert spec.compile().geom("marker:line:neutral").rgba[3] == 1
    views = tuple(RobotView(x, 0.0, 0.07, 1.0, 0.0, 0.0, 0.0) for x in (0.01, 0.5))
    state, events = ground.game.step(ground.game.start(), views, 0.02)
    assert [render(event.said.with_values(team="Ants")) for event in events] == ["Ants is first."]
    assert render(ground.game.over(state) or "") == "the race is won"
    assert list(ground.bots) == ["runner"]
    assert ground.match.duration_s == 60.0


def test_game_in_a_folder(race: Path) -> None:
    """A game in a folder is played by naming the folder."""
    ground = arena.load(str(race), {"game": {"length_m": 4}})
    assert ground.game.size_m == (4.0, 1.0)
    assert ground.name == str(race)
    play_race(ground)
    play_race(arena.from_settings(ground.name, ground.settings, ground.folder))


def test_changed_code_of_a_folder_is_played(race: Path) -> None:
    """Who changes the code of a game while Python runs plays the new code; an old arena stays."""
    rules = race / "rules.py"
    before = arena.load(str(race))
    assert arena.load(str(race))._module == before._module, "nothing has changed"
    text = rules.read_text()
    rules.write_text(text.replace("(length_m, 1.0)", "(length_m, 1.25)"))
    assert arena.load(str(race)).game.size_m == (3.0, 1.25)
    rules.write_text("no Python")
    with pytest.raises(UserError, match=r"rules.py, line 1\) raised SyntaxError"):
        arena.load(str(race))
    assert before.game.size_m == (3.0, 1.0)


def test_a_folder_that_breaks_breaks_again(race: Path) -> None:
    """A folder whose package raises an error is not taken for imported the next time."""
    (race / "__init__.py").write_text("raise ImportError('not today')")
    for _ in range(2):
        with pytest.raises(ImportError, match="not today"):
            arena.load(str(race))


def test_a_folder_runs_no_code_because_a_record_names_it(race: Path) -> None:
    """A record can't make a court import a folder; only the user can, by naming it."""
    (race / "__init__.py").write_text("raise SystemExit('code of a stranger')")
    settings = tomllib.loads((race / "arena.toml").read_text())
    for name in (str(race), os.path.relpath(race)):
        with pytest.raises(
            UserError, match=r"There is no arena .* if you name the folder yourself"
        ):
            arena.from_settings(name, settings)
    with pytest.raises(SystemExit, match="code of a stranger"):
        arena.from_settings(str(race), settings, race)


def test_game_installed_by_entry_point(race: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A game whose package is installed is played by its name."""
    info = race.parent / "race_of_another-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: race-of-another\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[lacoc.arenas]\nrace = race_of_another\n")
    monkeypatch.syspath_prepend(str(race.parent))
    assert "race" in plugins.installed("lacoc.arenas")
    ground = arena.load("race")
    assert ground.name == "race"
    play_race(ground)
    for module in [m for m in sys.modules if m.split(".")[0] == "race_of_another"]:
        monkeypatch.delitem(sys.modules, module)


@pytest.mark.parametrize("name", ["othello", "flag_strike", "practice"])
def test_copied_folder_is_a_game(name: str, tmp_path: Path) -> None:
    """A copy of a game's folder with a changed file is a game of its own."""
    original = plugins.folder_of(plugins.package("lacoc.arenas", "arena", name.replace("_", "-")))
    folder = tmp_path / name
    shutil.copytree(original, folder, ignore=shutil.ignore_patterns("__pycache__"))
    file = folder / "arena.toml"
    file.write_text(file.read_text().replace('title = "', 'title = "Our '))
    ground = arena.load(str(folder))
    assert ground.title == f"Our {tomllib.loads((original / 'arena.toml').read_text())['title']}"
    spec = mujoco.MjSpec()
    ground.build_field(spec)
    assert spec.compile().ngeom > 5
    assert ground.bots


def test_the_guide_names_all_that_a_game_has() -> None:
    """docs/write-an-arena.md names every rule, field, setting and building block of a game."""
    rules = {name for name in vars(Game) if not name.startswith("_")} | set(Game.__annotations__)
    fields = {name for kind in (RobotView, Place) for name in kind._fields}
    fields |= {f.name for kind in (GameEvent, MarkerInfo) for f in msgspec.structs.fields(kind)}
    settings = {f.name for f in msgspec.structs.fields(arena.MatchSettings)}
    pieces = {name for name, value in vars(field).items() if inspect.isfunction(value)}
    for name in rules | fields | settings | pieces:
        assert re.search(rf"`[^`]*\b{name}\b[^`]*`", GUIDE), name


def test_the_key_of_the_guide_s_bot_is_one(race: Path) -> None:
    """The second bot of docs/write-an-arena.md works exactly as printed."""
    (turner,) = re.findall(r"```python\n(from lacoc_arenas.bot.*?)^```", GUIDE, re.M | re.S)
    bots = race / "bots.py"
    bots.write_text(turner + "\nBOTS = {'turner': turner}\n")
    brain = brains.find(arena.load(str(race)), "turner")(None, 0)  # type: ignore[arg-type]
    frame = SimpleNamespace(clock_ticks=5)
    assert brain(frame) == (Level.LOCOMOTION, 1)  # type: ignore[arg-type]


def use(folder: Path) -> None:
    """Call every part of an arena that a court uses before a match."""
    ground = arena.load(str(folder))
    assert ground.bots
    spec = mujoco.MjSpec()
    ground.build_field(spec)
    scenes.make_scene(spec.compile(), ground.game, ("left", "right"))


WRONG = {
    "make": ("rules.py", "return Race(", "return object() or Race(", "has no state_type, markers"),
    "raises": ("rules.py", "return Race(", "return {}['x'](", r"line \d+\) raised KeyError: 'x'"),
    "no board": ("rules.py", "def board", "def bord", "which has no board"),
    "short board": (
        "rules.py",
        "(state.line,)",
        "()",
        r"board returned \(\). Expected a tuple of 1",
    ),
    "score": ("rules.py", "(int(state.line == LEFT), ", "(0.5, ", r"score returned \(0.5, 0\)"),
    "over": ("rules.py", "else None", "else False", "over returned False. Expected a Phrase"),
    "winner": (
        "rules.py",
        "leader(scores)",
        "2",
        "winner returned 2. Expected the index",
    ),
    "rule": ("rules.py", "rule = RULE", "rule = 3", "rule is 3. Expected a Phrase"),
    "gains": (
        "rules.py",
        "    def winner",
        "    def gains(self, state, seat):\n        return 3\n\n    def winner",
        "gains returned 3. Expected a Gains",
    ),
    "state": ("rules.py", "return State()", "return 3", "start returned 3. Expected a State"),
    "markers": (
        "rules.py",
        "markers = (Mark",
        "markers = 3 or (Mark",
        "markers is 3. Expected",
    ),
    "starts": ("rules.py", "self.starts = (", "self.starts = [] or (() ,", "starts is "),
    "size": ("rules.py", "(length_m, 1.0)", "(length_m, 0)", r"size_m is \(3.0, 0\)"),
    "syntax": ("rules.py", "class Race:", "class Race", r"rules.py, line \d+\) raised SyntaxError"),
    "no make": ("rules.py", "def make", "def build", "rules.py has no make"),
    "setting": ("arena.toml", "3.0", "0.5", r"table \[game\] .* is not from 1 to 20"),
    "BOTS": ("bots.py", '{"runner": straight}', "3", "BOTS in bots.py is 3. Expected a dict"),
    "build": (
        "field.py",
        "game.size_m",
        "game.siez_m",
        r"build \(.*, line 7\) raised Attr",
    ),
    "geom": (
        "field.py",
        '("line"',
        '("lime"',
        "Expected marker:NAME:STATE with the name",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_arena_is_told_in_one_sentence(race: Path, case: str) -> None:
    """One sentence tells which part of the arena is wrong, what it gave and what is expected."""
    name, was, now, says = WRONG[case]
    text = (race / name).read_text()
    assert text.count(was) == 1
    (race / name).write_text(text.replace(was, now))
    with pytest.raises(UserError, match=says):
        use(race)


@pytest.mark.parametrize(
    ("was", "now", "says"),
    [
        ("return State(seat + 1), (event,)", "return 1", "step returned 1. Expected the state"),
        ("return State(seat + 1), (event,)", "return state, (7,)", "events that are each a Game"),
        ("State(seat + 1), (event,)", "1, ()", "step returned 1. Expected a State"),
        ('marker="line", points', 'marker="lime", points', "'lime' is not one of them"),
        ("said=FIRST", "said=3", "an event with a Phrase in its field 'said'"),
        ("past.index(True)", "past.index(5)", r"step \(.*rules.py, line \d+\) raised ValueError"),
    ],
)
def test_a_wrong_answer_in_a_match_is_told(race: Path, was: str, now: str, says: str) -> None:
    """If a rule returns a wrong value during a match, the error is raised in that tick."""
    text = (race / "rules.py").read_text()
    assert text.count(was) == 1
    (race / "rules.py").write_text(text.replace(was, now))
    with pytest.raises(UserError, match=says):
        play_race(arena.load(str(race)))


def test_a_referee_s_wrong_state_stays_a_value_error(race: Path) -> None:
    """A marker state that a referee can't set is not reported as a mistake of the arena."""
    game = arena.load(str(race)).game
    with pytest.raises(NoSuchState, match="neutral, left or right"):
        game.set(game.start(), 0, 3)


def test_the_guide_s_game_is_played(race: Path, tmp_path: Path) -> None:
    """Two bots play the race of docs/write-an-arena.md, and the left one wins."""
    overrides = {"game": {"length_m": 1.2}, "match": {"duration_s": 20.0}}
    ground = arena.load(str(race), overrides)
    setup = Setup(
        match_id="race", court="c", match=1, arena=ground.name, settings=ground.settings, limits={}
    )
    players = [simulation.player(ground, seat, "runner", late_ticks=5 * seat) for seat in (0, 1)]
    result = simulation.simulate(setup, players, tmp_path / "records", arena=ground.folder)
    assert (render(result.reason), result.scores) == ("the race is won", (1, 0))
    assert result.official == "left"


@pytest.mark.parametrize(
    ("was", "now", "says"),
    [
        ("past.index(True)", "past.index(5)", "step .* raised ValueError"),
        ("(state.line,)", "(9 * state.line,)", r"board returned \(9,\)"),
        ("(int(state.line == LEFT), ", "(state.line and 0.5, ", r"score returned \(0.5, 0\)"),
        ("leader(scores)", "5 if any(scores) else None", "winner returned 5"),
    ],
)
def test_a_court_goes_on_when_a_game_breaks(
    race: Path, tmp_path: Path, was: str, now: str, says: str
) -> None:
    """At a court an error of the rules halts the match; its record has every beat, and is proven.

    Without a court the author of the game sees the error.
    """
    text = (race / "rules.py").read_text()
    assert text.count(was) == 1
    (race / "rules.py").write_text(text.replace(was, now))
    ground = arena.load(str(race), {"game": {"length_m": 1.2}, "match": {"duration_s": 20.0}})
    setup = Setup(
        match_id="race", court="c", match=1, arena=ground.name, settings=ground.settings, limits={}
    )
    players = [simulation.player(ground, seat, "runner", late_ticks=5 * seat) for seat in (0, 1)]
    with pytest.raises(UserError, match=says):
        simulation.simulate(setup, players, arena=ground.folder)

    match = matches.Match(setup, world.World, ground.folder)
    match.survives_rules = True
    journal = journals.Journal(match, tmp_path)
    for _ in headless._follow(
        inputs.whole_match(players, match.sheet), lambda items: journal.beat(items)[0]
    ):
        pass
    journal.close()
    assert match.phase is Phase.VOID, "it was halted, so it has no result"
    record = reader.Record.read(journal.writer.path)
    faults = [event for event in record.events if event.kind == "rules"]
    assert [bool(re.search(says, render(fault.said))) for fault in faults] == [True]
    elsewhere = shutil.copytree(race, tmp_path / "on another machine")
    *_, verdict = replay.verify(record, elsewhere, processes=1)
    assert verdict.kind is replay.VerdictKind.SAME


def test_a_proof_with_broken_rules_says_where_they_break(race: Path, tmp_path: Path) -> None:
    """Rules that break only now prove nothing about a record; their author reads the line."""
    ground = arena.load(str(race), {"game": {"length_m": 1.2}, "match": {"duration_s": 20.0}})
    setup = Setup(
        match_id="race", court="c", match=1, arena=ground.name, settings=ground.settings, limits={}
    )
    players = [simulation.player(ground, seat, "runner", late_ticks=5 * seat) for seat in (0, 1)]
    simulation.simulate(setup, players, tmp_path, arena=ground.folder)
    record = reader.Record.read(tmp_path / "race.mcap")
    broken = shutil.copytree(race, tmp_path / "broken")
    text = (broken / "rules.py").read_text()
    (broken / "rules.py").write_text(text.replace("past.index(True)", "past.index(5)"))
    with pytest.raises(UserError, match=r"rules.py, line \d+\) raised ValueError"):
        [*replay.verify(record, broken, processes=1)]
