"""Walks of the sample robots: as trials, and as matches of the same keys."""

from collections.abc import Sequence
from functools import cache

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import Entry, weigh_in
from lacoc_server.match.match import Match
from lacoc_server.trial.course import Course, practice_field
from lacoc_server.trial.walk import Press
from lacoc_server.world.sensed import make_course
from lacoc_server.world.world import World
from lacoc_shared.inputs import Input, JoinSeat, KeySeat, ReadySeat
from lacoc_shared.messages import SentFile
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import Phase

ROBOTS = ("hexapod", "quadruped", "octopod")


@cache
def entry_of(robot: str) -> Entry:
    """Weigh in a sample robot with its sample gait."""
    return weigh_in(SentFile(*find_robot(robot)), *sample_gait_files(robot))


@cache
def course_of(robot: str) -> Course:
    """Build the floor and the robot for trials of a sample robot."""
    return make_course(entry_of(robot).robot)


def match_digests(
    robot: str, locomotion: SentFile, presses: Sequence[Press], ticks: int
) -> list[bytes]:
    """Play a trial's keys in a practice match; return the state hash after each tick."""
    settings = practice_field().settings
    setup = Setup(
        match_id="trial", court="trial", match=1, arena="practice", settings=settings, limits={}
    )
    match = Match(setup, World)
    match.beat([JoinSeat(0, "Team", SentFile(*find_robot(robot)), None, locomotion, token_hash="")])
    due = {press.tick: press for press in presses}
    inputs: list[Input] = [ReadySeat(0, True)]
    found: list[bytes] = []
    while len(found) < ticks:
        if match.beat(inputs).ticked:
            found.append(match.physics.digest)
        elif match.fault is not None:
            break
        press = due.get(len(found)) if match.phase is Phase.PLAYING else None
        inputs = [KeySeat(0, len(found), int(press.level), press.digit)] if press else []
    return found
