"""A student at the page, without page and gateway: the same edits, trials and answers."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Literal

from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.learner import Learner
from lacoc_client.workshop.design.learning.rules import FREE
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.design.table import FileRow, FileTable
from lacoc_client.workshop.phases.evidence import By, Named, WentToPhase
from lacoc_client.workshop.phases.facts import FootWay, foot_ways
from lacoc_robots.library import find_robot
from lacoc_robots.robot_file import read_robot
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import TrialReply

LEGS, KEYS = 6, 9
SEQUENCES = ((0,), (8, 7, 6, 5), (1, 2, 3, 4), (5, 6, 7, 8))
ROOT, FIRST, SECOND = range(3)
QUESTIONS = (2, 1, 1, 1, 1, 1, 2, 0)
"""How many questions each step of the lesson has."""

Rows = dict[int, tuple[float, ...]]
Cells = Mapping[tuple[int, int, int], float]
"""(row, leg, level) -> angle [deg]"""
Asks = Callable[..., TrialReply]

_NAME, _FILE = find_robot("hexapod")
SPEC = read_robot(_FILE, _NAME)
START = tuple(round(math.degrees(angle), 3) for angle in SPEC.start_posture)


def new_table() -> Rows:
    """Return the table with which the page begins: all rows stand."""
    return dict.fromkeys(range(KEYS), START)


def changed(rows: Rows, cells: Cells) -> Rows:
    """Return a table with other numbers in some cells."""
    after = dict(rows)
    for (row, leg, level), angle in cells.items():
        joint = leg + LEGS * level
        after[row] = (*after[row][:joint], float(angle), *after[row][joint + 1 :])
    return after


def differing(rows: Rows, other: Rows, keys: tuple[int, ...]) -> dict[tuple[int, int, int], float]:
    """Return the cells of `other` that differ from those of `rows`, in some rows."""
    return {
        (key, joint % LEGS, joint // LEGS): other[key][joint]
        for key in keys
        for joint in range(3 * LEGS)
        if rows[key][joint] != other[key][joint]
    }


class Pupil:
    """A student at work.

    Args:
        folder: folder for the evidence.
        ask: lets a gait walk.
        sample: the sample's table.
    """

    def __init__(self, folder: Path, ask: Asks, sample: Rows) -> None:
        self.sample = sample
        self._ask = ask
        self._keeper = Keeper(folder / "evidence.sqlite")
        self.diary = Diary(self._keeper)
        self._reload()
        self.rows = new_table()
        self._undone: list[Rows] = []
        self._before: list[Rows] = []

    async def begin(self) -> None:
        """Open the page with a new table."""
        await self._tell(None)

    async def end(self) -> None:
        await self._keeper.close()

    @property
    def done(self) -> set[int]:
        """The phases that are done."""
        states = self.diary.progress.states
        return {number for number, state in enumerate(states) if state == "met"}

    def missing(self, phase: int) -> set[str]:
        """Return the codes of what a phase still lacks."""
        return {phrase.code for phrase in self.diary.progress.outcomes[phase].missing}

    # At the table

    async def types(self, cells: Cells) -> None:
        """Type numbers, one after another."""
        for cell, angle in cells.items():
            await self._change({cell: angle}, "hand")

    async def pastes(self, cells: Cells, by: By = "paste") -> None:
        """Bring numbers in one step: a paste, a table that was handed out, a tool, the coach."""
        await self._change(cells, by)

    async def opens(self, rows: Rows) -> None:
        """Open another table, as a file or the sample."""
        self._before.append(self.rows)
        self.rows = rows
        await self._tell(None)

    async def undoes(self) -> None:
        self._undone.append(self.rows)
        self.rows = self._before.pop()
        await self._tell(None)

    async def redoes(self) -> None:
        self._before.append(self.rows)
        self.rows = self._undone.pop()
        await self._tell(None)

    async def reloads(self, by: By | None) -> None:
        """Open the page anew; its first edit is told as one that was made `by` this way."""
        self._reload()
        await self._tell(by)

    async def guesses(self, cell: tuple[int, int, int], angle: float, said: str = "") -> None:
        """Guess where a foot goes, right unless `said` says otherwise; then type the number."""
        row, leg, _ = cell
        after = changed(self.rows, {cell: angle})
        old, new = (one[row][leg::LEGS] for one in (self.rows, after))
        way: Any = said or foot_ways(SPEC.legs[leg], old, new)[0]
        await self._change({cell: angle}, "hand", way)

    # Trials and questions

    async def tries(self, keys: str, seconds: float | None = None) -> None:
        """Let the robot walk, and have the walk compared with the sample's."""
        asked = self._trial(keys, seconds)
        facts = await self._learner.tried(asked, self._reply(self.rows, asked))
        await self._learner.compared(asked, facts)

    async def tries_all(self) -> None:
        """Try whatever phases 2 to 4 ask for."""
        await self.tries("A1", 3.0)
        await self.tries("A1:1, A2", 1.5)
        await self.tries("2")

    async def goes(self, *phases: int) -> None:
        for phase in phases:
            await self.diary.add(WentToPhase(phase=phase))

    async def answers(self, phase: int, *, right: bool = True) -> bool:
        """Answer the question of a phase; return whether there is one."""
        question = self.diary.question(phase)
        if question is None:
            return False
        choices = range(len(question.choices))
        choice = next(one for one in choices if (one in question.right) == right)
        return await self.chooses(phase, question.name, choice)

    async def answers_all(self) -> None:
        """Give the right answer to each question that is asked."""
        for phase in range(7):
            await self.answers(phase)

    async def chooses(self, phase: int, question: str, choice: int) -> bool:
        """Send an answer; return whether it was taken."""
        ask = requests.AnswerAsk(id=0, phase=phase, question=question, choice=choice)
        try:
            await self._learner.answered(ask)
        except UserError:
            return False
        return True

    async def names(self, word: str) -> None:
        await self.diary.add(Named(word=word))
        await self.diary.vote(word, "B")

    async def checks(self) -> None:
        ask = requests.CheckAsk(id=0, table=self._table(), sequences=SEQUENCES)
        await self._learner.checked(ask)

    async def takes_lesson(self, *, answers: bool = True, robot: str = "hexapod") -> None:
        """Go through the lesson of one leg."""
        for step, of in enumerate(QUESTIONS, start=1):
            await self.steps(step, robot=robot)
            for question in range(of if answers else 0):
                await self.steps(step, robot=robot, question=question, of=of, right=True)

    async def steps(self, step: int, robot: str = "hexapod", **fields: Any) -> None:
        """Come to a step of the lesson, or answer a question there."""
        await self._learner.stepped(requests.LessonAsk(id=0, step=step, robot=robot, **fields))

    def _reload(self) -> None:
        self._told: FileTable | None = None
        """The table without the edit that is told next; None: the page has just opened."""
        self._learner = Learner(Student("", self.diary, lambda: FREE), self._sample_trial)

    async def _change(self, cells: Cells, by: By, guess: FootWay | None = None) -> None:
        self._before.append(self.rows)
        self.rows = changed(self.rows, cells)
        await self._tell(by, guess)

    async def _tell(self, by: By | None, guess: FootWay | None = None) -> None:
        size: Literal["table"] | None = "table" if by == "coach" else None
        table = self._table()
        before, self._told = self._told or table, table
        if by is None:
            return  # a file was opened, or an edit undone: a page tells nothing
        ask = requests.EditAsk(
            id=0,
            before=before,
            table=table,
            sequences=SEQUENCES,
            by=by,
            size=size,
            guess=guess,
        )
        await self._learner.edited(ask)

    async def _sample_trial(self, asked: requests.TrialAsk) -> TrialReply:
        return self._reply(self.sample, asked)

    def _reply(self, rows: Rows, asked: requests.TrialAsk) -> TrialReply:
        gait = {key: tuple(map(math.radians, angles)) for key, angles in rows.items()}
        return self._ask(gait, asked.keys, asked.seconds, SEQUENCES)

    def _trial(self, keys: str, seconds: float | None) -> requests.TrialAsk:
        return requests.TrialAsk(
            id=0, table=self._table(), sequences=SEQUENCES, keys=keys, seconds=seconds
        )

    def _table(self) -> FileTable:
        rows = tuple(FileRow(key=key, angles_deg=row) for key, row in sorted(self.rows.items()))
        return FileTable(kind="postures", legs=LEGS, rows=rows)
