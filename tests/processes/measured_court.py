"""A court that times its own beats, for `tests.campaigns.flood.seat` and `benchmarks.courts`.

    python -m tests.processes.measured_court [NAME]

opens such a court and prints its address as a line of JSON. It answers each line "count" on
standard input with the times of the beats since the last one, and ends at a line "stop".
"""

import json
import os
import secrets
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_server.court.court import Court, CourtSettings
from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import Inbox
from lacoc_server.doors.network import CourtNetwork
from lacoc_server.match.entry import JoinCheck
from lacoc_shared.command.metrics import Exporter
from lacoc_shared.contest.tokens import new_token, new_token_hash
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import SentFile
from lacoc_shared.messages.office import open_match
from lacoc_shared.seat import Phase

NAME = "measured"


class MeasuredCourt(Court):
    """A court that keeps how long each beat took."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.cpu_s: list[float] = []
        """CPU time of the court's own thread in each beat."""
        self.wall_s: list[float] = []

    def _beat(self, now_s: float) -> None:
        begin_s, cpu_s = time.perf_counter(), time.thread_time()
        super()._beat(now_s)
        self.cpu_s.append(time.thread_time() - cpu_s)
        self.wall_s.append(time.perf_counter() - begin_s)

    @property
    def phase(self) -> Phase:
        """Return the phase of the current match."""
        return self._journal.match.phase

    def told(self) -> dict[str, Any]:
        """Return the times of the beats since the last call, and how many of them were slow."""
        told = {
            "wall_s": self.wall_s,
            "phase": self.phase,
            "slow_beats": self._pace.slow_beats,
            "at_s": time.monotonic(),
        }
        self.wall_s, self.cpu_s, self._pace.slow_beats = [], [], 0
        return told


@dataclass(frozen=True)
class Measured:
    """A measured court and how to reach it."""

    court: MeasuredCourt
    inbox: Inbox
    address: str
    tokens: dict[str, str]
    referee: str


@contextmanager
def measured_court(name: str = NAME) -> Iterator[Measured]:
    """Open a court of Robot-Othello, whose matches last an hour; the caller runs the court."""
    loaded = arenas.load("othello", {"match": {"duration_s": 3600.0, "countdown_s": 0.02}})
    tokens, referee = {seat.id: new_token() for seat in loaded.seats}, new_token()
    keys = KeySpace(name)
    files = (SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    join_check = JoinCheck(*files, Limits(), loaded.match.open_levels)
    opened = open_match({seat: [new_token_hash(token)] for seat, token in tokens.items()})
    inbox = Inbox(keys, list(tokens), join_check, secrets.token_bytes)
    desk = DecisionDesk([new_token_hash(referee)])
    with (
        tempfile.TemporaryDirectory() as folder,
        CourtNetwork(keys, ["tcp/127.0.0.1:0"], inbox, desk) as network,
    ):
        settings = CourtSettings(name, loaded, {}, Path(folder), assigned=opened)
        court = MeasuredCourt(settings, network)
        yield Measured(court, inbox, network.locators[0], tokens, referee)


def main() -> None:
    """Run a court until a line "stop" on standard input."""
    name = sys.argv[1] if len(sys.argv) > 1 else NAME
    with measured_court(name) as opened, Exporter("127.0.0.1:0") as exporter:
        exporter.registry.register(opened.court.metrics)
        where = {"name": name, "address": opened.address, "metrics": exporter.url}
        print(json.dumps(where | {"tokens": opened.tokens, "referee": opened.referee}), flush=True)
        os.set_blocking(sys.stdin.fileno(), False)

        def stopping() -> bool:
            word = sys.stdin.readline().strip()
            if word == "count":
                print(json.dumps(opened.court.told()), flush=True)
            return word == "stop"

        opened.court.run(stopping)


if __name__ == "__main__":
    main()
