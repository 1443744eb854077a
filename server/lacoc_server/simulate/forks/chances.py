"""The odds of a record: computed from forks in other processes, and kept beside the record.

Each moment has a hash of everything that decides how its forks end: the match until then, the
bots and the software. So kept forks are not played again, even if more forks are wanted.
"""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from functools import lru_cache
from pathlib import Path
from typing import Protocol

import msgspec

from lacoc_arenas import brains
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.replay import resume
from lacoc_server.match.match import Match
from lacoc_server.simulate.forks import odds
from lacoc_server.simulate.forks.jobs import bots_of, opened_record
from lacoc_server.simulate.forks.line import ForkChange, ForkLine, of_bot
from lacoc_server.simulate.forks.odds import MomentOdds
from lacoc_server.simulate.forks.origin import ForkSource
from lacoc_server.simulate.software import folder_hash, software
from lacoc_shared.codec import decode
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.schema import Result
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, Phase
from lacoc_shared.words import Phrase, say

FORMAT = 1
"""Version of the format of a file of odds."""


class Odds(msgspec.Struct, frozen=True, kw_only=True):
    """The odds of a match over its course."""

    format: int = FORMAT
    match_id: str
    record_hash: str
    """Hash of the record (`origin.ForkSource.hash`)."""
    seats: tuple[str, str]
    bots: tuple[str, str]
    """The bots that play the forks, by seat."""
    moments: tuple[MomentOdds, ...]
    """Moments in order of time. If the match has a result, the last one is its end, with chance 1,
    0.5 or 0."""


class ChanceJob(msgspec.Struct, frozen=True, kw_only=True):
    """A job for a process: to play forks of one moment."""

    file: str
    beat: int
    bots: tuple[str, str]
    variants: tuple[int, ...]
    arena: str | None = None
    """Folder of the arena, if it is not installed."""


class ForkEngine(Protocol):
    """Plays forks in other processes, such as those of `simulate.workers`."""

    def submit(
        self, function: Callable[[ChanceJob], tuple[float, ...] | Phrase], job: ChanceJob, /
    ) -> "Future[tuple[float, ...] | Phrase]":
        """Call the function with a job when a process is free; return a future of its result."""


class Wish(msgspec.Struct, frozen=True, kw_only=True):
    """Says for which record the odds are wanted, with which bots, and how exactly."""

    file: str
    bots: tuple[str, str]
    forks: int
    """Number of forks of each moment."""
    step_s: float
    """Seconds of play between two moments."""
    arena: str | None = None


def compute_odds(
    wish: Wish, engine: ForkEngine, known: Odds | None, progress: Callable[[int, int], None]
) -> Iterator[Odds]:
    """Compute the odds of a record.

    Args:
        wish: the record, and how its odds are to be computed.
        engine: plays the forks.
        known: odds computed earlier; forks of them that would end the same way again are reused.
        progress: called with the number of moments done, and the number that there will be at most.

    Yields:
        The odds so far, after each moment that is done; the last ones are complete.

    Raises:
        UserError: if the record can't be forked, does not have two seats, or has no play, or if a
            bot has a mistake.
    """
    source = opened_record(wish.file)
    first, second = _two_seats(source)
    course = MatchCourse(source)
    kept = _still_known(source, wish, known)
    moments: dict[int, MomentOdds] = {}
    ends = course.end
    if ends is not None:
        moments[ends.beat] = ends

    def result() -> Odds:
        return Odds(
            match_id=source.match_id,
            record_hash=source.hash,
            seats=(first, second),
            bots=wish.bots,
            moments=odds.pooled(moments.values()),
        )

    wanted = odds.grid(course.playing, round(wish.step_s * BEATS_PER_S))
    count = len(wanted) + len(moments)
    jobs = {beat: _job(wish, beat, kept) for beat in wanted}
    futures = {beat: engine.submit(margins, job) for beat, job in jobs.items() if job.variants}
    for beat in wanted:
        before = kept[beat].margins if beat in kept else ()
        found = futures[beat].result() if beat in futures else ()
        if isinstance(found, Phrase):
            raise UserError(found)
        moments[beat] = _moment(source, wish, course, beat, (*before, *found))
        progress(len(moments), count)
        yield result()


class MatchCourse:
    """The course of a recorded match: its beats of play, their clock, and its end.

    Args:
        source: the record.

    Raises:
        UserError: if it has no beat of play.
    """

    def __init__(self, source: ForkSource) -> None:
        record = source.record
        frames = [decode(encoded, Frame) for _, encoded in record.frames]
        clocks = {one.beat: one.clock_ticks for one in frames if one.phase == Phase.PLAYING}
        self.clocks = clocks
        """Ticks of the match's clock, by beat of play."""
        self.playing = sorted(clocks)
        if not self.playing:
            raise UserError(say("odds.no-play", match=source.match_id))
        self.end = _end(record.result, source, self.playing[-1] + 1)
        """The odds at the end of the match, which are certain; None: it has no result."""

    def clock_s(self, beat: int) -> float:
        """Return the clock at a beat of play [s]; for other beats, the clock at the end of play."""
        return self.clocks.get(beat, self.clocks[self.playing[-1]]) * BEAT_S


def margins(job: ChanceJob) -> tuple[float, ...] | Phrase:
    """Play the forks of one moment; return by how many points the first seat won each.

    If a user can correct the cause of an error, return the error's phrase instead.
    """
    try:
        return tuple(_margins(job))
    except UserError as error:
        return error.phrase


def key(source: ForkSource, beat: int, bots: tuple[str, str], arena: str | None = None) -> str:
    """Return the hash of everything that decides how the forks of a moment end.

    Args:
        source: the record.
        beat: first beat that the forks play themselves.
        bots: names of the bots; the contents of bot files and of ghosts' records are hashed.
        arena: folder of the arena, if it is not installed; its files are hashed.
    """
    digest = hashlib.blake2b(digest_size=16)
    for topic, number, data in source.messages:
        if number < beat and topic in ("/lacoc/header", "/lacoc/input"):
            digest.update(data)
    content = [(name, _content(name)) for name in bots]
    game = folder_hash(Path(arena)) if arena else ""
    digest.update(msgspec.msgpack.encode((beat, content, game, software())))
    return digest.hexdigest()


def margin(result: Result, seats: Sequence[str]) -> float:
    """Return by how many points the first seat won a match; negative: it lost.

    If a seat won by a rule other than points, its margin is at least one point.
    """
    points = float(result.scores[0] - result.scores[1])
    if result.computed == seats[0]:
        return max(1.0, points)
    if result.computed == seats[1]:
        return min(-1.0, points)
    return points if not result.computed else 0.0


def _margins(job: ChanceJob) -> Iterator[float]:
    source = opened_record(job.file)
    folder = Path(job.arena) if job.arena else None
    seats = _two_seats(source)
    match, saved = _match_at(job.file, job.beat, job.arena)
    bots = bots_of(source, job.bots, folder)
    for variant in job.variants:
        match.load(saved)
        change = ForkChange(players={i: of_bot(bot, i, variant) for i, bot in enumerate(bots)})
        line = ForkLine(source.record, match, change)
        journal = Journal(match, None)
        while True:
            beat, _ = journal.beat(line.inputs())
            line.see(beat.frame)
            if line.is_over:
                break
        yield margin(match.result(), seats)


@lru_cache(maxsize=1)
def _match_at(file: str, beat: int, arena: str | None) -> tuple[Match, bytes]:
    """Return a recorded match as it was before a beat, and a save of it.

    Each fork changes this match, so load the save into it before each fork.
    """
    before = opened_record(file).record.until(beat - 1)
    match = resume(before, folder=Path(arena) if arena else None).match
    while match.beats < beat - 1:  # beats in which nothing was recorded
        match.beat()
    match.history.keep_nothing()
    return match, match.save()


def _two_seats(source: ForkSource) -> tuple[str, str]:
    if len(source.seats) != 2:
        raise UserError(say("odds.two-seats", seats=source.seats))
    return source.seats[0], source.seats[1]


def _still_known(source: ForkSource, wish: Wish, known: Odds | None) -> dict[int, MomentOdds]:
    """Return the known moments whose forks would end the same way if they were played again."""
    if known is None or known.bots != wish.bots:
        return {}
    return {
        moment.beat: moment
        for moment in known.moments
        if moment.key and moment.key == key(source, moment.beat, wish.bots, wish.arena)
    }


def _job(wish: Wish, beat: int, kept: dict[int, MomentOdds]) -> ChanceJob:
    done = len(kept[beat].margins) if beat in kept else 0
    variants = tuple(range(done + 1, wish.forks + 1))
    return ChanceJob(file=wish.file, beat=beat, bots=wish.bots, variants=variants, arena=wish.arena)


def _moment(
    source: ForkSource, wish: Wish, course: MatchCourse, beat: int, ended: tuple[float, ...]
) -> MomentOdds:
    return MomentOdds(
        beat=beat,
        clock_s=course.clock_s(beat),
        margins=ended,
        chance=odds.chance(ended),
        key=key(source, beat, wish.bots, wish.arena),
    )


def _end(result: Result | None, source: ForkSource, beat: int) -> MomentOdds | None:
    if result is None or not result.computed:
        return None
    winner = result.official if result.official not in ("", "void") else result.computed
    won = {source.seats[0]: 1.0, "draw": 0.5}.get(winner, 0.0)
    points = float(result.scores[0] - result.scores[1])
    return MomentOdds(beat=beat, clock_s=result.clock_s, margins=(points,), chance=won)


def _content(bot: str) -> bytes:
    """Return the content of a bot's file or a ghost's record; empty for an installed bot."""
    is_ghost = bot.startswith(brains.GHOST)
    path = brains.ghost_file(bot)[0] if is_ghost else Path(bot).expanduser()
    return path.read_bytes() if (is_ghost or bot.endswith(".py")) and path.is_file() else b""
