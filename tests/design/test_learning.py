"""Tests of the phases with a real gateway, a real studio and a real evidence file."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from design_client import DesignClient, Refused
from processes import cut_power
from test_design_page import Gateway, sample

from lacoc_client.workshop.design.designer import EVIDENCE_FILE
from lacoc_client.workshop.phases.evidence import (
    CheckedGait,
    Compared,
    Edited,
    Evidence,
    Guessed,
    Tried,
    Voted,
)
from lacoc_client.workshop.phases.store import ClassStore

pytestmark = pytest.mark.slow

SEQUENCES = [[0], [4, 3, 2, 1], [1, 2, 3, 4]]
UP = 2
"""Index of "up" among the directions of a foot."""
Table = dict[str, Any]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path


@pytest.fixture
def starts(folder: Path) -> Iterator[Callable[[], tuple[Gateway, DesignClient]]]:
    """Give a function that starts `lacoc design` on the folder, and opens a page."""
    open_now: list[tuple[Gateway, DesignClient]] = []

    def start() -> tuple[Gateway, DesignClient]:
        gateway = Gateway(folder)
        page = DesignClient(gateway.url, gateway.key)
        open_now.append((gateway, page))
        return gateway, page

    yield start
    for gateway, page in open_now:
        page.close()
        if gateway.process.poll() is None:
            gateway.close()


def kept(folder: Path) -> list[Evidence]:
    with ClassStore(folder / EVIDENCE_FILE) as store:
        return [one.evidence for one in store.evidence("").result()]


def changed(table: Table, key: int, joint: int, angle_deg: float) -> Table:
    rows = [
        {
            **row,
            "angles_deg": [*row["angles_deg"][:joint], angle_deg, *row["angles_deg"][joint + 1 :]],
        }
        if row["key"] == key
        else row
        for row in table["rows"]
    ]
    return {**table, "rows": rows}


def standing(table: Table) -> Table:
    """Return the table in which all rows stand as row 0 does."""
    first = table["rows"][0]
    return {**table, "rows": [{**first, "key": row["key"]} for row in table["rows"]]}


def states(page: DesignClient) -> list[str]:
    return [phase["state"] for phase in page.phases["phases"]]


@pytest.mark.long
def test_two_phases_are_done_and_survive_a_kill(
    starts: Callable[[], tuple[Gateway, DesignClient]], folder: Path
) -> None:
    """A page completes phases 1 and 2; a gateway that is killed then loses no progress."""
    gateway, page = starts()
    table = standing(sample(page))
    assert not (folder / EVIDENCE_FILE).exists()
    page.edits(table)
    assert states(page) == ["open"] * 7

    guesses = []
    for joint, angle_deg, guess in (
        (0, -30.0, "back"),
        (0, 30.0, "back"),
        (6, 60.0, "up"),
        (12, 40.0, None),
        (6, 40.0, None),
        (12, 20.0, None),
    ):
        table = changed(table, 1, joint, angle_deg)
        said = page.edits(table, sequences=SEQUENCES, guess=guess)["guess"]
        guesses.append(said and said["right"])
    assert guesses == [True, False, True, None, None, None]
    page.until(lambda: page.phases["phases"][1]["asked"])
    asked = page.phases["phases"][1]["asked"]
    assert asked["name"] == "other-side"
    reply = page.ask("answer", phase=1, question="other-side", choice=UP)
    assert reply["right"]
    page.until(lambda: states(page)[1] == "met")
    with pytest.raises(Refused):
        page.ask("answer", phase=1, question="other-side", choice=UP)

    page.ask("phase", number=2)
    page.until(lambda: page.phases["phase"] == 2)
    for joint in (12, 14, 16):
        table = changed(table, 1, joint, 45.0)
        page.edits(table, sequences=SEQUENCES)
    for joint, angle_deg in ((0, 0.0), (3, 0.0), (6, 20.0)):
        table = changed(table, 1, joint, angle_deg)
        page.edits(table, sequences=SEQUENCES)
    page.ask("trial", table=table, sequences=SEQUENCES, keys="A1", seconds=3.0)
    page.until(lambda: page.phases["phases"][2]["asked"])
    asked = page.phases["phases"][2]["asked"]
    choice = [one["code"] for one in asked["choices"]].index("phases.margin-edge")
    assert page.ask("answer", phase=2, question=asked["name"], choice=choice)["right"]
    page.until(lambda: states(page)[2] == "met")
    page.ask("phase", number=3)
    before = page.phases

    cut_power(gateway.process)
    _, again = starts()
    assert states(again)[:4] == ["open", "met", "met", "open"]
    assert again.phases["phase"] == before["phase"] == 3


@pytest.mark.long
def test_an_own_gait_gets_a_word_and_is_compared_with_the_sample(
    starts: Callable[[], tuple[Gateway, DesignClient]], folder: Path
) -> None:
    """A slower gait gets a word from its student, and is compared with the sample.

    The evidence keeps the comparison, the guesses, the vote and the check.
    """
    gateway, page = starts()
    own = sample(page)
    halves = [
        {
            **row,
            "angles_deg": [angle / 2 for angle in row["angles_deg"][:6]] + row["angles_deg"][6:],
        }
        for row in own["rows"]
    ]
    slow = {**own, "rows": halves}
    page.edits(own, sequences=SEQUENCES)
    page.ask("trial", table=own, sequences=SEQUENCES, keys="2")
    page.ask("phase", number=5)
    page.edits(slow, "tool", sequences=SEQUENCES)
    guesses = [{"about": "pace", "said": "slower"}, {"about": "way", "said": "left"}]
    page.ask("trial", table=slow, sequences=SEQUENCES, keys="2", guesses=guesses)
    page.ask("trial", table=own, sequences=SEQUENCES, keys="2", watched=True)  # no evidence
    page.ask("name", word="calm")
    page.ask("vote", choice="B")
    page.ask("vote", choice="A")
    checked = page.ask("check", table=slow, sequences=SEQUENCES)
    wrong = page.ask("check", table=changed(slow, 1, 0, 170.0), sequences=SEQUENCES)
    page.until(lambda: not page.phases["phases"][5]["missing"][1:])
    page.close()
    gateway.close()

    evidence = kept(folder)
    assert (checked["keys"], checked["mistakes"]) == (3, [])
    assert len(wrong["mistakes"]) == 1
    assert [one.said for one in evidence if isinstance(one, Guessed) and one.right] == ["slower"]
    assert [type(one) for one in evidence].count(Tried) == 2
    assert any(isinstance(one, Compared) and "speed" in one.differs for one in evidence)
    assert [one.by for one in evidence if isinstance(one, Edited)] == ["tool"]
    assert {one.poll for one in evidence if isinstance(one, Voted)} == {"calm"}
    assert [one.mistakes for one in evidence if isinstance(one, CheckedGait)] == [0]
    assert page.phases["word"] == "calm"
    assert page.phases["trouble"] is None


def test_a_file_that_cannot_be_kept_is_told_and_disturbs_nobody(
    starts: Callable[[], tuple[Gateway, DesignClient]], folder: Path
) -> None:
    """While another program has the evidence file open, the page works and says what is wrong."""
    with ClassStore(folder / EVIDENCE_FILE):
        _, page = starts()
        table = sample(page)
        page.edits(table)
        page.edits(changed(table, 1, 0, 20.0), guess="forward")
        page.until(lambda: page.phases["phases"][1]["share"] > 0)

        assert page.phases["trouble"]["code"] == "database.in-use"
