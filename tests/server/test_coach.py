"""Tests of the coach: it ranks the numbers of a table, and improves a gait by few changes."""

import contextlib
import json
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_walks import course_of, entry_of

from lacoc_robots.library import find_robot
from lacoc_robots.reading import load_gait
from lacoc_robots.robot_file import read_robot
from lacoc_server.studio.answers import try_gait
from lacoc_server.studio.coach.coach import CoachFound, coached_key
from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.studio.coach.improve import Size, improve
from lacoc_server.studio.coach.matter import STEP_DEG, what_matters
from lacoc_server.studio.coach.search import Improved, Search
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.studio.coach.trials import Task, try_table
from lacoc_server.studio.coach.undo import undo
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.goal import Goal
from lacoc_shared.command import cli
from lacoc_shared.gait.tables import LocomotionTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.mistakes import UserError

SAMPLE = Path(__file__).parents[2] / "robots/lacoc_robots/samples/hexapod/Loco-data.txt"
BEST = (12, -7, 30, 5, 0, 21)
"""The best table of the made-up score below."""
RANGES = [(-60.0, 60.0)] * len(BEST)
WEIGHTS = (5.0, 4.0, 3.0, 2.0, 1.0, 0.5)


def made_up(tables: Sequence[Angles]) -> list[float]:
    """Score each table by its distance from `BEST`, with a different weight for each number."""
    return [
        1000 - sum(w * (a - b) ** 2 for w, a, b in zip(WEIGHTS, table, BEST, strict=True))
        for table in tables
    ]


def searched(size: Size, rounds: int = 40) -> Improved:
    """Search from zero angles for some rounds, undo changes that hardly help, return the result."""
    left = iter(range(rounds))
    own = (0,) * len(BEST)
    matters = what_matters(own, RANGES, made_up)
    search = Search(own, RANGES, made_up)
    found = improve(search, size, matters, made_up, lambda: next(left, None) is None, seed=1)
    *_, last = [*found, *undo(search, matters, made_up)]
    return last


def changes(found: Improved) -> int:
    """Count the angles of the found table that differ from zero."""
    return sum(angle != 0 for angle in found.angles_deg)


def test_a_size_limits_the_changes() -> None:
    """A search may change one number, at most three, or all; more changes give a better table."""
    cell, three, table = (searched(size) for size in Size)
    assert (changes(cell), changes(three)) == (1, 3)
    assert made_up([(0,) * 6])[0] < cell.score < three.score < table.score
    assert table.score > 990


def test_a_number_is_turned_to_its_best_degree() -> None:
    """If only one number affects the score, a search changes only this one, to its best degree."""

    def one_number(tables: Sequence[Angles]) -> list[float]:
        return [100.0 - (table[0] - 12) ** 2 for table in tables]

    own = (0,) * len(BEST)
    matters = what_matters(own, RANGES, one_number)
    search = Search(own, RANGES, one_number)
    *_, last = improve(search, Size.THREE, matters, one_number, lambda: False, seed=1)
    assert last.angles_deg == (12, *own[1:])


def test_the_same_seed_finds_the_same() -> None:
    """Two searches with the same seed and the same number of rounds give the same result."""
    assert searched(Size.TABLE, 20) == searched(Size.TABLE, 20)


def test_a_change_that_hardly_helps_is_undone() -> None:
    """The coach undoes a change that improves the score by very little."""

    def dull(tables: Sequence[Angles]) -> list[float]:
        return [100 - abs(table[0] - 20) - 0.01 * abs(table[1] - 20) for table in tables]

    left = iter(range(60))
    matters = what_matters((0, 0), RANGES[:2], dull)
    over = lambda: next(left, None) is None  # noqa: E731
    search = Search((0, 0), RANGES[:2], dull)
    *_, found = improve(search, Size.TABLE, matters, dull, over, seed=3)
    assert found.angles_deg[1] != 0
    *_, last = undo(search, matters, dull)
    assert last.angles_deg[1] == 0
    assert abs(last.angles_deg[0] - 20) <= 2


def test_what_matters_is_ranked() -> None:
    """The coach tries each number 10 degrees higher and lower, and tells both effects.

    It ranks the numbers by the larger of the two effects on the score.
    """
    found = what_matters((0,) * 6, RANGES, made_up)
    assert [one.size for one in found] == sorted((one.size for one in found), reverse=True)
    assert {one.number for one in found} == set(range(6))
    first = next(one for one in found if one.number == 0)
    up, down = made_up([(STEP_DEG, *(0,) * 5), (-STEP_DEG, *(0,) * 5)])
    now = made_up([(0,) * 6])[0]
    assert (first.up, first.down) == (up - now, down - now)


@given(st.data())
def test_a_table_keeps_its_sequence(data: st.DataObject) -> None:
    """Postures of one digit share a row of the table; changing one angle changes no other angle."""
    posture = st.tuples(*[st.floats(-1, 1)] * 3)
    rows = data.draw(st.lists(posture, min_size=1, max_size=4))
    order = data.draw(st.lists(st.integers(0, len(rows) - 1), min_size=1, max_size=8))
    sequence = tuple(rows[index] for index in order)
    table = KeyTable.of(sequence, order)
    assert len(table.rows) == len(set(order))
    assert len(KeyTable.of(sequence).rows) == len(sequence)
    assert table.sequence(table.angles_deg) == sequence
    number = data.draw(st.integers(0, len(table.angles_deg) - 1))
    turned = list(table.angles_deg)
    turned[number] += 7
    row, joint = table.cell(number)
    for posture_now, index in zip(table.sequence(tuple(turned)), table.order, strict=True):
        wanted = list(table.rows[index])
        if index == row:
            wanted[joint] = math.radians(turned[number])
        assert posture_now == tuple(wanted)


def test_goals() -> None:
    """Goal "forward" scores speed; "left" and "right" score turning to that side.

    A robot that lies on its belly for half of the time scores below 0.
    """
    task = sample_task(2)
    forward = try_table(task, task.table.angles_deg)
    left = try_table(sample_task(1), sample_task(1).table.angles_deg)
    assert goal_score(forward, Goal.FORWARD) == pytest.approx(forward.speed_mm_s, abs=5)
    assert goal_score(left, Goal.LEFT) > 40 > 0 > goal_score(left, Goal.RIGHT)
    lies = Figures(**{**vars(forward), "belly_share": 0.5})
    assert goal_score(lies, Goal.FORWARD) < 0


def sample_task(key: int) -> Task:
    """Return the task to improve a key of the hexapod's sample gait for goal "forward"."""
    entry = entry_of("hexapod")
    assert entry.gait.locomotion is not None
    sequences = entry.gait.locomotion.sequences
    return Task(entry.robot, sequences[0], KeyTable.of(sequences[key]), Goal.FORWARD, key)


@pytest.mark.slow
@pytest.mark.long
def test_the_command_finds_other_gaits(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """`lacoc coach --map` writes a gait for each cell of the map; `--variants` writes six gaits.

    From the gaits that `--keep` names, the coach breeds new variants. It refuses options that
    don't combine.
    """

    def found(*words: str) -> Any:
        with contextlib.suppress(SystemExit):
            cli.main(["coach", str(SAMPLE), *words, "--json"])
        return json.loads(capsys.readouterr().out)

    cells = found("--map", "--seconds", "1", "--out", str(tmp_path / "map"))["cells"]
    assert len(cells) == len([*(tmp_path / "map").iterdir()]) > 0
    six = tmp_path / "six"
    assert len(found("--variants", "--out", str(six))["variants"]) == 6
    keep = [word for n in (2, 5) for word in ("--keep", str(six / f"variant-{n}.txt"))]
    assert len(found("--variants", *keep)["variants"]) == 6
    for wrong in (["--map", "--size", "cell"], ["--map", *keep], ["--variants", "--for", "left"]):
        try:
            code = cli.main(["coach", str(SAMPLE), *wrong])
        except SystemExit as ended:
            code = int(ended.code or 0)
        assert code != 0


def test_the_command_writes_nothing_without_a_search(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """`--out` without a search is refused before anything is tried."""
    assert cli.main(["coach", str(SAMPLE), "--out", str(tmp_path / "better.txt")]) == 2
    assert "--out needs --size, --map or --variants" in capsys.readouterr().err


def test_the_command_says_what_it_writes(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Where nothing better is found, the file has the own gait, and the command says both."""
    figures = try_gait(course_of("hexapod"), entry_of("hexapod").gait, seconds=0.1).figures
    own = sample_task(2).table.angles_deg
    found = CoachFound([], [], Improved(own, 0.0), figures, figures, 0, stopped=False)
    monkeypatch.setattr("lacoc_server.commands.coach.Workers", contextlib.nullcontext)
    monkeypatch.setattr("lacoc_server.commands.coach.coach", lambda *_: found)
    out = tmp_path / "better.txt"
    with pytest.raises(SystemExit, match="0"):
        cli.main(["coach", str(SAMPLE), "--size", "cell", "--out", str(out)])
    said = capsys.readouterr()
    assert "No better gait was found" in said.out
    assert f"{out} written." in said.err
    assert out.exists()


def test_the_command_prints_the_readers_notes(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """What is perhaps not intended in the file is told before the search."""
    file = tmp_path / "Loco-data.txt"
    file.write_text(SAMPLE.read_text().replace("Position\tR,F", "Position\tL,F"))
    assert cli.main(["coach", str(file), "--key", "9"]) == 2
    assert "the legend says L,F, but joint 0 is a joint of leg R,F" in capsys.readouterr().err


def test_a_table_that_makes_no_key_is_told(tmp_path: Path) -> None:
    """Without posture 4 there is no key of level B: the message names the rows of key 2."""
    text = SAMPLE.read_text(encoding="utf-8").replace("Posture\t9", "Posture\t4")
    few = tmp_path / SAMPLE.name
    few.write_text(re.sub(r"^[4-9] Key.*\n", "", text, flags=re.MULTILINE))
    gait = load_gait(few, read_robot(find_robot("hexapod")[1], "robot.toml"))
    with pytest.raises(UserError, match=r"postures 1 to 4\. Type these rows"):
        coached_key(gait, Goal.FORWARD)


@pytest.mark.slow
@pytest.mark.long
def test_the_command(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """`lacoc coach` ranks all numbers; `--size three` repairs a mistake, and writes the gait."""

    def found(*words: str) -> Any:
        with contextlib.suppress(SystemExit):
            cli.main(["coach", *words, "--json"])
        return json.loads(capsys.readouterr().out)

    small = SAMPLE.parents[1] / "quadruped" / SAMPLE.name
    assert len(found(str(small), "--robot", "quadruped")["matters"]) == 48
    wrong, out = tmp_path / "Loco-data.txt", tmp_path / "better.txt"
    row = "1 Key\t0\t0\t-45\t0\t0\t45\t20\t20\t20\t20\t20\t20\t40\t0\t40"
    text = SAMPLE.read_text(encoding="utf-8")
    assert row in text
    wrong.write_text(text.replace(row, row[:-2] + "-40"), encoding="utf-8")
    told = found(str(wrong), "--size", "three", "--seconds", "2", "--out", str(out))
    (change,) = told["changes"]
    assert (change["from_deg"], change["to_deg"]) == (-40, 40)
    (repaired,) = told["repairs"]
    assert "other sign" in repaired["said"]
    assert told["after"]["speed_mm_s"] > 2 * told["before"]["speed_mm_s"]
    assert told["worse"] == []
    assert abs(told["after"]["drift_deg_s"]) < 5
    robot = read_robot(find_robot("hexapod")[1], "robot.toml")
    table = read_gait(out.read_bytes(), out.name, legs=robot.labels, range_deg=robot.ranges_deg)
    assert isinstance(table, LocomotionTable)
    assert len(table.sequences) == 4
