"""A contest without a network: bots play all its games as fast as the machine can.

A game is computed once. Its record is named by a hash of all that decides the game. So if the
contest is played again, games whose records exist need not be played. If an entry has
changed, only games that depend on it are played again.
"""

import hashlib
import os
from collections import Counter
from collections.abc import Callable, Container, Iterator, Sequence
from concurrent.futures import Future
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple, Protocol

import msgspec

from lacoc_server.contest.headless.pool import EngineLost, Job, PlayedAlone, ended, first_done
from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_server.contest.kept.folder import ContestFolder, file_hash
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import Contest, Newest, StageView
from lacoc_server.contest.league.facts import AnyFact, Outcome, Played, Replaced, new
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.timetable.schedule import due, playable
from lacoc_server.simulate import Seated
from lacoc_server.simulate.inputs import BotFailed
from lacoc_server.simulate.software import software
from lacoc_server.simulate.workers import WorkerDied
from lacoc_shared.contest.courts import beside
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path
from lacoc_shared.record.summary import Summary, summary
from lacoc_shared.words import Phrase, say

LATE_TICKS = 7
"""Two teams can meet again. Their bots then start later by this many ticks for each earlier game of
the match in the same seats, and for each game that an earlier match of the two can have at most."""
_MOST_DEATHS = 3
"""How many times a game is played again at most because the process that played it died."""
_MOST_VOIDS = 3
"""If a game was void this many times because MuJoCo could not go on, and that happens once more,
the game counts as a draw without points."""


class GameEngine(Protocol):
    """Plays games: in processes of this machine, or on other machines."""

    def submit(self, job: Job) -> "Future[PlayedAlone | Phrase]":
        """Queue a game; read its result from the future with `pool.ended`."""


class _DueGame(NamedTuple):
    """A game to play."""

    match: ContestMatch
    job: Job
    steer: str
    """The bot that steers teams without a bot of their own; "": both teams have one."""

    @property
    def name(self) -> tuple[str, int]:
        """Id of the game's pairing, and number of the game in its match."""
        return self.match.pairing.id, self.match.next_game

    @property
    def teams(self) -> tuple[str, str]:
        """The left and the right team."""
        left, right = self.job.teams
        return left, right


def play_contest(
    folder: ContestFolder,
    store: FactStore,
    engine: GameEngine,
    steer: str,
    changed: Callable[[Contest], None],
    tell: Callable[[Phrase], None],
) -> int:
    """Play a contest to its end; games that are played already are not played again.

    Args:
        folder: the contest.
        store: its facts.
        engine: plays the games.
        steer: the bot that steers teams without a bot.
        changed: called with the contest, at the beginning and after each change.
        tell: called at the end for each team that, in games of this call, pressed keys which its
            gait does not have.

    Returns:
        How many games this call played; games whose result was already there do not count.

    Raises:
        EngineLost: if the engine can play no more games; what was played is kept.
        UserError: if something can't be written; what was played is kept. Also if games can't be
            played, for example because a bot has a mistake or never answers. Then all other games
            are played first, and the error names each bot that failed.
    """
    playing: dict[Future[PlayedAlone | Phrase], _DueGame] = {}
    failed: dict[tuple[str, int], tuple[Job, Phrase]] = {}
    deaths: Counter[str] = Counter()
    entry = cache(folder.entries.load)
    played: set[str] = set()
    refused: Counter[str] = Counter()
    newest = Newest(FORMATS)
    while True:
        facts = store.facts()
        contest = newest.of(facts)
        changed(contest)
        if due(contest, FORMATS) is not None:
            store.decide(partial(_due, newest))
            continue
        known: list[Played | Replaced] = []
        busy = {game.name for game in playing.values()} | {*failed}
        for game in _games(contest, facts, entry, steer, folder.folder, busy):
            if (fact := _result(game, folder, facts)) is not None:
                known.append(fact)
            elif game.job.match_id in played:  # what was kept is no record, or was removed since
                path = packed_path(folder.records, game.job.match_id)
                failed[game.name] = (game.job, say("contest.no-result", file=str(path)))
            else:
                playing[engine.submit(game.job)] = game
        if known:
            store.decide(partial(_still_due, newest, facts, known))
            continue
        if not playing:
            break
        for future in first_done(set(playing))[0]:
            game = playing.pop(future)
            died = future.exception()
            if isinstance(died, WorkerDied) and died.last_words is None:
                deaths[game.job.match_id] += 1
                if deaths[game.job.match_id] <= _MOST_DEATHS:
                    continue  # it is played again
            try:
                found = ended(game.job, future)
            except EngineLost:
                raise
            except UserError as error:  # a bot with a mistake ends no game of other teams
                failed[game.name] = (game.job, error.phrase)
                continue
            _keep(folder, game.job, found.record)
            played.add(game.job.match_id)
            refused.update(dict(zip(game.teams, found.refused_keys, strict=True)))
    for team, keys in refused.items():
        if keys:
            tell(say("simulate.refused-keys", team=team, keys=keys))
    if failed:
        raise _failed([*failed.values()])
    return len(played)


def _failed(games: Sequence[tuple[Job, Phrase]]) -> UserError:
    """Return one error for games that can't be played; it says each reason once."""
    teams = {why: job.teams for job, why in reversed(games)}
    said = [
        why if why.code == BotFailed.CODE else say("contest.game-failed", teams=teams[why], why=why)
        for why in dict.fromkeys(why for _, why in games)
    ]
    return UserError(*said, say("contest.games-failed", count=len(games)))


def _still_due(
    newest: Newest,
    before: tuple[AnyFact, ...],
    known: Sequence[Played | Replaced],
    facts: tuple[AnyFact, ...],
) -> Iterator[AnyFact]:
    """Yield the results that can still be appended: those of games that are still to be played.

    Meanwhile another program may have appended another result of the game, a fact after which the
    game is not played, or other files of a team.

    Args:
        newest: computes the contest from facts.
        before: the facts by which the games were due.
        known: results of games that were computed meanwhile.
        facts: the facts now.
    """
    was, now = _files(newest.of(before)), _files(newest.of(facts))
    ready = playable(newest.of(facts))
    due_now = {(match.pairing.id, match.next_game, match.next_seats) for match in ready}
    for fact in known:
        same_files = all(was[team] == now[team] for team in fact.teams)
        if same_files and (fact.pairing, fact.game, fact.teams) in due_now:
            yield fact


def _files(contest: Contest) -> dict[str, str]:
    return {team.name: team.files for team in contest.teams}


def _due(newest: Newest, facts: tuple[AnyFact, ...]) -> Iterator[AnyFact]:
    if (draw := due(newest.of(facts), FORMATS)) is not None:
        yield draw


def _games(
    contest: Contest,
    facts: tuple[AnyFact, ...],
    entry: Callable[[str], ContestEntry],
    steer: str,
    folder: Path,
    busy: Container[tuple[str, int]],
) -> Iterator[_DueGame]:
    """Yield the games that can be played now, except those in `busy`, which are being played.

    The path of an arena starts in `folder`.
    """
    files = _files(contest)
    views = {match.pairing.id: view for view in contest.stages for match in view.matches}
    for match in playable(contest):
        name = (match.pairing.id, match.next_game)
        if match.next_seats is None or name in busy:
            continue
        late = late_ticks(contest, facts, match)
        entries = [entry(files[team]) for team in match.next_seats]
        seated = tuple(
            _seated(seat, team, one, steer)
            for seat, (team, one) in enumerate(zip(match.next_seats, entries, strict=True))
        )
        job = _job(views[match.pairing.id], seated, late, folder)
        yield _DueGame(match, job, "" if all(one.bot for one in entries) else steer)


def _seated(seat: int, team: str, entry: ContestEntry, steer: str) -> Seated:
    return Seated(entry.join(seat, team), entry.bot or steer, entry.program)


def late_ticks(contest: Contest, facts: Sequence[AnyFact], match: ContestMatch) -> int:
    """Return how many ticks late the bots start in the next game of a match.

    If they always started at once, two teams that meet again would repeat their earlier game. The
    number depends on the draw, on the game's number, and on how often this game was played without
    a result that counts. It does not depend on the order in which other games are played. `contest`
    and `facts` must be as they were before the game.
    """
    before = 0
    for view in contest.stages:
        most = view.stage.settings.games + view.stage.settings.extra_games
        for other in view.matches:
            if other.pairing.id == match.pairing.id:
                again = before + (match.next_game - 1) // 2
                return LATE_TICKS * again + len(_tries(match, facts))
            if {*other.teams} == {*match.teams}:
                before += most
    raise ValueError(f"no match {match.pairing.id}")


def _tries(match: ContestMatch, facts: Sequence[AnyFact]) -> list[Played]:
    """Return the results of a match's next game that do not count: void, or to be replayed."""
    return [
        fact
        for fact in facts
        if isinstance(fact, Played)
        and (fact.pairing, fact.game) == (match.pairing.id, match.next_game)
        and {*fact.teams} == {*match.teams}
    ]


def _job(view: StageView, seated: tuple[Seated, ...], late: int, folder: Path) -> Job:
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
    # Wherever the folder is, the game keeps its name.
    arena = beside(folder, plan.arena)
    return msgspec.structs.replace(job, match_id=digest.hexdigest(), arena=arena)


def _keep(folder: ContestFolder, job: Job, record: bytes | None) -> None:
    """Save the record of a game: write it under a temporary name, then rename it.

    A record that another program has saved meanwhile stays, because facts may have its hash.
    """
    assert record is not None
    path = packed_path(folder.records, job.match_id)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        folder.records.mkdir(parents=True, exist_ok=True)
        with part.open("wb") as file:
            file.write(record)
            file.flush()
            os.fsync(file.fileno())
        if _ended(path) is None:
            part.replace(path)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(path), why=why)) from None
    finally:
        part.unlink(missing_ok=True)


def _ended(path: Path) -> Summary | None:
    """Return the summary of a game's record; None: the file is missing, or has no result."""
    found = summary(path)
    return found if found is not None and found.scores else None


def _result(
    game: _DueGame, folder: ContestFolder, facts: tuple[AnyFact, ...]
) -> Played | Replaced | None:
    """Return the fact of a game's result, from its record; None: no record has a result."""
    path = packed_path(folder.records, game.job.match_id)
    found = _ended(path)
    if found is None:
        return None
    pairing, number = game.name
    voids = sum(fact.outcome == "void" for fact in _tries(game.match, facts))
    if found.winner == "void" and voids >= _MOST_VOIDS:
        return new(
            Replaced,
            pairing=pairing,
            game=number,
            teams=game.teams,
            scores=(0, 0),
            outcome="draw",
            reason="physics stopped",
        )
    return new(
        Played,
        pairing=pairing,
        game=number,
        teams=game.teams,
        scores=(found.scores[0], found.scores[1]),
        outcome=outcome(found.seats, found.winner),
        record=path.name,
        record_hash=file_hash(path),
        steer=game.steer,
    )


def outcome(seats: tuple[str, ...], winner: str) -> Outcome:
    """Return the outcome of a game from the winner of its record (a seat's id, or "draw")."""
    if winner == seats[0]:
        return "left"
    if winner == seats[1]:
        return "right"
    return "draw" if winner == "draw" else "void"
