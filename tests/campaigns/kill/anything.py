"""`python -m tests.campaigns.kill.anything`: kill any process at any moment; all must go on.

A court, a gateway, two bots and a referee run as processes of their own, connected by plain TCP.
About once a second one of them is killed (SIGKILL) and started again at once. The benchmark counts
the kills, and prints the last output of each process that ended by itself (a crash writes the
stack of every thread). At the end every record must verify.

With `--cores FOLDER` a process that crashes leaves a core dump in the folder, for gdb (on Linux, if
the system's pattern for core dumps is a plain file name).
"""

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

from arguments import arguments
from ports import free_port
from processes import LACOC

from lacoc_client.play.asking import NoCourt, NotNow
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_shared.contest.file import load
from lacoc_shared.contest.secrets import Secrets
from lacoc_shared.decisions import DECISIONS, Decision
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.record.files import segment_name

_WAIT = ("--wait", "600")
_BETWEEN_S = (0.2, 2.0)
_END_S = 60.0
_SAID_BYTES = 20_000
"""How much of the output of a process is kept after it ended by itself."""
_GOES_ON: dict[str, Decision] = {
    name: DECISIONS[name]() for name in ("official", "next", "start", "resume")
}
"""The decisions that the referee makes as soon as they are legal."""


def main() -> None:
    """Kill processes, print the counts, and exit with 1 if something went wrong."""
    if sys.argv[1:2] == ["--referee"]:
        _referee(Path(sys.argv[2]))
    options = arguments(__doc__, seconds=600.0, seed=1, cores=Path)
    with tempfile.TemporaryDirectory() as folder:
        found = run(Path(folder), options.seconds, random.Random(options.seed), options.cores)
    print(json.dumps(found))
    sys.exit(bool(found["ended"] or found["not_same"] or not found["same"]))


def run(
    folder: Path, seconds: float, chance: random.Random, cores: Path | None = None
) -> dict[str, object]:
    """Kill processes for a time, and verify the records.

    Args:
        folder: an empty folder.
        seconds: least length of the run.
        chance: chooses which process is killed, and when.
        cores: folder for core dumps; None: no core dumps.

    Returns:
        The kills of each process; the last output of each process that ended by itself; the number
        of records that verify; and what is wrong with the other records.
    """
    contest = folder / "contest.toml"
    contest.write_text(_contest(), encoding="utf-8")
    records = folder / "recordings"
    of_contest = ("--contest", str(contest))
    served = (str(contest), "--recordings", str(records))
    plan = load(contest)
    secrets, where = plan.secrets, ("--connect", plan.courts["main"].address())
    services = [
        _Service("court", folder, cores, *served, module="tests.processes.alone"),
        _Service("gateway", folder, cores, "web", *of_contest, "--listen", "127.0.0.1:0"),
        *(
            _Service(seat, folder, cores, "bot", bot, *where, *_seat(secrets, seat), *_WAIT)
            for seat, bot in (("left", "planner"), ("right", "nearest"))
        ),
        _Service("referee", folder, cores, "--referee", str(contest), module=__spec__.name),
    ]
    kills: Counter[str] = Counter()
    ended: list[str] = []
    end_s = time.monotonic() + seconds
    with ExitStack() as stack:
        for service in services:
            service.start()
            stack.callback(service.stop)
        # There must be a record, however slow the machine is.
        while time.monotonic() < end_s or not any(records.glob("*.mcap")):
            time.sleep(chance.uniform(*_BETWEEN_S))
            for service in services:
                if (said := service.ended()) is not None:
                    ended.append(said)
                    print(said, file=sys.stderr, flush=True)
                    service.start()
            service = chance.choice(services)
            service.kill()
            service.start()
            kills[service.name] += 1
    same, not_same = _verify(records)
    return {"kills": dict(kills), "ended": ended, "same": same, "not_same": not_same}


def _seat(secrets: Secrets, seat: str) -> tuple[str, ...]:
    return "--token", secrets.seat("main", seat)


class _Service:
    """A process that is started again after each end."""

    def __init__(
        self, name: str, folder: Path, cores: Path | None, *words: str, module: str = LACOC
    ) -> None:
        self.name = name
        self._log = folder / f"{name}.log"
        self._cores = cores
        self._words = [sys.executable, "-m", module, *words]
        self._process: subprocess.Popen[bytes]

    def start(self) -> None:
        kept = {name: value for name, value in os.environ.items() if name[:6] != "LACOC_"}
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                self._words,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=kept | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
                cwd=self._cores,
                preexec_fn=_allow_cores if self._cores else None,
            )

    def kill(self) -> None:
        self._process.kill()
        self._process.wait()

    def stop(self) -> None:
        self._process.terminate()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            raise

    def ended(self) -> str | None:
        """Return the last output of the process if it has ended by itself; None while it runs."""
        if (code := self._process.poll()) is None:
            return None
        said = self._log.read_bytes()[-_SAID_BYTES:].decode(errors="replace")
        return f"{self.name} (process {self._process.pid}) ended with {code}:\n{said}"


def _allow_cores() -> None:
    import resource

    resource.setrlimit(resource.RLIMIT_CORE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))


def _referee(contest: Path) -> None:
    """Be the referee: make the decisions that let matches go on, until this process is killed."""
    plan = load(contest)
    name, court = plan.court()
    while True:
        try:
            with open_client([court.address()]) as session:
                view = Spectator(session, name)
                hand = RefereeClient(session, name, plan.secrets.referee(name))
                while view.silent_s(time.monotonic()) < _END_S:
                    view.wait_frame(0.1)
                    legal = {} if view.health is None else view.health.decisions
                    for word, decision in _GOES_ON.items():
                        if word in legal and legal[word] is None:
                            view.health = None
                            hand.decide(decision, "a trial", "trial")
        except (NoCourt, NotNow):
            continue  # the court is being started again
        except UserError as error:  # the decision was legal half a second ago
            print(error, flush=True)
            time.sleep(0.1)


def _verify(folder: Path) -> tuple[int, list[str]]:
    """Verify every record; return how many are right, and what is wrong with the others."""
    segments = {
        name[0]: path for path in folder.glob("*.live.mcap") if (name := segment_name(path))
    }
    packed = {path.stem: path for path in folder.glob("*.mcap") if not segment_name(path)}
    same, not_same = 0, []
    for path in {**segments, **packed}.values():
        said = subprocess.run(
            [sys.executable, "-m", LACOC, "replay", "verify", "--json", str(path)],
            capture_output=True,
            text=True,
            check=False,
        )
        if said.returncode == 0:
            same += 1
        else:
            not_same.append(f"{path.name}: {said.stdout}{said.stderr}")
    return same, not_same


def _contest() -> str:
    port = free_port()
    return f"""
[court.main]
arena = "othello"
listen = ["tcp/127.0.0.1:{port}"]
settings.match = {{ duration_s = 20, countdown_s = 0.7 }}
"""


if __name__ == "__main__":
    main()
