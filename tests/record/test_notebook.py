"""Tests of records read as arrays: nothing is lost, and a bad record is refused with a message."""

import dataclasses
import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import msgspec
import numpy as np
import pytest

from lacoc_shared import codec
from lacoc_shared.messages import Frame, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import notebook
from lacoc_shared.record.export.kinematics import split_poses
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Header
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import Phase

MakeFrame = Callable[..., Frame]
MakeHeader = Callable[..., Header]
WriteMatch = Callable[..., Path]


@pytest.fixture
def path(tmp_path: Path, write_match: WriteMatch) -> Path:
    return write_match(tmp_path)


@pytest.fixture(scope="module")
def example() -> ModuleType:
    """Import examples/plot_match.py, and give the module."""
    file = Path(__file__).parents[2] / "examples" / "plot_match.py"
    spec = importlib.util.spec_from_file_location("plot_match", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_arrays_have_what_the_frames_have(path: Path) -> None:
    """Each frame's beat, clock, phase, score, board and poses stand in its row."""
    match = notebook.read(path)
    record = Record.read(path)

    assert match.beat.tolist() == [beat for beat, _ in record.frames]
    for row, (beat, encoded) in enumerate(record.frames):
        frame = codec.decode(encoded, Frame)
        assert match.time_s[row] == pytest.approx(beat * 0.02)
        assert match.clock_s[row] == pytest.approx(frame.clock_ticks * 0.02)
        assert match.phase[row] == Phase(frame.phase).name
        assert match.playing[row] == (frame.phase == Phase.PLAYING)
        assert match.score[row].tolist() == [seat.score for seat in frame.seats]
        assert tuple(match.markers[row]) == codec.unpack_states(frame.markers, 3)
        for robot, pose in zip(match.robots, split_poses(frame.poses, (12, 12)), strict=True):
            own = [*robot.position_m[row], *robot.quaternion[row], *robot.joints_rad[row]]
            assert own == pose.tolist()
    assert match.marker_names.tolist() == ["c0", "c1", "c2"]
    assert match.marker_position_m[2].tolist() == pytest.approx([0.6, 0.0])
    assert (match.winner, match.arena, match.cut) == ("left", "othello", "")


def test_keys_and_events_are_tables(path: Path) -> None:
    """Each key and each event has a row, in order, with times in their units."""
    match = notebook.read(path)

    assert match.keys.beat.tolist() == [3, 3, 13, 13, 23, 23, 33, 33]
    assert match.keys.seat.tolist() == [0, 1] * 4
    assert match.keys.key.tolist() == [2, 3] * 4
    assert match.keys.held_ms.tolist() == [0, 60, 0, 120, 0, 40, 0, 100]
    assert match.keys.late_ms.tolist() == [0, 0, 0, 0, 0, 20, 0, 20]
    assert match.events.kind.tolist() == ["flip"] * 4
    assert match.events.time_s == pytest.approx(np.array([0.06, 0.26, 0.46, 0.66]))
    assert match.events.text[0] == '"Ants" flip a disc, and more'
    for table in (match.keys, match.events):
        columns = notebook.columns(table)
        assert list(columns) == [field.name for field in dataclasses.fields(table)]
        assert len({len(column) for column in columns.values()}) == 1


def test_each_shows_as_one_short_line(path: Path) -> None:
    """What a notebook shows of a match and its parts is a short line, not whole arrays."""
    match = notebook.read(path)

    assert repr(match.robots[0]).startswith("RobotArrays(seat='left', team='Ants', frames=")
    assert repr(match.keys) == "KeyArrays(8 keys)"
    assert repr(match.events) == "EventArrays(4 events)"
    assert repr(match).endswith(", winner='left')")
    assert "match_id='" in repr(Record.read(path))
    for one in (match, match.robots[0], Record.read(path)):
        assert len(repr(one)) < 150, repr(one)
        assert "\n" not in repr(one)


def test_a_field_without_robots_is_nan(
    tmp_path: Path, header: MakeHeader, sheet: Sheet, frame: MakeFrame
) -> None:
    """Before READY there are no robots: their numbers are NaN. Tables without a row are empty."""
    writer = RecordWriter(tmp_path, header())
    writer.sheet(0, sheet)
    writer.frame(0, codec.encode(frame(0, Phase.LOBBY)))
    writer.frame(1, codec.encode(frame(1, Phase.READY)))
    writer.close()
    match = notebook.read(str(writer.path))

    for robot in match.robots:
        assert np.isnan(robot.position_m[0]).all()
        assert np.isfinite(robot.joints_rad[1]).all()
    assert len(match.keys.beat) == len(match.events.beat) == 0


def test_another_robot_has_its_own_columns(
    tmp_path: Path, header: MakeHeader, sheet: Sheet, frame: MakeFrame
) -> None:
    """If a team comes back with fewer joints, the columns of the missing joints are NaN."""
    left = sheet.seats[0]
    other = msgspec.structs.replace(
        sheet, seats=(msgspec.structs.replace(left, legs=left.legs[:2]), sheet.seats[1])
    )
    writer = RecordWriter(tmp_path, header())
    writer.sheet(0, sheet)
    writer.frame(0, codec.encode(frame(0)))
    writer.sheet(1, other)
    whole = frame(1, joints=0.5)
    cut = np.frombuffer(whole.poses, "<f4")
    shorter = np.concatenate([cut[:13], cut[19:]]).tobytes()
    writer.frame(1, codec.encode(msgspec.structs.replace(whole, poses=shorter)))
    writer.close()
    match = notebook.read(writer.path)

    assert match.robots[0].joints_rad.shape == (2, 12)
    assert match.robots[0].joints_rad[1, :6].tolist() == [0.5] * 6
    assert np.isnan(match.robots[0].joints_rad[1, 6:]).all()
    assert match.robots[1].joints_rad[1].tolist() == [0.5] * 12


def test_bad_records_are_refused(
    tmp_path: Path, header: MakeHeader, sheet: Sheet, frame: MakeFrame, scene: Scene
) -> None:
    """A file that is no record, a record without a frame, and a contradictory one are refused."""
    other = tmp_path / "other.mcap"
    other.write_bytes(b"no record")
    with pytest.raises(UserError, match=r"other\.mcap"):
        notebook.read(other)

    empty = RecordWriter(tmp_path, header(match_id="empty"))
    empty.sheet(0, sheet)
    empty.scene(0, scene)
    empty.close()
    with pytest.raises(UserError, match="no frame"):
        notebook.read(empty.path)

    wrong = RecordWriter(tmp_path, header(match_id="wrong"))
    wrong.sheet(0, sheet)
    poses = frame(0).poses[:-4]
    wrong.frame(0, codec.encode(msgspec.structs.replace(frame(0), poses=poses)))
    wrong.close()
    with pytest.raises(UserError, match="do not fit together"):
        notebook.read(wrong.path)


def test_the_example_draws_the_match(path: Path, example: ModuleType) -> None:
    """The example's picture is SVG with a path and a line of points for each robot."""
    root = ElementTree.fromstring(example.picture(notebook.read(path)))
    lines = [child for child in root if child.tag.endswith("polyline")]

    assert len(lines) == 4  # two paths, two scores
    assert "left: Ants" in "".join(root.itertext())


def test_the_example_s_axis_has_the_points_of_the_match(path: Path, example: ModuleType) -> None:
    """The axis of points goes from the fewest points to the most, in round steps."""
    match = notebook.read(path)
    score = np.broadcast_to([[15, 21]], match.score.shape)
    root = ElementTree.fromstring(example.picture(dataclasses.replace(match, score=score)))
    labels = [one.text or "" for one in root if one.get("text-anchor") == "end"]

    assert [label for label in labels if label.isdecimal()] == [str(n) for n in range(15, 22)]


@pytest.mark.parametrize(
    ("out", "said"),
    [
        ("a.png", "its name must end in .svg: a.png does not"),
        ("none/a.svg", "Cannot write none/a.svg: No such file"),
    ],
)
def test_the_example_explains_a_mistake(
    out: str, said: str, path: Path, example: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the picture can't be written where the user wants it, one line says why."""
    monkeypatch.chdir(path.parent)
    monkeypatch.setattr("sys.argv", ["plot_match.py", str(path), out])
    with pytest.raises(SystemExit, match=said):
        example.main()
