"""The processes of a contest: its courts, the gateway with the pages, and the bots that play."""

import math
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Self

from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.league.contest import Contest
from lacoc_shared.command.child import apart, command_line, kept_child
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import check_free, endpoint
from lacoc_shared.words import Phrase, say

_END_S = 5.0
_ADDRESS_S = 20.0
_LOOK_S = 0.5
_AGAIN_S = 5.0
"""Shortest time between two starts of one bot [s]."""


@contextmanager
def court(
    where: ContestFolder,
    name: str,
    folder: Path,
    speed: float,
    tell: Callable[[Phrase], None],
    *,
    here: bool,
) -> Iterator[str]:
    """Run a court of the contest until the block ends; yield its address.

    If its process ends, it is started again, and goes on with its match. If it can't be opened, it
    is tried again for some seconds: the courts of a killed office may still use their addresses for
    some seconds.

    Args:
        where: the contest.
        name: the court's name.
        folder: folder for what the process prints; it is made.
        speed: 2 plays twice as fast as real time.
        tell: called with the reason if the court can't be opened at the first try.
        here: True: the court runs on the office's machine. False: it runs on the machine that the
            contest file names for it, if any.

    Raises:
        UserError: if the court can't be opened.
    """
    words = ["serve", "--contest", str(where.file), "--court", name, "--json"]
    words += ["--speed", str(speed)]
    entry = where.contest.courts[name]
    if here and entry.elsewhere:
        words += ["--listen", entry.listen[0]]
    listen = entry.listen[:1] if here and entry.elsewhere else entry.own_listen
    folder.mkdir(parents=True, exist_ok=True)
    what = say("child.contest-court", court=name)
    end_s = time.monotonic() + _ADDRESS_S
    is_told = False
    with ExitStack() as stack:
        while True:
            try:
                _check_free(where.contest, name, listen)
                again = _at_same_port(words, listen[0])
                opened = stack.enter_context(kept_child(words, folder, what, again, tell))
                break
            except UserError as error:
                if time.monotonic() > end_s:
                    raise
                if not is_told:
                    tell(say("child.tried-again", why=error.phrase, seconds=_ADDRESS_S))
                    is_told = True
                time.sleep(_LOOK_S)
        yield opened["locators"][0]


@contextmanager
def pages(
    where: ContestFolder,
    folder: Path,
    listen: str | None,
    show: bool,
    desk: str,
    tell: Callable[[Phrase], None],
) -> Iterator[str]:
    """Serve the pages of a contest until the block ends; yield their address.

    Args:
        where: the contest.
        folder: folder for what the process prints.
        listen: where to listen; None: this machine only.
        show: whether to open a browser.
        desk: address of the office's desk.
        tell: called when the gateway has ended and is started again.
    """
    words = ["web", "--contest", str(where.file), "--office", desk, "--json"]
    first = [*words, *(["--listen", listen] if listen else []), *(["--open"] if show else [])]
    place = folder / "pages"
    place.mkdir()

    def again(opened: dict[str, Any]) -> list[str]:
        return [*words, "--listen", opened["listen"]]  # also if it took a free port: links stay

    with kept_child(first, place, say("child.gateway"), again, tell) as opened:
        yield opened["url"]


def told_address(contest: ContestFile, name: str, opened: str) -> str:
    """Return the address at which contestants on other machines reach a court of this machine.

    Args:
        contest: the contest.
        name: the court's name.
        opened: the address at which it was opened, with the real port.
    """
    court = contest.courts[name]
    if court.connect:
        return court.connect
    port = opened.rpartition(":")[2]
    if court.host:
        return f"{court.listen[0].rpartition(':')[0]}:{port}"
    return f"{opened.partition('/')[0]}/{contest.own_host}:{port}"


def _check_free(contest: ContestFile, name: str, listen: Sequence[str]) -> None:
    """Check that a court can listen at its addresses, before a process is started for it.

    Raises:
        UserError: if it can't; the message names the court, the port and what to do.
    """
    try:
        check_free([endpoint(one, contest.public.protocol) for one in listen])
    except UserError as error:
        raise UserError(say("child.no-address", court=name, why=error.phrase)) from None


def _at_same_port(words: list[str], listen: str) -> Callable[[dict[str, Any]], list[str]]:
    """Return a function that makes the command line with which a court is started again.

    If the court was given a free port at its first start, the command line names the same port.
    """
    place, _, port = listen.rpartition(":")

    def again(opened: dict[str, Any]) -> list[str]:
        if port != "0":
            return words
        return [*words, "--listen", f"{place}:{opened['locators'][0].rpartition(':')[2]}"]

    return again


class _PlayingBot(NamedTuple):
    """The process of a team's bot."""

    files: str
    """Hash of the files that it plays with."""
    call: str
    """The newest call of its team with these files; "": its team is in no game."""
    process: "subprocess.Popen[bytes]"


class Bots:
    """Runs the bots of teams: a process for each team, which plays at one court after the other.

    Used as a context manager; all processes end with it.

    Args:
        where: the contest.
        addresses: the courts' addresses, by name.
    """

    def __init__(self, where: ContestFolder, addresses: Mapping[str, str]) -> None:
        self._where = where
        self._addresses = addresses
        self._playing: dict[str, _PlayingBot] = {}
        """The running bots, by team."""
        self._ending: list[subprocess.Popen[bytes]] = []
        self._begun_s: dict[str, float] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for process in (*(one.process for one in self._playing.values()), *self._ending):
            _end(process)

    def follow(self, contest: Contest) -> None:
        """Start the bots of teams that are called for the first time.

        If the process of a called team's bot has ended, start it again. If a team has new files,
        end its bot, but not in a game: it plays that to the end.
        """
        bots = {team.name: team for team in contest.teams if team.bot}
        called = {name: call.id for call in contest.running for name in call.teams if name in bots}
        for name, there in [*self._playing.items()]:
            call = called.get(name, "")
            if name in bots and there.files == bots[name].files:
                self._playing[name] = there._replace(call=call)
            elif call != there.call or not call:
                del self._playing[name]
                there.process.terminate()
                self._ending.append(there.process)
        self._ending = [process for process in self._ending if process.poll() is None]
        now_s = time.monotonic()
        for name, call in called.items():
            team, playing = bots[name], self._playing.get(name)
            gone = playing is None or playing.process.poll() is not None
            if gone and now_s - self._begun_s.get(name, -math.inf) > _AGAIN_S:
                self._begun_s[name] = now_s
                process = self._start(name, team.bot, team.files)
                self._playing[name] = _PlayingBot(team.files, call, process)

    def _start(self, team: str, bot: str, files: str) -> "subprocess.Popen[bytes]":
        program = self._where.entries.path / files / "bot.py"
        name = str(program) if program.exists() else bot
        court, authority = self._where.contest.asked, self._where.contest.public.authority
        stand_in = self._where.contest.courts[court].stand_in()
        at = ",".join(filter(None, (self._addresses[court], stand_in)))
        words = ["bot", name, "--court", court, "--connect", at]
        words += [] if authority is None else ["--authority", str(authority)]
        options = apart()
        options["env"] |= {"LACOC_TOKEN": self._where.contest.secrets.team(team)}
        return subprocess.Popen(
            command_line(words), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options
        )


def _end(process: "subprocess.Popen[bytes]") -> None:
    process.terminate()
    try:
        process.wait(_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
