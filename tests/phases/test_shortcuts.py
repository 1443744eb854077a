"""Ways to tick a phase without learning: none ticks anything. The honest way ticks each phase."""

import math
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from aside import run_async
from every_third import every_third
from pupil import (
    FIRST,
    LEGS,
    QUESTIONS,
    ROOT,
    SECOND,
    START,
    Asks,
    Pupil,
    Rows,
    changed,
    differing,
    new_table,
)

from lacoc_shared.gait.tables import Posture

pytestmark = pytest.mark.slow

Way = Callable[[Pupil], Awaitable[None]]
WAYS: dict[str, Way] = {}
TRIPOD = {
    (1, 0, SECOND): 40.0,
    (1, 2, SECOND): 40.0,
    (1, 4, SECOND): 40.0,
    (1, 0, ROOT): 0.0,
    (1, 3, ROOT): 0.0,
}
"""What makes row 1 stand on three legs."""
MOVES = (
    ((1, 0, ROOT), 15.0),
    ((1, 0, FIRST), 50.0),
    ((1, 0, SECOND), 40.0),
    ((1, 0, ROOT), 45.0),
    ((1, 0, FIRST), 20.0),
    ((1, 0, SECOND), 20.0),
)
"""Six postures of a leg, each by another move."""


def way(does: Way) -> Way:
    """Put a way into the table of all."""
    assert does.__name__ not in WAYS
    WAYS[does.__name__] = does
    return does


def all_21() -> Rows:
    return dict.fromkeys(new_table(), (21.0,) * (3 * LEGS))


def cells_of(rows: Rows, keys: tuple[int, ...] = (1, 2, 3, 4)) -> dict[tuple[int, int, int], float]:
    """Return the cells in which a table differs from a new one."""
    return differing(new_table(), rows, keys)


async def asked_in_phase_2(pupil: Pupil, *, right: bool | None = None) -> None:
    """Do the work of phase 2, and answer its question; `right` None: leave it open."""
    await pupil.goes(2)
    await pupil.types(TRIPOD)
    await pupil.tries("A1", 3.0)
    assert pupil.missing(2) == {"phases.answer"}
    if right is not None:
        assert await pupil.answers(2, right=right)


async def tries_everything(pupil: Pupil) -> None:
    """Try what phases 2 to 4 ask for, and answer whatever is asked, right."""
    await pupil.goes(1, 2, 3, 4)
    await pupil.tries_all()
    await pupil.answers_all()


# Numbers that change next to nothing


@way
async def types_21_over_20_in_the_sample(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(2, 3, 4)
    await pupil.types({(1, leg, FIRST): 21.0 for leg in range(LEGS)})
    await tries_everything(pupil)


@way
async def types_9_degrees_more_into_the_sample(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(2, 3, 4)
    lifted = {(row, leg, SECOND): 49.0 for row in (1, 2) for leg in (0, 2, 4)}
    await pupil.types(lifted)
    await tries_everything(pupil)


@way
async def types_all_values_21(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.types(cells_of(all_21()))
    await tries_everything(pupil)


@way
async def pastes_all_values_21(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(all_21(), tuple(range(9))))
    await tries_everything(pupil)


@way
async def types_numbers_away_and_back(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(2, 3, 4)
    for cell, angle in cells_of(pupil.sample).items():
        await pupil.types({cell: angle + 20})
        await pupil.types({cell: angle})
    await tries_everything(pupil)


@way
async def types_three_large_numbers_into_the_sample(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(2, 3, 4)
    await pupil.types({(row, leg, SECOND): 60.0 for row in (1, 2) for leg in (0, 2, 4)})
    await tries_everything(pupil)


# Numbers of others


@way
async def opens_the_sample(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await tries_everything(pupil)


@way
async def opens_the_sample_before_the_page_is_reloaded(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(2, 3, 4)
    await pupil.reloads("hand")
    await tries_everything(pupil)


@way
async def pastes_the_sample(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample))
    await tries_everything(pupil)


@way
async def pastes_the_sample_row_by_row_in_each_phase(pupil: Pupil) -> None:
    for phase, keys in ((2, (1,)), (3, (2,)), (4, (3, 4))):
        await pupil.goes(phase)
        for key in keys:
            await pupil.pastes(cells_of(pupil.sample, (key,)))
        await tries_everything(pupil)


@way
async def pastes_the_sample_cell_by_cell(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    for cell, angle in cells_of(pupil.sample).items():
        await pupil.pastes({cell: angle})
    await tries_everything(pupil)


@way
async def pastes_the_sample_and_types_the_same_numbers(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample))
    for cell, angle in cells_of(pupil.sample).items():
        await pupil.types({cell: 0.0})
        await pupil.types({cell: angle})
    await tries_everything(pupil)


@way
async def opens_a_file_of_a_friend_after_typing_something(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.types({(row, leg, SECOND): 50.0 for row in (1, 2) for leg in (0, 2, 4)})
    await pupil.opens(changed(pupil.sample, {(1, 0, ROOT): 10.0}))
    await tries_everything(pupil)


@way
async def takes_what_the_teacher_handed_out(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample, tuple(range(9))))
    await pupil.types({(8, 0, FIRST): 50.0})
    await tries_everything(pupil)


@way
async def takes_what_the_teacher_handed_out_and_changes_six_numbers(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample))
    await pupil.types({(row, leg, SECOND): 55.0 for row in (1, 2) for leg in (0, 2, 4)})
    await tries_everything(pupil)


@way
async def takes_the_coachs_table(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample), "coach")
    await tries_everything(pupil)


@way
async def takes_the_coachs_cells_one_by_one(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    for cell, angle in cells_of(pupil.sample).items():
        await pupil.pastes({cell: angle}, "coach")
    await tries_everything(pupil)


@way
async def types_over_the_coachs_numbers_and_back(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample), "coach")
    for cell, angle in cells_of(pupil.sample).items():
        await pupil.types({cell: angle - 30})
        await pupil.types({cell: angle})
    await tries_everything(pupil)


# Undo, redo and copies


@way
async def pastes_undoes_and_redoes(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.pastes(cells_of(pupil.sample))
    await pupil.undoes()
    await pupil.redoes()
    await tries_everything(pupil)


@way
async def types_and_undoes_in_the_sample(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(2, 3, 4)
    for cell in cells_of(pupil.sample):
        await pupil.types({cell: 10.0})
        await pupil.undoes()
    await tries_everything(pupil)


@way
async def redoes_what_was_typed_before_the_phase(pupil: Pupil) -> None:
    await pupil.types(TRIPOD)
    for _ in TRIPOD:
        await pupil.undoes()
    await pupil.goes(2)
    for _ in TRIPOD:
        await pupil.redoes()
    await pupil.tries("A1", 3.0)
    await pupil.answers_all()


@way
async def types_before_the_phase_and_back_and_forth_in_it(pupil: Pupil) -> None:
    await pupil.types(TRIPOD)
    await pupil.goes(2)
    for cell, angle in TRIPOD.items():
        await pupil.types({cell: angle + 30})
        await pupil.types({cell: angle})
    await pupil.tries("A1", 3.0)
    await pupil.answers_all()


@way
async def does_the_work_without_coming_to_the_phase(pupil: Pupil) -> None:
    await pupil.types(cells_of(pupil.sample))
    await pupil.tries_all()
    await pupil.answers_all()


@way
async def takes_all_numbers_from_the_lesson(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    for cell, angle in cells_of(pupil.sample, (1, 2, 3, 4)).items():
        await pupil.pastes({cell: angle}, "lesson")
    await tries_everything(pupil)


@way
async def copies_the_numbers_of_the_lesson(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    for cell, angle in cells_of(pupil.sample, (1, 2)).items():
        await pupil.pastes({cell: angle}, "lesson")
    for cell, angle in cells_of(pupil.sample, (3, 4)).items():
        await pupil.pastes({cell: angle}, "tool")
    await tries_everything(pupil)


@way
async def copies_row_1_into_all_rows(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    await pupil.types({(1, leg, SECOND): 21.0 for leg in range(LEGS)})
    copies = {(row, leg, SECOND): 21.0 for row in (2, 3, 4) for leg in range(LEGS)}
    await pupil.pastes(copies, "tool")
    await tries_everything(pupil)


@way
async def copies_the_sample_with_the_tools(pupil: Pupil) -> None:
    await pupil.goes(2, 3, 4)
    for key in (1, 2, 3, 4):
        await pupil.pastes(cells_of(pupil.sample, (key,)), "tool")
    await tries_everything(pupil)


# Guesses and answers


@way
async def guesses_with_steps_of_one_degree(pupil: Pupil) -> None:
    for level in range(3):
        for step in range(1, 4):
            await pupil.guesses((1, 0, level), START[LEGS * level] + step)
    await pupil.answers_all()


@way
async def guesses_the_same_move_again_and_again(pupil: Pupil) -> None:
    for _ in range(8):
        for angle in (0.0, 45.0):
            await pupil.guesses((1, 0, ROOT), angle)
    await pupil.answers_all()


@way
async def guesses_one_move_through_all_choices(pupil: Pupil) -> None:
    for said in ("up", "down", "out", "in", "still", "forward", "back"):
        for cell, angle in MOVES[:3]:
            await pupil.guesses(cell, angle, said)
            await pupil.undoes()
    await pupil.answers_all()


@way
async def looks_first_and_guesses_afterwards(pupil: Pupil) -> None:
    await pupil.types(dict(MOVES[:3]))
    await pupil.types(dict(MOVES[3:]))
    await pupil.opens(new_table())
    for cell, angle in MOVES:
        await pupil.guesses(cell, angle)
    await pupil.answers_all()


@way
async def pastes_postures_and_guesses_nothing(pupil: Pupil) -> None:
    for step in range(8):
        await pupil.pastes({(1, 0, level): 20.0 * step for level in range(3)})
    await pupil.answers_all()


@way
async def answers_before_anything_is_asked(pupil: Pupil) -> None:
    await pupil.goes(0, 1, 2, 3, 4, 5, 6)
    for phase in range(7):
        for choice in range(4):
            for name in ("spot", "other-side", "margin", "push", "seam", "differs", "key-right"):
                assert not await pupil.chooses(phase, name, choice)


@way
async def guesses_an_answer_through_all_choices(pupil: Pupil) -> None:
    await asked_in_phase_2(pupil)
    question = pupil.diary.question(2)
    assert question is not None
    wrong = next(choice for choice in range(4) if choice not in question.right)
    assert await pupil.chooses(2, question.name, wrong)
    for choice in range(4):
        assert not await pupil.chooses(2, question.name, choice)


@way
async def tries_the_same_again_after_a_wrong_answer(pupil: Pupil) -> None:
    await asked_in_phase_2(pupil, right=False)
    await pupil.tries("A1", 3.0)
    assert not await pupil.answers(2)


@way
async def changes_a_little_after_a_wrong_answer(pupil: Pupil) -> None:
    await asked_in_phase_2(pupil, right=False)
    await pupil.types({(1, 0, SECOND): 49.0})
    await pupil.tries("A1", 3.0)
    assert not await pupil.answers(2)


@way
async def pastes_after_a_wrong_answer(pupil: Pupil) -> None:
    await asked_in_phase_2(pupil, right=False)
    await pupil.pastes({(1, 0, SECOND): 60.0})
    await pupil.tries("A1", 3.0)
    assert not await pupil.answers(2)


@way
async def reloads_after_a_wrong_answer(pupil: Pupil) -> None:
    await asked_in_phase_2(pupil, right=False)
    await pupil.reloads(None)
    await pupil.goes(1, 2)
    await pupil.tries("A1", 3.0)
    assert not await pupil.answers(2)


# The lesson, the idea and the file


@way
async def clicks_through_the_lesson(pupil: Pupil) -> None:
    await pupil.takes_lesson(answers=False)
    await pupil.answers_all()


@way
async def takes_the_lesson_and_guesses_through_all_spots(pupil: Pupil) -> None:
    await pupil.takes_lesson()
    assert await pupil.answers(0, right=False)
    await pupil.steps(3)
    assert not await pupil.answers(0)


@way
async def has_an_idea_and_leaves_the_sample_as_it_is(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(5)
    await pupil.names("calm")
    await pupil.tries("2")
    await pupil.answers_all()


@way
async def has_an_idea_that_the_coach_had(pupil: Pupil) -> None:
    await pupil.opens(pupil.sample)
    await pupil.goes(5)
    await pupil.names("calm")
    calm = {key: tuple(0.6 * angle for angle in row) for key, row in pupil.sample.items()}
    await pupil.pastes(differing(pupil.sample, calm, (1, 2, 3, 4)), "coach")
    await pupil.tries("2")
    await pupil.answers_all()


@way
async def imports_a_whole_file_for_phase_6(pupil: Pupil) -> None:
    await pupil.goes(6)
    await pupil.pastes(cells_of(pupil.sample, tuple(range(9))))
    await pupil.checks()
    for key in "0123":
        await pupil.tries(key)
    await pupil.answers_all()


@pytest.fixture(scope="module")
def sample_rows(sample: dict[int, Posture]) -> Rows:
    """Give the sample's table in degrees."""
    return {
        key: tuple(round(math.degrees(angle), 3) for angle in angles)
        for key, angles in sample.items()
    }


def test_there_are_thirty_ways() -> None:
    """The table has at least thirty ways."""
    assert len(WAYS) >= 30


@pytest.mark.parametrize("name", every_third(WAYS))
def test_no_way_around_ticks_anything(
    name: str, tmp_path: Path, ask_trial: Asks, sample_rows: Rows
) -> None:
    """No phase is done after a way to tick it without learning."""

    async def goes() -> set[int]:
        pupil = Pupil(tmp_path, ask_trial, sample_rows)
        await pupil.begin()
        await WAYS[name](pupil)
        await pupil.end()
        return pupil.done

    assert run_async(goes) == set()


async def honest(pupil: Pupil) -> list[set[int]]:
    """Do all phases as they are meant; return what was done after each of them."""
    found = []
    await pupil.begin()
    await pupil.takes_lesson()
    await pupil.answers(0)
    found.append(pupil.done)

    await pupil.goes(1)
    for cell, angle in MOVES:
        await pupil.guesses(cell, angle)
    await pupil.answers(1)
    found.append(pupil.done)

    await pupil.goes(2)
    await pupil.pastes({(1, 1, FIRST): 21.0}, "lesson")  # whatever the lesson gave is welcome
    await pupil.types(TRIPOD)
    await pupil.tries("A1", 3.0)
    await pupil.answers(2)
    found.append(pupil.done)

    await pupil.goes(3)
    await pupil.types(differing(pupil.rows, pupil.sample, (2,)))
    await pupil.tries("A1:1, A2", 1.5)
    await pupil.answers(3)
    found.append(pupil.done)

    await pupil.goes(4)
    await pupil.types(differing(pupil.rows, pupil.sample, (3, 4)))
    await pupil.tries("2")
    await pupil.answers(4)
    found.append(pupil.done)
    assert pupil.diary.has_earned_sample

    await pupil.goes(5)
    await pupil.names("calm")
    await pupil.types(
        {
            (row, leg, ROOT): math.copysign(20, pupil.rows[row][leg])
            for row in (1, 2, 3, 4)
            for leg in range(LEGS)
            if pupil.rows[row][leg]
        }
    )
    await pupil.tries("2")
    await pupil.answers(5)
    found.append(pupil.done)

    await pupil.goes(6)
    await pupil.pastes(differing(pupil.rows, pupil.sample, (5, 6, 7, 8)))  # a friend's keys
    await pupil.types({(row, 0, FIRST): 32.0 for row in (1, 2, 3, 4)})
    await pupil.types({(row, 5, FIRST): 32.0 for row in (1, 2, 3, 4)})
    await pupil.checks()
    for key in "0123":
        await pupil.tries(key)
    await pupil.answers(6)
    found.append(pupil.done)
    await pupil.end()
    return found


def test_the_honest_way_ticks_each_phase(
    tmp_path: Path, ask_trial: Asks, sample_rows: Rows
) -> None:
    """Work of one's own, and a right answer, tick each phase; nothing else is ticked with it."""
    found = run_async(lambda: honest(Pupil(tmp_path, ask_trial, sample_rows)))

    assert found == [set(range(number + 1)) for number in range(len(found))]
    assert len(found) == 7


def test_a_wrong_answer_leads_to_another_question(
    tmp_path: Path, ask_trial: Asks, sample_rows: Rows
) -> None:
    """After a wrong answer a new number and a trial bring another question."""

    async def goes() -> set[int]:
        pupil = Pupil(tmp_path, ask_trial, sample_rows)
        await pupil.begin()
        await asked_in_phase_2(pupil)
        first = pupil.diary.question(2)
        await pupil.answers(2, right=False)
        assert pupil.missing(2) == {"phases.try-again"}
        await pupil.types({(1, 2, SECOND): 55.0})
        await pupil.tries("A1", 3.0)
        other = pupil.diary.question(2)
        assert first is not None
        assert other is not None
        assert first.name != other.name
        await pupil.answers(2)
        await pupil.end()
        return pupil.done

    assert run_async(goes) == {2}


def test_evidence_outlives_a_restart(tmp_path: Path, ask_trial: Asks, sample_rows: Rows) -> None:
    """The steps of the lesson and an open question are the same after a restart."""

    async def goes() -> None:
        pupil = Pupil(tmp_path, ask_trial, sample_rows)
        await pupil.begin()
        await pupil.takes_lesson()
        question, steps = pupil.diary.question(0), pupil.diary.lesson
        await pupil.end()
        again = Pupil(tmp_path, ask_trial, sample_rows)
        await again.diary.read()
        assert again.diary.question(0) == question
        assert again.diary.lesson == steps
        assert again.diary.progress.lesson_step == len(QUESTIONS)
        await again.end()

    run_async(goes)
