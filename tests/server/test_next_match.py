"""Tests of what a court's next match takes from the last one: seats, files and silences."""

import errno
import itertools
import os
import secrets
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from running import until

from lacoc_arenas import arena as arenas
from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_server.court.court import Court, CourtSettings
from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import Inbox
from lacoc_server.doors.network import CourtNetwork
from lacoc_server.match.entry import JoinCheck
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.decisions import Abort, Halt, Next, Set, Start
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import Input, KeySeat
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import SeatFrame, SentFile, Sheet
from lacoc_shared.messages.office import open_match
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import Phase, SeatFlag
from lacoc_shared.words import say

pytestmark = pytest.mark.slow

TOKENS = {"left": "the token of left", "right": "the token of right"}
WHISTLE = "the token of the referee"


class Room(NamedTuple):
    """A running court, a session for each seat, and a referee."""

    sessions: tuple[Session, Session]
    referee: RefereeClient

    def controller(self, seat: int, robot: str = "hexapod") -> Controller:
        postures, locomotion = sample_gait_files(robot)
        return self.with_files(
            seat,
            robot=SentFile(*find_robot(robot)),
            postures=postures,
            locomotion=locomotion,
        )

    def with_files(self, seat: int, **files: SentFile | None) -> Controller:
        name = list(TOKENS)[seat]
        return Controller(self.sessions[seat], "main", name, TOKENS[name], f"Team {name}", **files)

    def decide(self, decision: Start | Abort | Next) -> None:
        self.referee.decide(decision, "a test", "Kubota")


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Room]:
    """Run a court in a thread, so that a test can fake a full disk; give the court's clients."""
    arena = arenas.load("othello", {"match": {"countdown_s": 0.02}})
    files = (SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    join_check = JoinCheck(*files, Limits(), arena.match.open_levels)
    opened = open_match({seat: [new_token_hash(token)] for seat, token in TOKENS.items()})
    inbox = Inbox(KeySpace("main"), list(TOKENS), join_check, secrets.token_bytes)
    desk = DecisionDesk([new_token_hash(WHISTLE)])
    over = threading.Event()
    with (
        CourtNetwork(KeySpace("main"), ["tcp/127.0.0.1:0"], inbox, desk) as network,
        ExitStack() as stack,
    ):
        settings = CourtSettings("main", arena, {}, tmp_path / "recordings", assigned=opened)
        court = Court(settings, network)
        thread = threading.Thread(target=court.run, args=(over.is_set,))
        thread.start()
        stack.callback(thread.join)
        stack.callback(over.set)
        left, right = (stack.enter_context(open_client([network.locators[0]])) for _ in range(2))
        yield Room((left, right), RefereeClient(left, "main", WHISTLE))


def sheet(controller: Controller, match: int) -> Sheet:
    """Return the sheet of a match; wait until it has arrived."""
    until([controller], lambda: controller.view.sheet.match == match)
    return controller.view.sheet


def seat_of(controller: Controller, seat: int) -> SeatFrame:
    assert controller.view.frame is not None
    return controller.view.frame.seats[seat]


def phase_is(controller: Controller, phase: Phase) -> bool:
    return controller.view.frame is not None and controller.view.frame.phase == phase


def playing(room: Room) -> list[Controller]:
    """Bring a match into PLAYING, and return the controllers of both seats."""
    players = [room.controller(seat) for seat in range(2)]
    for player in players:
        player.join()
        player.ready()
    until(players, lambda: phase_is(players[0], Phase.READY))
    room.decide(Start())
    until(players, lambda: phase_is(players[0], Phase.PLAYING))
    return players


def test_the_next_match_takes_the_files_that_were_sent_in_this_one(room: Room) -> None:
    """Files that are sent during a match are used in the next one, and not before."""
    playing(room)
    left = room.controller(0, "quadruped")
    assert left.join() == (say("note.files-next-match"),)
    assert sheet(left, 1).seats[0].robot == "Hexapod"
    room.decide(Abort())
    room.decide(Next())
    robots = [seat.robot for seat in sheet(left, 2).seats]
    assert robots == ["Quadruped", "Hexapod"]


def test_a_team_that_comes_back_without_files_keeps_its_own(room: Room) -> None:
    """A team that comes back without files keeps the files that it sent last."""
    playing(room)
    room.controller(0, "quadruped").join()
    kept, _ = room.with_files(0).join()
    assert kept.code == "note.files-kept"
    room.decide(Abort())
    room.decide(Next())
    again = room.with_files(0)
    assert [note.code for note in again.join()] == ["note.files-kept"]
    assert [seat.robot for seat in sheet(again, 2).seats] == ["Quadruped", "Hexapod"]


def test_a_team_that_joins_after_the_end_has_a_seat_in_the_next_match(room: Room) -> None:
    """A team that joins after a match has ended has a seat in the next one."""
    left, right = room.controller(0), room.controller(1)
    left.join()
    room.decide(Abort())
    assert right.join() == (say("note.next-match"),)
    room.decide(Next())
    assert [seat.team for seat in sheet(right, 2).seats] == ["Team left", "Team right"]
    right.ready()


def test_a_silent_seat_stays_silent_in_the_next_match(room: Room) -> None:
    """A seat that is silent when a match ends is silent in the next one, until it is heard."""
    left, right = room.controller(0), room.controller(1)
    left.join()
    right.join()  # and is not heard from then on
    until([left], lambda: seat_of(left, 1).flags & SeatFlag.SILENT)
    room.decide(Abort())
    room.decide(Next())
    until([left], lambda: left.view.frame is not None and left.view.frame.match == 2)
    until([left], lambda: seat_of(left, 1).flags & SeatFlag.SILENT)
    until([left, right], lambda: not seat_of(left, 1).flags & SeatFlag.SILENT)
    assert not seat_of(left, 0).flags & SeatFlag.SILENT


def test_a_contestant_who_comes_back_is_heard(room: Room) -> None:
    """A contestant who leaves in play and joins again is no longer silent."""
    players = playing(room)
    players[0].leave()
    until(players[1:], lambda: seat_of(players[1], 0).flags & SeatFlag.SILENT)
    players[0].join()
    until(players, lambda: not seat_of(players[1], 0).flags & SeatFlag.SILENT)


def test_a_robot_stands_when_a_key_arrives_with_the_leave(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If a contestant leaves in play, keys of the same beat do not let the robot walk on."""
    players = playing(room)
    commands, seqs = Inbox.commands, itertools.count(100)

    def with_keys(self: Inbox, *arrived: Any) -> list[Input]:
        held = self.health(0.0)[0].session
        keys = [KeySeat(0, next(seqs), Level.LOCOMOTION, 2)] if held else []
        return [*commands(self, *arrived), *keys]

    monkeypatch.setattr(Inbox, "commands", with_keys)
    until(players, lambda: seat_of(players[1], 0).key == 2)
    players[0].leave()
    until(players[1:], lambda: seat_of(players[1], 0).flags & SeatFlag.SILENT)
    assert seat_of(players[1], 0).key == 0


def test_the_disk_fills_in_the_beat_of_next(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    """If the disk is full in the beat of `next`, the next match opens when there is room."""
    players = [room.controller(seat) for seat in range(2)]
    for player in players:
        player.join()
    room.decide(Abort())
    append, filled, room_again = RecordWriter._append, threading.Event(), threading.Event()

    def until_next(self: RecordWriter, data: bytes | bytearray) -> int:
        if b"\xa4next" in bytes(data):
            filled.set()
        if filled.is_set() and not room_again.is_set():
            self._write_error = os.strerror(errno.ENOSPC)
            return 0
        return append(self, data)

    monkeypatch.setattr(RecordWriter, "_append", until_next)
    deciding = threading.Thread(target=room.decide, args=(Next(),))
    deciding.start()
    left = players[0]
    until(players, lambda: left.view.health is not None and left.view.health.record_trouble)
    assert filled.is_set()
    assert sheet(left, 1).match == 1
    room_again.set()
    deciding.join(10)
    assert not deciding.is_alive()
    assert [seat.team for seat in sheet(left, 2).seats] == ["Team left", "Team right"]


def test_health_says_at_once_what_robots_would_gain(room: Room) -> None:
    """Health names what each robot would gain while robots stand, and comes when that changes."""
    left = room.controller(0)
    left.join()
    until([left], lambda: left.view.health is not None)
    assert left.view.health is not None
    assert left.view.health.gains == ()
    players = playing(room)
    view = players[0].view
    until(players, lambda: view.health is not None and len(view.health.gains) == 2)
    assert view.health is not None
    first = view.health.gains[0].said
    assert first == say("gains.inside", marker="c0r2")
    room.referee.decide(Halt(), "a test", "Kubota")
    room.referee.decide(Set(marker="c0r2", state="right"), "a test", "Kubota")
    until(players, lambda: view.health is not None and view.health.gains[0].said != first)
    assert view.health.gains[0].said == say("gains.their-disc", marker="c0r2")
