"""A contest with random results and troubles, fact by fact, as an office appends them."""

from collections.abc import Iterator
from random import Random
from typing import TypeVar

from msgspec.structs import replace

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
    StageSettings,
    Voided,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.timetable.schedule import Assignment, assign

_Kind = TypeVar("_Kind", bound=AnyFact)

LEAST_REST_MS = 60_000
GAME_MS = 180_000


class Event:
    """A contest under way: its facts, and a random generator that decides what happens next."""

    def __init__(self, teams: int, courts: int, random: Random, trouble: float = 0.0) -> None:
        self.random = random
        self.trouble = trouble
        """Probability that something goes wrong after a game."""
        self.names = [f"t{number:03d}" for number in range(1, teams + 1)]
        self.courts = [f"court-{number}" for number in range(1, courts + 1)]
        self.facts: list[AnyFact] = []
        self.now_ms = 0
        self.ends: dict[str, tuple[int, Assignment]] = {}
        """By court: when its game ends, and the game."""
        for name in self.names:
            self.add(Entered, team=name, files=f"files of {name}")

    def append(self, fact: _Kind) -> _Kind:
        """Append a fact, with the next number and the present time; return it."""
        number = len(self.facts)
        placed = replace(fact, id=f"f{number}", number=number, at_ms=self.now_ms)
        self.facts.append(placed)
        return placed

    def add(self, kind: type[_Kind], **values: object) -> _Kind:
        """Make a fact and append it; return it."""
        return self.append(new(kind, **values))

    def begin(self, stage: str, how: str, entries: list[str], **settings: object) -> None:
        self.add(Planned, stage=stage, format=how, settings=StageSettings(**settings))
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
        """End the running game that ends first; if none runs, let time pass for teams that rest."""
        if not self.ends:
            self.now_ms += LEAST_REST_MS
            return
        court = min(self.ends, key=lambda court: (self.ends[court][0], court))
        end_ms, game = self.ends.pop(court)
        self.now_ms = max(self.now_ms, end_ms)
        if self.random.random() < self.trouble:
            self._trouble(game)
        else:
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

    def _trouble(self, game: Assignment) -> None:
        """Let something go wrong with a game; half of these troubles leave it without a result."""
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
            case 5:
                self._played(game)
                self.add(Replaced, game=game.game, scores=(5, 1), outcome="left", **about)
            case 6:
                self._played(game)
                self.add(Voided, **about)
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

    def _earlier(self) -> ContestMatch | None:
        """Choose a match with a played game; None if no match has one, or if a court has a game."""
        if self.ends:
            return None
        played = [match for view in self.contest.stages for match in view.matches if match.games]
        return self.random.choice(played) if played else None
