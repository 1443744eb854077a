"""Tests of weighing in: a robot and its gait files are checked together (rules 1 and 2)."""

import pytest
from stage import join

from lacoc_robots.limits import Limits
from lacoc_server.match.entry import JoinCheck, weigh_in
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import PROTOCOL, Join, SentFile
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import render, say

HEXAPOD = join(0)


def mistakes_of(
    robot: SentFile | None = None,
    postures: SentFile | None = None,
    locomotion: SentFile | None = None,
    **limits: float,
) -> list[Mistake]:
    with pytest.raises(FileRefused) as refused:
        weigh_in(robot or HEXAPOD.robot, postures, locomotion, Limits.of(limits))
    return refused.value.mistakes


def edited(file: SentFile | None, old: str, new: str) -> SentFile:
    assert file is not None
    assert old.encode() in file.data
    return SentFile(file.name, file.data.replace(old.encode(), new.encode(), 1))


@pytest.mark.parametrize("robot", ["hexapod", "long-legs", "quadruped", "octopod"])
def test_every_sample_is_let_in(robot: str) -> None:
    """Every sample robot is accepted with its sample gait."""
    was: JoinSeat = join(0, robot=robot)
    entry = weigh_in(was.robot, was.postures, was.locomotion)
    assert entry.gait.joints == entry.robot.joints


def test_one_gait_file_is_enough() -> None:
    """A robot with a table for only one level is accepted; one without any table is refused."""
    assert weigh_in(HEXAPOD.robot, HEXAPOD.postures, None).gait.locomotion is None
    assert weigh_in(HEXAPOD.robot, None, HEXAPOD.locomotion).gait.postures is None
    (mistake,) = mistakes_of()
    assert mistake.found == say("gait.none-for-arena")


def test_a_gait_needs_keys_at_an_open_level() -> None:
    """If only level B is open, a robot with nothing but a Loco-data file is refused."""
    with pytest.raises(FileRefused, match=r"gait convert Loco-data\.xlsx LocoTra-data"):
        weigh_in(HEXAPOD.robot, HEXAPOD.postures, None, levels=(Level.LOCOMOTION,))


def test_the_files_are_not_swapped() -> None:
    """A Loco-data file that is sent as LocoTra-data is a mistake, and so is the reverse."""
    found = [m.expected for m in mistakes_of(None, HEXAPOD.locomotion, HEXAPOD.postures)]
    assert found == [
        say("gait.loco-data"),
        say("gait.locotra-data"),
    ]


def test_a_workbook_is_refused() -> None:
    """An Excel file sent as Loco-data is a mistake, because a court reads only text."""
    assert mistakes_of(None, SentFile("Loco-data.xlsx", b"PK\x03\x04"))


def test_a_gait_for_another_robot() -> None:
    """If a gait has fewer angles than the robot has joints, both of its files have a mistake."""
    other = join(0, robot="quadruped")
    assert {m.file for m in mistakes_of(None, other.postures, other.locomotion)} == {
        "Loco-data.txt",
        "LocoTra-data.txt",
    }


def test_angles_out_of_the_robots_own_range() -> None:
    """Rules 2: an angle outside the robot file's range is a mistake; it is not clamped silently."""
    narrow = edited(HEXAPOD.robot, "range_deg = [-150, 150]", "range_deg = [-45, 45]")
    assert weigh_in(narrow, HEXAPOD.postures, HEXAPOD.locomotion).robot.name == "Hexapod"
    far = edited(HEXAPOD.postures, "40", "45.5")
    (mistake,) = mistakes_of(narrow, far)
    assert (mistake.file, mistake.found) == ("Loco-data.txt", "45.5")
    assert "-45" in render(mistake.expected)
    weigh_in(HEXAPOD.robot, far, None)


def test_a_range_is_met_exactly() -> None:
    """An angle at the end of a joint's range is accepted, in spite of rounding to radians."""
    for end in ("127.8", "124.6", "120.1"):
        robot = edited(HEXAPOD.robot, "range_deg = [-150, 150]", f"range_deg = [-{end}, {end}]")
        gait = edited(HEXAPOD.postures, "40", end)
        weigh_in(robot, gait, None)


def test_all_mistakes_of_all_files_at_once() -> None:
    """The mistakes of all three files are reported at once."""
    robot = edited(HEXAPOD.robot, "mass_kg = 0.125", "mass_kg = 7")
    postures = edited(HEXAPOD.postures, "45", "abc")
    locomotion = edited(HEXAPOD.locomotion, "45", "def")
    found = mistakes_of(robot, postures, locomotion)
    assert [m.file for m in found] == ["robot.toml", "Loco-data.txt", "LocoTra-data.txt"]


def test_the_contests_limits() -> None:
    """Rules 1: a contest may lower the limits for robots, such as the speed of joints."""
    (mistake,) = mistakes_of(None, HEXAPOD.postures, ang_min_deg_s=100.0)
    assert mistake.field == "drive.ang_min_deg_s"


def test_a_legend_that_contradicts_the_columns_is_told_with_the_join() -> None:
    """If a file's legend contradicts its columns, the columns count and the entry has a note."""
    assert HEXAPOD.postures is not None
    exchanged = HEXAPOD.postures.data.replace(b"R,F", b"x").replace(b"L,F", b"R,F")
    (note,) = weigh_in(HEXAPOD.robot, SentFile("mine.txt", exchanged), None).notes
    assert "the legend says R,F, but joint 5 is a joint of leg L,F" in render(note)
    assert weigh_in(HEXAPOD.robot, HEXAPOD.postures, HEXAPOD.locomotion).notes == ()


def asks(team: str = "Ants", **files: SentFile | None) -> Join:
    """Return a team's join with some files, as a controller sends it."""
    return Join(protocol=PROTOCOL, token="", name=team, **files)


CONTEST = JoinCheck(
    HEXAPOD.robot, HEXAPOD.postures, HEXAPOD.locomotion, Limits(), (Level.LOCOMOTION,)
)
SAMPLE = asks(robot=HEXAPOD.robot, postures=HEXAPOD.postures, locomotion=HEXAPOD.locomotion)
OWN = join(0, team="Ants", robot="quadruped")


def test_a_team_that_comes_back_without_files_keeps_its_own() -> None:
    """A team that joins its seat again without files keeps its files, and a note names them."""
    whole, (note,) = CONTEST(asks(), OWN)
    assert whole == asks(robot=OWN.robot, postures=OWN.postures, locomotion=OWN.locomotion)
    assert note.code == "note.files-kept"
    assert "robot.toml, Loco-data.txt and LocoTra-data.txt" in render(note)


@pytest.mark.parametrize(
    ("asked", "held"),
    [
        (asks(), None),
        (asks("Bees"), OWN),
        (asks(), join(0, team="Ants")),
    ],
)
def test_without_files_a_team_gets_the_sample(asked: Join, held: JoinSeat | None) -> None:
    """A team without files of its own gets the sample robot and gait, and a note says so."""
    whole, notes = CONTEST(asked, held)
    files = (whole.robot, whole.postures, whole.locomotion)
    assert files == (SAMPLE.robot, SAMPLE.postures, SAMPLE.locomotion)
    assert notes == (say("note.files-sample"),)


def test_files_that_a_team_brings_are_used() -> None:
    """A team that comes back with one gait file gets the contest's robot.

    It gets none of its former files, and nothing for the other gait file.
    """
    whole, notes = CONTEST(asks(locomotion=HEXAPOD.locomotion), OWN)
    assert (whole.robot, whole.postures) == (HEXAPOD.robot, None)
    assert notes == ()
