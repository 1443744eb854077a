"""Tests of weighing in at a court's door: the files, and whether the robot can stand (rules 1)."""

import time

import msgspec
import pytest
from stage import join as sample

from lacoc_robots.limits import Limits
from lacoc_server.court.weighing import Weighing
from lacoc_server.match import entry
from lacoc_server.match.entry import JoinCheck
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import PROTOCOL, Join, SentFile
from lacoc_shared.mistakes import FileRefused

HEXAPOD = sample(0)
WHOLE = Join(
    protocol=PROTOCOL,
    token="",
    name="Ants",
    robot=HEXAPOD.robot,
    postures=HEXAPOD.postures,
    locomotion=HEXAPOD.locomotion,
)


def join_check() -> JoinCheck:
    return JoinCheck(
        HEXAPOD.robot, HEXAPOD.postures, HEXAPOD.locomotion, Limits(), (Level.LOCOMOTION,)
    )


def known(weighing: Weighing, join: Join, patience_s: float = 60.0) -> Join:
    until_s = time.monotonic() + patience_s
    while (weighed := weighing(join)) is None:
        assert time.monotonic() < until_s
        time.sleep(0.005)
    return weighed[0]


def changed(old: bytes, new: bytes) -> Join:
    data = HEXAPOD.robot.data.replace(old, new)
    assert data != HEXAPOD.robot.data
    return msgspec.structs.replace(WHOLE, robot=SentFile("mine.toml", data))


def test_a_robot_is_tried_once() -> None:
    """Only the first join with a robot waits for a stand test; later joins use its outcome."""
    with Weighing(join_check()) as weighing:
        assert weighing(WHOLE) is None
        assert known(weighing, WHOLE) == WHOLE
        nothing = Join(protocol=PROTOCOL, token="", name="Bees")  # the contest's robot is the same
        assert weighing(nothing) is not None


def test_wrong_files_are_told_without_a_trial() -> None:
    """Files with mistakes are refused at once, without a stand test."""
    with Weighing(join_check()) as weighing, pytest.raises(FileRefused, match="mass_kg"):
        weighing(changed(b"mass_kg = 0.125", b"mass_kg = 125"))


def test_a_robot_that_does_not_stay_is_refused() -> None:
    """A robot that moves from its start is refused each time; other robots are still accepted."""
    legs = b"45,  0, -45, -45,  0, 45,  # root"
    rowing = changed(legs, b"100, 100, 100, 100, 100, 100,  # root")
    with Weighing(join_check()) as weighing:
        for _ in range(2):
            with pytest.raises(FileRefused, match=r"moves 0\.\d+ m from its start within 2 s"):
                known(weighing, rowing)
        assert known(weighing, WHOLE) == WHOLE


def test_files_are_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that were weighed in at the door are not read again for the match."""
    robot = changed(b'name = "Hexapod"', b'name = "Read once"').robot
    assert robot is not None
    read = []
    real = entry.read_robot
    monkeypatch.setattr(entry, "read_robot", lambda *args: read.append(1) or real(*args))
    files = (robot, HEXAPOD.postures, HEXAPOD.locomotion)
    first = entry.weigh_in(*files, levels={Level.LOCOMOTION})
    assert entry.weigh_in(*files, Limits(), (Level.LOCOMOTION,)) is first
    assert read == [1]
