"""A contest that is played by chance, fact by fact, as an office would append them."""

import itertools
from collections.abc import Iterator
from random import Random

from lacoc_server.contest.league.contest import Contest, compute, next_round
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Disqualified,
    Drawn,
    Entered,
    NoShow,
    Planned,
    Played,
    Recalled,
    Replaced,
    Replay,
    RoundDrawn,
    Settings,
    Voided,
    Withdrawn,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.matches import Match
from lacoc_server.contest.league.schedule import Assignment, assign

LEAST_REST_MS = 60_000
GAME_MS = 180_000


class Event:
    """A contest under way: its facts, and what chance does next."""

    def __init__(self, teams: int, courts: int, random: Random, trouble: float = 0.0) -> None:
        self.random = random
        self.trouble = trouble
        """Probability that something goes wrong after a game."""
        self.names = [f"t{number:03d}" for number in range(1, teams + 1)]
        self.courts = [f"court-{number}" for number in range(1, courts + 1)]
        self.facts: list[AnyFact] = []
        self.now_ms = 0
        self._numbers = itertools.count()
        self.ends: dict[str, tuple[int, Assignment]] = {}
        """By court: when its game ends, and the game."""
        for name in self.names:
            self.add(Entered, team=name, files=f"files of {name}")

    def add(self, kind: type[AnyFact], **values: object) -> None:
        number = next(self._numbers)
        self.facts.append(kind(id=f"f{number}", number=number, at_ms=self.now_ms, **values))

    def begin(self, stage: str, how: str, entries: list[str], **settings: object) -> None:
        self.add(Planned, stage=stage, format=how, settings=Settings(**settings))
        self.add(Drawn, stage=stage, entries=tuple(entries))

    @property
    def contest(self) -> Contest:
        return compute(self.facts, FORMATS)

    def play(self, stage: str) -> Iterator[tuple[Contest, list[Assignment]]]:
        """Play a stage to its end; yield the contest and what was assigned at each step."""
        while not (contest := self.contest).stage(stage).over:
            if contest.stage(stage).may_draw:
                self.add(
                    RoundDrawn,
                    stage=stage,
                    round=len(contest.stage(stage).stage.drawn) + 1,
                    pairs=next_round(contest, stage, FORMATS),
                )
                continue
            given = assign(contest, self.courts, self.now_ms, LEAST_REST_MS)
            for one in given:
                self.add(
                    Called, pairing=one.pairing, game=one.game, teams=one.teams, court=one.court
                )
                length = self.random.randint(1, GAME_MS)
                self.ends[one.court] = (self.now_ms + length, one)
            yield contest, given
            self._end_first()

    def _end_first(self) -> None:
        """Go to the end of the next game; without one, let time pass for teams that rest."""
        if not self.ends:
            self.now_ms += LEAST_REST_MS
            return
        court = min(self.ends, key=lambda court: (self.ends[court][0], court))
        end_ms, game = self.ends.pop(court)
        self.now_ms = max(self.now_ms, end_ms)
        if self.random.random() < self.trouble and self._trouble(game):
            return
        self._played(game)

    def _played(self, game: Assignment) -> None:
        left, right = self.random.randint(0, 9), self.random.randint(0, 9)
        outcome = "left" if left > right else "right" if right > left else "draw"
        self.add(
            Played,
            pairing=game.pairing,
            game=game.game,
            teams=game.teams,
            scores=(left, right),
            outcome=outcome,
            record=f"record of {game.pairing}/{game.game}",
        )

    def _trouble(self, game: Assignment) -> bool:
        """Let something go wrong; True: the game has no result."""
        about = {"pairing": game.pairing, "teams": game.teams, "reason": "trouble"}
        match self.random.randint(0, 7):
            case 0:
                self.add(Recalled, pairing=game.pairing, game=game.game)
            case 1:
                self.add(Recalled, pairing=game.pairing, game=game.game)
                self.add(NoShow, pairing=game.pairing, team=self.random.choice(game.teams))
            case 2:
                self.add(Recalled, pairing=game.pairing, game=game.game)
                self.add(Withdrawn, team=self.random.choice(game.teams), reason="robot broken")
            case 3:
                self.add(Recalled, pairing=game.pairing, game=game.game)
                self.add(Disqualified, team=self.random.choice(game.teams), reason="two robots")
            case 4:
                self._played(game)
                self.add(Replay, game=game.game, **about)
                return True
            case 5:
                self._played(game)
                self.add(Replaced, game=game.game, scores=(5, 1), outcome="left", **about)
                return True
            case 6:
                self._played(game)
                self.add(Voided, **about)
                return True
            case _:
                self._played(game)
                earlier = self._earlier()
                if earlier is not None:
                    self.add(
                        Replay,
                        pairing=earlier.pairing.id,
                        game=earlier.games[-1].number,
                        teams=earlier.games[-1].teams,
                        reason="protest",
                    )
                return True
        return True

    def _earlier(self) -> Match | None:
        """Choose a match that was played and that no game on a court hangs on."""
        if self.ends:
            return None
        played = [match for view in self.contest.stages for match in view.matches if match.games]
        return self.random.choice(played) if played else None
