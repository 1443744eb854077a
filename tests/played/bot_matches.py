"""Matches of bots without a network, and those among them that proofs are tried on."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import combinations_with_replacement
from pathlib import Path
from typing import Any

from lacoc_arenas import arena as arenas
from lacoc_arenas.bot import Brain, Key
from lacoc_arenas.steering import FORWARD, STAND, TURN_LEFT, TURN_RIGHT, Eyes
from lacoc_server.simulate import player, simulate
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.record.schema import Setup

ARENAS = ("othello", "flag-strike")
BOTS = ("straight", "nearest", "planner")
WRESTLER = "wrestler"
"""Name of a bot that only `bot_match` knows."""
_PAIRS = list(combinations_with_replacement((WRESTLER, *BOTS), 2))
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


def setup_of(name: str, settings: Mapping[str, Any] | None = None, match_id: str = "m") -> Setup:
    """Return the setup of a match in an arena, some of whose entries may be replaced."""
    own = arenas.load(name, settings).settings
    return Setup(match_id=match_id, court="main", match=1, arena=name, settings=own, limits={})


def bot_match(
    folder: Path | None,
    name: str,
    bots: Sequence[str],
    settings: Mapping[str, Any] | None = None,
    *,
    match_id: str = "m",
    robots: Sequence[str] = ("hexapod", "hexapod"),
    teams: Sequence[str | None] = (None, None),
    late_ticks: Sequence[int] = (0, 0),
    watch: Callable[[Frame], None] | None = None,
) -> Path:
    """Play a match of bots.

    Args:
        folder: where the record goes; None: there is none.
        name: the arena.
        bots: the bot of each seat, which may be `WRESTLER`.
        settings: what replaces entries of the arena's file.
        match_id: name of the match.
        robots: the robot of each seat.
        teams: the team in each seat; None: it is called as its bot.
        late_ticks: how much later each seat's keys come.
        watch: gets each frame.

    Returns:
        The path of the record.
    """
    arena = arenas.load(name, settings)
    players = []
    for seat, bot in enumerate(bots):
        known = BOTS[0] if bot == WRESTLER else bot
        one = player(arena, seat, known, robots[seat], teams[seat], late_ticks[seat])
        players.append(replace(one, bot=wrestler) if bot == WRESTLER else one)
    simulate(setup_of(name, settings, match_id), players, folder, watch)
    return Path(folder or "", f"{match_id}.mcap")


def play(folder: Path, number: int, seconds: float) -> Path:
    """Play one of the matches for proofs, and return the path of its record.

    They are of both games, with all bots, and with robots that push each other all the time.

    Args:
        folder: where the record goes.
        number: number of the match, from 0; the same number gives the same match.
        seconds: how long it lasts.
    """
    name = ARENAS[number % len(ARENAS)]
    return bot_match(
        folder,
        name,
        # In every third match two wrestlers play; the other matches take the pairs in turn.
        _PAIRS[0 if number % 3 == 0 else number % len(_PAIRS)],
        {"match": {"duration_s": seconds, "countdown_s": 0.1}},
        match_id=f"{name}-{number:03d}",
        robots=[_ROBOTS[(number // 2 + seat) % len(_ROBOTS)] for seat in range(2)],
        teams=("Team 0", "Team 1"),
        late_ticks=[(7 * number + 3 * seat) % 50 for seat in range(2)],
    )
