"""docs/rules.md, which contestants read, states the numbers that the software uses."""

import math
import re
from pathlib import Path

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot
from lacoc_robots.limits import Limits
from lacoc_robots.robot_file import read_robot

PAGE = (Path(__file__).parents[2] / "docs" / "rules.md").read_text(encoding="utf-8")
SECTIONS = dict(
    re.findall(r"^## (?:\d+\. )?([^\n]+)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
)


def settings(name: str) -> dict[str, object]:
    return arenas.load(name).settings["game"]  # type: ignore[no-any-return]


def test_limits_for_robots() -> None:
    """docs/rules.md states the default limits for robots."""
    limits = Limits()
    text = SECTIONS["Your robot"]
    for phrase in (
        f"{limits.width_m} x {limits.length_m} x {limits.height_m} m",
        f"{limits.mass_min_kg:g} to {limits.mass_max_kg:g} kg",
        f"{limits.part_mass_min_kg:g} to {limits.part_mass_max_kg:g} kg",
        f"{limits.link_min_m:g} to {limits.link_max_m:g} m long",
        f"radius {limits.radius_min_m:g} to {limits.radius_max_m:g} m",
        f"±{limits.range_deg:g} degrees",
        f"at most {limits.ang_min_deg_s:g} degrees/s",
        f"at most {limits.torque_n_m:g} N m",
        f"0 to {limits.hold_s:g} s",
    ):
        assert phrase in text, phrase


def test_a_match() -> None:
    """docs/rules.md states the length of a match, its countdown and the freeze after [x]."""
    for name in ("othello", "flag-strike"):
        match = arenas.load(name).match
        assert f"lasts {match.duration_s / 60:g} minutes" in SECTIONS["A match"]
        assert f"{match.countdown_s:g} seconds of countdown" in SECTIONS["A match"]
        assert f"{match.restart_freeze_s:g} seconds of the clock" in SECTIONS["Your keys"]
        assert match.levels == ("B",)


def test_othello() -> None:
    """docs/rules.md states Robot-Othello's numbers."""
    game, text = settings("othello"), SECTIONS["Robot-Othello"]
    assert f"{game['pitch_m']:.2f} m from middle to middle" in text
    assert f"{game['disc_radius_m']} m in radius" in text
    assert f"wall {game['wall_m']} m outside" in text
    cells = game["start_cells"]
    assert isinstance(cells, list)
    assert f"column {cells[0][0]}, row {cells[0][1]}" in text
    assert f"column {5 - cells[0][0]}, row {5 - cells[0][1]}" in text
    assert f"left on rows {', '.join(str(row) for _, row in cells)}" in text
    assert f"right on rows {', '.join(str(5 - row) for _, row in cells)}" in text
    assert game["opening"] == "halves"
    assert game["flank"] is True


def test_flag_strike() -> None:
    """docs/rules.md states Flag-Strike's numbers."""
    game, text = settings("flag-strike"), SECTIONS["Flag-Strike"]
    assert "{} x {} m".format(*game["size_m"]) in text  # type: ignore[misc]
    assert f"radius {game['corner_radius_m']} m" in text
    assert f"{game['corner_inset_m']:.2f} m from both walls" in text
    assert f"counts {game['corner_points']} points" in text
    assert f"(radius {game['pole_radius_m']} m, height {game['pole_height_m']} m)" in text
    assert f"nearer than {game['clearance_m']} m" in text
    starts = game["starts"]
    assert isinstance(starts, list)
    left = ", ".join(f"({x:g}, {y:g})" for x, y in starts)
    right = ", ".join(f"({-x:g}, {-y:g})".replace("-0)", "0)") for x, y in starts)
    assert f"left {left}, right {right}" in text
    colours = game["colour"]
    assert isinstance(colours, list)
    rows = [f"| {len(c['flags'])} {c['name']} | {c['points']} |" for c in colours]
    assert "\n".join(rows) in text
    assert f"{sum(len(c['flags']) * c['points'] for c in colours)} points" in text


def test_practice() -> None:
    """docs/rules.md states the size of practice's field and its limit for silence in minutes."""
    size = settings("practice")["size_m"]
    text = SECTIONS["Practice"]
    assert "{} x {} m".format(*size) in text  # type: ignore[misc]
    minutes = arenas.load("practice").match.unattended_s / 60
    assert f"heard of you for {minutes:g} minutes" in text


def test_the_workshops_robot() -> None:
    """docs/rules.md states the numbers of the workshop's robot."""
    file, data = find_robot("hexapod")
    robot = read_robot(data, file)
    text = SECTIONS["Your robot"]
    assert f"{len(robot.legs)} legs".replace("6", "six") in text
    assert f"weighs {robot.mass_kg:.3f} kg" in text
    assert f"at {math.degrees(robot.ang_min_rad_s):.0f} degrees a second" in text
    assert " · ".join(f"{leg} {label}" for leg, label in enumerate(robot.labels)) in text
    low_rad, high_rad = robot.ranges_rad[0]
    assert f"between {math.degrees(low_rad):.0f} and +{math.degrees(high_rad):.0f} deg" in text
