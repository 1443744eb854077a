"""The processes of a contest: its courts, the gateway with the pages, and the bots that play."""

import math
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Self

from lacoc_server.contest.folder import ContestFolder
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.tokens import TeamTokens
from lacoc_shared.command.child import apart, command_line, kept_child
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_SEATS = ("left", "right")
_END_S = 5.0
_ADDRESS_S = 20.0
_LOOK_S = 0.5
_AGAIN_S = 5.0
"""Shortest time between two starts of a bot in the same seat."""


@contextmanager
def courts(where: ContestFolder, folder: Path, speed: float) -> Iterator[dict[str, str]]:
    """Run the contest's courts until the block ends; give the address of each by its name.

    A court that ends is started again: it goes on with its match.

    Args:
        where: the contest.
        folder: folder for what the processes print.
        speed: 2 plays twice as fast as real time.
    """
    with ExitStack() as stack:
        addresses = {}
        for name in where.contest.courts:
            words = ["serve", "--contest", str(where.file), "--court", name, "--json"]
            words += ["--speed", str(speed)]
            place = folder / name
            place.mkdir()
            addresses[name] = stack.enter_context(_court(name, words, place))["locators"][0]
        yield addresses


@contextmanager
def _court(name: str, words: list[str], folder: Path) -> Iterator[dict[str, Any]]:
    """Run a court; one of an office that was killed may hold its address for some seconds more."""
    end_s = time.monotonic() + _ADDRESS_S
    with ExitStack() as stack:
        while True:
            what = say("child.contest-court", court=name)
            try:
                opened = stack.enter_context(kept_child(words, folder, what, _at_same_place(words)))
                break
            except UserError:
                if time.monotonic() > end_s:
                    raise
                time.sleep(_LOOK_S)
        yield opened


@contextmanager
def pages(where: ContestFolder, folder: Path, listen: str | None, show: bool) -> Iterator[str]:
    """Serve the pages of a contest until the block ends; give their address.

    Args:
        where: the contest.
        folder: folder for what the process prints.
        listen: where to listen; None: this machine only.
        show: whether to open a browser.
    """
    words = ["web", "--contest", str(where.file), "--json"]
    words += ["--listen", listen] if listen else []
    first = [*words, "--open"] if show else words
    place = folder / "pages"
    place.mkdir()
    with kept_child(first, place, say("child.gateway"), _same(words)) as opened:
        yield opened["url"]


def _at_same_place(words: list[str]) -> Callable[[dict[str, Any]], list[str]]:
    """Return a function that gives the words of a later start of a court, at the same address."""
    return lambda opened: [*words, "--listen", opened["locators"][0]]


def _same(words: list[str]) -> Callable[[object], list[str]]:
    """Return a function that gives the words of a later start, whatever the first one said."""
    return lambda _: words


class _Seat(NamedTuple):
    """A seat of a game that a bot plays."""

    call: str
    court: str
    seat: str
    team: str


class Bots:
    """Plays for the teams that are bots: a process for each seat of a running game.

    Used as a context manager; all processes end with it.

    Args:
        where: the contest.
        tokens: the tokens of the teams.
        addresses: the courts' addresses by name.
    """

    def __init__(
        self, where: ContestFolder, tokens: TeamTokens, addresses: Mapping[str, str]
    ) -> None:
        self._where = where
        self._tokens = tokens
        self._addresses = addresses
        self._playing: dict[_Seat, subprocess.Popen[bytes]] = {}
        self._ending: list[subprocess.Popen[bytes]] = []
        self._begun_s: dict[_Seat, float] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for process in (*self._playing.values(), *self._ending):
            _end(process)

    def follow(self, contest: Contest, there: Mapping[str, str | None]) -> None:
        """Start the bots of the games that courts have, and end those of games that are over.

        Args:
            contest: the contest.
            there: by court, the call that it has; None: not known now.
        """
        bots = {team.name: team for team in contest.teams if team.bot}
        wanted = {
            _Seat(call.id, call.court, seat, team): bots[team]
            for call in contest.running
            for seat, team in zip(_SEATS, call.teams, strict=True)
            if team in bots and there.get(call.court) == call.id
        }
        running = {call.id for call in contest.running}
        for seat in [one for one in self._playing if one.call not in running]:
            process = self._playing.pop(seat)
            process.terminate()
            self._ending.append(process)
        self._ending = [process for process in self._ending if process.poll() is None]
        now_s = time.monotonic()
        for seat, team in wanted.items():
            running_now = self._playing.get(seat)
            gone = running_now is None or running_now.poll() is not None
            if gone and now_s - self._begun_s.get(seat, -math.inf) > _AGAIN_S:
                self._begun_s[seat] = now_s
                self._playing[seat] = self._start(seat, team.bot, team.files)

    def _start(self, seat: _Seat, bot: str, files: str) -> "subprocess.Popen[bytes]":
        program = self._where.entries.path / files / "bot.py"
        words = ["bot", str(program) if program.exists() else bot, "--name", seat.team]
        words += ["--court", seat.court, "--connect", self._addresses[seat.court]]
        options = apart()
        options["env"] |= {"LACOC_TOKEN": self._tokens.of(seat.team)}
        return subprocess.Popen(
            command_line([*words, "--seat", seat.seat]),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            **options,
        )


def _end(process: "subprocess.Popen[bytes]") -> None:
    process.terminate()
    try:
        process.wait(_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
