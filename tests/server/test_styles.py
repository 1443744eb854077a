"""Tests of other ways of walking: styles of a table, the map of gaits, and variants."""

import threading
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_walks import entry_of

from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.coach.coach import task_of
from lacoc_server.studio.coach.trials import Task, Trials, try_table
from lacoc_server.studio.styles.archive import (
    Archive,
    MapGrid,
    MapPlace,
    arousal_mm_s,
    grid_of,
    is_sound,
)
from lacoc_server.studio.styles.found import map_reply, variants_reply
from lacoc_server.studio.styles.gait_map import Mapped, fill
from lacoc_server.studio.styles.style import WAYS, Styles, Way, far_apart
from lacoc_server.studio.styles.variants import VARIANTS, vary
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.goal import Goal

GRID = MapGrid(20.0, 6.0)


@pytest.fixture(scope="module")
def workers() -> Iterator[Workers]:
    """Give two processes in which all tests of this module try tables."""
    with Workers(2) as workers:
        yield workers


@cache
def task_for(robot: str) -> Task:
    """Return the task of a search: a sample robot and its key 2 (forward)."""
    entry = entry_of(robot)
    return task_of(entry.robot, entry.gait, 2, Goal.FORWARD, None)


def styles_of(robot: str) -> Styles:
    """Return the styles of a sample robot's key 2 (forward)."""
    task = task_for(robot)
    return Styles(task.robot, task.table)


@cache
def own_figures() -> Figures:
    """Return the figures of the quadruped's own gait, whose trials are short."""
    task = task_for("quadruped")
    return try_table(task, task.table.angles_deg)


def walk(speed_mm_s: float, lift_mm: float, **more: Any) -> Figures:
    """Return figures of a straight walk with a period of 1 s."""
    made = replace(own_figures(), speed_mm_s=speed_mm_s, clearance_mm=lift_mm, cycle_s=1.0)
    return replace(made, upright=1.0, belly_share=0.0, drift_deg_s=0.0, lateral_mm_s=0.0, **more)


@pytest.mark.parametrize("robot", ["hexapod", "quadruped", "octopod"])
@pytest.mark.parametrize("way", WAYS)
def test_a_step_in_a_way_is_measured_as_one(robot: str, way: Way) -> None:
    """If `turned` moves a table one step in a `Way`, such as WIDTH, `look` measures about 1."""
    styles, own = styles_of(robot), task_for(robot).table.angles_deg
    index = WAYS.index(way)
    for step in (-1.0, 1.0):
        turned = styles.turned(own, step * np.eye(len(WAYS))[index])
        looks = styles.look(turned) - styles.look(own)
        assert 0.4 < looks[index] * step < 1.3, looks


@settings(max_examples=30)
@given(st.lists(st.floats(-6, 6), min_size=len(WAYS), max_size=len(WAYS)))
def test_a_turned_table_is_within_the_ranges(steps: list[float]) -> None:
    """However much `turned` changes a table, it gives whole degrees within the joints' ranges."""
    task = task_for("quadruped")
    own = task.table.angles_deg
    turned = styles_of("quadruped").turned(own, steps)
    ranges_deg = task.robot.ranges_deg * len(task.table.rows)
    assert all(low <= a <= high for a, (low, high) in zip(turned, ranges_deg, strict=True))
    assert all(isinstance(angle, int) for angle in turned)


def test_no_step_changes_nothing() -> None:
    """A table does not change by a step of zero, or when it is mixed with itself."""
    for robot in ("hexapod", "octopod"):
        own, styles = task_for(robot).table.angles_deg, styles_of(robot)
        assert styles.turned(own, [0.0] * len(WAYS)) == own
        assert styles.between(own, own, 0.7) == own


@given(st.lists(st.tuples(*[st.floats(-9, 9)] * 3), min_size=1, max_size=12), st.integers(1, 6))
def test_the_choice_is_far_apart(points: list[tuple[float, ...]], count: int) -> None:
    """The nearest two chosen vectors are at least half as far apart as in the best choice."""
    looks = [np.array(point) for point in points]
    chosen = far_apart(looks, count)
    assert len(chosen) == len(set(chosen)) == min(count, len(looks))

    def least(indices: tuple[int, ...]) -> float:
        pairs = combinations(indices, 2)
        return min((float(np.linalg.norm(looks[a] - looks[b])) for a, b in pairs), default=0.0)

    best = max(least(some) for some in combinations(range(len(looks)), len(chosen)))
    assert least(tuple(chosen)) >= best / 2 - 1e-9


def test_the_choice_is_far_from_what_is_taken() -> None:
    """The vector nearest to one that was taken before is chosen last."""
    looks = [np.array([x]) for x in (0.0, 5.0, 10.0)]
    assert far_apart(looks, 3, [np.array([9.0])]) == [0, 1, 2]


WALKS = st.tuples(
    st.tuples(*[st.integers(-60, 60)] * 2),
    st.builds(walk, st.floats(-20, 200), st.floats(0, 60)),
)


@given(st.lists(WALKS, max_size=20))
def test_a_map_keeps_the_best_of_each_cell(walks: list[Any]) -> None:
    """Each cell has the best of all gaits that belong there, whatever their order."""
    archives = [Archive((0, 0), GRID), Archive((0, 0), GRID)]
    for archive, order in zip(archives, (walks, walks[::-1]), strict=True):
        for table, figures in order:
            would = archive.would_take(table, figures)
            assert archive.add(table, figures) == would
    one, other = (a.elites for a in archives)
    assert {p: e.worth for p, e in one.items()} == {p: e.worth for p, e in other.items()}
    assert one.keys() == {GRID.place(figures) for _, figures in walks} - {None}
    for place, elite in one.items():
        assert GRID.place(elite.figures) == place


def test_a_map_prefers_the_smaller_change() -> None:
    """Of two gaits that score nearly the same, the map keeps the one with fewer degrees changed."""
    archive = Archive((0, 0), GRID)
    archive.add((30, 30), walk(52.0, 20.0))
    assert archive.add((5, 0), walk(51.0, 20.0))
    assert not archive.add((4, 30), walk(53.0, 20.0))
    assert archive.add((30, 30), walk(58.0, 20.0))


def test_only_sound_gaits_are_in_a_map() -> None:
    """A gait that falls, rests on its body, turns, goes sideways or backward is not kept."""
    archive = Archive((0, 0), GRID)
    good = walk(50.0, 20.0)
    for wrong in (
        {"upright": 0.5},
        {"belly_share": 0.01},
        {"drift_deg_s": -4.0},
        {"lateral_mm_s": 30.0},
        {"speed_mm_s": -1.0},
        {"cycles": 0, "cycle_s": None},
    ):
        assert not archive.add((1, 1), replace(good, **wrong))
    assert archive.add((1, 1), good)


def test_arousal_is_height_over_period() -> None:
    """Arousal is step height over period; the last cells of a map have no upper end."""
    assert arousal_mm_s(replace(walk(50.0, 30.0), cycle_s=2.0)) == 15.0
    assert GRID.place(walk(50.0, 13.0)) == MapPlace(2, 1)
    for value in range(1, 200):
        place = GRID.place(walk(value, value))
        assert place is not None
        assert place.speed == sum(value >= low for low in GRID.speeds_mm_s) - 1
        assert place.arousal == sum(value >= low for low in GRID.arousals_mm_s) - 1
    assert GRID.place(walk(1e4, 1e4)) == MapPlace(5, 4)
    assert grid_of(entry_of("hexapod").robot, walk(60.4, 16.0)) == GRID


@pytest.mark.slow
@pytest.mark.long
def test_a_small_map(workers: Workers) -> None:
    """Two rounds of a search fill more than one cell; the same seed finds the same gaits."""
    task = task_for("quadruped")
    own = task.table.angles_deg
    found = []
    for _ in range(2):
        trials = Trials(task, workers, threading.Event())
        archive = Archive(own, grid_of(task.robot, own_figures()))
        archive.add(own, own_figures())
        for _, _ in zip(
            range(2), fill(archive, styles_of("quadruped"), own, trials, 1), strict=False
        ):
            pass
        found.append(archive)
    assert found[0].elites == found[1].elites
    assert len(found[0].elites) > 1
    reply = map_reply(task, 2, Mapped(found[0], own_figures(), 0, False))
    assert reply.own is not None
    assert reply.own in {(one.speed, one.arousal) for one in reply.cells}
    for cell in reply.cells:
        figures = try_table(task, cell.gait.table)
        assert vars(figures) == cell.gait.figures
        assert is_sound(figures)
        assert cell.speed == 5 or reply.speeds_mm_s[cell.speed] <= figures.speed_mm_s
        assert len(cell.gait.changes) == sum(
            a != b for a, b in zip(own, cell.gait.table, strict=True)
        )


@pytest.mark.slow
@pytest.mark.long
def test_variants_of_two_rounds(workers: Workers) -> None:
    """Six variants walk upright and differ; the next round repeats none of the earlier tables."""
    task = task_for("quadruped")
    own, styles = task.table.angles_deg, styles_of("quadruped")
    trials = Trials(task, workers, threading.Event())
    first = vary(trials, [own], [own], 3, 0, lambda _: None)
    tables = [one.angles_deg for one in first.variants]
    second = vary(trials, tables[:2], [own, *tables], 3, 1, lambda _: None)
    for found in (first, second):
        assert len(found.variants) == VARIANTS
        assert all(is_sound(one.figures) and one.figures.speed_mm_s > 0 for one in found.variants)
        looks = [styles.look(one.angles_deg) for one in found.variants]
        assert all(np.linalg.norm(a - b) > 0.5 for a, b in combinations(looks, 2))
    assert not {one.angles_deg for one in second.variants} & {own, *tables}
    reply = variants_reply(task, 2, first)
    assert all(one.differences and one.changes for one in reply.variants)
    sizes = [[abs(one.steps) for one in gait.differences] for gait in reply.variants]
    assert sizes == [sorted(one, reverse=True) for one in sizes]
