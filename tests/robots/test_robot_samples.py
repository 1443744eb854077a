"""Every sample robot's folder is complete and can be loaded, and the robot walks."""

import itertools
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import mujoco as mj
import numpy as np
import pytest

import lacoc_robots.samples
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.model import STEPS_PER_TICK
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_server.match.drive import Drive
from lacoc_shared.gait.tables import (
    SAMPLE_KEYS,
    Gait,
    Level,
    LocomotionTable,
    PostureTable,
    to_locomotion,
)
from lacoc_shared.gait.text import read_gait, write_gait

Compile = Callable[..., mj.MjModel]
FOLDERS = [p.parent for p in sorted(Path(lacoc_robots.samples.__path__[0]).glob("*/robot.toml"))]
STAND, LEFT, FORWARD, RIGHT = range(4)

samples = pytest.mark.parametrize("folder", FOLDERS, ids=[folder.name for folder in FOLDERS])

RULES_2_TABLE = """
45   0 -45 -45   0  45   20  20  20  20  20  20    0   0   0   0   0   0
 0   0 -45   0   0  45   20  20  20  20  20  20   40   0  40   0  40   0
45   0   0 -45   0   0   20  20  20  20  20  20   40   0  40   0  40   0
45   0   0 -45   0   0   20  20  20  20  20  20    0  40   0  40   0  40
 0   0 -45   0   0  45   20  20  20  20  20  20    0  40   0  40   0  40
45   0   0   0   0  45   20  20  20  20  20  20   40   0  40   0  40   0
45  45   0 -45   0   0   20  20  20  20  20  20   40   0  40   0  40   0
45  45   0 -45   0   0   20  20  20  20  20  20    0  40   0  40   0  40
45   0   0   0   0  45   20  20  20  20  20  20    0  40   0  40   0  40
"""


def load(folder: Path) -> tuple[RobotSpec, PostureTable, LocomotionTable]:
    robot = read_robot(*find_robot(str(folder))[::-1])
    files = sample_gait_files(str(folder))
    assert files.postures is not None
    assert files.locomotion is not None
    postures = read_gait(files.postures.data, files.postures.name, legs=robot.labels)
    locomotion = read_gait(files.locomotion.data, files.locomotion.name, legs=robot.labels)
    assert isinstance(postures, PostureTable)
    assert isinstance(locomotion, LocomotionTable)
    return robot, postures, locomotion


def walk(
    model: mj.MjModel, robot: RobotSpec, gait: Gait, digit: int, seconds: float
) -> Iterator[mj.MjData]:
    """Drive a robot with one key of level B from its start; yield the physics after every tick."""
    data = mj.MjData(model)
    qpos = [model.joint(f"r0_j{joint}").qposadr[0] for joint in range(robot.joints)]
    data.qpos[qpos] = robot.start_posture
    drive = Drive(
        gait, robot.start_posture, robot.ang_min_rad_s, robot.advance, robot.hold_us, repeat=True
    )
    state = drive.press(drive.begin(Level.LOCOMOTION), Level.LOCOMOTION, digit)
    for _ in range(round(seconds * 50)):
        state = drive.tick(state)
        data.ctrl[:] = state.angles
        mj.mj_step(model, data, nstep=STEPS_PER_TICK)
        yield data
    assert not data.warning.number.any()


def heading_rad(data: mj.MjData) -> float:
    right = data.body("r0_body").xmat.reshape(3, 3)[:, 0]
    return math.atan2(right[1], right[0])


def test_the_samples_there_are() -> None:
    """The sample robots are the workshop's, a long-legged one, an octopod and a quadruped."""
    names = [folder.name for folder in FOLDERS]
    assert names == ["hexapod", "long_legs", "octopod", "quadruped"]
    assert [len(load(folder)[0].legs) for folder in FOLDERS] == [6, 6, 8, 4]


@samples
def test_folder(folder: Path) -> None:
    """A sample is a package with a robot file and both gait files, as `write_gait` writes them."""
    robot, postures, locomotion = load(folder)
    assert (folder / "__init__.py").read_text().startswith('"""')
    assert (folder / "Loco-data.txt").read_bytes() == write_gait(postures, robot.labels)
    assert (folder / "LocoTra-data.txt").read_bytes() == write_gait(locomotion, robot.labels)


@samples
def test_keys_mean_the_same(folder: Path) -> None:
    """In each sample, [0] is stand, [1] turn left, [2] walk, [3] turn right (workshop Fig. 4-2)."""
    robot, postures, locomotion = load(folder)
    assert locomotion == to_locomotion(postures, SAMPLE_KEYS)
    assert postures.postures[0] == pytest.approx(robot.start_posture)


def test_workshop_tables() -> None:
    """The hexapod's files hold the workshop's whole table and the 18 lines of workshop Fig. 4-2."""
    folder = FOLDERS[0]
    _, postures, _ = load(folder)
    for key, row in enumerate(RULES_2_TABLE.strip().splitlines()):
        angles_deg = [math.degrees(angle) for angle in postures.postures[key]]
        assert angles_deg == pytest.approx([float(cell) for cell in row.split()])
    assert len(postures.postures) == 9
    lines = (folder / "LocoTra-data.txt").read_text().splitlines()
    assert [i for i, line in enumerate(lines, 1) if "\t" not in line] == [1, 2, 4, 9, 14]
    assert len(lines) == 18


@pytest.mark.slow
@samples
def test_walks_forward(folder: Path, compile_world: Compile) -> None:
    """A sample gait walks straight at 20 mm/s or more for 20 s, with an upright body."""
    robot, postures, locomotion = load(folder)
    gait = Gait(postures, locomotion)
    for data in walk(compile_world(robot), robot, gait, FORWARD, 20.0):
        body = data.body("r0_body")
        assert body.xmat[8] > 0.95
        assert body.xpos[2] - robot.size_m[2] / 2 > 0.01  # the belly never drags
    assert body.xpos[1] > 20 * 0.020
    assert abs(body.xpos[0]) < 0.1 * body.xpos[1]
    assert abs(math.degrees(heading_rad(data))) < 20


@pytest.mark.slow
@samples
@pytest.mark.parametrize(("digit", "sense"), [(LEFT, 1), (RIGHT, -1)], ids=["left", "right"])
def test_turns(folder: Path, digit: int, sense: int, compile_world: Compile) -> None:
    """[1] turns left and [3] turns right, at 8 degrees/s or more, nearly on the spot."""
    robot, postures, locomotion = load(folder)
    headings = [0.0]
    for data in walk(compile_world(robot), robot, Gait(postures, locomotion), digit, 10.0):
        assert data.body("r0_body").xmat[8] > 0.95
        headings.append(heading_rad(data))
    turned_deg = math.degrees(np.unwrap(headings)[-1])
    assert sense * turned_deg > 80
    assert math.hypot(*data.body("r0_body").xpos[:2]) < 0.1


@pytest.mark.slow
@samples
def test_stands(folder: Path, compile_world: Compile) -> None:
    """With [0] the robot stays where it was put (workshop 3-2: the regular position)."""
    robot, postures, locomotion = load(folder)
    ticks = walk(compile_world(robot), robot, Gait(postures, locomotion), STAND, 4.0)
    (data,) = itertools.islice(ticks, 199, None)
    assert np.allclose(data.body("r0_body").xpos[:2], 0.0, atol=0.002)
    assert data.body("r0_body").xmat[8] > 0.999


@pytest.mark.slow
def test_workshop_speed(compile_world: Compile) -> None:
    """With `advance = "reached"`, the workshop's gait walks at about 57 mm/s on level B."""
    robot, postures, locomotion = load(FOLDERS[0])
    *_, data = walk(compile_world(robot), robot, Gait(postures, locomotion), FORWARD, 20.0)
    assert data.body("r0_body").xpos[1] / 20 == pytest.approx(0.057, abs=0.004)
