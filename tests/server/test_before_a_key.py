"""A robot whose arms reach flags from its start place does not score before a key (rules 1, 4)."""

import msgspec
import pytest
from stage import LEFT, QUICK, RIGHT, Stage, join, key, setup

from lacoc_robots.library import find_robot
from lacoc_server.match.entry import weigh_in
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused

_ARMS = (0, 3, 4, 7)
"""The legs at the corners of the octopod."""
_LARGE = {"width_m": 1.0, "length_m": 1.0}


def _arms() -> JoinSeat:
    """Return an octopod whose corner legs are long, and reach out level in its start posture."""
    name, data = find_robot("octopod")
    text = data.decode()
    head, *legs = text.split("[[leg]]\n")
    for leg in _ARMS:
        legs[leg] = legs[leg].replace("0.075", "0.10") + "lengths_m = [0.015, 0.12, 0.12]\n"
    posture = [[0.0] * 8, [15.0] * 8, [0.0] * 8]
    for leg, root in zip(_ARMS, (12.0, -12.0, -12.0, 12.0), strict=True):
        posture[0][leg], posture[1][leg], posture[2][leg] = root, 20.0, 70.0
    start, rest = head.split("posture_deg = [")
    angles = [angle for level in posture for angle in level]
    head = f"{start}posture_deg = {angles}\n{rest.partition(']')[2]}"
    robot = SentFile(name, ("[[leg]]\n".join([head, *legs])).encode())
    rows = "\t".join(str(angle) for angle in angles)
    gait = SentFile("LocoTra-data.txt", f"2\n1\n{rows}\n1\n{rows}\n".encode())
    return JoinSeat(LEFT, "Arms", robot, None, gait, token_hash="")


def test_a_robot_that_unfolds_is_too_large() -> None:
    """A robot that is small with every angle 0 may not be larger where it stands (rules 1)."""
    one = _arms()
    with pytest.raises(FileRefused) as refused:
        weigh_in(one.robot, None, one.locomotion)
    found = [str(mistake) for mistake in refused.value.mistakes]
    assert all("in its start posture" in text for text in found), found


@pytest.mark.slow
@pytest.mark.parametrize("idle", [True, False])
def test_arms_that_reach_flags_do_not_strike_them_before_a_key(idle: bool) -> None:
    """Flags that a robot touches while it only stands stay up, also when a key comes later.

    They fall when it touches them anew. Without this rule (rules 4) four would fall at once.
    """
    started = msgspec.structs.replace(setup("flag-strike", QUICK), limits=_LARGE)
    stage = Stage("flag-strike", QUICK, World)
    stage.match = Match(started, World)
    stage.to_playing(_arms(), join(RIGHT))
    stage.match.seats[LEFT].idle = idle
    stage.run(60)
    assert len(stage.match.physics.touched()[LEFT]) == 4
    stage.beat(key(LEFT, 1))
    stage.run(2)
    assert stage.scores == ((0, 0) if idle else (4, 0))
