"""Tests of `verify` and of a court's start with cut, damaged or foreign records.

Everything readable is recovered, a message says what is missing, and no record is changed.
"""

import json
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest
from lacoc_process import ALONE, run_lacoc
from running import served, write_contest
from stage import FORWARD, LEFT, QUICK, RIGHT, X, decide, join, key, setup
from typer.testing import CliRunner

from lacoc_arenas import arena as arenas
from lacoc_server.commands.replay.verify import app as verify_app
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.recovery import unfinished
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.command import plugins
from lacoc_shared.inputs import Input, ReadySeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.commands import app as replay_app
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Setup
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.words import render

pytestmark = pytest.mark.slow

ID = "20260501-100000-main-001"
INPUTS: dict[int, list[Input]] = {
    0: [join(LEFT), join(RIGHT)],
    1: [ReadySeat(LEFT, True), ReadySeat(RIGHT, True)],
    8: [decide(d.Start())],
    20: [key(LEFT, FORWARD, 1), key(RIGHT, FORWARD, 1)],
    80: [key(RIGHT, X, 2)],
}
BEATS = 120
OTHELLO = arenas.load("othello")


def play(folder: Path, made: Setup, arena: Path | None = None) -> Path:
    """Play 120 beats; leave a record without an end, as a kill does; return the segment's path."""
    journal = Journal(Match(made, World, arena), folder)
    for number in range(BEATS):
        journal.beat(INPUTS.get(number, ()))
    journal.leave()
    assert journal.writer is not None
    return journal.writer.path


@pytest.fixture(scope="module")
def left_behind(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    made = msgspec.structs.replace(setup("othello", QUICK), match_id=ID)
    return play(tmp_path_factory.mktemp("left"), made).read_bytes()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "recordings"
    made.mkdir()
    return made


def segment(folder: Path, data: bytes, number: int = 0) -> Path:
    path = files.segment_path(folder, ID, number)
    path.write_bytes(data)
    return path


def with_header(data: bytes, folder: Path, **changes: Any) -> bytes:
    """Return a record's data with changed fields in its header."""
    path = segment(folder, data)
    header = Record.read(path).header
    old, new = encode(header), encode(msgspec.structs.replace(header, **changes))
    at = data.index(old)
    length = int.from_bytes(data[at - 30 : at - 22], "little") + len(new) - len(old)
    head = data[: at - 30] + length.to_bytes(8, "little") + data[at - 22 : at]
    return head + new + data[at + len(old) :]


def versions(data: bytes, folder: Path, **changes: str) -> bytes:
    header = Record.read(segment(folder, data)).header
    return with_header(data, folder, versions={**header.versions, **changes})


def verdict(path: Path) -> Verdict:
    *_, last = verify(Record.read(path))
    assert isinstance(last, Verdict)
    return last


@pytest.mark.parametrize("share", [0.2, 0.5, 0.83, 0.999])
def test_a_cut_record_is_had_to_the_cut(share: float, left_behind: bytes, folder: Path) -> None:
    """A cut record verifies up to the cut, and a court goes on from there."""
    path = segment(folder, left_behind[: round(share * len(left_behind))])
    found = verdict(path)
    assert found.kind is VerdictKind.SAME
    left = unfinished(folder, "main", OTHELLO)
    assert left is not None
    assert left.match.beats + 1 == found.beats
    assert left.cut is not None
    assert "has no end:" in render(left.cut)


@pytest.mark.parametrize("flips", [20, pytest.param(60, marks=pytest.mark.long)])
def test_a_flipped_byte_anywhere_is_told_or_harmless(
    left_behind: bytes, folder: Path, flips: int
) -> None:
    """A flipped bit never makes `verify` or a court's start fail, except with a UserError.

    The record stays as it is. `verify` finds at least three of four flips.
    """
    whole = Record.read(segment(folder, left_behind))
    chance = random.Random(7)
    told = {"verify": 0, "start": 0}
    for _ in range(flips):
        data = bytearray(left_behind)
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        path = segment(folder, bytes(data))
        try:
            found = verdict(path)
            told["verify"] += found.kind is not VerdictKind.SAME or found.beats < BEATS
        except UserError:
            told["verify"] += 1
        try:
            left = unfinished(folder, "main", OTHELLO)
            told["start"] += left is None or left.match.beats < BEATS - 1
        except UserError:
            told["start"] += 1
        assert path.read_bytes() == data
    # The other flips do not change the match: they hit versions, publish times, message numbers.
    assert told["verify"] >= 0.75 * flips
    assert told["start"] > flips / 6
    assert whole.last_beat == BEATS - 1


@pytest.mark.parametrize("size", [0, 4, 900])
def test_an_empty_last_segment_is_passed_over(size: int, left_behind: bytes, folder: Path) -> None:
    """A court goes on with the match if the newest segment is empty or has no whole header."""
    segment(folder, left_behind)
    segment(folder, left_behind[:size], 1)
    left = unfinished(folder, "main", OTHELLO)
    assert left is not None
    assert (left.match.beats, left.segment) == (BEATS - 1, 2)


def test_an_empty_first_segment_is_no_match(left_behind: bytes, folder: Path) -> None:
    """If the only segment has no whole header, there is no match to go on with."""
    segment(folder, left_behind[:700])
    assert unfinished(folder, "main", OTHELLO) is None


def test_a_missing_segment_is_told(left_behind: bytes, folder: Path) -> None:
    """A court refuses to go on with a match that lacks a segment, and names the missing beats.

    `info`, `export` and `verify` read the part before the gap, and name the missing beats too.
    """
    first = segment(folder, left_behind)
    header = msgspec.structs.replace(Record.read(first).header, segment=2, first_beat=200)
    RecordWriter(folder, header).leave()
    words = "Beats 120 to 199 are missing before"
    with pytest.raises(UserError, match=rf"{words}.*serve --fresh"):
        unfinished(folder, "main", OTHELLO)
    for command in (["info"], ["export", "--events", "--out", str(folder / "out")]):
        done = CliRunner().invoke(replay_app, [*command, str(first)])
        assert done.exit_code == 0
        assert words in " ".join(done.stderr.split())
    done = CliRunner().invoke(verify_app, [str(first), "--json"])
    found = json.loads(done.stdout)
    assert done.exit_code == 1
    assert (found["same"], found["verdict"], found["beats"]) == (False, "same", BEATS)
    assert words in found["cut"]
    assert found["text"].startswith("not proven; only the part that can be read is the same")
    lines = CliRunner().invoke(verify_app, [str(first)]).stdout.splitlines()
    assert lines[0].startswith("A part of the record is lost or damaged")
    assert lines[1].startswith("not proven; ")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda data, at: with_header(data, at, format=2), "has format 2, and this software reads"),
        pytest.param(
            lambda data, at: with_header(data, at, format=0),
            "has format 0, and this software reads",
            marks=pytest.mark.long,
        ),
        pytest.param(
            lambda data, at: versions(data, at, mujoco="3.9.9"),
            "made with MuJoCo 3.9.9",
            marks=pytest.mark.long,
        ),
        (lambda data, at: data.replace(*other_model(data)), "damaged, or this is not the software"),
        (
            lambda data, at: with_header(data, at, setup=setup_of("/home/a/game")),
            'was played in arena "/home/a/game", and this court plays "othello"',
        ),
    ],
)
def test_a_record_of_another_version_is_refused(
    change: Callable[[bytes, Path], bytes], words: str, left_behind: bytes, tmp_path: Path
) -> None:
    """A court refuses to go on with a record of other software or another arena, and says why.

    `serve --fresh` opens a new match beside the record. Nothing changes the record.
    """
    contest, folder = write_contest(tmp_path / "contest.toml"), tmp_path / "recordings"
    folder.mkdir()
    data = change(left_behind, folder)
    path = segment(folder, data)
    with pytest.raises(UserError) as refused:
        unfinished(folder, "main", OTHELLO)
    assert words in str(refused.value)
    done = run_lacoc(ALONE, str(contest), "--recordings", str(folder))
    assert done.returncode == 2
    assert words in " ".join(done.stderr.split())
    assert "--fresh" in done.stderr
    with served(contest, folder, "--fresh"):
        assert path.read_bytes() == data
    assert path.read_bytes() == data
    assert unfinished(folder, "main", OTHELLO) is None, "a match came after it"


def setup_of(arena: str) -> Setup:
    return msgspec.structs.replace(setup("othello", QUICK), match_id=ID, arena=arena)


def other_model(data: bytes) -> tuple[bytes, bytes]:
    """Return the model's hash in the event of READY, and a false hash of the same length."""
    at = data.rindex(b"\xa5model\xb0") + 7
    return data[at : at + 16], b"0" * 16


def test_no_code_runs_because_a_record_names_it(tmp_path: Path, left_behind: bytes) -> None:
    """If a record names a folder with code, verify and a court's start do not run it."""
    game, folder = tmp_path / "game", tmp_path / "recordings"
    game.mkdir()
    folder.mkdir()
    (game / "__init__.py").write_text("raise SystemExit('code of a stranger')")
    path = segment(folder, with_header(left_behind, folder, setup=setup_of(str(game))))
    done = CliRunner().invoke(verify_app, [str(path)])
    assert "code of a stranger" not in done.output
    assert isinstance(done.exception, UserError)
    assert "--arena FOLDER" in str(done.exception)
    with pytest.raises(UserError, match="was played in arena"):
        unfinished(folder, "main", OTHELLO)


def test_a_folder_that_the_user_names_plays_its_record(tmp_path: Path) -> None:
    """A record of a game in a folder is verified and resumed if the user names the folder.

    The folder may have moved since the match was recorded.
    """
    original = plugins.folder_of(plugins.package("lacoc.arenas", "arena", "othello"))
    here, there = tmp_path / "here", tmp_path / "there"
    shutil.copytree(original, here, ignore=shutil.ignore_patterns("__pycache__"))
    ground = arenas.load(str(here), QUICK)
    made = msgspec.structs.replace(
        setup("othello", QUICK), match_id=ID, arena=ground.name, settings=ground.settings
    )
    path = tmp_path / files.segment_path(tmp_path, ID, 0)
    path.write_bytes(play(tmp_path / "running", made, here).read_bytes())
    here.rename(there)
    done = CliRunner().invoke(verify_app, [str(path), "--arena", str(there)])
    assert done.stdout.startswith("same, bit for bit: 120 beats"), done.output
    left = unfinished(path.parent, "main", arenas.load(str(there)))
    assert left is not None
    assert (left.match.beats, left.match.arena.folder) == (BEATS - 1, there)
