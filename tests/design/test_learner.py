"""Tests of how much evidence one student may make."""

from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from aside import run_async

from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.learner import Learner
from lacoc_client.workshop.design.learning.rules import FREE
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.design.requests import CheckAsk, EditAsk, TrialAsk
from lacoc_client.workshop.design.table import FileRow, FileTable
from lacoc_client.workshop.phases.evidence import By, Edited
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import TrialReply


def table(rows: int, legs: int, angle_deg: float, changed: int | None = None) -> FileTable:
    """Return a table with an angle in its first rows (`changed`; None: all), and 0 in the rest."""
    kind = "postures" if rows <= 10 else "locomotion"
    places = [(row, 0) if kind == "postures" else divmod(row, 100) for row in range(rows)]
    angles = [angle_deg if changed is None or row < changed else 0.0 for row in range(rows)]
    return FileTable(
        kind=kind,
        legs=legs,
        rows=tuple(
            FileRow(key=key, posture=posture, angles_deg=(angle,) * (3 * legs))
            for (key, posture), angle in zip(places, angles, strict=True)
        ),
    )


def edit(rows: int, legs: int, changed: int | None = None, by: By = "paste") -> EditAsk:
    before, after = table(rows, legs, 0.0), table(rows, legs, 1.0, changed)
    return EditAsk(id=0, before=before, table=after, by=by)


async def no_sample(_: TrialAsk) -> TrialReply | None:
    return None


def learn(folder: Path, work: Callable[[Learner], Awaitable[None]]) -> None:
    """Do something with the page of a student."""

    async def run() -> None:
        keeper = Keeper(folder / "class.sqlite")
        await work(Learner(Student("Ann", Diary(keeper, "Ann"), lambda: FREE), no_sample))
        await keeper.close()

    run_async(run)


@pytest.mark.parametrize(
    ("asked", "times"),
    [(edit(10, 6), 200), (edit(10, 8, changed=1, by="hand"), 200), (edit(330, 8), 4)],
    ids=["whole tables", "typed", "largest tables"],
)
def test_what_a_page_tells_after_a_break_is_taken_at_once(
    tmp_path: Path, asked: EditAsk, times: int
) -> None:
    """200 edits of a usual table, or some of the largest."""

    async def work(learner: Learner) -> None:
        for _ in range(times):
            learner.student.diary.spend_request()
            await learner.edited(asked)
        assert len(learner.student.diary.evidence) == times

    learn(tmp_path, work)


def test_a_flood_of_made_up_edits_is_refused(tmp_path: Path) -> None:
    """It neither fills the class file nor keeps the class waiting."""
    flood = edit(200, 30)

    async def work(learner: Learner) -> None:
        refused: list[str] = []
        for _ in range(30):
            try:
                await learner.edited(flood)
            except UserError as error:
                refused.append(error.phrase.code)
        edits = [one for one in learner.student.diary.evidence if isinstance(one, Edited)]
        assert sum(len(one.legs) for one in edits) < 20_000
        assert refused == ["gateway.too-much"] * (30 - len(edits))
        with pytest.raises(UserError):
            await learner.checked(CheckAsk(id=0, table=flood.table))

    learn(tmp_path, work)


def test_requests_for_evidence_have_a_rate(tmp_path: Path) -> None:
    """Also small ones: what is computed from evidence takes longer with each of them."""
    diary = Diary(Keeper(tmp_path / "class.sqlite"), "Ann")

    def flood() -> None:
        for _ in range(3000):
            diary.spend_request()

    with pytest.raises(UserError):
        flood()
