"""Arena files: every setting has an effect, and a wrong setting is named."""

import copy
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest

from lacoc_arenas import arena
from lacoc_arenas.game import LEFT, RobotView
from lacoc_shared import words
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError

mujoco = pytest.importorskip("mujoco")

INSTALLED = ["othello", "flag-strike", "practice"]


def look(name: str, overrides: dict[str, Any] | None = None) -> bytes:
    """Return, as bytes, everything in a game and its field that a setting can change."""
    ground = arena.load(name, overrides)
    game = ground.game
    spec = mujoco.MjSpec()
    ground.build_field(spec)
    model = spec.compile()
    said = [
        game.markers,
        game.starts,
        game.size_m,
        game.start(),
        [game.winner(_all_left(game), scores) for scores in ((1, 2), (2, 1))],
        _flanked(game),
        [model.geom_pos.tolist(), model.geom_size.tolist(), model.geom_rgba.tolist()],
    ]
    return msgspec.msgpack.encode(said)


def _all_left(game: Any) -> Any:
    state = game.start()
    for index in range(len(game.markers)):
        state = game.set(state, index, LEFT)
    return state


def _flanked(game: Any) -> Any:
    """Return the Robot-Othello board after the left robot flips discs; None for other games."""
    if not game.markers or game.markers[0].kind != "disc":
        return None
    state = game.start()
    for index in range(36):
        state = game.set(state, index, LEFT if index in (12, 17) else 2)
    discs = game.markers[13], game.markers[20]
    views = tuple(RobotView(d.x_m, d.y_m, 0.07, 1.0, 0.0, 0.0, 0.0) for d in discs)
    return game.step(state, views, 0.02)[0].cells


SETTINGS: list[tuple[str, str, Any]] = [
    ("othello", "pitch_m", 0.32),
    ("othello", "disc_radius_m", 0.10),
    ("othello", "wall_m", 0.20),
    ("othello", "opening", "checkers"),
    ("othello", "start_cells", [[0, 3], [0, 2]]),
    ("othello", "flank", False),
    ("flag-strike", "size_m", [2.2, 2.0]),
    ("flag-strike", "corner_radius_m", 0.14),
    ("flag-strike", "corner_inset_m", 0.18),
    ("flag-strike", "corner_points", 6),
    ("flag-strike", "all_corners_win", True),
    ("flag-strike", "starts", [[-0.6, 0.0]]),
    ("flag-strike", "pole_radius_m", 0.02),
    ("flag-strike", "pole_height_m", 0.3),
    ("practice", "size_m", [3.0, 2.4]),
    ("practice", "start", [0.5, 0.0]),
    ("practice", "heading_deg", 0.0),
]


@pytest.mark.parametrize(("name", "key", "value"), SETTINGS)
def test_setting_changes_what_it_says(name: str, key: str, value: Any) -> None:
    """Each entry of [game], when overridden, changes the game or its field."""
    assert look(name, {"game": {key: value}}) != look(name)


def test_every_setting_is_tested() -> None:
    """`SETTINGS` has every entry of [game], except two of Flag-Strike that other tests change."""
    for name in INSTALLED:
        tested = {key for arena_name, key, _ in SETTINGS if arena_name == name}
        tested |= {"clearance_m", "colour"} if name == "flag-strike" else set()
        assert tested == arena.load(name).settings["game"].keys()


def test_layout_in_the_file_is_the_layout() -> None:
    """The settings give flags their places and points; another `rgb` changes the field."""
    colours = copy.deepcopy(arena.load("flag-strike").settings["game"]["colour"])
    colours[0]["flags"][0:2] = [[-0.1, 0.5], [0.1, -0.5]]
    colours[1]["points"] = 4
    overrides = {"game": {"colour": colours}}
    game = arena.load("flag-strike", overrides).game
    flags = [marker for marker in game.markers if marker.kind == "flag"]
    assert (flags[0].x_m, flags[0].y_m) == (-0.1, 0.5)
    assert [flag.points for flag in flags] == [1] * 8 + [4] * 6 + [3] * 4 + [5] * 2
    painted = copy.deepcopy(arena.load("flag-strike").settings["game"]["colour"])
    painted[2]["rgb"] = "#123456"
    assert look("flag-strike", {"game": {"colour": painted}}) != look("flag-strike")


def test_match_settings() -> None:
    """A contest may override a match's length and open levels; the arena's other values stay."""
    ground = arena.load("othello", {"match": {"duration_s": 60, "levels": ["A", "B"]}})
    assert ground.match.duration_s == 60.0
    assert ground.match.open_levels == (Level.POSTURE, Level.LOCOMOTION)
    assert ground.match.countdown_s == 3.0


def test_practice_match() -> None:
    """Practice has one seat, both levels, no time limit and no referee (rules 7)."""
    ground = arena.load("practice")
    assert [seat.id for seat in ground.seats] == ["solo"]
    match = ground.match
    assert match.open_levels == (Level.POSTURE, Level.LOCOMOTION)
    assert (match.duration_s, match.countdown_s, match.restart_freeze_s) == (0.0, 0.0, 0.0)
    assert (match.start, match.unattended_s) == ("ready", 900.0)


@pytest.mark.parametrize("name", ["othello", "flag-strike"])
def test_seats_of_the_games(name: str) -> None:
    """The left seat is blue without a pattern; the right seat is orange with stripes."""
    seats = arena.load(name).seats
    assert [(seat.id, seat.colour, seat.pattern) for seat in seats] == [
        ("left", "#0072b2", "plain"),
        ("right", "#e69f00", "stripes"),
    ]


def test_file_is_the_only_source() -> None:
    """The code has no defaults for entries of [game]: leaving one out is an error."""
    for name in INSTALLED:
        for key in arena.load(name).settings["game"]:
            settings = copy.deepcopy(arena.load(name).settings)
            del settings["game"][key]
            with pytest.raises(UserError, match=f'entry "{key}" is missing'):
                arena.from_settings(name, settings)


def edit_flags(edit: Callable[[list[dict[str, Any]]], None]) -> dict[str, Any]:
    colours = copy.deepcopy(arena.load("flag-strike").settings["game"]["colour"])
    edit(colours)
    return {"colour": colours}


def move(colour: int, flag: int, *places: list[float]) -> dict[str, Any]:
    def edit(colours: list[dict[str, Any]]) -> None:
        colours[colour]["flags"][flag : flag + len(places)] = places

    return edit_flags(edit)


WRONG: list[tuple[str, dict[str, Any], str]] = [
    ("othello", {"pich_m": 0.3}, 'no entry "pich_m"'),
    ("othello", {"pitch_m": "wide"}, ": pitch_m: expected a number, without quotes, found text"),
    ("othello", {"pitch_m": float("nan")}, ": pitch_m: expected a number above 0"),
    ("othello", {"wall_m": float("inf")}, ": wall_m: expected a number of at most 20"),
    ("othello", {"wall_m": 0.0}, ": wall_m: "),
    (
        "othello",
        {"disc_radius_m": 0.16},
        "disc_radius_m 0.16 is more than half of pitch_m 0.3: the discs overlap; make the radius "
        "smaller or the pitch larger",
    ),
    ("othello", {"opening": "chess"}, ': opening: "chess" is not possible.'),
    ("othello", {"start_cells": []}, ": start_cells: "),
    (
        "othello",
        {"start_cells": [[3, 0]]},
        ": start_cells[0][0]: expected a whole number of at most 2",
    ),
    (
        "othello",
        {"start_cells": [[0, 6]]},
        ": start_cells[0][1]: expected a whole number of at most 5",
    ),
    ("othello", {"start_cells": [[0, 1], [0, 1]]}, ": start_cells names a cell twice"),
    ("othello", {"flank": "yes"}, ": flank: "),
    (
        "flag-strike",
        {"size_m": [2.4, 2.0], "corner_inset_m": 0.9},
        "corner_inset_m 0.9 and corner_radius_m 0.15 make the corners overlap in a field of "
        "2.4 x 2.0 m",
    ),
    ("flag-strike", {"starts": [[-1.2, 0.0]]}, "the start [-1.2, 0.0] is outside the walls"),
    ("flag-strike", {"starts": [[-1.0, 0.0]]}, "the start [-1.0, 0.0] is outside the walls"),
    ("flag-strike", {"starts": [[-0.6, 1.0]]}, "the start [-0.6, 1.0] is outside the walls"),
    ("flag-strike", {"corner_points": 0}, ": corner_points: "),
    (
        "flag-strike",
        {"clearance_m": 0.34},
        "flag10 (yellow, [-0.34, 0.6]) is 0.328 m from the left start [-0.6, 0.4], nearer than "
        "clearance_m 0.34; flag11",
    ),
    (
        "flag-strike",
        move(0, 4, [-0.40, 0.05], [0.40, -0.05]),
        "flag4 (green, [-0.4, 0.05]) is 0.206 m from the left start [-0.6, 0.0], nearer than "
        "clearance_m 0.25",
    ),
    (
        "flag-strike",
        move(0, 0, [0.40, 0.05], [-0.40, -0.05]),
        "flag0 (green, [0.4, 0.05]) is 0.206 m from the right start [0.6, 0.0]",
    ),
    (
        "flag-strike",
        {"starts": [[-0.6, 0.4]], **move(0, 0, [0.40, -0.35], [-0.40, 0.35])},
        "flag0 (green, [0.4, -0.35]) is 0.206 m from the right start [0.6, -0.4]",
    ),
    (
        "flag-strike",
        move(3, 0, [0.5, 0.6], [-0.5, -0.6]),
        "flag18 (black, [0.5, 0.6]) is 0.211 m from the edge of corner3",
    ),
    (
        "flag-strike",
        move(1, 0, [-0.16, 0.01]),
        "flag8 (yellow, [-0.16, 0.01]) has no partner: another yellow flag must stand at "
        "[0.16, -0.01]",
    ),
    ("flag-strike", move(3, 0, [0.0, 0.0]), "flag18 (black, [0.0, 0.0]) has no partner"),
    ("flag-strike", move(2, 0, [0.14, 0.82]), "stands where flag14 (purple, [0.14, 0.82]) stands"),
    (
        "flag-strike",
        move(3, 0, [1.2, 0.0], [-1.2, 0.0]),
        "flag18 (black, [1.2, 0.0]) stands outside the walls; ",
    ),
    ("flag-strike", edit_flags(lambda c: c[0]["flags"].pop()), "there are 19 flags, expected 20"),
    (
        "flag-strike",
        edit_flags(lambda c: c[3].update(points=1)),
        ": two colours of flags have the same points; each needs its own",
    ),
    (
        "flag-strike",
        edit_flags(lambda c: c[3].update(name="green")),
        ": two colours of flags have the same name",
    ),
    ("flag-strike", edit_flags(lambda c: c[0].update(rgb="green")), ": colour[0].rgb: "),
    ("flag-strike", {"colour": []}, "there are 0 colours of flags, expected 4"),
    ("practice", {"start": [1.2, 0.0]}, "start [1.2, 0.0] is outside the walls"),
    ("practice", {"heading_deg": float("nan")}, ": heading_deg: "),
]


@pytest.mark.parametrize(
    "game",
    [
        {"size_m": [2.4, 2.0], "starts": [[-1.1, 0.0]]},
        {"corner_inset_m": 0.52, "clearance_m": 0.01},
    ],
)
def test_a_field_of_other_measures(game: dict[str, Any]) -> None:
    """A field of another size is accepted if its parts are within the walls and don't overlap."""
    assert arena.load("flag-strike", {"game": game}).game.markers


@pytest.mark.parametrize(("name", "game", "says"), WRONG)
def test_wrong_game_setting(name: str, game: dict[str, Any], says: str) -> None:
    """A wrong entry of [game] is refused, and the message names the setting or the flag.

    It says whether the entry is in the file, or was given to replace one of the file.
    """
    with pytest.raises(UserError) as refused:
        arena.load(name, {"game": game})
    assert f'The settings given for arena "{name}" are wrong: game' in str(refused.value)
    assert says.removeprefix(": ") in str(refused.value)
    whole = arena.merge(arena.load(name).settings, {"game": game})
    with pytest.raises(UserError) as refused:
        arena.from_settings(name, whole)
    assert f'The table [game] of arena "{name}" is wrong: ' in str(refused.value)
    assert says in str(refused.value)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"match": {"duration_s": -1}}, ": match.duration_s: "),
        ({"match": {"levels": []}}, ": match.levels: "),
        ({"match": {"levels": ["C"]}}, ": match.levels[0]: "),
        ({"match": {"start": "now"}}, ": match.start: "),
        ({"match": {"minutes": 3}}, 'no entry "minutes". Allowed entries: duration_s, '),
        ({"seat": [{"id": "left", "colour": "blue"}]}, ": seat[0].colour: "),
        ({"seat": [{"id": "left", "colour": "#0072b2"}]}, "needs 2 [[seat]] tables"),
        ({"seat": [{"id": "a", "colour": "#0072b2"}] * 2}, "each with its own id; found a and a"),
        ({"titel": "x"}, 'no entry "titel". Allowed entries: title, match, seat, game.'),
    ],
)
def test_wrong_common_setting(overrides: dict[str, Any], says: str) -> None:
    """A setting of all games that has a wrong value is refused, and the message names it.

    It says whether the setting is in the file, or was given to replace one of the file.
    """
    whole = arena.merge(arena.load("othello").settings, overrides)
    for load, given, where in (
        (arena.load, overrides, 'The settings given for arena "othello" are wrong: '),
        (arena.from_settings, whole, 'The file of arena "othello" is wrong: '),
    ):
        with pytest.raises(UserError) as refused:
            load("othello", given)
        assert where in str(refused.value)
        assert says in str(refused.value)


def test_unknown_arena() -> None:
    """Loading an unknown arena raises UserError, which lists the installed ones."""
    with pytest.raises(UserError, match=r"no arena .chess.\. Installed: .*othello.*practice"):
        arena.load("chess")


def test_unreadable_file(tmp_path: Path) -> None:
    """The message about an arena file that is not valid TOML names the file."""
    for name in ("rules.py", "field.py", "bots.py"):
        (tmp_path / name).touch()
    (tmp_path / "arena.toml").write_text("title =")
    with pytest.raises(UserError, match=r"arena\.toml can't be read: Invalid value"):
        arena.load(str(tmp_path))


def test_a_folder_that_is_no_whole_arena(tmp_path: Path) -> None:
    """A folder without all files of an arena is refused.

    The error names the missing files. It also says in which table of a contest file numbers can
    be changed without a folder.
    """
    with pytest.raises(UserError, match=r"lacks arena\.toml, rules\.py, field\.py and bots\.py\. "):
        arena.load(str(tmp_path))
    (tmp_path / "arena.toml").write_text("title = ''")
    (tmp_path / "bots.py").touch()
    with pytest.raises(
        UserError, match=r"lacks rules\.py and field\.py\. .*\[court\.NAME\.settings"
    ):
        arena.load(str(tmp_path))
    with pytest.raises(UserError, match=r"lacks rules\.py"):
        arena.from_settings(str(tmp_path), {}, tmp_path)


@pytest.mark.parametrize("name", INSTALLED)
def test_settings_make_the_same_arena_again(name: str) -> None:
    """The settings that a record keeps make the same arena again."""
    first = arena.load(name)
    settings = msgspec.msgpack.decode(msgspec.msgpack.encode(first.settings))
    again = arena.from_settings(first.name, settings)
    assert again.settings == first.settings
    assert again.game.start() == first.game.start()
    assert again.game.markers == first.game.markers


@pytest.mark.parametrize("name", INSTALLED)
def test_state_survives_the_record(name: str) -> None:
    """The start state of a game is the same after packing with msgpack and unpacking."""
    game = arena.load(name).game
    packed = msgspec.msgpack.encode(game.start())
    assert msgspec.msgpack.decode(packed, type=game.state_type) == game.start()


def test_merge_replaces_single_entries() -> None:
    """Merging settings keeps a table's other entries, but replaces a list as a whole."""
    merged = arena.merge({"a": {"b": 1, "c": [1, 2]}, "d": 3}, {"a": {"c": [4]}, "e": 5})
    assert merged == {"a": {"b": 1, "c": [4]}, "d": 3, "e": 5}


def test_a_wrong_setting_in_japanese() -> None:
    """A message in Japanese about a wrong layout contains no English sentence."""
    words.use("ja")
    try:
        with pytest.raises(UserError) as refused:
            arena.load("flag-strike", {"game": move(3, 0, [1.2, 0.0], [-1.2, 0.0])})
        told = str(refused.value)
    finally:
        words.use("en")
    assert "flag18 (black, [1.2, 0.0]) が壁の外にあります。" in told
    assert not re.search(r"[a-z]+ [a-z]+ [a-z]+", told)
