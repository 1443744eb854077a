"""Reads a robot and its gait from the files that a user names."""

from pathlib import Path

from lacoc_robots.library import find_robot
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_shared.gait.joining import sample_sequences
from lacoc_shared.gait.tables import Gait, PostureTable
from lacoc_shared.gait.workbook.file import read_gait_file
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import Phrase, say


def read_robot_file(name: str) -> RobotSpec:
    """Read a robot's file and check it against the limits of rules 1.

    Raises:
        UserError: if there is no such robot.
        FileRefused: with every mistake of its file.
    """
    file, data = find_robot(name)
    return read_robot(data, file)


def load_gait(file: Path, robot: RobotSpec, notes: list[Phrase] | None = None) -> Gait:
    """Read a gait file of a robot; postures are joined into the sequences of the sample's keys.

    If the file lacks a posture of one of these sequences, the gait has no level B.

    Args:
        file: the gait file.
        robot: the robot that the gait must fit.
        notes: list that remarks are appended to: not mistakes, but perhaps not intended.

    Raises:
        UserError: if the file can't be read.
        FileRefused: with every mistake of the file.
    """
    table = read_gait_file(file, legs=robot.labels, range_deg=robot.ranges_deg, notes=notes)
    if isinstance(table, PostureTable):
        gait = Gait(table, sample_sequences(table))
    else:
        gait = Gait(None, table)
    if gait.joints != robot.joints:
        found = say("trial.joints", joints=gait.joints)
        expected = say("trial.joints-of", joints=robot.joints, robot=robot.name)
        raise FileRefused([Mistake(file=file.name, found=found, expected=expected)])
    return gait
