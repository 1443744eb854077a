"""Matches for proofs: both games, all bots, and robots that push each other all the time."""

import os
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import replace
from itertools import combinations_with_replacement
from pathlib import Path

from lacoc_arenas import arena as arenas
from lacoc_arenas.bot import Brain, Key
from lacoc_arenas.steering import FORWARD, STAND, TURN_LEFT, TURN_RIGHT, Eyes
from lacoc_server.simulate import player, simulate
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.record.schema import Setup

OTHER_ARITHMETIC = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-FMA_Usable,-FMA4_Usable,-AVX2_Usable"
}
"""Environment variables that make glibc use its functions for older processors."""

ARENAS = ("othello", "flag-strike")
_WRESTLER = "wrestler"
_PAIRS = list(combinations_with_replacement((_WRESTLER, "straight", "nearest", "planner"), 2))
_ROBOTS = ("hexapod", "hexapod", "quadruped", "long-legs", "octopod")
_STRAY_RAD = 0.3


def wrestler(sheet: Sheet, seat: int) -> Brain:
    """Return a brain that walks into the other robot and keeps walking."""
    eyes = Eyes(sheet)

    def brain(frame: Frame) -> Key | None:
        poses, standing = eyes.poses(frame), frame.seats[seat]
        if standing.locked_ticks or frame.clock_ticks % 16:
            return None
        other = poses[1 - seat] if len(poses) > 1 else None
        bearing_rad = poses[seat].bearing_rad(other.x_m, other.y_m) if other else 0.0
        key = FORWARD if abs(bearing_rad) < _STRAY_RAD else TURN_LEFT
        key = TURN_RIGHT if bearing_rad < -_STRAY_RAD else key
        key = key if other else STAND
        return None if (standing.level, standing.key) == key else key

    return brain


def play(folder: Path, number: int, seconds: float) -> Path:
    """Play one of the matches, and return the path of its record.

    Args:
        folder: where the record goes.
        number: number of the match, from 0; the same number gives the same match.
        seconds: how long it lasts.
    """
    name = ARENAS[number % len(ARENAS)]
    arena = arenas.load(name, {"match": {"duration_s": seconds, "countdown_s": 0.1}})
    # In every third match two wrestlers play; the other matches take the pairs in turn.
    pair = _PAIRS[0 if number % 3 == 0 else number % len(_PAIRS)]
    players = [
        player(
            arena,
            seat,
            "straight" if bot == _WRESTLER else bot,
            robot=_ROBOTS[(number // 2 + seat) % len(_ROBOTS)],
            team=f"Team {seat}",
            late_ticks=(7 * number + 3 * seat) % 50,
        )
        for seat, bot in enumerate(pair)
    ]
    players = [
        replace(one, bot=wrestler) if bot == _WRESTLER else one
        for one, bot in zip(players, pair, strict=True)
    ]
    made = Setup(
        match_id=f"{name}-{number:03d}",
        court="main",
        match=1,
        arena=name,
        settings=arena.settings,
        limits={},
    )
    simulate(made, players, folder)
    return folder / f"{made.match_id}.mcap"


def elsewhere(module: str, words: Iterable[str]) -> str:
    """Run a module under `OTHER_ARITHMETIC`, and return what it prints."""
    done = subprocess.run(
        [sys.executable, "-m", module, *words],
        env={**os.environ, **OTHER_ARITHMETIC},
        cwd=Path(__file__).parents[1],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return done.stdout
