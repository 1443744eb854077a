"""Tests of `lacoc play` and `lacoc practice` at a real terminal and with keys from a pipe."""

import os
import signal
import subprocess
import termios
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from court_process import CourtProcess, OpenCourt
from lacoc_process import COMMAND, environment, run_lacoc
from waiting import LIMIT_S

from lacoc_robots.library import sample_gait_files
from lacoc_shared.command import cli, installing

pexpect: Any = pytest.importorskip("pexpect")

pytestmark = pytest.mark.slow

SHOW_CURSOR = "\x1b[?25h"


class Terminal:
    """A command that runs at a terminal of its own."""

    def __init__(self, folder: Path, *words: str) -> None:
        self.child = pexpect.spawn(
            *(COMMAND[0], [*COMMAND[1:], *words]),
            cwd=str(folder),
            timeout=LIMIT_S,
            dimensions=(30, 110),
            encoding="utf-8",
            codec_errors="replace",  # a kill can cut a character in two
            # The LINES and COLUMNS of a test runner would count more than `dimensions`.
            env=environment(TERM="xterm-256color", LINES="30", COLUMNS="110"),
        )
        self.usual = self.modes()

    def modes(self) -> list[Any]:
        """Return the settings of the terminal, such as whether it echoes keys."""
        return termios.tcgetattr(self.child.child_fd)[:4]

    def sees(self, *texts: str) -> None:
        """Wait until the texts are on the screen, one after another."""
        for text in texts:
            self.child.expect_exact(text)

    def press(self, *keys: str) -> None:
        for key in keys:
            self.child.send(key)

    def ended(self) -> int:
        """Wait until the command has ended, and return its exit code."""
        self.child.expect(pexpect.EOF)
        self.child.wait()  # `close` alone would give up on a slow machine
        self.child.close()
        code = self.child.exitstatus
        return -self.child.signalstatus if code is None else int(code)

    def kill(self) -> None:
        """End the command if it still runs."""
        self.child.kill(signal.SIGKILL)
        self.child.wait()
        self.child.close()


@pytest.fixture
def started(open_court: OpenCourt, tmp_path: Path) -> Iterator[tuple[CourtProcess, Terminal]]:
    """Give a court whose match is being played, and the terminal of its left player."""
    court = open_court("--arena", "othello", "--seconds", "60", "--speed", "2")
    terminal = Terminal(tmp_path, "play", "--terminal", "--name", "Ants", *court.where("left"))
    terminal.sees("Ants", " holds the left seat of court main: Robot-Othello.")
    court.start("bot", "straight", *court.where("right"), stdout=subprocess.DEVNULL)
    terminal.sees("press r when you are ready")
    terminal.press("2")
    terminal.sees("[2] refused: keys work only while the match is being played.")
    terminal.press("r")
    terminal.sees("Ants is ready.", "READY")
    words = ("--token", court.referee, "--wait", "20", *court.where())
    assert court.start("referee", "start", *words).wait(LIMIT_S) == 0
    terminal.sees("PLAYING")
    yield court, terminal
    terminal.kill()


def test_keys_of_a_terminal(started: tuple[CourtProcess, Terminal], tmp_path: Path) -> None:
    """Keys work at a terminal as rules 3 and workshop 4-4 say.

    When the player leaves, Pos-data.txt is written; an older file of this name gets another name.
    """
    _, terminal = started
    (tmp_path / "Pos-data.txt").write_text("older")
    terminal.press("1")
    terminal.sees("B key 1, posture")
    terminal.press("\x1b[A")
    terminal.sees("B key 2, posture", "round trip")
    terminal.press("7")
    terminal.sees("[7] refused: your gait file has no such key.")
    terminal.press("\t")
    terminal.sees("This arena allows only level B locomotion.")
    terminal.press(" ")
    terminal.sees("The terminal can't change the view")
    terminal.press("k")
    terminal.sees("[k] does nothing.")
    terminal.press("x")
    terminal.sees("Ants goes back to the start.")
    terminal.press("3")
    terminal.sees("[3] refused: your robot was restarted a moment ago")
    terminal.press("r")
    terminal.sees("This is not possible now: the match is being played.")
    terminal.press("z")
    terminal.sees("You have left.", "Pos-data.1.txt", "Pos-data.txt written")

    assert terminal.ended() == 0
    assert (tmp_path / "Pos-data.1.txt").read_text() == "older"
    header, *rows = (tmp_path / "Pos-data.txt").read_text().splitlines()
    assert header.split("\t")[:4] == ["time_s", "x_m", "y_m", "z_m"]
    assert len(header.split("\t")) == 7 + 18
    assert len(rows) > 50


@pytest.mark.parametrize(
    "way",
    [
        "q",
        pytest.param("\x03", marks=pytest.mark.long),
        signal.SIGTERM,
        pytest.param(signal.SIGHUP, marks=pytest.mark.long),
    ],
)
def test_the_terminal_is_as_before_however_one_leaves(
    open_court: OpenCourt, tmp_path: Path, way: str | signal.Signals
) -> None:
    """After q, Ctrl-C, a kill or a closed window, the terminal's echo and cursor are on again."""
    court = open_court("--arena", "othello")
    terminal = Terminal(tmp_path, "play", "--terminal", *court.where("left"))
    terminal.sees("press r when you are ready")
    assert terminal.modes() != terminal.usual
    if isinstance(way, str):
        terminal.press(way)
    else:
        terminal.child.kill(way)
    terminal.sees(SHOW_CURSOR, "You have left.")

    terminal.child.expect(pexpect.EOF)
    assert terminal.modes() == terminal.usual
    assert terminal.ended() == 0
    assert not (tmp_path / "Pos-data.txt").exists()


@pytest.mark.long
def test_a_court_that_is_gone_is_said_and_comes_back(
    started: tuple[CourtProcess, Terminal],
) -> None:
    """While the court sends nothing, the player sees a banner; afterwards the match goes on."""
    court, terminal = started
    watch = court.start("watch", "--json", "--hz", "0", *court.where())
    assert watch.stdout is not None
    lines = iter(watch.stdout.readline, "")
    assert any('"Play begins."' in line for line in lines)
    os.kill(court.process.pid, signal.SIGSTOP)
    try:
        terminal.sees("No answer from the court for 1 s - trying again")
        assert any('{"type":"link","silent_s":1' in line for line in lines)
    finally:
        os.kill(court.process.pid, signal.SIGCONT)
    terminal.press("2")
    terminal.sees("B key 2, posture")


def piped(folder: Path, script: str, *words: str, **options: Any) -> tuple[int, str]:
    """Run a command with keys from a pipe; return its exit code and all that it printed."""
    done = run_lacoc(*words, input=script, cwd=folder, **{"env": environment()} | options)
    return done.returncode, done.stdout + done.stderr


def test_keys_from_a_pipe_play_a_match(open_court: OpenCourt, tmp_path: Path) -> None:
    """After the last key of its pipe, `lacoc play` stays in the match until the match is over."""
    court = open_court("--arena", "othello", "--seconds", "6", "--speed", "4")
    court.start("bot", "straight", *court.where("right"), stdout=subprocess.DEVNULL)
    words = ("start", "--token", court.referee, "--wait", "30", *court.where())
    court.start("referee", *words, stdout=subprocess.DEVNULL)
    script = "what is this\n1.0 3\n0.5 2"
    code, said = piped(tmp_path, script, "play", "--terminal", "--ready", *court.where("left"))

    assert code == 0
    assert "Line 1 can't be used: 'what' " in said
    assert "The match is finished: time is up." in said
    assert said.rstrip().endswith("You have left. The seat stays yours.")
    assert "refused" not in said


@pytest.mark.long
def test_practice_walks_with_the_sample_keys(tmp_path: Path) -> None:
    """The sample robot walks by keys 1 to 4 at level A and by key 2 at level B (workshop 4-4)."""
    steps = "".join(f"0.5 {key}\n" for key in "12341234")
    script = f"0.2 0\n{steps}tab\n0.5 2\n2.0 z\n"
    code, said = piped(tmp_path, script, "practice", "--terminal", "--name", "Me")

    assert code == 0, said
    assert "Pos-data.txt written" in said
    rows = [line.split("\t") for line in (tmp_path / "Pos-data.txt").read_text().splitlines()[1:]]
    by_time = {float(row[0]): float(row[2]) for row in rows}
    middle_m = by_time[min(by_time, key=lambda time_s: abs(time_s - 4.6))]
    # The sample walks 42 mm/s, more slowly at first; on a busy machine keys come late.
    assert middle_m > 0.03
    assert float(rows[-1][2]) > middle_m + 0.03
    times_s = [float(row[0]) for row in rows]
    assert times_s[-1] > 5  # 6.7 s if no frame of a busy machine was late
    assert [*tmp_path.iterdir()] == [tmp_path / "Pos-data.txt"]  # nobody asked for a record


def test_practice_takes_the_files_of_the_folder(tmp_path: Path) -> None:
    """If no file is named, practice takes the files of its folder and says so (workshop 4-1)."""
    sample = sample_gait_files("hexapod")
    assert sample.postures is not None
    (tmp_path / "Loco-data.txt").write_bytes(sample.postures.data)
    words = ("practice", "--terminal", "--recordings", "kept")
    code, said = piped(tmp_path, "0.1 1\n0.3 tab 2\n3.0 q\n", *words)

    assert code == 0, said
    assert "Files used from this folder: Loco-data.txt." in said
    assert "[2] refused: your gait file has no such key." in said
    kept = {path.suffix for path in (tmp_path / "kept").iterdir()}
    assert ".mcap" in kept  # segments, until a process that outlives the practice has packed them


@pytest.mark.long
def test_practice_begins_anew(tmp_path: Path) -> None:
    """Practice begins a new match even if a killed court left an unfinished match in the folder."""
    kept = ("--recordings", str(tmp_path / "kept"))
    left = CourtProcess(tmp_path, "--arena", "othello", *kept)
    left.process.kill()
    left.close()
    words = ("practice", "--terminal", *kept)
    code, said = piped(tmp_path, "0.1 0\n0.5 q\n", *words)
    assert code == 0, said
    assert len([*(tmp_path / "kept").glob("*-main-001*.mcap")]) == 2


def test_practice_without_mujoco_says_what_to_install(tmp_path: Path) -> None:
    """Without MuJoCo, practice prints one line that says what to install, and exits with 2."""
    (tmp_path / "mujoco.py").write_text("raise ModuleNotFoundError('no mujoco', name='mujoco')")
    words = ("practice", "--terminal")
    code, said = piped(tmp_path, "", *words, env=environment(PYTHONPATH=str(tmp_path)))

    assert code == 2
    assert said.count("\n") == 1
    assert installing.command("server") in said


@pytest.fixture(scope="module")
def quiet_court(tmp_path_factory: pytest.TempPathFactory) -> Iterator[CourtProcess]:
    """Give a court in the lobby that nobody joins."""
    court = CourtProcess(tmp_path_factory.mktemp("court"), "--arena", "othello")
    yield court
    court.close()


def _where(court: CourtProcess, changes: dict[str, str]) -> list[str]:
    given = {"connect": court.address, "token": court.tokens["left"]} | changes
    return [word for name, value in given.items() for word in (f"--{name}", value)]


@pytest.mark.parametrize("command", [["play", "--terminal"], ["bot", "straight"]])
@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"token": "not-the-token-of-it"}, "token"),
        ({"court": "centre"}, 'There is no court "centre" at'),
        ({"connect": "tcp/127.0.0.1:1"}, "No program answers at tcp/127.0.0.1:1."),
        ({"connect": "my court"}, '"my court" is not an address.'),
        ({"name": "x" * 25}, "1 to 24 characters that can be seen"),
        ({"robot": "centipede"}, "centipede"),
    ],
)
def test_a_wrong_start_is_one_clear_message(
    quiet_court: CourtProcess,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: list[str],
    changes: dict[str, str],
    expected: str,
) -> None:
    """A command with a wrong option prints one error message and exits with 2."""
    monkeypatch.chdir(tmp_path)
    with open(os.devnull) as no_keys:
        monkeypatch.setattr("sys.stdin", no_keys)
        code = cli.main([*command, *_where(quiet_court, changes)])
    said = "".join(capsys.readouterr())

    assert code == 2, said
    assert said.count("Error: ") == 1
    assert expected in said
    assert "Traceback" not in said


def test_wrong_files_are_a_table(quiet_court: CourtProcess, tmp_path: Path) -> None:
    """The court refuses the gait of another robot, and a table shows the mistake (rules 2)."""
    sample = sample_gait_files("quadruped")
    assert sample.postures is not None
    (tmp_path / "four.txt").write_bytes(sample.postures.data)
    words = ("play", "--terminal", "--gait", "four.txt", *quiet_court.where("left"))
    code, said = piped(tmp_path, "", *words)

    assert code == 2
    assert "1 mistake. The file is not used until all are corrected." in said
    assert "│ four.txt │" in said
    assert "6 legs" in said


def test_the_board_at_a_terminal(quiet_court: CourtProcess, tmp_path: Path) -> None:
    """`watch --board` draws the board, and leaves the terminal in order when it is killed."""
    terminal = Terminal(tmp_path, "watch", "--terminal", "--board", *quiet_court.where())
    terminal.sees(
        "Robot-Othello, match 1", "LOBBY", "waiting for the left seat to join", "L", "R", "R"
    )
    terminal.child.kill(signal.SIGTERM)
    terminal.sees(SHOW_CURSOR)

    assert terminal.ended() == 0
