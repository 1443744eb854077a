"""A court of a contest with an office, in a process of its own, and teams that play there."""

import functools
import itertools
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from contest_tokens import keep_tokens
from ports import free_port
from running import served
from waiting import LIMIT_S

from lacoc_arenas import arena as arenas
from lacoc_client.play.bot_player import BotPlayer
from lacoc_client.play.controller import Controller
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.contest.live.court_link import Asked, CourtLink, CourtResult, Unanswered
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.messages import Done, Refusal, SentFile
from lacoc_shared.messages.office import AssignedSeat
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

SEATS = ("left", "right")
QUICK = {"match": {"countdown_s": 0.1, "duration_s": 1.0, "start": "ready"}}
"""Settings of a match of one second without a referee."""
FIXTURE = say(
    "fixture.game", match=say("fixture.semi-final", stage=None, number=1), game=2, games=3
)

OFFICE = "the token of the office"
WHISTLE = "the token of the referee"

_calls = itertools.count(1)


@functools.cache
def hash_of(team: str) -> str:
    """Return the hash of a team's token; a team has one token for all its matches."""
    return new_token_hash(token(team))


def token(team: str) -> str:
    return f"the token of {team}"


def entry(seat: str, team: str, robot: str = "hexapod", **changes: Any) -> AssignedSeat:
    """Return a team in a seat, with a sample robot's files; `changes` replace the seat's fields."""
    postures, locomotion = sample_gait_files(robot)
    files: dict[str, Any] = {"robot": SentFile(*find_robot(robot))}
    files |= {"postures": postures, "locomotion": locomotion, "token_hashes": (hash_of(team),)}
    return AssignedSeat(id=seat, team=team, **(files | changes))


def new_call() -> str:
    return f"call-{next(_calls)}"


class Office:
    """The office's side of one court, and the players of its matches."""

    def __init__(self, session: Session, process: subprocess.Popen[str]) -> None:
        self.session = session
        self.process = process
        self.link = CourtLink(session, "main", OFFICE)

    def assign(
        self, left: str | AssignedSeat, right: str | AssignedSeat, call: str = "", **changes: Any
    ) -> str:
        """Assign a match, and return its call once the court has it."""
        call = call or new_call()
        answer = self.asks(left, right, call, **changes)
        assert answer == Done(), answer
        self.until(lambda: self.link.call == call)
        return call

    def asks(
        self, left: str | AssignedSeat, right: str | AssignedSeat, call: str = "", **changes: Any
    ) -> Done | Refusal:
        """Ask the court to play a match, and return the court's answer."""
        sides = zip(SEATS, (left, right), strict=True)
        seats = [entry(seat, one) if isinstance(one, str) else one for seat, one in sides]
        changes, call = {"arena_settings": QUICK} | changes, call or new_call()
        return self.answer(lambda: self.link.assign(call, FIXTURE, seats, **changes))

    def withdraw(self, call: str) -> Done | Refusal:
        """Ask the court to take a match back, and return the court's answer."""
        return self.answer(lambda: self.link.withdraw(call))

    def answer(self, ask: Callable[[], Asked]) -> Done | Refusal:
        """Ask a court until it answers, as an office does: a busy machine may be late."""
        end_s = time.monotonic() + LIMIT_S
        while isinstance(answer := ask().wait(), Unanswered):
            assert time.monotonic() < end_s, "the court does not answer"
        return answer

    def refusal(self, *sides: str | AssignedSeat, **changes: Any) -> Refusal:
        """Assign a match that the court must refuse, and return the refusal."""
        answer = self.asks(*sides, **changes)
        assert isinstance(answer, Refusal)
        return answer

    def until(self, true: Callable[[], bool]) -> None:
        end_s = time.monotonic() + LIMIT_S
        while not true():
            assert time.monotonic() < end_s, "it did not come true"
            self.link.poll()
            time.sleep(0.005)

    def phase(self, phase: Phase) -> None:
        """Wait for a phase."""
        self.until(lambda: self.link.phase is phase)

    def controller(self, seat: str, team: str, **files: SentFile | None) -> Controller:
        return Controller(self.session, "main", seat, token(team), "any name", **files)

    def plays(self, *teams: str, until: Callable[[], bool] | None = None) -> list[Controller]:
        """Let bots of two teams play until the match has a result or `until` is true.

        Returns:
            The teams' controllers.
        """
        players = [self.controller(seat, team) for seat, team in zip(SEATS, teams, strict=True)]
        for player in players:
            player.join()
        self.go_on(players, until or (lambda: self.link.result is not None))
        return players

    def go_on(self, players: list[Controller], until: Callable[[], bool]) -> None:
        """Let bots play with controllers that have joined, until a condition is true."""
        arena = arenas.load("othello")
        bots = [BotPlayer(player, arena, next(iter(arena.bots))) for player in players]

        def done() -> bool:
            for player, bot in zip(players, bots, strict=True):
                if (frame := player.wait_frame(0.02)) is not None:
                    bot.see(frame)
            return until()

        self.until(done)

    @property
    def result(self) -> CourtResult:
        assert self.link.result is not None
        return self.link.result


def write_office_contest(path: Path) -> Path:
    """Write the contest file of one court, whose every match is late, and its office."""
    path.write_text(f"""
[health]
worst_late_ms = 0.0
[court.main]
arena = "othello"
listen = ["tcp/127.0.0.1:{free_port()}"]
settings.match.countdown_s = 0.1
""")
    keep_tokens(path, {}, WHISTLE)
    return path


@contextmanager
def office_of(contest: Path, folder: Path, *words: str) -> Iterator[Office]:
    """Run a contest's court until the block ends; give an `Office` that is linked to the court."""
    address = contest.read_text().partition('listen = ["')[2].partition('"')[0]
    with (
        served(contest, folder, *words, office=True) as process,
        open_client([address]) as session,
    ):
        yield Office(session, process)
