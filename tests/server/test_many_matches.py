"""Tests of `lacoc simulate` with many players: who plays, what is printed, how it ends."""

import json
import re
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from handed_in import players_of
from lacoc_process import run_lacoc, started
from typer.testing import CliRunner
from waiting import LIMIT_S

import lacoc
from lacoc_server.commands.simulate import _pairs, app, simulate_command
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.record.reader import Record

BROKEN = b"1\n1\n5"


def in_json(*words: str) -> list[dict[str, Any]]:
    """Return the lines that `lacoc simulate --json` prints."""
    done = run_lacoc("simulate", "--json", *words)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


@pytest.mark.long
@pytest.mark.slow
def test_each_match_is_printed_when_it_has_ended(tmp_path: Path) -> None:
    """`--json` prints who is left out, the remaining players, and two lines for each match.

    One line names the match's record, the other one has the standings.
    """
    anna, ben, dai = players_of(tmp_path, "anna", "ben", "大")
    (chie,) = players_of(tmp_path, "chie", locomotion=BROKEN)
    emi = f"straight@{tmp_path / 'emi'}"
    records = tmp_path / "records"
    out, nobody, begin, *rest = in_json(
        anna, ben, chie, emi, dai, "--rounds", "3", "--seconds", "1", "--leave-out",
        "--record", str(records),
    )  # fmt: skip
    assert (out["kind"], out["player"], out["why"]) == ("left-out", chie, None)
    assert {mistake["file"] for mistake in out["mistakes"]} == {"chie/LocoTra-data.txt"}
    assert out["mistakes"][0]["found"]["code"] == "gait.fewer-keys"
    assert "chie/LocoTra-data.txt, row 1" in out["text"]
    assert (nobody["player"], nobody["mistakes"]) == (emi, [])
    assert nobody["why"]["code"] == "simulate.no-folder"
    assert begin == {"kind": "begin", "players": [anna, ben, dai], "matches": 3}

    matches, tables = rest[::2], rest[1::2]
    assert {line["kind"] for line in matches} == {"match"}
    assert Counter(name for line in matches for name in line["players"]) == {
        anna: 2, ben: 2, dai: 2,
    }  # fmt: skip
    assert sorted(line["record"] for line in matches) == sorted(
        path.name for path in records.iterdir()
    )
    for line in matches:
        record = Record.read(records / line["record"])
        assert record.result is not None
        assert list(record.result.teams) == line["result"]["teams"]
        assert line["winner"] in (0, 1, None)
    assert [(line["kind"], line["done"]) for line in tables] == [
        ("standings", number) for number in (1, 2, 3)
    ]
    ranks = [line["rank"] for line in tables[-1]["standings"]]
    assert (ranks[0], ranks) == (1, sorted(ranks))
    last = {line["name"]: line for line in tables[-1]["standings"]}
    assert last.keys() == {anna, ben, dai}
    assert all(line["won"] + line["drawn"] + line["lost"] == 2 for line in last.values())
    assert sum(line["points"] for line in last.values()) == 3 * 36


def test_what_a_bot_prints_is_no_result(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """All lines on standard output are JSON, whatever a bot prints."""
    bot = tmp_path / "my_bot.py"
    bot.write_text("print('load')\ndef bot(sheet, seat):\n    print('bot')\n    return print\n")
    simulate_command([str(bot), "straight"], seconds=0.1, json=True)
    shown = capsys.readouterr()
    kinds = [json.loads(line)["kind"] for line in shown.out.splitlines()]
    assert kinds == ["begin", "match", "standings"]
    assert {"load", "bot"} < {*shown.err.splitlines()}


@pytest.mark.slow
def test_a_bot_may_go_to_another_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever a bot goes, the next match finds its files, and all records are kept together."""
    monkeypatch.chdir(tmp_path)
    away = "os.chdir(os.path.dirname(__file__) or '..')\n"
    Path("my_bot.py").write_text(
        f"import os\n{away}def bot(sheet, seat):\n    {away}    return lambda frame: None\n"
    )
    Path("pilot_bot.py").write_text("def bot(sheet, seat):\n    return lambda frame: None\n")
    words = ["my_bot.py", "pilot_bot.py", "--seconds", "0.1", "--record", "kept"]
    for more in ([], ["--both-sides", "--jobs", "1"]):
        done = CliRunner().invoke(app, [*words, *more])
        assert done.exit_code == 0, done.exception
    lacoc.simulate("my_bot.py", "straight", seconds=0.1, record="kept")
    assert len([*Path("kept").iterdir()]) == 4


def test_without_two_players_left_nothing_begins(tmp_path: Path) -> None:
    """If fewer than two players can play, the command fails and says why the others can't."""
    (anna,) = players_of(tmp_path, "anna")
    wrong = players_of(tmp_path, "ben", "chie", locomotion=BROKEN)
    with pytest.raises(FileRefused) as refused:
        simulate_command([anna, *wrong], seconds=1.0, leave_out=True)
    assert {mistake.file for mistake in refused.value.mistakes} == {
        f"{name}/LocoTra-data.txt" for name in ("ben", "chie")
    }
    with pytest.raises(UserError, match="There is no folder"):
        simulate_command([anna, f"straight@{tmp_path}/nobody"], seconds=1.0, leave_out=True)


def test_a_robot_that_falls_is_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A robot that does not stand is left out; the command names its player and the mistake."""
    anna, ben, chie = players_of(tmp_path, "anna", "ben", "chie")
    gait = tmp_path / "chie" / "LocoTra-data.txt"
    leaning = gait.read_bytes().replace(b"20\t20\t20\t20\t20\t20", b"-50\t-50\t-50\t80\t80\t80", 1)
    gait.write_bytes(leaning)
    simulate_command([anna, ben, chie], seconds=1.0, leave_out=True, rounds=1)
    said = capsys.readouterr()
    assert f"left out, because they can't play: {chie}" in said.err
    assert "leans" in said.err
    assert "chie" not in said.out


@pytest.mark.parametrize("players", range(2, 10))
@pytest.mark.parametrize("rounds", range(1, 9))
def test_all_players_meet_equally_many(players: int, rounds: int) -> None:
    """With --rounds nobody has more matches than others, and the seats differ by at most one."""
    pairs = _pairs(players, 2, False, rounds)
    often = Counter(one for pair in pairs for one in pair)
    if rounds < players or players % 2 == 0:
        assert set(often.values()) == {rounds + players % 2 * rounds % 2}
        assert len({*map(frozenset, pairs)}) == min(len(pairs), players * (players - 1) // 2)
    left = Counter(pair[0] for pair in pairs)
    assert all(abs(2 * left[one] - often[one]) <= 1 for one in range(players))


def test_rounds_are_for_two_seats() -> None:
    """In an arena with one seat, --rounds is refused."""
    with pytest.raises(UserError, match="has 1 seat"):
        simulate_command(["walker", "walker"], arena="practice", seconds=1.0, rounds=1)


@pytest.fixture
def many(tmp_path: Path) -> Iterator["subprocess.Popen[str]"]:
    """Give a process that plays long matches, each with a record in the folder "records"."""
    words = ["straight", "nearest", "--repeat", "3", "--seconds", "600", "--json", "--jobs", "2"]
    process = started(
        "simulate", *words, "--record", str(tmp_path / "records"),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    with process:
        assert process.stdout is not None
        assert json.loads(process.stdout.readline())["kind"] == "begin"
        while len([*(tmp_path / "records").glob("*.part")]) < 2:
            assert process.poll() is None
            time.sleep(0.02)
        yield process
        process.kill()


@pytest.mark.slow
def test_a_request_to_end_leaves_nothing_half_done(
    many: "subprocess.Popen[str]", tmp_path: Path
) -> None:
    """SIGTERM ends the command and its worker processes; half records are removed."""
    workers = psutil.Process(many.pid).children(recursive=True)
    many.send_signal(signal.SIGTERM)
    assert many.wait(LIMIT_S) == 130
    assert psutil.wait_procs(workers, 10)[1] == []
    assert list((tmp_path / "records").iterdir()) == []


@pytest.mark.long
@pytest.mark.slow
def test_a_worker_that_dies_is_told(many: "subprocess.Popen[str]", tmp_path: Path) -> None:
    """If a worker process is killed, the command names its match, ends, and leaves no record."""
    for child in psutil.Process(many.pid).children(recursive=True):
        if "spawn_main" in " ".join(child.cmdline()):
            child.kill()
            break
    _, said = many.communicate(timeout=LIMIT_S)
    assert many.returncode == 2
    assert "The process that played straight and nearest was killed" in said
    assert list((tmp_path / "records").iterdir()) == []


@pytest.mark.slow
def test_a_bot_that_fails_stops_no_other_match(tmp_path: Path) -> None:
    """A match whose bot fails is told by its team, and all others are played.

    Keys that a gait does not have are counted.
    """
    bad, wrong = tmp_path / "my_bot.py", tmp_path / "your_bot.py"
    bad.write_text("def bot(sheet, seat):\n    return lambda frame: 1 // 0\n")
    wrong.write_text(
        "from lacoc_arenas.bot import Key\n"
        "def bot(sheet, seat):\n    return lambda frame: Key(1, 9)\n"
    )
    done = run_lacoc("simulate", str(bad), str(wrong), "straight", "--seconds", "1", "--json")
    assert done.returncode == 2
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    failed = [line for line in lines if line["kind"] == "failed"]
    assert len(failed) == 4
    assert all(str(bad) in line["players"] for line in failed)
    assert re.match(
        r"my_bot: The bot .*my_bot\.py stopped with an error .*my_bot\.py:2\)", failed[0]["text"]
    )
    matches = [line for line in lines if line["kind"] == "match"]
    keys = [dict(zip(line["players"], line["refused_keys"], strict=True)) for line in matches]
    assert len(keys) == 2
    assert all(one[str(wrong)] > 20 and not one["straight"] for one in keys)
    assert re.search(r"your_bot: \d+ keys were refused", done.stderr)
    assert "Matches without a result: 4 of 6; all others were played." in done.stderr


@pytest.mark.long
def test_a_player_has_one_name_in_all_tables(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Matches and standings call a player the same; players with one team's name are told apart."""
    anna, ben = players_of(tmp_path, "anna", "ben")
    bot, other = tmp_path / "my_bot.py", f"nearest@{tmp_path / 'anna'}"
    bot.write_text("def bot(sheet, seat):\n    return lambda frame: None\n")
    simulate_command([str(bot), ben, anna, other], seconds=0.2, jobs=1)
    matches, standings = (
        [cells[0].strip() for line in part.splitlines() if len(cells := line.split("│")[1:]) > 2]
        for part in capsys.readouterr().out.split("points")
    )
    assert {*matches} == {*standings}
    assert {"my_bot", "ben"} < {*standings}
    assert len({*standings}) == 4
