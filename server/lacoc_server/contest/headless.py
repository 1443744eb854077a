"""A contest without a network: bots play all its games as fast as the machine can.

A game is computed once. Its record is named by a hash of all that decides it, so whoever plays the
same contest again, or one in which a single entry has changed, finds the other games done.
"""

import hashlib
import os
import platform
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from functools import cache
from importlib import resources
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple, Protocol

import msgspec

from lacoc_server.contest.entries import Entry
from lacoc_server.contest.folder import ContestFolder, file_hash
from lacoc_server.contest.league.contest import Contest, StageView, compute
from lacoc_server.contest.league.facts import AnyFact, Outcome, Played, Replaced, new
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.matches import Match
from lacoc_server.contest.league.schedule import due, playable
from lacoc_server.contest.pool import Ended, Job, ended, first_done
from lacoc_server.contest.store import FactStore
from lacoc_server.simulate import Seated
from lacoc_server.world import arithmetic
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path
from lacoc_shared.record.summary import summary
from lacoc_shared.words import Phrase, say

LATE_TICKS = 7
"""Ticks by which bots start later each time that two teams meet in the same seats."""
_MOST_VOIDS = 3
"""After so many games in which physics stopped, a game counts as a draw without points."""
_PACKAGES = ("lacoc_shared", "lacoc_robots", "lacoc_arenas", "lacoc_server")
_SOURCES = (".py", ".toml", ".xml", ".txt")


class Engine(Protocol):
    """What plays games: processes of this machine, or of others."""

    def submit(self, job: Job) -> "Future[Ended | Phrase]":
        """Play a game when there is room; its result is read with `pool.ended`."""


class _Game(NamedTuple):
    """A game to play."""

    match: Match
    job: Job

    @property
    def name(self) -> tuple[str, int]:
        return self.match.pairing.id, self.match.next_game


def play(
    folder: ContestFolder,
    store: FactStore,
    engine: Engine,
    steer: str,
    changed: Callable[[Contest], None],
) -> int:
    """Play a contest to its end; whatever is played already is not played again.

    Args:
        folder: the contest.
        store: its facts.
        engine: plays the games.
        steer: the bot that steers teams without a bot.
        changed: called with the contest, at the beginning and after each change.

    Returns:
        How many games were played now; others were known.

    Raises:
        UserError: if a file has a mistake, a process died, or something can't be written. What was
            played is kept.
    """
    playing: dict[Future[Ended | Phrase], _Game] = {}
    entry = cache(folder.entries.load)
    played = 0
    while True:
        facts = store.facts()
        contest = compute(facts, FORMATS)
        changed(contest)
        if (draw := due(contest, FORMATS)) is not None:
            store.append(draw)
            continue
        busy = {game.name for game in playing.values()}
        known: list[AnyFact] = []
        for game in _games(contest, facts, entry, steer):
            if game.name not in busy:
                if (fact := _known(game, folder, facts)) is not None:
                    known.append(fact)
                else:
                    playing[engine.submit(game.job)] = game
        if not known and not playing:
            return played
        for future in () if known else first_done(set(playing))[0]:
            game = playing.pop(future)
            _keep(folder, game.job, ended(game.job, future))
            played += 1
            known += [fact] if (fact := _known(game, folder, facts)) is not None else []
        store.append(*known)


def _games(
    contest: Contest,
    facts: tuple[AnyFact, ...],
    entry: Callable[[str], Entry],
    steer: str,
) -> Iterator[_Game]:
    """Yield the games that can be played now."""
    files = {team.name: team.files for team in contest.teams}
    views = {match.pairing.id: view for view in contest.stages for match in view.matches}
    for match in playable(contest):
        if match.next_seats is None:
            continue
        late = _late_ticks(contest, match) + _voids(match, facts)
        seated = tuple(
            _seated(seat, team, entry(files[team]), steer)
            for seat, team in enumerate(match.next_seats)
        )
        yield _Game(match, _job(views[match.pairing.id], seated, late))


def _seated(seat: int, team: str, entry: Entry, steer: str) -> Seated:
    return Seated(entry.join(seat, team), entry.bot or steer, entry.program)


def _late_ticks(contest: Contest, match: Match) -> int:
    """Return how much later the bots start, because these teams have met before.

    The number depends on the draw alone, never on the order in which games are played.
    """
    before = 0
    for view in contest.stages:
        most = view.stage.settings.games + view.stage.settings.extra_games
        for other in view.matches:
            if other.pairing.id == match.pairing.id:
                return LATE_TICKS * (before + (match.next_game - 1) // 2)
            if {*other.teams} == {*match.teams}:
                before += most
    return LATE_TICKS * before


def _voids(match: Match, facts: tuple[AnyFact, ...]) -> int:
    """Count the void games that this one replaces."""
    return sum(
        isinstance(fact, Played)
        and fact.outcome == "void"
        and (fact.pairing, fact.game) == (match.pairing.id, match.next_game)
        for fact in facts
    )


def _job(view: StageView, seated: tuple[Seated, ...], late: int) -> Job:
    plan = view.plan
    job = Job(
        match_id="",
        arena=plan.arena,
        overrides=plan.arena_settings,
        players=seated,
        late_ticks=late,
        limits=plan.limits,
        brings_record=True,
    )
    digest = hashlib.blake2b(msgspec.msgpack.encode((job, software())), digest_size=16)
    return msgspec.structs.replace(job, match_id=digest.hexdigest())


def _keep(folder: ContestFolder, job: Job, played: Ended) -> None:
    """Write the record of a game; it gets its name when it is complete and on the disk."""
    assert played.record is not None
    path = packed_path(folder.records, job.match_id)
    part = path.with_name(f"{path.name}.part")
    try:
        folder.records.mkdir(parents=True, exist_ok=True)
        with part.open("wb") as file:
            file.write(played.record)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(path), why=why)) from None


def _known(game: _Game, folder: ContestFolder, facts: tuple[AnyFact, ...]) -> AnyFact | None:
    """Return what the record of a game says; None: there is no record of it."""
    path = packed_path(folder.records, game.job.match_id)
    found = summary(path) if path.exists() else None
    if found is None or not found.scores or game.match.next_seats is None:
        return None
    pairing, number = game.name
    if found.winner == "void" and _voids(game.match, facts) >= _MOST_VOIDS:
        return new(
            Replaced,
            pairing=pairing,
            game=number,
            teams=game.match.next_seats,
            scores=(0, 0),
            outcome="draw",
            reason="physics stopped",
        )
    return new(
        Played,
        pairing=pairing,
        game=number,
        teams=game.match.next_seats,
        scores=(found.scores[0], found.scores[1]),
        outcome=outcome(found.seats, found.winner),
        record=path.name,
        record_hash=file_hash(path),
    )


def outcome(seats: tuple[str, ...], winner: str) -> Outcome:
    """Return the outcome of a game from the winner of its record (a seat's id, or "draw")."""
    if winner == seats[0]:
        return "left"
    if winner == seats[1]:
        return "right"
    return "draw" if winner == "draw" else "void"


@cache
def software() -> str:
    """Return a hash of all software that decides how a game goes: ours, MuJoCo, numpy, Python."""
    digest = hashlib.blake2b(digest_size=16)
    for name in _PACKAGES:
        root = Path(str(resources.files(name)))
        for path in sorted(root.rglob("*")):
            if path.suffix in _SOURCES and path.is_file():
                digest.update(path.relative_to(root).as_posix().encode() + b"\0")
                digest.update(path.read_bytes() + b"\0")
    parts = [version("mujoco"), version("numpy"), platform.python_version()]
    digest.update(msgspec.json.encode([*parts, dict(arithmetic.here())], order="deterministic"))
    return digest.hexdigest()
