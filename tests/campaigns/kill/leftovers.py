"""Kills commands at random moments and looks at what stays in the folder for temporary files.

    python -m tests.campaigns.kill.leftovers --kills 200

Each command is killed with -9 at a random moment of its first seconds. The next one starts and ends
as usual; then the folder must be empty.
"""

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil
from arguments import arguments
from lacoc_process import started

_LONGEST_S = 5.0
_END_S = 60.0


def _commands(folder: Path) -> dict[str, list[str]]:
    """Return the command lines by name; they work in a folder."""
    contest = str(folder / "contest.toml")
    return {
        "demo": ["demo", "--headless"],
        "practice": ["practice", "--no-open"],
        "design": ["design", "--no-open", str(folder)],
        "class": ["class", str(folder / "class"), "--no-open"],
        "serve": ["serve", "--listen", "127.0.0.1:0"],
        "simulate": ["simulate", "planner", "straight", "--seconds", "20"],
        "contest run": ["contest", "run", contest, "--entries"],
        "contest headless": ["demo", "--contest", "--headless"],
    }


def killed(kills: int, seed: int = 0, *, fresh: bool = True) -> tuple[int, Counter[str]]:
    """Kill commands at random moments.

    Args:
        kills: how many.
        seed: chooses commands and moments.
        fresh: whether each command gets a new interpreter, as users' commands do.

    Returns:
        How many folders they left in all, and how many of them the next start did not remove, by
        command.
    """
    dice = random.Random(seed)
    found, left = 0, Counter[str]()
    with tempfile.TemporaryDirectory() as place:
        folder, temporary = Path(place, "work"), Path(place, "temporary")
        folder.mkdir()
        temporary.mkdir()
        environment = {**os.environ, "TMPDIR": str(temporary), "HOME": str(folder)}
        options = {"cwd": folder, "env": environment, "fresh": fresh}
        _run(["contest", "init", str(folder / "contest.toml")], options)
        commands = _commands(folder)
        for _ in range(kills):
            name = dice.choice([*commands])
            _kill(commands[name], options, dice.uniform(0.1, _LONGEST_S))
            found += len([*temporary.iterdir()])
            _run(["simulate", "straight", "straight", "--seconds", "0.1"], options)
            for path in temporary.iterdir():
                left[f"{name}: {path.name.rpartition('-')[0]}"] += 1
    return found, left


def _run(words: list[str], options: Mapping[str, Any]) -> None:
    """Run a command to its end; it makes a folder for temporary files, and so sweeps first."""
    with started(*words, stdout=subprocess.DEVNULL, **options) as command:
        assert command.wait() == 0
    swept = "from lacoc_shared.command.scratch import Scratch; Scratch('x').close()"
    where = {"cwd": options["cwd"], "env": options["env"]}
    subprocess.run([sys.executable, "-c", swept], check=True, **where)


def _kill(words: list[str], options: Mapping[str, Any], after_s: float) -> None:
    """Start a command, kill it after some seconds, and wait until its own processes have gone."""
    none = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    process = started(*words, **none, **options)
    with suppress(subprocess.TimeoutExpired):
        process.wait(after_s)
    own: list[psutil.Process] = []
    with suppress(psutil.Error):
        own = psutil.Process(process.pid).children(recursive=True)
    with suppress(ProcessLookupError):
        os.kill(process.pid, signal.SIGKILL)
    process.wait()
    _, alive = psutil.wait_procs(own, _END_S)
    for one in alive:
        with suppress(psutil.Error):
            one.kill()


def main() -> int:
    """Kill, and print what was left."""
    options = arguments(__doc__, kills=200, seed=0)
    began_s = time.monotonic()
    found, left = killed(options.kills, options.seed)
    print(
        f"{options.kills} kills in {time.monotonic() - began_s:.0f} s left {found} folders; "
        f"after the next start: {dict(left) or 0}"
    )
    return int(bool(left))


if __name__ == "__main__":
    raise SystemExit(main())
