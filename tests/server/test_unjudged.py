"""Tests of matches without a referee (start = "ready"), which go on by themselves (rules 7)."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace
from stage import LEFT, RIGHT, Script, ScriptedPhysics, decide, join, key, setup
from verdicts import verdict

from lacoc_arenas import arena as arenas
from lacoc_server.court import court as court_module
from lacoc_server.court.court import Court, CourtSettings
from lacoc_server.doors.inbox import Door
from lacoc_server.doors.network import Arrival
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.recovery import unfinished
from lacoc_server.journal.verdict import VerdictKind
from lacoc_server.match.match import Match
from lacoc_server.match.physics import Fault
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.inputs import (
    THE_COURT,
    HeardSeat,
    Input,
    JoinSeat,
    LeaveSeat,
    ReadySeat,
    SilentSeat,
)
from lacoc_shared.messages import Done, Event, Outcome, SeatHealth
from lacoc_shared.messages.office import open_match
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.matches import MatchName
from lacoc_shared.record.reader import Record
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import NOBODY, Phase
from lacoc_shared.words import say

P = Phase
LONG = 200
"""Four seconds, in beats."""
TROUBLE = say("record.disk-trouble", file="m.mcap", why="Input/output error")

HASH = new_token_hash("a token")


class Quiet:
    """Stands in for a court's network: it delivers what the test puts into `said`."""

    locators = ("tcp/127.0.0.1:1",)
    input_delay_ms = newest_event = 0
    sheet_hash = b""
    dropped: dict[str, int] = {}  # noqa: RUF012 - nobody changes it

    def __init__(self, seats: int) -> None:
        self.sessions = [0] * seats
        self.said: list[Input] = []
        self.events: list[Event] = []
        self.outcomes: list[Outcome] = []

    def poll(self, now_s: float, match: int, beat: int, silent: Sequence[bool]) -> list[Arrival]:
        said, self.said = self.said, []
        for item in said:
            if isinstance(item, JoinSeat):
                self.sessions[item.seat] = 7
        return [Arrival(item, self.outcomes.append) for item in said]

    def doors(self) -> tuple[Door, ...]:
        return (Door(0, {}),) * len(self.sessions)

    def seat_health(self, now_s: float) -> tuple[SeatHealth, ...]:
        return tuple(
            SeatHealth(id="s", joined=True, session=one, heard_ms=None, commands_hz=0.0, refused={})
            for one in self.sessions
        )

    def publish_event(self, event: Event) -> None:
        self.events.append(event)

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *_: None


class Held:
    """A court that the test runs beat by beat."""

    def __init__(
        self, arena: str, folder: Path | None = None, overrides: dict[str, Any] | None = None
    ) -> None:
        self.ground, self.folder = arenas.load(arena, overrides), folder
        self.now_s = 0.0
        self.open()

    def open(self) -> None:
        left = unfinished(self.folder, "main", self.ground) if self.folder else None
        self.network = Quiet(len(self.ground.seats))
        tokens = {seat.id: [HASH] for seat in self.ground.seats}
        settings = CourtSettings("main", self.ground, {}, self.folder, assigned=open_match(tokens))
        self.court = Court(settings, self.network, left)  # type: ignore[arg-type]

    def kill(self) -> None:
        """Leave the record as a kill does: write nothing more, and release the file."""
        self.court._journal.leave()

    @property
    def match(self) -> Match:
        return self.court._journal.match

    def beat(self, *said: Input) -> Match:
        self.network.said += said
        self.now_s += 0.02
        self.court._health.begin(self.now_s, 0.0, self.network.doors())
        self.court._beat(self.now_s)
        return self.match

    def run(self, beats: int) -> Match:
        for _ in range(beats):
            self.beat()
        return self.match

    def begin(self) -> None:
        for seat in range(len(self.ground.seats)):
            self.beat(join(seat, token_hash=HASH))
            self.beat(ReadySeat(seat, True))
        self.run(3)
        assert self.match.phase is P.PLAYING

    @property
    def decided(self) -> list[str]:
        return [e.data["decision"] for e in self.network.events if e.kind == "decision"]


@pytest.mark.parametrize("arena", ["practice", "othello"])
def test_a_killed_match_goes_on_when_a_contestant_is_back(tmp_path: Path, arena: str) -> None:
    """Rules 7: a killed match without a referee waits in HALTED until a contestant is back."""
    held = Held(arena, tmp_path, {"match": {"start": "ready", "countdown_s": 0.02}})
    held.begin()
    held.kill()
    held.open()
    assert held.run(LONG).phase is P.HALTED, "nobody may find a match already running"
    ticks = held.match.ticks
    held.beat(join(LEFT, token_hash=HASH))
    assert held.run(30).phase is P.PLAYING
    assert held.match.ticks > ticks
    held.beat(key(LEFT, 2, seq=9))
    assert held.network.outcomes[-1] == Done()
    assert held.decided == ["halt", "resume"]
    held.kill()
    assert verdict(Record.read(sorted(tmp_path.iterdir()))).kind is VerdictKind.SAME


def test_a_killed_match_with_a_referee_waits_for_the_referee(tmp_path: Path) -> None:
    """A killed match with a referee stays HALTED, even when both contestants are back."""
    held = Held("othello", tmp_path, {"match": {"countdown_s": 0.02}})
    held.beat(join(LEFT, token_hash=HASH), join(RIGHT, token_hash=HASH))
    held.beat(ReadySeat(LEFT, True), ReadySeat(RIGHT, True))
    held.beat(decide(d.Start()))
    held.run(3)
    held.kill()
    held.open()
    held.beat(join(LEFT, token_hash=HASH), join(RIGHT, token_hash=HASH))
    assert held.run(LONG).phase is P.HALTED
    held.kill()


def test_a_halted_match_waits_in_silence_and_a_long_silence_ends_it() -> None:
    """Rules 7: after a halt of the court a match waits while its seat is silent, and then goes on.

    After `unattended_s` of silence the match ends, and the next one opens.
    """
    held = Held("practice", None, {"match": {"unattended_s": 10.0}})
    held.begin()
    held.beat(SilentSeat(LEFT))
    held.beat(decide(d.Halt(), by=THE_COURT))
    assert held.run(LONG).phase is P.HALTED
    held.beat(HeardSeat(LEFT))
    assert held.run(30).phase is P.PLAYING
    held.beat(SilentSeat(LEFT))
    assert held.run(520).setup.match == 2
    assert (held.match.phase, held.match.seats[LEFT].team) == (P.LOBBY, "Ants")
    reasons = [e.said for e in held.network.events if e.data.get("after") == "FINISHED"]
    minutes = held.match.rules.unattended_s / 60
    assert reasons == [say("event.finished", why=say("over.nobody-heard", minutes=minutes))]


def test_the_result_of_two_teams_is_shown_for_10_s() -> None:
    """After a match of two teams without a referee, the court shows the result for 10 s."""
    rules = {"start": "ready", "countdown_s": 0.02, "duration_s": 0.2}
    held = Held("othello", None, {"match": rules})
    held.begin()
    held.run(20)
    assert held.match.phase is P.OFFICIAL
    held.run(450)
    assert (held.match.phase, held.match.setup.match) == (P.OFFICIAL, 1)
    assert held.run(50).setup.match == 2


def test_leaving_a_halted_match_ends_it() -> None:
    """Rules 7: if everybody leaves a halted match, it ends and the next opens with empty seats."""
    held = Held("practice")
    held.begin()
    held.beat(decide(d.Halt()))
    held.beat(LeaveSeat(LEFT))
    assert held.run(5).setup.match == 2
    assert held.match.seats[LEFT].join is None


@pytest.mark.parametrize("seat", [LEFT, NOBODY])
def test_after_a_fault_the_robot_is_put_back_and_play_goes_on(
    monkeypatch: pytest.MonkeyPatch, seat: int
) -> None:
    """Rules 7: after a fault of physics, the robot is put back at its start and play goes on."""
    script = Script(faults={10: Fault(seat, say("fault.velocity"))})
    monkeypatch.setattr(
        court_module, "World", lambda arena, entries: ScriptedPhysics(arena, entries, script)
    )
    held = Held("practice")
    held.begin()
    held.run(LONG)
    assert (held.match.phase, held.match.fault) == (P.PLAYING, None)
    assert held.decided == ["restart", "resume"]
    assert held.match.ticks > LONG - 30


def test_a_fault_that_comes_back_at_once_fills_no_log(monkeypatch: pytest.MonkeyPatch) -> None:
    """If physics stops at once after each resume, the court resumes only twice a second."""
    held = Held("practice")
    held.begin()
    monkeypatch.setattr(World, "step", lambda self, angles: Fault(LEFT, say("fault.contacts")))
    held.run(10 * 50)
    assert held.decided.count("resume") in (19, 20)
    held.beat(LeaveSeat(LEFT))
    assert held.run(5).setup.match == 2


def test_after_a_full_disk_play_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a time with a full disk, the court halts the match and resumes it by itself."""
    held = Held("practice", tmp_path)
    held.begin()

    def full(writer: RecordWriter) -> None:
        raise UserError("The record can't be written: No space left on device.")

    with monkeypatch.context() as patch:
        patch.setattr(RecordWriter, "flush", full)
        beats = held.match.beats
        held.run(LONG)
        assert held.match.beats == beats + 1
    held.run(60)
    assert held.match.phase is P.PLAYING
    assert held.decided == ["halt", "resume"]
    held.kill()


def test_a_disk_that_reports_errors_halts_the_match_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the disk reports an error at `fsync`, the court halts the match once and resumes it."""
    held = Held("practice", tmp_path)
    held.begin()
    monkeypatch.setattr(RecordWriter, "sync_trouble", TROUBLE)
    held.run(LONG)
    assert held.match.phase is P.PLAYING
    assert held.decided == ["halt", "resume"]
    held.kill()


def test_a_match_of_an_older_court_goes_on(tmp_path: Path) -> None:
    """Its setup says nothing of seats; the match after it is one that the court assigned itself."""
    ground = arenas.load("practice")
    name = MatchName.new(tmp_path, "main", 1)
    old = replace(setup("practice"), match_id=str(name), settings=ground.settings)
    journal = Journal(Match(old, World), tmp_path)
    journal.beat([join(0, token_hash=HASH)])
    journal.beat([ReadySeat(0, True)])
    journal.leave()
    held = Held("practice", tmp_path)
    assert held.match.assigned is None
    assert held.match.setup.match_id == str(name)
    held.beat(decide(d.Abort()))
    held.beat(decide(d.Next()))
    held.run(2)
    assert held.match.setup.match == 2
    assert held.match.assigned is not None
    assert held.match.assigned.is_alone
    assert held.match.seats[0].team == "Ants"
