"""Checks a published contest on all cores."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from lacoc_server.contest.verify.games import Game, check_game, games_of
from lacoc_server.contest.verify.history import check_earlier, decisions
from lacoc_server.contest.verify.published import check_published, read
from lacoc_server.contest.verify.sampling import least_forged, sample
from lacoc_server.studio.workers import WorkerDied, WorkerFailed, Workers
from lacoc_shared.words import Phrase, say

_LONGEST_S = 3600.0
"""Longest time that the proof of a game may take [s]."""


class Checked(NamedTuple):
    """What the check of a published contest found."""

    findings: tuple[Phrase, ...]
    """What does not follow; empty: everything does."""
    decisions: tuple[Phrase, ...]
    """What people decided; no record can prove it."""
    facts: int
    games: int
    proven: int
    """Games whose records were proven; of the others only the results were compared."""
    least_forged: int
    """If this many records are forged, a check finds one with probability `sampling.CONFIDENCE`."""


def check(
    folder: Path,
    progress: Callable[[int, int], None],
    *,
    earlier: Path | None = None,
    sampled: int | None = None,
    seed: int = 0,
    jobs: int | None = None,
) -> Checked:
    """Check a published contest.

    Args:
        folder: the published folder.
        progress: told how many games are checked, and how many there are.
        earlier: folder of an earlier publication of the contest, or a file with its facts. These
            facts must still be there, unchanged. None: nothing is compared.
        sampled: number of games whose records are proven, chosen by chance; None: all. The results
            of all games are compared with their records.
        seed: chooses the games.
        jobs: number of processes; None: one for each core.

    Raises:
        UserError: if facts can't be read, or name a format that is not known here.
    """
    facts = read(folder)
    findings = [*check_earlier(read(earlier), facts)] if earlier is not None else []
    findings += check_published(folder, facts)
    games = games_of(facts)
    proven = games if sampled is None else sample(games, sampled, seed)
    findings += _check_games(folder, games, {game.played.id for game in proven}, jobs, progress)
    return Checked(
        findings=tuple(findings),
        decisions=tuple(decisions(facts)),
        facts=len(facts),
        games=len(games),
        proven=len(proven),
        least_forged=least_forged(len(games), len(proven)),
    )


def _check_games(
    folder: Path,
    games: Sequence[Game],
    proven: set[str],
    jobs: int | None,
    progress: Callable[[int, int], None],
) -> list[Phrase]:
    found: list[Phrase] = []
    with Workers(jobs, limit_s=_LONGEST_S) as workers:
        futures = [
            workers.submit(check_game, folder, game, game.played.id in proven) for game in games
        ]
        for number, (game, future) in enumerate(zip(games, futures, strict=True), 1):
            try:
                found += future.result()
            except (WorkerDied, WorkerFailed) as error:  # no record may end the check of the others
                why = str(error).strip().splitlines()[-1]
                played = game.played
                found.append(
                    say(
                        "verify.not-checked",
                        record=played.record,
                        why=why,
                        pairing=played.pairing,
                        game=played.game,
                    )
                )
            progress(number, len(games))
    return found
