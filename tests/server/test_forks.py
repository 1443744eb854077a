"""Tests of forks of a record: unchanged forks repeat it bit for bit, others go on as at a court."""

import dataclasses
import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from bot_matches import bot_match
from mcap.reader import make_reader
from msgspec.structs import replace
from typer.testing import CliRunner

from lacoc_server.commands.replay.fork import app as fork_app
from lacoc_server.commands.replay.verify import app as verify_app
from lacoc_server.contest.league.facts import Planned, Played, new
from lacoc_server.contest.verify.games import GameToCheck, check_game
from lacoc_server.journal.replay import resume, verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_server.simulate.forks.fork import Forked, fork
from lacoc_server.simulate.forks.jobs import ForkJob, bots_of, play_fork
from lacoc_server.simulate.forks.line import ForkChange, of_bot
from lacoc_server.simulate.forks.origin import ForkSource, read_source
from lacoc_server.simulate.forks.script import Script
from lacoc_shared.codec import decode, encode
from lacoc_shared.decisions import TakeBack
from lacoc_shared.inputs import Decide, HeardSeat, KeySeat, SilentSeat
from lacoc_shared.messages import DecisionReply
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.commands import app as record_app
from lacoc_shared.record.matches import MatchName
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import ForkChanges, ForkSeat, Origin
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say, use

QUICK: dict[str, Any] = {
    "match": {"duration_s": 4.0, "countdown_s": 0.2},
    "game": {"pitch_m": 0.15, "disc_radius_m": 0.0675, "opening": "reversi"},
}
"""A small board, on which bots flip discs within seconds."""
MATCH = "20260501-100000-main-001"


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> ForkSource:
    """Give a whole match's record, to fork from it."""
    folder = tmp_path_factory.mktemp("record")
    bot_match(folder, "othello", ("planner", "nearest"), QUICK, match_id=MATCH, late_ticks=(0, 7))
    return read_source(folder / f"{MATCH}.mcap")


@pytest.fixture(scope="module")
def file(source: ForkSource, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the path of the record in `source`."""
    return next(tmp_path_factory.getbasetemp().glob(f"record*/{MATCH}.mcap"))


def beat_of(source: ForkSource, phase: str) -> int:
    return next(one.beat for one in source.record.events if one.data.get("after") == phase)


def flips(source: ForkSource) -> list[tuple[int, int]]:
    return [(one.beat, one.number) for one in source.record.events if "marker" in one.data]


def proven(forked: Forked) -> Record:
    """Check that a fork's record is proven, and return it."""
    assert forked.record is not None
    record = Record.read(forked.record)
    verdict = next(one for one in verify(record, processes=1) if isinstance(one, Verdict))
    assert (record.cut, verdict.kind) == (None, VerdictKind.SAME)
    return record


@pytest.mark.slow
def test_a_fork_without_a_change_is_the_record(source: ForkSource, tmp_path: Path) -> None:
    """From any phase, a fork goes on as its record, bit for bit; only match id and court differ."""
    started, ended = beat_of(source, "PLAYING"), beat_of(source, "FINISHED")
    for beat in (30, started - 3, started + 120, ended):
        again = proven(fork(source, beat, match_id=f"f{beat}", folder=tmp_path))
        was, now = source.record, dict(again.frames)
        assert {number: now.get(number) for number, _ in was.frames} == dict(was.frames)
        assert len(now) <= len(was.frames) + 1  # a new segment begins with a frame
        assert (again.inputs, again.events, again.touches) == (was.inputs, was.events, was.touches)
        assert again.result is not None
        assert was.result is not None
        assert replace(again.result, match_id=MATCH, court="main") == was.result
        assert again.header.match_id == again.sheets[0][1].match_id == f"f{beat}"


def test_a_fork_names_its_origin(source: ForkSource, tmp_path: Path) -> None:
    """A fork's header names its origin: match, beat and record; a fork can be an origin too."""
    beat = beat_of(source, "FINISHED")
    first = fork(source, beat, match_id="first", folder=tmp_path)
    assert first.record is not None
    origin = Record.read(first.record).header.setup.origin
    assert origin is not None
    assert (origin.match_id, origin.beat, origin.record_hash) == (MATCH, beat, source.hash)
    second = fork(read_source(first.record), beat, match_id="second", folder=tmp_path)
    assert second.record is not None
    again = Record.read(second.record).header.setup.origin
    assert again is not None
    assert again.match_id == "first"
    assert again.record_hash not in ("", source.hash)
    with pytest.raises(UserError, match="exists already"):
        fork(source, beat, match_id="first", folder=tmp_path)


def test_a_take_back_agrees_with_the_dry_run(source: ForkSource, tmp_path: Path) -> None:
    """A fork that takes an event back ends with the scores that the referee's dry run gave."""
    events = flips(source)
    assert events
    match = resume(source.record.until(beat_of(source, "FINISHED"))).match
    asks = [Decide("referee", "", TakeBack(number, dry_run=True)) for _, number in events]
    for (beat, number), reply in zip(events, match.beat(asks).outcomes, strict=True):
        assert isinstance(reply, DecisionReply)
        forked = fork(source, beat + 1, ForkChange(take_back=number))
        assert (forked.result.scores, forked.changes) == (reply.scores, reply.changes)
        assert (forked.phase, forked.result.official) == (Phase.FINISHED, "")
    with pytest.raises(UserError, match="refuses this change at beat"):
        fork(
            source, events[0][0] - 5, ForkChange(take_back=events[0][1])
        )  # it has not happened yet


def test_a_short_fork_has_its_take_back(source: ForkSource) -> None:
    """A take-back waits for a beat without recorded inputs; a fork does not end before it."""
    at, number = flips(source)[0]
    busy = {beat: [HeardSeat(0)] for beat in (at + 1, at + 2, at + 3)}
    record = dataclasses.replace(source.record, inputs={**source.record.inputs, **busy})
    changed = dataclasses.replace(source, record=record)
    forked = fork(changed, at + 1, ForkChange(take_back=number), seconds=0.02)
    assert (forked.decided_beat, forked.beats) == (at + 4, 4)
    assert forked.changes


@pytest.mark.slow
def test_bots_and_a_script_take_over(source: ForkSource, file: Path, tmp_path: Path) -> None:
    """If the recorded bots take over without a delay, a fork has the same result as its record.

    The same delays of the bots give the same result, and other delays another one. A script
    presses its keys, also [x], at their times; the other seat keeps its recorded keys.
    """
    first = beat_of(source, "PLAYING") + 1
    beat = first + 50
    bots = bots_of(source, ("planner", "nearest"), None)

    def ended(beat: int, variant: int) -> str:
        players = {seat: of_bot(bot, seat, variant) for seat, bot in enumerate(bots)}
        return fork(source, beat, ForkChange(players=players)).result.digest

    assert source.record.result is not None
    assert ended(beat, 0) == source.record.result.digest
    assert ended(first, 1) == ended(first, 1) != ended(first, 2)
    job = ForkJob(
        file=str(file),
        beat=beat,
        scripts={"left": Script("moves/left.txt", ("1", "0.5 x"))},
        restart=("right",),
        match_id="scripted",
        folder=str(tmp_path),
    )
    record = proven(play_fork(job))
    own = [
        (at, item.key)
        for at, items in record.inputs.items()
        for item in items
        if isinstance(item, KeySeat) and item.seat == 0 and at >= beat
    ]
    assert [key for _, key in own] == [1, 10]
    assert own[1][0] - own[0][0] == 25
    origin = record.header.setup.origin
    assert origin is not None
    assert origin.changes == ForkChanges(
        seats=(ForkSeat(seat="left", script="left.txt"), ForkSeat(seat="right")),
        restart=("right",),
    )
    restarts = [one.seat for one in record.events if one.kind in ("restart", "decision")]
    assert len(restarts) >= 2
    quiet = [x for items in record.inputs.values() for x in items if isinstance(x, SilentSeat)]
    assert quiet == []  # the record of the other seat goes on until the end


def test_an_unfinished_match_goes_on(source: ForkSource, tmp_path: Path) -> None:
    """A record that ends in play goes on: its seats fall silent, and play ends."""
    whole = source.record
    cut = ForkSource(whole.until(beat_of(source, "PLAYING") + 40), source.messages)
    forked = fork(cut, cut.last_beat + 1, match_id="on")
    assert (forked.phase, forked.result.computed != "") == (Phase.FINISHED, True)
    assert fork(cut, cut.last_beat, match_id="on", seconds=0.5).beats == 25


def test_an_assigned_match_gives_its_fork_no_call(source: ForkSource) -> None:
    """A fork of an assigned match has the call "fork", and a fixture that names that match.

    A fork's id, such as "fork-1-at-60-of-MATCH", can't be read as the name of a court's match.
    """
    from lacoc_server.simulate.forks.origin import stem
    from lacoc_shared.messages.office import Assigned

    assigned = Assigned(call="c17", fixture=say("fixture.waiting"), seats=())
    record = source.record.until(source.last_beat)
    record.headers = [
        replace(one, setup=replace(one.setup, assigned=assigned)) for one in record.headers
    ]
    made = stem(ForkSource(record, source.messages), 60, "f").setup
    assert made.assigned is not None
    assert made.assigned.call == "fork"
    assert MATCH in render(made.assigned.fixture)
    assert MatchName.parse(f"fork-1-at-60-of-{MATCH}") is None


def test_a_contest_with_a_fork_is_found_out(source: ForkSource, tmp_path: Path) -> None:
    """If a fork replaces a published record, the check says which match it is a fork of."""
    (tmp_path / "records").mkdir()
    forked = fork(source, source.last_beat, match_id="f", folder=tmp_path / "records")
    assert forked.record is not None
    played = new(
        Played, pairing="p", game=1, teams=forked.result.teams, scores=(0, 0), outcome="draw",
        record="f.mcap",
    )  # fmt: skip
    plan = new(Planned, stage="s", format="round-robin", arena="othello", arena_settings=QUICK)
    about = say("fixture.named", name="x")
    game = GameToCheck(played=played, about=about, plan=plan, files=((), ()))
    found = [render(one) for one in check_game(tmp_path, game, proven=False).wrong]
    assert any(f"it is a fork of match {MATCH}" in one for one in found), found


# The command.


def run(app: Any, *words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, [*words])
    said = str(result.exception) if result.exception else ""
    return result.exit_code, result.output + said


@pytest.mark.slow
def test_the_command_writes_a_fork_and_verify_says_so(file: Path, tmp_path: Path) -> None:
    """`fork` writes a record of its own; the first line of `verify` says what it is a fork of."""
    code, said = run(fork_app, str(file), "--beat", "100", "--out", str(tmp_path), "--seconds", "1")
    assert code == 0, said
    made = tmp_path / f"fork-1-at-100-of-{MATCH}.mcap"
    assert made.exists()
    assert "nobody's official result" in said
    code, said = run(verify_app, str(made))
    assert code == 0
    assert said.strip().startswith("This is a fork, not an official record: up to beat 100")
    assert "same, bit for bit" in said


@pytest.mark.slow
def test_forks_can_be_told_apart(file: Path, source: ForkSource, tmp_path: Path) -> None:
    """The command, its JSON and `replay info` say in both languages how a fork was made.

    A bot's file is named without its folders, and each of several forks has other delays.
    """
    beat, number = flips(source)[0]
    bot = tmp_path / "my_bot.py"
    bot.write_text("def bot(sheet, seat):\n    return lambda frame: None\n")
    words = ("--beat", str(beat + 1), "--seconds", "0.2", "--out", str(tmp_path))
    code, said = run(fork_app, str(file), *words)
    assert code == 0, said
    assert "How it was made: nothing was changed." in said
    changes = ("--take-back", str(number), "--restart", "right", "--players", f"{bot},-")
    code, said = run(fork_app, str(file), *words, *changes)
    assert code == 0, said
    made = (
        "left: the bot my_bot.py, right: recorded keys, "
        f"event {number} taken back, right: robot put back at its start"
    )
    assert f"How it was made: {made}." in said
    code, said = run(fork_app, str(file), *words, *changes, "--times", "2", "--json")
    assert code == 0, said
    lines = [line for line in said.splitlines() if line.startswith("{")]
    first, second, odds = map(json.loads, lines)
    assert [one["made"]["variant"] for one in (first, second, odds)] == [1, 2, 0]
    assert first["made"]["seats"][0] == {"seat": "left", "bot": "my_bot.py", "script": ""}
    path = Path(second["record"])
    said = run(record_app, "info", str(path))[1]
    assert f"How it was made  {made}, delays of the bots: number 2\n" in said
    told = json.loads(run(record_app, "info", str(path), "--json")[1])
    assert told["fork_of"]["changes"] == second["made"]
    use("ja")
    try:
        assert "left の席はボット my_bot.py" in run(record_app, "info", str(path))[1]
    finally:
        use("en")


def test_a_fork_of_an_older_version_does_not_say_how(source: ForkSource, tmp_path: Path) -> None:
    """A record whose origin has no changes, from an older version, is read, and says so."""
    older = {"match_id": MATCH, "beat": 60, "record_hash": source.hash}
    assert decode(encode(older), Origin).changes is None
    forked = fork(source, source.last_beat, match_id="f", folder=tmp_path)
    said = run(record_app, "info", str(forked.record))[1]
    assert "How it was made  its record does not say" in said


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--beat", "9999"), "The record has no beat 9999 to fork at. Choose one from 1 to"),
        (("--beat", "0"), "The record has no beat 0"),
        (("--beat", "5", "--players", "planner,planner"), "Nobody can take over at beat 5"),
        (("--beat", "120", "--players", "planner"), "--players names 1 player"),
        (("--beat", "120", "--players", "nobody,-"), "nobody"),
        (("--beat", "120", "--restart", "up"), 'There is no seat "up"'),
        (("--beat", "120", "--times", "3"), "needs a bot in a seat"),
        (("--beat", "120", "--keys", "left"), "does not name a seat and a file"),
        (("--beat", "120", "--keys", "left=none.txt"), "Cannot read none.txt"),
        (("--beat", "20", "--take-back", "12"), "Event 12 happens at beat"),
        (("--beat", "120", "--players", "planner,-", "--keys", "left=keys.txt"), "both name"),
        (
            ("--beat", "120", "--keys", "left=wrong.txt"),
            "The script wrong.txt has a mistake. Line 1 can't be used: 'forward'",
        ),
        (("--beat", "120", "--take-back", "999"), "event 999 can't be taken back"),
        (
            ("--beat", "120", "--out", "keys.txt"),
            "be written to keys.txt: File exists",
        ),
        (
            ("--beat", "120", "--out", "keys.txt/a"),
            "be written to keys.txt/a: Not a dir",
        ),
        (
            ("--beat", "120", "--out", "keys.txt", "--times", "2", "--players", "planner,planner"),
            "No record can be written to keys.txt",
        ),
    ],
)
def test_a_mistake_is_explained(
    words: tuple[str, ...],
    said: str,
    file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """If options of `fork` are wrong, the error says which and why, and no fork is written."""
    monkeypatch.chdir(tmp_path)
    Path("keys.txt").write_text("1.0 2\n")
    Path("wrong.txt").write_text("0 forward\n")
    code, found = run(fork_app, str(file), "--out", str(file.parent), *words)
    assert code != 0
    assert said in found
    assert [*file.parent.glob("fork*")] == []


def test_a_record_that_can_not_be_forked(file: Path, source: ForkSource, tmp_path: Path) -> None:
    """A file that is no record, a damaged record and one of another MuJoCo can't be forked.

    Each is refused with its reason.
    """
    text = tmp_path / "text.mcap"
    text.write_text("no record")
    code, said = run(fork_app, str(text), "--beat", "100")
    assert code != 0
    assert "text.mcap" in said
    damaged = tmp_path / f"{MATCH}.mcap"
    shutil.copy(file, damaged)
    with damaged.open("rb") as packed:
        summary = make_reader(packed).get_summary()
    assert summary is not None
    data = bytearray(damaged.read_bytes())
    data[summary.chunk_indexes[-1].chunk_start_offset + 100] ^= 0xFF
    damaged.write_bytes(data)
    code, said = run(fork_app, str(damaged), "--beat", "100", "--out", str(tmp_path))
    assert code != 0
    assert "A part of the record is lost or damaged, so no match can go on from it." in said
    assert said.count("again from where it was made") == 1
    record = source.record.until(source.last_beat)
    versions = {**record.header.versions, "mujoco": "1.2.3"}
    record.headers = [replace(record.header, versions=versions)]
    with pytest.raises(UserError, match=r"made with MuJoCo 1\.2\.3"):
        fork(ForkSource(record, source.messages), 100)
