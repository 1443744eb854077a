"""Checks a published contest on all cores."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from lacoc_server.contest.league.facts import AnyFact, Played
from lacoc_server.contest.verify.games import GameCheck, GameToCheck, check_game, games_of
from lacoc_server.contest.verify.history import check_earlier, decisions
from lacoc_server.contest.verify.published import check_published, other_sheet, read
from lacoc_server.contest.verify.sampling import least_forged, sample
from lacoc_server.simulate.workers import WorkerDied, WorkerFailed, Workers
from lacoc_shared.words import Phrase, say

_LONGEST_S = 3600.0
"""Longest time that the proof of a game may take [s]."""


class ContestCheck(NamedTuple):
    """The result of a check of a published contest."""

    findings: tuple[Phrase, ...]
    """What contradicts the facts or the records; empty: nothing does."""
    unchecked: tuple[Phrase, ...]
    """What could not be checked, with the reason: keys of bots, each with its game, or the
    sheet."""
    decisions: tuple[Phrase, ...]
    """Decisions of the organiser and staff; no record can prove them."""
    in_play: tuple[Phrase, ...]
    """Decisions of referees in games at courts."""
    facts: int
    games: int
    proven: int
    """Number of games whose records were proven; of all other games only the results were
    compared."""
    by_bots: int
    """Number of games with bots in which the keys of all bots were checked."""
    by_people: int
    """Number of games at courts between teams without bots: no record shows who pressed their
    keys."""
    least_forged: int
    """If at least this many records are forged, a check of this size finds one with probability
    `sampling.CONFIDENCE`."""


def check(
    folder: Path,
    progress: Callable[[int, int], None],
    *,
    earlier: Path | None = None,
    sampled: int | None = None,
    seed: int = 0,
    jobs: int | None = None,
    programs: bool = False,
) -> ContestCheck:
    """Check a published contest.

    Args:
        folder: the published folder.
        progress: called with the number of checked games and of all games; first with 0, once facts
            and tables are checked.
        earlier: folder of an earlier publication of the contest, or a file with its facts. These
            facts must still be there, unchanged. None: nothing is compared.
        sampled: number of games whose records are proven, chosen by chance; None: all. The results
            of all games are compared with their records.
        seed: for the choice by chance; the same seed chooses the same games.
        jobs: number of processes; None: one for each core.
        programs: whether to run the programs of bots that are in entries.

    Raises:
        UserError: if facts can't be read, or name a format that is not known here.
    """
    facts = read(folder)
    findings = [*check_earlier(read(earlier), facts)] if earlier is not None else []
    findings += check_published(folder, facts)
    games = games_of(facts)
    progress(0, len(games))
    proven = games if sampled is None else sample(games, sampled, seed)
    ids = {game.played.id for game in proven}
    found = [*_check_games(folder, games, ids, jobs, progress, programs)]
    findings += (one for game in found for one in game.wrong)
    sound = [game for game in found if not (game.wrong or game.unchecked)]
    return ContestCheck(
        findings=tuple(findings),
        unchecked=(
            *filter(None, [other_sheet(folder)]),
            *(one for game in found for one in game.unchecked),
        ),
        decisions=(*decisions(facts), *_steered(facts)),
        in_play=tuple(one for game in found for one in game.decided),
        facts=len(facts),
        games=len(games),
        proven=len(proven),
        by_bots=sum(game.has_bots for game in sound),
        by_people=sum(not game.has_bots for game in sound),
        least_forged=least_forged(len(games), len(proven)),
    )


def _steered(facts: Sequence[AnyFact]) -> Iterator[Phrase]:
    """Yield a phrase for each bot that steered teams without one: its name, and how many games.

    People chose these bots, so the phrases are listed among their decisions.
    """
    bots = Counter(fact.steer for fact in facts if isinstance(fact, Played) and fact.steer)
    for bot, games in bots.items():
        yield say("verify.steered", bot=bot, games=games)


def _check_games(
    folder: Path,
    games: Sequence[GameToCheck],
    proven: set[str],
    jobs: int | None,
    progress: Callable[[int, int], None],
    programs: bool,
) -> Iterator[GameCheck]:
    with Workers(jobs, limit_s=_LONGEST_S) as workers:
        futures = [
            workers.submit(check_game, folder, game, game.played.id in proven, programs)
            for game in games
        ]
        for number, (game, future) in enumerate(zip(games, futures, strict=True), 1):
            try:
                yield future.result()
            except (WorkerDied, WorkerFailed) as error:  # no record may end the check of the others
                why = str(error).strip().splitlines()[-1]
                failed = say(
                    "verify.not-checked", record=game.played.record, why=why, about=game.about
                )
                yield GameCheck(wrong=(failed,))
            progress(number, len(games))
