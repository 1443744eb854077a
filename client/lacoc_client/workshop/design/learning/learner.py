"""Turns what a student does on one page into evidence for the phases."""

import asyncio
import hashlib
from collections.abc import Awaitable, Callable

import msgspec

from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.files import sent_gait
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.design.learning.tried_rows import numbers, row_names
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.evidence import (
    SAMPLE,
    Answered,
    CheckedGait,
    Coached,
    Compared,
    Edited,
    Evidence,
    Guessed,
    Rows,
    TookStep,
    Tried,
    edited,
)
from lacoc_client.workshop.phases.facts import (
    TrialFacts,
    differences,
    foot_ways,
    pace,
    trial_facts,
    way,
)
from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot
from lacoc_robots.robot_file import RobotSpec, read_robot
from lacoc_shared.gait.text import read_gait
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.studio import TrialReply
from lacoc_shared.words import Phrase, say


class Judged(msgspec.Struct, frozen=True, kw_only=True):
    """A guess of where a foot goes, and whether it was right."""

    said: str
    was: tuple[str, ...]
    """All correct answers; first the direction in which the foot moved most."""
    right: bool


class EditReply(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to a page that reported an edit of its table (`EditAsk`)."""

    guess: Judged | None = None
    """The judged guess; None: the student guessed nothing, or the guess can't be judged."""


class AnswerReply(msgspec.Struct, frozen=True, kw_only=True):
    """What a page is told after the student answered the question of a phase (`AnswerAsk`)."""

    right: bool
    was: tuple[Phrase, ...]
    """All correct choices."""
    because: Phrase
    """An explanation of the right choices."""


class CheckReply(msgspec.Struct, frozen=True, kw_only=True):
    """The answer to a page that had its table checked (`CheckAsk`)."""

    keys: int
    """For a table of locomotion, the number of its keys. For a table of postures, the number of
    different sequences that the page sent."""
    mistakes: tuple[Mistake, ...] = ()


class Learner:
    """Makes evidence of what a student does on one page; used from the event loop only.

    Args:
        student: the student whose page it is.
        sample: repeats a trial with the sample gait; returns None if no sample fits the robot.
    """

    def __init__(
        self,
        student: Student,
        sample: Callable[[requests.TrialAsk], Awaitable[TrialReply | None]],
    ) -> None:
        self.student = student
        self._diary = student.diary
        self._sample = sample
        self._last: dict[str, TrialFacts] = {}
        self._samples: dict[tuple[str, SentFile | None], TrialFacts | None] = {}

    async def edited(self, asked: requests.EditAsk) -> EditReply:
        """Keep an edit as evidence; judge the guess of where the foot goes that came with it.

        Raises:
            FileRefused: with every mistake of the table or of the robot.
            UserError: if the student has sent too many edits lately.
        """
        self._diary.spend_table(asked.table)
        version = _version(asked.table, asked.sequences)
        if asked.before.kind != asked.table.kind:
            return EditReply()
        edit = edited(_rows(asked.before), _rows(asked.table), version, asked.by)
        if edit is None:
            return EditReply()
        self._diary.spend_edit(edit)
        evidence: list[Evidence] = [edit]
        judged = None
        if asked.guess is not None and asked.by == "hand":
            spec = await asyncio.to_thread(_robot, asked.robot)
            if (guess := _guessed(edit, asked.guess, spec)) is not None:
                evidence.append(guess)
                judged = Judged(said=guess.said, was=guess.was, right=guess.right)
        if asked.by == "coach" and asked.size is not None:
            evidence.append(Coached(version=version, size=asked.size))
        await self._diary.add(*evidence)
        return EditReply(guess=judged)

    async def tried(self, asked: requests.TrialAsk, reply: TrialReply) -> TrialFacts | None:
        """Keep a trial as evidence, and judge what the student guessed about it before.

        Returns:
            The facts of the trial; None: the trial is no evidence.
        """
        facts = _facts(reply, asked.keys)
        if asked.table is None or facts is None:
            return None
        before = self._last.get(asked.keys)
        self._last[asked.keys] = facts
        spec = await asyncio.to_thread(_robot, asked.robot)
        evidence: list[Evidence] = [
            Tried(
                version=_version(asked.table, asked.sequences),
                facts=facts,
                rows=row_names(asked, facts.keys[-1]),
                numbers=numbers(asked, facts.keys, spec),
            )
        ]
        for guess in asked.guesses:
            if guess.about == "way":
                evidence.append(Guessed(about="way", said=guess.said, was=(way(facts),)))
            elif before is not None:
                evidence.append(Guessed(about="pace", said=guess.said, was=(pace(before, facts),)))
        await self._diary.add(*evidence)
        return facts

    async def compared(self, asked: requests.TrialAsk, own: TrialFacts | None) -> bool:
        """Compare a trial of a key of level B with the same trial of the sample gait.

        Args:
            asked: the trial.
            own: the facts of the trial, as `tried` returns them.

        Returns:
            Whether the comparison was kept as evidence.
        """
        if asked.table is None or own is None or not own.keys[-1].startswith("B"):
            return False
        place = (asked.keys, asked.robot)
        if place not in self._samples:
            try:
                reply = await self._sample(asked)
            except (UserError, FileRefused):
                return False  # the sample can't be tried now; the next trial asks again
            self._samples[place] = None if reply is None else _facts(reply, asked.keys)
        sample = self._samples[place]
        differs = differences(own, sample) if sample is not None else ()
        if differs:
            version = _version(asked.table, asked.sequences)
            await self._diary.add(Compared(version=version, against=SAMPLE, differs=differs))
        return bool(differs)

    async def answered(self, asked: requests.AnswerAsk) -> AnswerReply:
        """Judge and keep the answer to the question of a phase.

        Raises:
            UserError: if the phase does not ask this question now.
        """
        question = self._diary.question(asked.phase)
        if (
            question is None
            or question.name != asked.question
            or asked.choice >= len(question.choices)
        ):
            raise UserError(say("class.not-asked"))
        is_right = asked.choice in question.right
        await self._diary.add(
            Answered(phase=asked.phase, question=question.name, said=asked.choice, right=is_right)
        )
        was = tuple(question.choices[place] for place in sorted(question.right))
        return AnswerReply(right=is_right, was=was, because=question.because)

    async def stepped(self, asked: requests.LessonAsk) -> None:
        """Keep as evidence that the student reached a step of the lesson or answered a question.

        A step that the student reaches twice in a row is kept once.

        The first answer to a question, right or wrong, counts for its step. After a wrong answer to
        the question of phase 0, one more answer here lets that question be asked again.
        """
        is_answer = asked.question is not None
        one = TookStep(
            step=asked.step,
            robot=asked.robot,
            question=asked.question if asked.question is not None else -1,
            of=asked.of if is_answer else 0,
            choice=asked.choice if is_answer else -1,
            right=asked.right and is_answer,
        )
        if is_answer or self._diary.lesson[-1:] != (one,):
            await self._diary.add(one)

    async def checked(self, asked: requests.CheckAsk) -> CheckReply:
        """Check a table against its robot's joints, as `lacoc gait check` does.

        Raises:
            FileRefused: with every mistake of the robot file; mistakes of the table are returned.
            UserError: if a locomotion table has no row of a key below its highest key, or if the
                student has sent too many tables lately.
        """
        self._diary.spend_table(asked.table)
        spec = await asyncio.to_thread(_robot, asked.robot)
        table = asked.table
        sequences = set(asked.sequences or ())
        keys = (
            len({row.key for row in table.rows}) if table.kind == "locomotion" else len(sequences)
        )
        mistakes: tuple[Mistake, ...] = ()
        try:
            sent = sent_gait(table)
            read_gait(sent.data, sent.name, legs=spec.labels, range_deg=spec.ranges_deg)
        except FileRefused as error:
            mistakes = tuple(error.mistakes)
        else:
            version = _version(table, asked.sequences)
            await self._diary.add(CheckedGait(version=version, keys=keys, mistakes=0))
        return CheckReply(keys=keys, mistakes=mistakes)


def _version(table: FileTable, sequences: object) -> str:
    """Return a name for the content of a table and its sequences; equal contents have equal names.

    Raises:
        FileRefused: with every mistake of the table.
        UserError: if a locomotion table has no row of a key below its highest key.
    """
    data = sent_gait(table).data + repr(sequences).encode()
    return hashlib.blake2b(data, digest_size=8).hexdigest()


def _rows(table: FileTable) -> Rows:
    return {(row.key, row.posture): row.angles_deg for row in table.rows}


def _robot(robot: SentFile | None) -> RobotSpec:
    if robot is None:
        robot = SentFile(*find_robot(WORKSHOPS_ROBOT))
    return read_robot(robot.data, robot.name)


def _guessed(edit: Edited, said: str, spec: RobotSpec) -> Guessed | None:
    """Judge the guess of where the foot of the first changed leg goes.

    Returns:
        The guess with the right answers; None: it can't be judged.
    """
    leg = edit.legs[0]
    if not leg.before_deg or leg.leg >= len(spec.legs):
        return None
    was = foot_ways(spec.legs[leg.leg], leg.before_deg, leg.angles_deg)
    if len(edit.legs) > 1 or len(leg.changed) > 1:
        return Guessed(about="foot", said=said, was=was)
    level = leg.changed[0]
    return Guessed(
        about="foot",
        said=said,
        was=was,
        leg=leg.leg,
        level=level,
        before_deg=leg.before_deg[level],
        after_deg=leg.angles_deg[level],
        of_legs=len(spec.legs),
    )


def _facts(reply: TrialReply, keys: str) -> TrialFacts | None:
    try:
        return trial_facts(reply, keys)
    except ValueError:
        return None  # the studio is of another version
