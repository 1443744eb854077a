"""Tests of the processes of a contest."""

import socket
import urllib.request
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest
from every_third import every_third
from small_contest import CONTEST, SWISS
from waiting import LIMIT_S, until

from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.live import venue
from lacoc_shared.words import Phrase, render, say

COURT = """
[court.red]
arena = "othello"
listen = ["127.0.0.1:{port}"]
"""


@pytest.mark.slow
def test_a_court_whose_port_is_taken_says_so_before_it_tries_again(tmp_path: Path) -> None:
    """The message names court and port, and says what to do; once the port is free, it opens."""
    told: list[Phrase] = []
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]

        def tell(what: Phrase) -> None:
            told.append(what)
            other.close()

        file = tmp_path / "contest.toml"
        file.write_text(CONTEST + COURT.format(port=port) + SWISS, "utf-8")
        opened = venue.court(ContestFolder(file), "red", tmp_path / "red", 1.0, tell, here=True)
        with opened as address:
            assert address == f"tcp/127.0.0.1:{port}"
    (why,) = map(render, told)
    assert why.startswith(f"Court red can't be opened. Port {port} is in use")
    assert "[court.red]" in why


@pytest.mark.slow
@pytest.mark.parametrize("listen", every_third(["127.0.0.1:0", None]))
def test_killed_pages_come_back_at_their_address(tmp_path: Path, listen: str | None) -> None:
    """Also if they took a free port: links lead there, and pages that are open come back."""
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST + COURT.format(port=0) + SWISS, "utf-8")

    def is_there(url: str) -> bool:
        try:
            with urllib.request.urlopen(f"{url}/healthz", timeout=LIMIT_S) as answer:
                return bool(answer.status == 200)
        except OSError:
            return False

    told: list[Phrase] = []
    where = ContestFolder(file)
    with venue.pages(where, tmp_path, listen, False, "tcp/127.0.0.1:1", told.append) as url:
        assert is_there(url)
        pages = next(
            one
            for one in psutil.Process().children(recursive=True)
            if url.rpartition(":")[2] in {str(c.laddr.port) for c in one.net_connections()}
        )
        pages.kill()
        until(lambda: not pages.is_running() or pages.status() == psutil.STATUS_ZOMBIE)
        until(lambda: is_there(url))
        assert told[:1] == [say("child.again", what=say("child.gateway"), why=None)]


class _Idle:
    """A process that runs until it is ended."""

    def __init__(self) -> None:
        self.ended = False

    def poll(self) -> int | None:
        return 0 if self.ended else None

    def terminate(self) -> None:
        self.ended = True

    def wait(self, timeout: float) -> None:
        pass


def test_a_bot_with_new_files_plays_its_game_to_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The next game has the new program, also if it is called as soon as the last one ends."""
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST + COURT.format(port=0) + SWISS, "utf-8")
    started: list[tuple[str, _Idle]] = []

    def start(team: str, bot: str, files: str) -> _Idle:
        started.append((files, _Idle()))
        return started[-1][1]

    def contest(files: str, *calls: str) -> Any:
        team = SimpleNamespace(name="Ants", bot="planner", files=files)
        running = [SimpleNamespace(id=one, teams=("Ants", "Bees")) for one in calls]
        return SimpleNamespace(teams=(team,), running=running)

    with venue.Bots(ContestFolder(file), {}) as bots:
        monkeypatch.setattr(bots, "_start", start)
        monkeypatch.setattr(venue, "_AGAIN_S", 0.0)
        bots.follow(contest("old", "c1"))
        bots.follow(contest("new", "c1"))
        assert [(files, one.ended) for files, one in started] == [("old", False)]
        bots.follow(contest("new", "c2"))
        assert [(files, one.ended) for files, one in started] == [("old", True), ("new", False)]
        bots.follow(contest("new"))
        bots.follow(contest("newest"))
        assert [one.ended for _, one in started] == [True, True]
