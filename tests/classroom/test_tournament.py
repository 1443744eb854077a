"""Tests of a class's tournament: real matches, played by the real command."""

import asyncio
import sys
from collections.abc import Mapping
from pathlib import Path

import msgspec
import psutil
import pytest
from aside import run_async

from lacoc_client.play import simulation
from lacoc_client.web.gateway.wire import FAULT
from lacoc_client.workshop.classroom.tournament import Tournament, TournamentState
from lacoc_client.workshop.phases.export import free_name
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.seat_files import SeatFiles
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import faults, render

HEXAPOD = SeatFiles(None, *sample_gait_files("hexapod"))
LONG_LEGS = SeatFiles(SentFile(*find_robot("long-legs")), *sample_gait_files("long-legs"))
BROKEN = SeatFiles(None, None, SentFile("level B of Loco-data.txt", b"1\n1\n5"))
WITHOUT = HEXAPOD._replace(locomotion=None)


class Class:
    """A class that plays; it keeps every state that it was told."""

    def __init__(self, folder: Path) -> None:
        self.states: list[TournamentState] = []
        self.news = asyncio.Event()
        self.kept: list[bytes] = []
        self.tournament = Tournament(folder, self.take, self.keep)

    async def keep(self) -> None:
        self.kept.append(msgspec.json.encode(self.state))

    def take(self) -> None:
        self.states.append(self.tournament.state)
        self.news.set()

    @property
    def state(self) -> TournamentState:
        return self.tournament.state

    async def until(self, done: int) -> None:
        """Wait until `done` matches have ended, or the tournament is over."""
        while self.state.state == "running" and self.state.done < done:
            self.news.clear()
            await asyncio.wait_for(self.news.wait(), 60)


@pytest.mark.slow
@pytest.mark.long
def test_a_tournament_of_a_class(tmp_path: Path) -> None:
    """Gaits play under nicknames, each match has a record, and gaits with mistakes are left out."""

    async def play() -> None:
        room = Class(tmp_path)
        players = {"../ana": HEXAPOD, "ANA": LONG_LEGS, "ana": HEXAPOD, "りく 🐜": LONG_LEGS}
        unfit = {"Zoë": BROKEN, "Quinn": WITHOUT}
        await room.tournament.play({**players, **unfit}, "othello", 1, 3.0)
        assert (room.state.state, room.state.arena) == ("running", "othello")
        with pytest.raises(UserError, match="is being played"):
            await room.tournament.play(players, "othello", 1, 3.0)
        await room.until(3)
        last = room.state
        assert (last.state, last.done, last.of, last.trouble) == ("done", 2, 2, None)
        assert {name for one in last.matches for name in (one.left, one.right)} == {*players}
        assert {one.name for one in last.standings} == {*players}
        assert sum(one.points for one in last.standings) == 2 * 36
        assert [state.done for state in room.states] == sorted(s.done for s in room.states)
        for one in last.matches:
            assert one.record is not None
            record = Record.read(room.tournament.recordings / one.record)
            assert record.result is not None
            assert record.result.scores == one.scores
        again = Class(tmp_path)
        again.tournament.load(room.kept[-1])
        assert again.state == last
        again.tournament.load(b"of another version")
        await again.tournament.forget("ana")
        said = msgspec.json.encode(again.state)
        assert b'"ana"' in room.kept[-1]
        assert b'"ana"' not in said
        assert again.kept[-1] == said
        gone = [one.record for one in last.matches if "ana" in (one.left, one.right)]
        assert not any((tmp_path / "recordings" / str(name)).exists() for name in gone)
        assert [one.name for one in again.state.standings].count("–") == 1
        quinn, zoe = last.left_out
        assert (quinn.name, quinn.mistakes) == ("Quinn", ())
        assert quinn.why is not None
        assert "no key with which the robot walks" in render(quinn.why)
        assert (zoe.name, zoe.why) == ("Zoë", None)
        assert {mistake.file for mistake in zoe.mistakes} == {"level B of Loco-data.txt"}
        assert faults(quinn.why) == [f for m in zoe.mistakes for f in faults(m.phrase)] == []

    run_async(play)


@pytest.mark.slow
@pytest.mark.long
def test_a_tournament_that_is_ended_early(tmp_path: Path) -> None:
    """After a kill or a stop the matches so far stay, and another tournament can begin."""

    async def play() -> None:
        room = Class(tmp_path)
        players = {"Ada": HEXAPOD, "Bo": LONG_LEGS}
        await room.tournament.play(players, "othello", 50, 3.0)
        await room.until(1)
        (command,) = children()
        workers = command.children(recursive=True)
        command.kill()
        await room.until(51)
        assert (room.state.state, room.state.of) == ("stopped", 50)
        assert room.state.trouble is not None
        assert "ended with -9" in render(room.state.trouble)
        assert faults(room.state.trouble) == []
        assert 1 <= room.state.done == len(room.state.matches) < 50
        assert psutil.wait_procs(workers, 30)[1] == []

        kept = [*room.tournament.recordings.glob("*.mcap")]
        await room.tournament.play(players, "othello", 50, 3.0)
        assert room.state.matches == ()
        await room.until(1)
        await room.tournament.forget("Ada")
        await room.until(room.state.done + 1)
        assert b'"Ada"' not in msgspec.json.encode(room.state)
        assert [*room.tournament.recordings.glob("*.mcap")] == kept
        await room.tournament.stop()
        assert (room.state.state, room.state.trouble) == ("stopped", None)
        assert len(room.state.matches) >= 1
        assert children() == []
        assert not [*room.tournament.recordings.glob("*.part")]
        await room.tournament.stop()

    run_async(play)


def children() -> list[psutil.Process]:
    """Return the commands that this process has started, and that still run."""
    return [
        child
        for child in psutil.Process().children()
        if "simulate" in child.cmdline() and child.status() != psutil.STATUS_ZOMBIE
    ]


@pytest.mark.slow
def test_a_tournament_of_broken_gaits_says_who_was_left_out(tmp_path: Path) -> None:
    """If fewer than two gaits are right, the tournament stops and names the others."""

    async def play() -> None:
        room = Class(tmp_path)
        await room.tournament.play({"Ada": HEXAPOD, "Bo": BROKEN}, "othello", 1, 3.0)
        await room.until(1)
        assert (room.state.state, room.state.matches) == ("stopped", ())
        assert room.state.trouble is not None
        assert render(room.state.trouble).endswith("at least two gaits that walk. Left out: Bo.")

    run_async(play)


def test_a_line_that_nobody_can_read_ends_a_tournament_with_a_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The page shows that an error occurred, and the log shows which one."""
    told = [sys.executable, "-c", "print('no line of a simulation')"]
    monkeypatch.setattr(simulation, "command_line", lambda _: told)

    async def play() -> None:
        room = Class(tmp_path)
        await room.tournament.play({"Ada": HEXAPOD, "Bo": LONG_LEGS}, "othello", 1, 3.0)
        await room.until(1)
        assert (room.state.state, room.state.trouble) == ("stopped", FAULT)

    run_async(play)
    assert "DecodeError" in caplog.text


@pytest.mark.parametrize("players", [{}, {"Ada": HEXAPOD}, {"Ada": HEXAPOD, "Bo": WITHOUT}])
def test_fewer_than_two_can_not_play(tmp_path: Path, players: Mapping[str, SeatFiles]) -> None:
    """Without two gaits that walk, a tournament is refused and does not begin."""

    async def play() -> None:
        room = Class(tmp_path)
        with pytest.raises(UserError, match="at least two gaits that walk"):
            await room.tournament.play(players, "othello", 1, 3.0)
        assert room.state.state == "none"
        await room.tournament.stop()

    run_async(play)


def test_names_of_folders() -> None:
    """Each nickname gives a folder name that every system accepts and no other student has."""
    taken: list[str] = []
    for name in (
        "Ana",
        "ana",
        "ÁNA",
        "a\u0301na",
        "CON",
        "nul.txt",
        "..",
        "x" * 90 + ".y",
        "\ud800",
    ):
        taken.append(free_name(name, taken))
    assert taken == [
        "Ana", "ana (2)", "ÁNA", "a\u0301na (2)", "_CON", "_nul.txt", "_", "x" * 60, "_ (2)",
    ]  # fmt: skip
