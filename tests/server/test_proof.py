"""Tests of what `verify` proves, with the same and another arithmetic (docs/reliability.md)."""

import json
import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from bot_matches import play
from msgspec import structs
from other_arithmetic import elsewhere
from tests.campaigns.forge.proof import Prover, forge, forged
from typer.testing import CliRunner
from verdicts import told, verdict

from lacoc_server.commands.replay.verify import app as verify_app
from lacoc_server.journal.judge import Judge
from lacoc_server.journal.section import Difference, SectionFinding, Worlds, simulate_section
from lacoc_server.journal.verdict import Verdict, VerdictKind, conclude, other_arithmetic
from lacoc_server.world import arithmetic
from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.messages import Frame
from lacoc_shared.record.commands import app as record_app
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import FORMAT, Header, Setup
from lacoc_shared.words import Phrase, render, say

SECONDS = 6.0
FORGERIES = 50

HERE = dict(arithmetic.here())
THERE = {**HERE, "functions": "0" * 16, "path": "0" * 16}


def header(first_beat: int = 0, made_by: Mapping[str, str] = HERE) -> Header:
    setup = Setup(court="main", match=1, arena="othello", settings={}, limits={})
    return Header(
        format=FORMAT,
        match_id="m",
        segment=0,
        first_beat=first_beat,
        started="",
        versions={},
        setup=setup,
        arithmetic=dict(made_by),
    )


@pytest.fixture(scope="module")
def paths(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Give the records of two matches of each game, between hexapods that push each other."""
    folder = tmp_path_factory.mktemp("proof")
    return [play(folder, number, SECONDS) for number in (0, 30, 1, 31)]


def with_arithmetic(record: Record, made_by: Mapping[str, str]) -> Record:
    record.headers = [structs.replace(h, arithmetic=dict(made_by)) for h in record.headers]
    return record


# From findings to a verdict.


@pytest.mark.parametrize(
    ("made_by", "finding", "kind"),
    [
        (HERE, SectionFinding(1, 9), VerdictKind.SAME),
        (THERE, SectionFinding(1, 9), VerdictKind.SAME),
        ({}, SectionFinding(1, 9), VerdictKind.SAME),
        (HERE, SectionFinding(1, 9, Difference(5, ("poses",))), VerdictKind.DIFFERS),
        (
            THERE,
            SectionFinding(1, 9, Difference(5, ("poses",)), None, 1e-9),
            VerdictKind.OTHER_ARITHMETIC,
        ),
        (
            {},
            SectionFinding(1, 9, Difference(5, ("poses",)), None, 1e-9),
            VerdictKind.OTHER_ARITHMETIC,
        ),
        (THERE, SectionFinding(1, 9, *[Difference(5, ("poses",))] * 2, 1e-3), VerdictKind.DIFFERS),
    ],
)
def test_bits_may_differ_only_where_another_arithmetic_recorded(
    made_by: Mapping[str, str], finding: SectionFinding, kind: VerdictKind
) -> None:
    """A replay must have the record's bits; with another arithmetic, poses may differ a little."""
    found = conclude([header(made_by=made_by)], 10, 10, [None], [finding])
    assert (found.kind, found.same) == (kind, kind is not VerdictKind.DIFFERS)
    assert found.differs_at == (5 if kind is VerdictKind.DIFFERS else None)
    if kind is VerdictKind.OTHER_ARITHMETIC:
        assert found.worst == (1, 9)
        assert "at most by 1.0e-09 m or rad, in beats 1 to 9" in render(found.said)


def test_each_segment_says_what_made_it() -> None:
    """A section may be replayed with other bits only if another arithmetic recorded part of it."""
    headers = [header(), header(100, THERE)]
    bits = Difference(50, ("poses",))
    for first, last, kind in (
        (1, 99, VerdictKind.DIFFERS),
        (90, 110, VerdictKind.OTHER_ARITHMETIC),
    ):
        found = conclude(headers, 200, 200, [None], [SectionFinding(first, last, bits)])
        assert found.kind is kind


def test_the_first_difference_is_told_with_all_of_its_beat() -> None:
    """The verdict names the first beat that differs, and all differences in that beat."""
    findings = [
        SectionFinding(1, 9, Difference(7, ("state-hash", "poses"))),
        SectionFinding(10, 19, Difference(12, ("poses",))),
    ]
    judged = [Difference(7, ("events", "seats"))]
    found = conclude([header()], 20, 20, judged, findings)
    assert render(found.said) == "beat 7 differs: seats, poses, state hash, its events"


def test_a_fingerprint_names_the_machine() -> None:
    """Arithmetics with equal hashes are the same; a fingerprint's other fields name the machine."""
    assert arithmetic.same(HERE, {**HERE, "python": "4"})
    assert not arithmetic.same(HERE, THERE)
    assert not arithmetic.same({}, {})
    assert other_arithmetic(HERE, HERE) is None
    assert HERE["processor"] in render(other_arithmetic(THERE, HERE) or "")
    assert "does not say" in render(other_arithmetic({}, HERE) or "")


# Honest records, and forged ones.


@pytest.mark.slow
@pytest.mark.long
def test_honest_records_are_the_same(paths: Sequence[Path]) -> None:
    """The verdict on an honest record is "same", even if the record has no fingerprint."""
    for path in paths:
        assert verdict(Record.read(path)).kind is VerdictKind.SAME
    older = with_arithmetic(Record.read(paths[0]), {})
    found = verdict(older, processes=2)
    assert found.kind is VerdictKind.SAME
    assert found.sections == len(older.snapshots) + 1


@pytest.mark.long
@pytest.mark.usefixtures("has_other_arithmetic")
def test_honest_records_hold_with_another_arithmetic(paths: Sequence[Path]) -> None:
    """Verified with another arithmetic, honest records still pass, and no forgery does."""
    found = [elsewhere(told, str(path)) for path in paths]
    assert [one["kind"] for one in found] == [VerdictKind.OTHER_ARITHMETIC] * len(paths), found
    assert all(0 < one["distance"] < 1e-5 for one in found)
    assert elsewhere(forged, [*map(str, paths)], FORGERIES, 2)["passed"] == []


@pytest.mark.slow
@pytest.mark.parametrize("count", [20, pytest.param(FORGERIES, marks=pytest.mark.long)])
def test_no_forgery_passes(paths: Sequence[Path], count: int) -> None:
    """No forgery of a record passes, even if it names another arithmetic."""
    found = forge(paths, count, seed=1)
    assert found.passed == []
    assert len(found.kinds) > 0.3 * count


@pytest.mark.slow
def test_physics_is_saved_no_oftener_than_a_court_does(paths: Sequence[Path]) -> None:
    """With another arithmetic each snapshot may deviate a little: one too many is told."""
    record = with_arithmetic(Record.read(paths[0]), THERE)
    _, section, *_ = Judge(record, None, dict(record.snapshots)).sections()
    del section.steps[100:]
    section.end, worlds = None, Worlds()
    assert simulate_section(section, worlds).bits is None
    assert worlds._world is not None
    record.snapshots.insert(1, (section.last_beat, worlds._world.save()))
    found = Prover().verdict(record)
    assert isinstance(found, Verdict)
    assert found.differs_at == section.last_beat


@pytest.mark.slow
@pytest.mark.parametrize("made_by", [HERE, THERE, {}])
def test_a_pose_is_told_beyond_the_bound_only(
    made_by: Mapping[str, str], paths: Sequence[Path]
) -> None:
    """Verify finds each changed pose, but with another arithmetic only changes above a bound."""
    record = with_arithmetic(Record.read(paths[0]), made_by)
    at = len(record.frames) // 2
    beat, encoded = record.frames[at]
    frame, prover = decode(encoded, Frame), Prover()
    for change_m, is_told in ((1e-6, made_by == HERE), (1e-4, True)):
        x_m = struct.unpack_from("<f", frame.poses)[0] + change_m
        poses = struct.pack("<f", x_m) + frame.poses[4:]
        record.frames[at] = beat, encode(structs.replace(frame, poses=poses))
        found = prover.verdict(record)
        assert isinstance(found, Verdict)
        assert found.differs_at == (beat if is_told else None)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("nudge_m", "made_by", "kind"),
    [
        (1e-12, {**THERE, "model": "0" * 16}, VerdictKind.OTHER_ARITHMETIC),
        (1e-6, {**THERE, "model": "0" * 16}, VerdictKind.DIFFERS),
        (1e-12, THERE, VerdictKind.DIFFERS),
        (1e-12, {}, VerdictKind.DIFFERS),
    ],
)
def test_a_model_may_have_other_last_bits(
    nudge_m: float, made_by: Mapping[str, str], kind: VerdictKind, paths: Sequence[Path]
) -> None:
    """A replay's scene may have other last bits than the record's only if the models differ too."""
    record = with_arithmetic(Record.read(paths[0]), made_by)
    for at, (beat, scene) in enumerate(record.scenes):
        old = message_hash(encode(scene))
        bodies = [
            structs.replace(body, pos=(body.pos[0] + nudge_m, *body.pos[1:]))
            for body in scene.bodies
        ]
        scene = structs.replace(scene, bodies=tuple(bodies))
        new = message_hash(encode(scene))
        record.scenes[at] = beat, scene
        record.frames = [(b, data.replace(old, new)) for b, data in record.frames]
        record.sheets = [
            (b, structs.replace(sheet, scene=new if sheet.scene == old else sheet.scene))
            for b, sheet in record.sheets
        ]
    for at, event in enumerate(record.events):
        if "model" in event.data:
            data = {**event.data, "model": "f" * 16}
            record.events[at] = structs.replace(event, data=data)
    assert record.result is not None
    record.results = [structs.replace(record.result, model="f" * 16)]
    found = Prover().verdict(record)
    assert isinstance(found, Verdict)
    assert found.kind is kind, render(found.said)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rule", "kind"), [(None, VerdictKind.SAME), (say("rule.practice"), VerdictKind.DIFFERS)]
)
def test_a_sheet_of_an_earlier_version_says_no_rule(
    rule: Phrase | None, kind: VerdictKind, paths: Sequence[Path]
) -> None:
    """A record whose sheets lack the rule is the same; one with another rule differs."""
    record = Record.read(paths[0])
    record.sheets = [(b, structs.replace(sheet, rule=rule)) for b, sheet in record.sheets]
    found = Prover().verdict(record)
    assert isinstance(found, Verdict)
    assert found.kind is kind, render(found.said)


# The command.


@pytest.mark.slow
def test_the_command_tells_the_verdict(paths: Sequence[Path]) -> None:
    """`lacoc replay verify --json` prints the verdict; for an honest record it exits with 0."""
    done = CliRunner().invoke(verify_app, [str(paths[0]), "--json"])
    told = json.loads(done.stdout)
    assert done.exit_code == 0
    assert (told["same"], told["verdict"], told["lost"]) == (True, "same", False)
    assert told["arithmetic"] == {"record": HERE, "here": HERE}


@pytest.mark.slow
def test_a_damaged_index_loses_nothing(tmp_path: Path) -> None:
    """If only the index of a record is damaged, all of it is proven, with a warning.

    It can be forked too, and `info` says that it is complete.
    """
    path = play(tmp_path, 0, 0.5)
    whole = Record.read(path)
    data = bytearray(path.read_bytes())
    data[-200] ^= 1
    path.write_bytes(data)
    done = CliRunner().invoke(verify_app, [str(path), "--json"])
    told = json.loads(done.stdout)
    assert done.exit_code == 0
    assert (told["same"], told["verdict"], told["lost"]) == (True, "same", False)
    assert told["beats"] == whole.last_beat + 1
    assert "Nothing of the match is lost" in told["flaw"]
    done = CliRunner().invoke(verify_app, [str(path)])
    assert done.stdout.startswith("same, bit for bit")
    assert "has a damaged index" in done.stdout
    done = CliRunner().invoke(record_app, ["info", str(path), "--json"])
    told = json.loads(done.stdout)
    assert (told["complete"], told["cut"]) == (True, "")
    assert "has a damaged index" in told["flaw"]
    last = str(whole.last_beat)
    fork = pytest.importorskip("lacoc_server.commands.replay.fork")
    done = CliRunner().invoke(fork.app, [str(path), "--beat", last, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "has a damaged index" in done.stderr


@pytest.mark.slow
def test_a_record_that_lost_a_part_is_not_proven(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If a part of a record is lost, the rest is verified and the exit code is 1."""
    monkeypatch.setattr("lacoc_shared.record.packed.CHUNK_BYTES", 20_000)
    path = play(tmp_path, 0, 2.0)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    done = CliRunner().invoke(verify_app, [str(path), "--json"])
    told = json.loads(done.stdout)
    assert done.exit_code == 1
    assert (told["same"], told["verdict"], told["lost"]) == (False, "same", True)
    assert 10 < told["beats"] < 150
    assert "is damaged at byte" in told["cut"]
    done = CliRunner().invoke(verify_app, [str(path)])
    assert done.exit_code == 1
    assert done.stdout.startswith("A part of the record is lost or damaged")
    assert "same, bit for bit" in done.stdout
