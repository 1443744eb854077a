"""The log of processes that run for long: its lines, and that writing it never waits."""

import json
import os
import subprocess
import sys
from datetime import datetime
from pathlib import Path

import pytest
from waiting import LIMIT_S

SAY = """
from lacoc_shared.command import log
log.get().info("before")
log.start({json})
say = log.get(court="main")
say.info("Ants flip c2r3.", kind="flip", match_id="m-1", clock_ticks=615, data={{"points": (1, 2)}})
say.warning("3 slow beats.", kind="slow", match_id="m-1")
say.debug("not this")
"""


def said(code: str, encoding: str = "utf-8") -> str:
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        encoding=encoding,
        env=os.environ | {"PYTHONIOENCODING": encoding},
        check=True,
        timeout=LIMIT_S,
    )
    assert done.stderr == ""
    return done.stdout


def test_lines_for_a_program() -> None:
    """With JSON, a line has time, level, court and match; messages before `start` are dropped."""
    first, second = map(json.loads, said(SAY.format(json=True)).splitlines())
    assert datetime.fromisoformat(first.pop("timestamp")).tzinfo is not None
    assert first == {
        "text": "Ants flip c2r3.",
        "kind": "flip",
        "level": "info",
        "court": "main",
        "match_id": "m-1",
        "clock_ticks": 615,
        "data": {"points": [1, 2]},
    }
    assert (second["level"], second["kind"]) == ("warning", "slow")


def test_lines_for_a_person() -> None:
    """Without JSON, a line has time, match, clock and text; a pipe gets no colours."""
    first, second = said(SAY.format(json=False)).splitlines()
    assert first[8:] == " m-1 0:12.3  Ants flip c2r3."
    assert second[8:] == " m-1  3 slow beats."


NAMES = """
from lacoc_shared.command import log
log.start({json})
for text in ("Équipe", "チーム 🤖 takes the left seat.", "three"):
    log.get(court="main").info(text)
"""


def test_what_a_terminal_can_not_show_ends_no_log() -> None:
    """A character that the terminal can't show is written as a number, and the log goes on."""
    lines = said(NAMES.format(json=False), "cp1252").splitlines()
    assert [line.split("  ")[1] for line in lines] == [
        "Équipe",
        r"\u30c1\u30fc\u30e0 \ud83e\udd16 takes the left seat.",
        "three",
    ]


def test_what_a_pipe_can_not_encode_is_read_as_it_was() -> None:
    """With JSON, characters that the encoding lacks are escaped, so a program reads them all."""
    lines = said(NAMES.format(json=True), "cp1252").splitlines()
    assert [json.loads(line)["text"] for line in lines] == [
        "Équipe",
        "チーム 🤖 takes the left seat.",
        "three",
    ]


NOBODY_READS = """
import sys
from lacoc_shared.command import log
log.start(True)
for number in range(30_000):
    log.get().info("x" * 100, number=number)
print("done", file=sys.stderr, flush=True)
sys.stdin.readline()
"""


@pytest.mark.slow
def test_a_pipe_that_nobody_reads_holds_nothing() -> None:
    """The log does not wait for a full pipe; lines that find no room are dropped."""
    with subprocess.Popen(
        [sys.executable, "-c", NOBODY_READS],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stderr.readline() == "done\n"
        numbers = [json.loads(process.stdout.readline())["number"] for _ in range(5000)]
        process.stdin.write("\n")
        process.stdin.close()
        rest = process.stdout.read().splitlines()
    assert numbers == [*range(5000)]
    assert 5000 <= len(rest) < 25_000


FULL_FOR_A_MOMENT = """
import io, resource, sys, threading
from lacoc_shared.command import log

failed = threading.Event()

class Disk(io.FileIO):
    def write(self, data):
        try:
            return super().write(data)
        except OSError:
            failed.set()
            raise

sys.stdout = io.TextIOWrapper(io.BufferedWriter(Disk(sys.argv[1], "w")))
log.start(True)
_, most = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (0, most))
log.get().info("while it is full")
assert failed.wait(60)
resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
log.get().info("when there is room")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit for files")
def test_a_disk_that_is_full_for_a_moment_ends_no_log(tmp_path: Path) -> None:
    """The log goes on when there is room again."""
    path = tmp_path / "log"
    subprocess.run(
        [sys.executable, "-c", FULL_FOR_A_MOMENT, str(path)], check=True, timeout=LIMIT_S
    )
    lines = [json.loads(line)["text"] for line in path.read_text().splitlines()]
    assert lines == ["while it is full", "when there is room"]


@pytest.mark.parametrize("as_json", [False, True])
def test_the_stack_of_a_crash_is_not_lost(as_json: bool) -> None:
    """A crash's stack goes into a plain log; with JSON it goes to standard error."""
    code = f"""
import faulthandler, time
from lacoc_shared.command import log, screen
screen.show_crashes(None)
log.start({as_json})
log.get().info("one")
time.sleep(0.2)
faulthandler._sigsegv()
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=LIMIT_S
    )
    assert done.returncode != 0
    first, *rest = done.stdout.splitlines()
    assert "one" in first
    assert ("Fatal Python error: Segmentation fault" in rest) is not as_json
    assert ("Fatal Python error: Segmentation fault" in done.stderr) is as_json
