"""An export has the right contents, and other programs can read it."""

import csv
import io
import itertools
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from google.protobuf.json_format import MessageToDict
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from typer.testing import CliRunner

from lacoc_shared import codec
from lacoc_shared.command import cli
from lacoc_shared.messages import Event, Frame, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.commands import app
from lacoc_shared.record.export import tables as export
from lacoc_shared.record.export.foxglove import foxglove
from lacoc_shared.record.export.pos_data import PosData
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Header, Result
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say, use

MakeFrame = Callable[..., Frame]
MakeHeader = Callable[..., Header]
WriteMatch = Callable[..., Path]
ROBOTS = (12, 12)


@pytest.fixture
def record(tmp_path: Path, write_match: WriteMatch) -> Record:
    """Give the record of the match that `write_match` writes."""
    return Record.read(write_match(tmp_path))


def _table(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text), delimiter="\t"))


def test_pos_data_is_the_table_of_rules_2(frame: MakeFrame) -> None:
    """Pos-data has a header row, tabs, six decimals, degrees, and the time since the first row."""
    half = math.radians(90) / 2
    root = (0.25, -0.5, 0.0625, math.cos(half), 0.0, 0.0, math.sin(half))
    data = PosData(1, ROBOTS)
    for beat in (7, 8):
        other = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        data.add(frame(beat, roots=(other, root), joints=math.radians(-30)))
    lines = data.text().splitlines()
    assert lines[0] == "\t".join(
        ["time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"]
        + [f"j{joint}_deg" for joint in range(12)]
    )
    assert len(lines) == 3
    cells = lines[2].split("\t")
    assert cells[:6] == ["0.020000", "0.250000", "-0.500000", "0.062500", "0.000000", "0.000000"]
    assert float(cells[6]) == pytest.approx(90, abs=1e-4)
    assert [float(cell) for cell in cells[7:]] == pytest.approx([-30] * 12, abs=1e-4)
    assert {len(cell.partition(".")[2]) for cell in cells} == {6}


def test_pos_data_has_a_row_for_each_tick_of_physics(frame: MakeFrame) -> None:
    """Pos-data has a row for each tick of physics, but none for other beats or late frames."""
    data = PosData(0, ROBOTS)
    beats = [
        (0, Phase.LOBBY, 0),
        (1, Phase.READY, 0),
        (2, Phase.READY, 0),
        (3, Phase.COUNTDOWN, 0),
        (50, Phase.COUNTDOWN, 0),
        (153, Phase.PLAYING, 1),
        (154, Phase.PLAYING, 2),
        (157, Phase.PLAYING, 5),  # the frames of beats 155 and 156 have not arrived
        (156, Phase.PLAYING, 4),  # the frame of beat 156 comes late: it gives no row
        (158, Phase.HALTED, 5),
        (200, Phase.COUNTDOWN, 5),
        (350, Phase.PLAYING, 6),
        (351, Phase.FINISHED, 7),
        (352, Phase.FINISHED, 7),
        (353, Phase.OFFICIAL, 7),
    ]
    for beat, phase, clock in beats:
        data.add(frame(beat, phase, clock))
    rows = _table(data.text())
    assert [float(row["x_m"]) for row in rows] == pytest.approx(
        [0.01 * beat for beat in (1, 2, 153, 154, 157, 350, 351)], abs=1e-6
    )
    assert [float(row["time_s"]) for row in rows] == pytest.approx(
        [0.02 * tick for tick in (0, 1, 2, 3, 6, 7, 8)]
    )


def test_a_match_that_a_referee_ends_has_no_last_tick(frame: MakeFrame) -> None:
    """If a decision ends the match, no physics ran in that beat, so Pos-data has no row for it."""
    data = PosData(0, ROBOTS)
    data.add(frame(10, Phase.PLAYING, 10))
    data.add(frame(11, Phase.FINISHED, 10))
    assert len(_table(data.text())) == 1


def test_pos_data_of_a_record(record: Record) -> None:
    """Pos-data of a record has a row for each tick, and an unknown seat is refused."""
    rows = _table(export.pos_data(record, "left").decode())
    assert [float(row["x_m"]) for row in rows] == pytest.approx(
        [0.01 * beat for beat in range(40)], abs=1e-6
    )
    with pytest.raises(
        UserError, match=r'no seat "middle" in this match\. Its seats are left and right'
    ):
        export.pos_data(record, "middle")


def test_pos_data_starts_anew_with_another_robot(
    tmp_path: Path, header: MakeHeader, sheet: Sheet, frame: MakeFrame
) -> None:
    """If a team comes back with another robot, Pos-data has rows of the new robot only."""
    six = msgspec.structs.replace(
        sheet,
        seats=(msgspec.structs.replace(sheet.seats[0], legs=tuple("abcdef")), sheet.seats[1]),
    )
    writer = RecordWriter(tmp_path, header())
    writer.sheet(0, sheet)
    writer.frame(0, codec.encode(frame(0, Phase.READY)))
    writer.sheet(1, six)
    poses = np.zeros(7 + 18 + 7 + 12, "<f4")
    poses[3] = 1.0
    later = msgspec.structs.replace(frame(1, Phase.READY), poses=poses.tobytes())
    writer.frame(1, codec.encode(later))
    writer.close()
    rows = _table(export.pos_data(Record.read(writer.path), "left").decode())
    assert len(rows) == 1
    assert "j17_deg" in rows[0]


def test_events_as_csv(record: Record) -> None:
    """In the CSV file of events, quotes and commas are kept, and seat and team are names."""
    rows = list(csv.DictReader(io.StringIO(export.events_csv(record).decode("utf-8-sig"))))
    assert rows[1] == {
        "number": "13",
        "beat": "13",
        "clock_s": "0.26",
        "pos_data_s": "0.26",
        "kind": "flip",
        "seat": "left",
        "team": "Ants",
        "code": "plain.text",
        "text": '"Ants" flip a disc, and more',
    }
    assert len(rows) == 4


def test_events_are_found_in_pos_data(
    tmp_path: Path, header: MakeHeader, sheet: Sheet, frame: MakeFrame
) -> None:
    """`pos_data_s` of an event is the `time_s` of its beat in Pos-data; "" outside of physics."""
    phases = [Phase.LOBBY, Phase.READY, Phase.COUNTDOWN, Phase.PLAYING, Phase.HALTED, Phase.PLAYING]
    writer = RecordWriter(tmp_path, header())
    writer.sheet(0, sheet)
    for beat, phase in enumerate(phases):
        writer.event(_event(beat))
        writer.frame(beat, codec.encode(frame(beat, phase)))
    writer.close()
    record = Record.read(writer.path)
    rows = list(csv.DictReader(io.StringIO(export.events_csv(record).decode("utf-8-sig"))))
    assert [row["pos_data_s"] for row in rows] == ["", "0.00", "", "0.02", "", "0.04"]
    path = {float(row["time_s"]): row for row in _table(export.pos_data(record, "left").decode())}
    for event in rows:
        if event["pos_data_s"]:
            there = path[float(event["pos_data_s"])]
            assert float(there["x_m"]) == pytest.approx(0.01 * int(event["beat"]))


def _event(beat: int) -> Event:
    said = say("plain.text", text="something")
    return Event(number=beat + 1, match=1, beat=beat, clock_ticks=beat, kind="phase", said=said)


def test_events_as_csv_open_in_excel_in_their_language(record: Record) -> None:
    """The CSV file begins with a byte order mark, and its texts are in the process's language."""
    event = msgspec.structs.replace(record.events[0], said=say("event.team-ready", team="歩行"))
    record.events[:] = [event]
    use("ja")
    try:
        made = export.events_csv(record)
        text = render(event.said, "ja")
    finally:
        use("en")
    assert made.startswith(b"\xef\xbb\xbfnumber,")
    assert text in made.decode()


def test_the_result_as_json(record: Record, result: Result) -> None:
    """The result as JSON can be read as a Result; a match without a result is refused."""
    assert msgspec.json.decode(export.result_json(record), type=Result) == result
    record.results = []
    with pytest.raises(UserError, match="has no result: it was never finished"):
        export.result_json(record)


def _foxglove(record: Record) -> dict[str, list[tuple[int, Any]]]:
    """Map each "topic schema" of a record's Foxglove file to its messages, with their times [ns].

    Messages are decoded with the schemas in the file alone.
    """
    reader = make_reader(
        io.BytesIO(foxglove(record)), validate_crcs=True, decoder_factories=[DecoderFactory()]
    )
    found: dict[str, list[tuple[int, Any]]] = {}
    for schema, channel, message, value in reader.iter_decoded_messages():
        assert schema is not None
        assert (channel.message_encoding, schema.encoding) == ("protobuf", "protobuf")
        plain = MessageToDict(
            value, preserving_proto_field_name=True, always_print_fields_with_no_presence=True
        )
        found.setdefault(f"{channel.topic} {schema.name}", []).append((message.log_time, plain))
    return found


def test_foxglove_draws_the_match(record: Record) -> None:
    """A Foxglove file has Foxglove's own schemas, and the poses of all robot bodies every 40 ms."""
    found = _foxglove(record)
    assert set(found) == {
        "/tf foxglove.FrameTransforms",
        "/scene foxglove.SceneUpdate",
        "/board foxglove.SceneUpdate",
        "/events foxglove.Log",
        "/match lacoc.Match",
        "/robot/left lacoc.Robot",
        "/robot/right lacoc.Robot",
    }
    transforms = found["/tf foxglove.FrameTransforms"]
    times = [time for time, _ in transforms]
    assert {b - a for a, b in itertools.pairwise(times)} == {40_000_000}
    assert len(times) == 20
    last = {t["child_frame_id"]: t for t in transforms[-1][1]["transforms"]}
    assert set(last) == {"left/body", "left/leg", "right/body", "right/leg"}
    assert last["left/body"]["translation"] == {"x": 0.38, "y": 0.0, "z": 0.1}
    assert last["left/leg"]["translation"] == {"x": 0.43, "y": 0.0, "z": 0.1}
    assert last["left/leg"]["rotation"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    logs = found["/events foxglove.Log"]
    assert [log["message"] for _, log in logs] == ['"Ants" flip a disc, and more'] * 4


def test_foxglove_has_numbers_to_plot(record: Record) -> None:
    """A Foxglove file has clock, score, keys, path and joint angles, with names and units."""
    found = _foxglove(record)
    matches, left = found["/match lacoc.Match"], found["/robot/left lacoc.Robot"]
    assert [time for time, _ in matches] == [time for time, _ in left]
    sheet = record.sheets[-1][1]
    frame = codec.decode(record.frames[-2][1], Frame)
    _, last = matches[-1]
    assert last["phase"] == int(frame.phase)
    assert last["clock_s"] == pytest.approx(frame.clock_ticks * 0.02)
    assert last["left_s"] == pytest.approx(max(0, sheet.duration_s - frame.clock_ticks * 0.02))
    _, robot = left[-1]
    assert (robot["score"], robot["key"]) == (frame.seats[0].score, frame.seats[0].key)
    path, _ = export.pos_data(record, "left").decode().splitlines()[-2:]
    values = [float(value) for value in path.split("\t")[1:]]
    names = ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")
    assert [robot[name] for name in names] == pytest.approx(values[:6], abs=1e-5)
    assert robot["joint_deg"] == pytest.approx(values[6:], abs=1e-4)


def test_names_in_tables_are_no_formulas(record: Record) -> None:
    """A team's name that looks like a formula is text in the table of events."""
    (beat, sheet), *_ = record.sheets
    seats = tuple(msgspec.structs.replace(seat, team="=1+2") for seat in sheet.seats)
    record.sheets = [(beat, msgspec.structs.replace(sheet, seats=seats))]
    record.events = [msgspec.structs.replace(record.events[0], seat=0)]
    text = export.events_csv(record).decode("utf-8-sig")
    assert [row["team"] for row in csv.DictReader(io.StringIO(text))] == ["'=1+2"]


def test_foxglove_has_every_shape(record: Record) -> None:
    """A Foxglove file has every shape of the scene; a robot's shapes have its team's colour."""
    [(_, update)] = _foxglove(record)["/scene foxglove.SceneUpdate"]
    entities = {entity["id"]: entity for entity in update["entities"]}
    assert set(entities) == {"world", "left/body", "left/leg", "right/body", "right/leg"}
    floor = entities["world"]["cubes"][0]
    assert (floor["size"]["x"], floor["pose"]["position"]["z"]) == (10.0, -0.0005)
    box = entities["right/body"]
    assert box["frame_id"] == "right/body"
    assert box["cubes"][0]["size"] == {"x": 0.1, "y": 0.12, "z": 0.05}
    assert box["cubes"][0]["color"] == {"r": 1.0, "g": 128 / 255, "b": 0.0, "a": 1.0}
    leg = entities["left/leg"]
    assert leg["cylinders"][0]["size"] == {"x": 0.03, "y": 0.03, "z": 0.04}
    assert [ball["pose"]["position"]["z"] for ball in leg["spheres"]] == [-0.02, 0.02, 0.0]


def test_foxglove_shows_the_board_as_it_changes(record: Record) -> None:
    """A Foxglove file has the whole board at each change, so a viewer can start at any time."""
    boards = _foxglove(record)["/board foxglove.SceneUpdate"]
    assert [(time - boards[0][0]) // 20_000_000 for time, _ in boards] == [0, 20]
    for _, update in boards:
        assert update["deletions"][0]["type"] == "ALL"
        assert [entity["id"] for entity in update["entities"]] == ["c0", "c1", "c2"]
        assert all(len(entity["cylinders"]) == 1 for entity in update["entities"])
    middle = boards[0][1]["entities"][1]
    assert middle["frame_id"] == "world"
    assert middle["cylinders"][0]["pose"]["position"] == {"x": 0.3, "y": 0.0, "z": 0.0}


def test_a_marker_is_drawn_in_its_state(record: Record, scene: Scene) -> None:
    """The board is drawn with the shapes of each marker's current state."""
    geoms = tuple(
        msgspec.structs.replace(geom, rgba=(0.1 * geom.state, 0, 0, 1.0))
        if geom.marker >= 0
        else geom
        for geom in scene.geoms
    )
    record.scenes = [(0, msgspec.structs.replace(scene, geoms=geoms))]
    boards = _foxglove(record)["/board foxglove.SceneUpdate"]
    reds = [
        [entity["cylinders"][0]["color"]["r"] for entity in update["entities"]]
        for _, update in boards
    ]
    assert reds == [[0.1, 0.1, 0.1], [0.2, 0.1, 0.1]]


def test_info(tmp_path: Path, write_match: WriteMatch) -> None:
    """`lacoc replay info` prints text for a person, and with --json one line for a program."""
    path = write_match(tmp_path)
    words = CliRunner().invoke(app, ["info", str(path)])
    assert words.exit_code == 0
    assert "Ants 20, Bees, Inc 16; winner: left; time is up, after 180.00 s of play" in words.stdout
    found = json.loads(CliRunner().invoke(app, ["info", str(path), "--json"]).stdout)
    assert found["teams"] == {"left": "Ants", "right": "Bees, Inc"}
    assert (found["frames"], found["inputs"], found["events"], found["snapshots"]) == (40, 10, 4, 2)
    assert (found["complete"], found["cut"], found["result"]["scores"]) == (True, "", [20, 16])
    assert found["keys"]["left"] == {"count": 4, "held_most_beats": 0, "late": 0}
    assert found["keys"]["right"] == {"count": 4, "held_most_beats": 6, "late": 2}
    assert "right 4 (2 late, delayed by at most 6 beats)" in words.stdout


def test_info_of_a_cut_record(tmp_path: Path, write_match: WriteMatch) -> None:
    """`lacoc replay info` says that a cut record has no end and no result."""
    path = write_match(tmp_path)
    path.write_bytes(path.read_bytes()[:-2500])
    words = CliRunner().invoke(app, ["info", str(path)])
    assert "none: the match was never finished" in words.stdout
    assert "has no end:" in words.stderr
    found = json.loads(CliRunner().invoke(app, ["info", str(path), "--json"]).stdout)
    assert (found["complete"], found["lost"], found["result"]) == (False, False, None)


def test_info_tells_the_time_played(tmp_path: Path, write_match: WriteMatch) -> None:
    """The time played includes time that the referee added; the clock does not include it."""
    path = write_match(tmp_path, gives_s=10.0)
    words = CliRunner().invoke(app, ["info", str(path)]).stdout
    assert "after 190.00 s of play (the clock: 180.00 s)" in " ".join(words.split())
    made = json.loads(export.result_json(Record.read(path)))
    assert (made["played_s"], made["clock_s"]) == (190.0, 180.0)


def test_info_of_a_damaged_record(tmp_path: Path, write_match: WriteMatch) -> None:
    """`lacoc replay info` says that a damaged record's result is lost, not that there was none."""
    path = write_match(tmp_path)
    data = bytearray(path.read_bytes())
    data[-2500] ^= 0xFF
    data[-2492] ^= 0xFF
    path.write_bytes(data)
    words = CliRunner().invoke(app, ["info", str(path)])
    assert "lost: it stood in the part of the record that can't be read" in words.stdout
    assert "no: a part of the record is lost or damaged" in words.stdout
    assert "never finished" not in words.stdout
    with pytest.raises(UserError, match="The result of match m is lost"):
        export.result_json(Record.read(path))


def test_export_writes_all_there_is(tmp_path: Path, write_match: WriteMatch) -> None:
    """`lacoc replay export` without options writes all outputs and adds a number to older files."""
    path, out = write_match(tmp_path), tmp_path / "out"
    for _ in range(2):
        done = CliRunner().invoke(app, ["export", str(path), "--out", str(out)])
        assert done.exit_code == 0
    names = [
        "Pos-data-left.txt",
        "Pos-data-right.txt",
        "events.csv",
        "result.json",
        "foxglove.mcap",
    ]
    assert done.stdout.split() == [str(out / f"m-{name}") for name in names]
    assert len(list(out.iterdir())) == 2 * len(names)
    assert (out / "m-Pos-data-left.1.txt").read_text() == (out / "m-Pos-data-left.txt").read_text()


def test_export_writes_what_is_asked(tmp_path: Path, write_match: WriteMatch) -> None:
    """`lacoc replay export` writes only the chosen outputs, and none if one can't be made."""
    path, out = write_match(tmp_path), tmp_path / "out"
    args = ["export", str(path), "--out", str(out), "--pos-data", "left"]
    done = CliRunner().invoke(app, args)
    assert done.stdout.split() == [str(out / "m-Pos-data-left.txt")]
    failed = CliRunner().invoke(app, [*args, "--events", "--pos-data", "top"])
    assert isinstance(failed.exception, UserError)
    assert [file.name for file in out.iterdir()] == ["m-Pos-data-left.txt"]


def test_export_of_a_match_that_never_began(
    tmp_path: Path, header: MakeHeader, capsys: pytest.CaptureFixture[str]
) -> None:
    """For a match that never began, export writes what it can and says why files are missing."""
    RecordWriter(tmp_path, header()).close()
    path, out = tmp_path / "m.000.live.mcap", tmp_path / "out"
    done = CliRunner().invoke(app, ["export", str(path), "--out", str(out)])
    assert done.exit_code == 0
    assert [file.name for file in out.iterdir()] == ["m-events.csv"]
    assert "has no result" in done.stderr
    assert "has no scene" in done.stderr


def test_the_command_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`lacoc replay` is an entry point; for a missing file it prints an error and exits with 2."""
    assert cli.main(["replay", "info", str(tmp_path / "none.mcap")]) == 2
    assert "There is no record" in capsys.readouterr().err


def test_names_in_a_hostile_record_lead_nowhere(
    tmp_path: Path, header: MakeHeader, frame: MakeFrame, sheet: Sheet, scene: Scene
) -> None:
    """An export writes only into its folder, whatever names a record has for match and seats."""
    writer = RecordWriter(tmp_path, header(match_id="aaaaaaaaaa"))
    writer.sheet(0, sheet)
    writer.scene(0, scene)
    writer.frame(1, codec.encode(frame(1)))
    writer.close()
    path, out = tmp_path / "hostile.mcap", tmp_path / "in" / "side"
    data = writer.path.read_bytes().replace(b"aaaaaaaaaa", b"../../else")
    path.write_bytes(data.replace(b"left", b"../l"))
    before = set(tmp_path.rglob("*"))
    assert CliRunner().invoke(app, ["export", str(path), "--out", str(out)]).exit_code == 0
    new = set(tmp_path.rglob("*")) - before - {out, out.parent}
    assert {file.parent for file in new} == {out}
    assert ".._.._else-Pos-data-.._l.txt" in {file.name for file in new}


def test_a_record_that_contradicts_itself(
    tmp_path: Path, header: MakeHeader, frame: MakeFrame, sheet: Sheet
) -> None:
    """If frames do not fit the sheet, an export is refused with a message."""
    writer = RecordWriter(tmp_path, header())
    writer.sheet(0, sheet)
    short = msgspec.structs.replace(frame(1), poses=b"abc")
    writer.frame(1, codec.encode(short))
    writer.close()
    words = ["export", str(writer.path), "--out", str(tmp_path / "out"), "--pos-data", "left"]
    done = CliRunner().invoke(app, words)
    assert isinstance(done.exception, UserError)
    assert "do not fit together" in str(done.exception)


def test_info_in_japanese(tmp_path: Path, write_match: WriteMatch) -> None:
    """`lacoc replay info` prints headings and sentences in the user's language."""
    path = write_match(tmp_path)
    use("ja")
    try:
        told = CliRunner().invoke(app, ["info", str(path)]).stdout
    finally:
        use("en")
    assert "勝者：左。時間切れ" in told
    assert not re.findall(r"\b(Match|Court|Teams|Held|Keys|winner|frames|late)\b", told)
