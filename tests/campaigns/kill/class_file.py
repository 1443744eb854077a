"""Kills a program that keeps a class, again and again, and counts what is lost.

    python -m tests.campaigns.kill.class_file --kills 100

A child process writes evidence and tables, and prints each that the store has accepted. It is
killed at a random moment (SIGKILL). Then the file is opened. All acknowledged evidence must be
there. A change of the table may be lost only if it was made less than 2 s before the kill; the
longest time for which the machine let the child stand still is added to this.
"""

import random
import subprocess
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from arguments import arguments

from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.phases.evidence import Guessed
from lacoc_client.workshop.phases.store import ClassStore

STUDENT, FILE = "Ada", "Loco-data.txt"
OLDEST_S = 2.0
"""How long before the kill a lost change of the table may have been made [s]."""
_PAUSE_S = 0.005
_LONGEST_S = 3.5  # longer than `OLDEST_S`, so that in some runs a table must have been written


class Killed(NamedTuple):
    """What the file had after one kill."""

    acknowledged: int
    """Number of the last acknowledged piece of evidence; 0: none."""
    kept: int
    """Number of the last piece of evidence in the file."""
    holes: int
    """How many pieces of evidence before the last one are missing in the file."""
    table_lost_s: float
    """Age, at the kill, of the oldest change of the table that was lost [s]; 0: none was lost."""
    stalled_s: float
    """Longest time between two lines that the child printed [s]."""

    @property
    def lost(self) -> int:
        """How much acknowledged evidence was lost."""
        return self.holes + max(0, self.acknowledged - self.kept)


def kill_once(path: Path, after_s: float) -> Killed:
    """Start a child on a file, kill it `after_s` after its first line, and look at the file."""
    child = subprocess.Popen(
        [sys.executable, "-m", "tests.campaigns.kill.class_file", "--child", str(path)],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert child.stdout is not None
    with child, child.stdout as said:
        lines = [said.readline()]
        time.sleep(after_s)
        child.kill()
        killed_s = time.monotonic()
        lines += [line for line in said if line.endswith("\n")]
    # time.monotonic() is one clock for all processes of a machine.
    seen = [(word, int(number), float(at_s)) for word, number, at_s in map(str.split, lines)]
    acknowledged = max((number for word, number, _ in seen if word == "evidence"), default=0)
    with ClassStore(path) as store:
        numbers = [one.number for one in store.evidence().result()]
        version = max((int(table.version) for table in store.documents()), default=0)
    lost = [killed_s - at_s for word, number, at_s in seen if word == "table" and number > version]
    times_s = [at_s for _, _, at_s in seen] + [killed_s]
    return Killed(
        acknowledged=acknowledged,
        kept=max(numbers, default=0),
        holes=max(numbers, default=0) - len(numbers),
        table_lost_s=max(lost, default=0.0),
        stalled_s=max(b - a for a, b in pairwise(times_s)),
    )


def keep_on(path: Path) -> None:
    """Write evidence and tables until somebody ends this process."""
    store = ClassStore(path)
    version = max((int(table.version) for table in store.documents()), default=0)
    while True:
        version += 1
        content = b"x" * 5000
        store.keep(Document(STUDENT, FILE, str(version), time.time(), content))
        print("table", version, time.monotonic(), flush=True)
        guess = Guessed(about="foot", said="forward", was=("forward", "up"))
        number = store.add(STUDENT, guess, time.time()).result()
        print("evidence", number, time.monotonic(), flush=True)
        time.sleep(_PAUSE_S)


def main() -> None:
    """Run the kills and print what was lost."""
    if sys.argv[1:2] == ["--child"]:
        keep_on(Path(sys.argv[2]))
    options = arguments(__doc__, kills=100)
    draw = random.Random(0)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "class.sqlite"
        kills = [kill_once(path, draw.uniform(0, _LONGEST_S)) for _ in range(options.kills)]
    too_old = sum(kill.table_lost_s > OLDEST_S + kill.stalled_s for kill in kills)
    lost = sum(kill.lost for kill in kills)
    print(f"{len(kills)} kills, {kills[-1].kept} pieces of evidence: {lost} lost")
    oldest_s = max(kill.table_lost_s for kill in kills)
    print(
        f"oldest change of a table that was lost: {oldest_s:.2f} s; {too_old} older than it may be"
    )
    sys.exit(bool(lost or too_old))


if __name__ == "__main__":
    main()
