"""Tests of the health verdict: its measurements, its advice, and its place in the record."""

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
import pytest
from stage import LEFT, QUICK, RIGHT, Script, Stage, X, decide, join, key, setup
from typer.testing import CliRunner

from lacoc_arenas import arena as arenas
from lacoc_server.court.health import MatchHealth, advice
from lacoc_server.doors.inbox import Door
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_server.match.match import Match
from lacoc_server.match.physics import Fault
from lacoc_server.simulate import player, simulate
from lacoc_server.world.world import World
from lacoc_shared.contest.health_limits import HealthLimits
from lacoc_shared.decisions import Declare, Halt, Resume, Start
from lacoc_shared.inputs import Advice, HeardSeat, Input, LeaveSeat, ReadySeat, SilentSeat
from lacoc_shared.messages import HealthVerdict, LinkVerdict
from lacoc_shared.record.commands import app
from lacoc_shared.record.export.tables import result_json
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, faults, say

GOOD = HealthVerdict(
    played_beats=1000,
    real_time_factor=1.0,
    slow_beats=0,
    worst_late_ms=3.0,
    faults=0,
    resumptions=0,
    seats=(LinkVerdict(id="left", silences=0, silent_s=0, expected=200, arrived=198, refused={}),),
    advice=(),
)


@dataclass
class Held:
    """A match, by default one beat before PLAYING, with its `MatchHealth` and a made-up clock."""

    stage: Stage = field(default_factory=lambda: Stage("othello", QUICK).to_playing())
    speed: float = 1.0
    before: HealthVerdict | None = None
    now_s: float = 100.0
    heard: int = 0
    refused: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self.refused["flood"] = 7  # refused before this match: must not be in its verdict
        self.health = MatchHealth(
            self.stage.match, HealthLimits(), self.doors(), speed=self.speed, before=self.before
        )

    def doors(self) -> tuple[Door, Door]:
        return Door(self.heard, self.refused), Door(self.heard, {})

    def beat(self, *inputs: Input, took_s: float = 0.02, late_s: float = 0.0) -> None:
        self.now_s += took_s
        self.health.begin(self.now_s, late_s, self.doors())
        self.health.measure(inputs, self.stage.beat(*inputs))

    def seconds(self, count: int, repeats: int = 10) -> None:
        for beat in range(50 * count):
            self.heard += repeats * (beat % 50 + 1) // 50 - repeats * (beat % 50) // 50
            self.beat()

    @property
    def verdict(self) -> HealthVerdict:
        return self.health.verdict()

    @property
    def left(self) -> LinkVerdict:
        return self.verdict.seats[LEFT]


def codes(verdict: HealthVerdict) -> list[str]:
    return [why.code for why in verdict.advice if isinstance(why, Phrase)]


def lost(verdict: HealthVerdict) -> list[object]:
    """Return the seats whose commands got lost, according to the advice."""
    reasons = [why for why in verdict.advice if isinstance(why, Phrase)]
    return [why.values["seat"] for why in reasons if why.code == "health.lost-commands"]


def test_a_match_that_is_held_well() -> None:
    """If no beat is late and every repeated command arrives, no rematch is advised."""
    held = Held()
    held.seconds(4)
    verdict = held.verdict
    assert (verdict.real_time_factor, verdict.slow_beats, verdict.faults) == (1.0, 0, 0)
    assert verdict.played_beats == 199  # the first beat of PLAYING is not counted
    assert held.left.expected == 30
    assert held.left.arrived == 30
    assert verdict.advice == ()


def test_how_far_a_robot_walks_and_by_which_keys() -> None:
    """The verdict has the way of each robot without its sways and restarts, and its keys."""
    x_m, y_m = arenas.load("othello").game.starts[LEFT][0][:2]
    way = {tick: {LEFT: (x_m, y_m + 0.004 * tick)} for tick in range(1, 101)}
    way |= {tick: {LEFT: (x_m, y_m + 0.4 + 0.004 * (tick % 2))} for tick in range(101, 150)}
    way[150] = {LEFT: (x_m, y_m)}
    held = Held(Stage("othello", QUICK, script=Script(poses=way)).to_playing())
    held.beat()
    held.beat(key(LEFT, 2))
    held.beat(key(LEFT, 2, seq=2), key(RIGHT, 9))
    held.beat(key(LEFT, X, seq=3))
    held.seconds(3)
    left, right = held.verdict.seats
    assert left.walked_m == pytest.approx(0.4, abs=0.02)
    assert left.keys == {"B2": 2, "x": 1}
    assert (right.walked_m, right.keys) == (0.0, {})
    later = Held(before=held.verdict)
    later.beat()
    later.beat(key(LEFT, 1))
    assert later.left.keys == {"B2": 2, "x": 1, "B1": 1}
    assert later.left.walked_m == left.walked_m


def test_only_the_time_that_is_played_counts() -> None:
    """The verdict leaves out beats outside PLAYING, and the first after each entry to PLAYING."""
    held = Held(Stage("othello", QUICK))
    held.beat(took_s=3.0, late_s=2.98)
    held.stage.to_playing()
    held.beat()
    held.beat(late_s=0.003)
    held.stage.decide(Halt())
    held.beat(took_s=5.0, late_s=4.98)
    held.stage.decide(Resume())
    held.beat(took_s=2.0)
    held.beat()
    held.beat()
    verdict = held.verdict
    assert held.stage.match.phase is Phase.PLAYING
    assert verdict.real_time_factor == 1.0
    assert (verdict.slow_beats, verdict.worst_late_ms) == (0, 3.0)


@pytest.mark.parametrize("speed", [1.0, 4.0])
def test_slow_beats_and_the_real_time_factor(speed: float) -> None:
    """If one beat in 50 takes five times its length, the real-time factor is 1/1.08.

    The speed of the court does not change that.
    """
    held = Held(speed=speed)
    held.beat(took_s=0.02 / speed)
    for beat in range(250):
        slow = beat % 50 == 0
        held.beat(took_s=(0.1 if slow else 0.02) / speed, late_s=0.08 if slow else 0.001)
    verdict = held.verdict
    assert verdict.real_time_factor == pytest.approx(1 / 1.08, abs=1e-4)
    assert (verdict.slow_beats, verdict.worst_late_ms) == (5, 80.0)
    assert codes(verdict)[:2] == ["health.real-time", "health.slow-beats"]


def test_repeats_of_a_lossy_link() -> None:
    """A seat that is heard 6 times a second instead of 10 has lost commands.

    Commands that come more often later do not make up for those that were lost.
    """
    held = Held()
    held.seconds(1)
    held.seconds(10, repeats=6)
    assert held.left.arrived / held.left.expected == pytest.approx(0.6, abs=0.05)
    assert "left" in lost(held.verdict)
    missed = held.left.expected - held.left.arrived
    held.seconds(10, repeats=60)  # a bot sends as often as this
    assert held.left.expected - held.left.arrived <= missed + 4


@pytest.mark.parametrize("speed", [0.5, 5.0])
def test_repeats_at_a_court_of_another_speed(speed: float) -> None:
    """Controllers repeat ten times in a second of wall time, so at any speed nothing is lost.

    If fewer commands come in a second of wall time, they have got lost.
    """
    held, lossy = Held(speed=speed), Held(speed=speed)
    for beat in range(500):
        before, after = (round(10 * at / (50 * speed)) for at in (beat, beat + 1))
        held.heard += after - before
        lossy.heard = held.heard // 2
        held.beat(took_s=0.02 / speed)
        lossy.beat(took_s=0.02 / speed)
    seconds = int(499 / (50 * speed))
    assert held.left.expected == 10 * seconds
    assert held.verdict.advice == ()
    assert lost(lossy.verdict) == ["left", "right"]


def test_repeats_that_come_a_little_early_or_late() -> None:
    """If seconds with 9 and with 11 repeats alternate, at most one repeat counts as lost."""
    held = Held()
    for repeats in (10, 9, 11, 9, 11, 9, 11, 10):
        held.seconds(1, repeats)
    assert held.left.expected - held.left.arrived <= 1


def test_repeats_of_a_match_that_is_often_halted() -> None:
    """No repeat counts as lost because of a halt: only whole seconds of play are measured."""
    held = Held()
    for _ in range(6):
        for beat in range(60):
            held.heard += beat % 5 == 4
            held.beat()
        held.beat(decide(Halt()))
        held.beat(decide(Resume()))
    assert held.left.expected == held.left.arrived == 60


def test_who_left_is_missed_by_nobody() -> None:
    """A team that has left the match does not count as having a lossy link."""
    held = Held()
    held.seconds(2)
    expected = held.left.expected
    held.beat(LeaveSeat(LEFT))
    held.seconds(10, repeats=0)
    assert held.left.expected <= expected + 10
    assert "left" not in lost(held.verdict)
    assert "right" in lost(held.verdict)


def test_silences() -> None:
    """The verdict says how often and how long each seat was silent in PLAYING.

    After more than 5 s of silence of a seat, a rematch is advised.
    """
    held = Held()
    for _ in range(2):
        held.beat(SilentSeat(LEFT))
        held.seconds(3)
        held.beat(HeardSeat(LEFT))
    assert held.left.silences == 2
    assert held.left.silent_s == pytest.approx(2 * 3.02)
    assert held.verdict.seats[RIGHT].silences == 0
    assert "health.silent-seat" in codes(held.verdict)


def test_refusals_of_this_match() -> None:
    """The verdict counts what the court's doors and the rules have refused during the match."""
    held = Held()
    held.beat()
    held.refused.update({"flood": 3, "bad-seal": 1})
    held.beat(key(LEFT, 9))
    assert held.left.refused == {"flood": 3, "bad-seal": 1, "no-such-key": 1}


def test_faults_of_physics() -> None:
    """A single fault of physics is counted, and is enough to advise a rematch."""
    script = Script(faults={3: Fault(LEFT, say("fault.velocity"))})
    held = Held(Stage("othello", QUICK, script=script).to_playing())
    held.seconds(1)
    assert held.verdict.faults == 1
    assert held.verdict.advice == (say("health.faults", times=1, most=0),)


def test_a_killed_court_goes_on_counting() -> None:
    """A restarted court adds its measurements to those from before the kill."""
    first = Held()
    first.beat()
    first.beat(SilentSeat(LEFT))
    first.beat(HeardSeat(LEFT), key(RIGHT, 9))
    first.beat(took_s=0.42, late_s=0.4)
    first.seconds(2)
    second = Held(before=first.verdict)
    assert second.verdict == first.verdict
    second.seconds(2)
    after = second.verdict
    assert after.played_beats == first.verdict.played_beats + 99
    assert after.worst_late_ms == 400.0
    assert first.verdict.real_time_factor < after.real_time_factor < 1
    assert after.seats[LEFT].silences == 1
    assert after.seats[RIGHT].refused == {"no-such-key": 1}


LINK = GOOD.seats[0]


@pytest.mark.parametrize(
    ("held", "why"),
    [
        ({"real_time_factor": 0.97}, say("health.real-time", factor=0.97, least=0.98)),
        ({"slow_beats": 11}, say("health.slow-beats", percent=1.1, most=1)),
        ({"worst_late_ms": 201.0}, say("health.late-beat", late_ms=201, most_ms=200)),
        ({"faults": 1}, say("health.faults", times=1, most=0)),
        ({"resumptions": 3}, say("health.restarts", times=3, most=2)),
        (
            {"seats": (msgspec.structs.replace(LINK, silent_s=5.02),)},
            say("health.silent-seat", seat="left", seconds=5.02, most_s=5),
        ),
        (
            {"seats": (msgspec.structs.replace(LINK, arrived=100),)},
            say("health.lost-commands", seat="left", percent=50, least=70),
        ),
    ],
    ids=["factor", "slow", "worst", "faults", "resumptions", "silent", "repeats"],
)
def test_each_limit_has_its_phrase(held: dict[str, object], why: Phrase) -> None:
    """For each limit of the contest that is exceeded, the advice has one phrase."""
    verdict = msgspec.structs.replace(GOOD, **held)
    assert list(advice(GOOD, HealthLimits())) == []
    assert list(advice(verdict, HealthLimits())) == [why]
    assert not faults(why)


def test_advice_is_an_event_of_the_match() -> None:
    """Advice is an input of the match and becomes an event, so a replay has the same log."""
    stage = Stage("othello", QUICK).to(Phase.FINISHED)
    stage.beat(Advice(("a", "b")))
    stage.beat(Advice(()))
    assert [event.said for event in stage.events[-2:]] == [
        say("event.advised", reasons=["a", "b"]),
        say("event.not-advised"),
    ]
    assert {event.kind for event in stage.events[-2:]} == {"advice"}


@pytest.mark.slow
def test_the_record_has_the_verdict_and_verifies(tmp_path: Path) -> None:
    """A record keeps the health verdict beside the result, and still verifies bit for bit.

    `replay info` and the exported result show the verdict.
    """
    match = Match(setup("othello", QUICK), World)
    health = MatchHealth(match, HealthLimits(), [Door(0, {})] * 2)
    journal = Journal(match, tmp_path, measure=health.measure)
    assert journal.writer is not None
    seated = [(join(LEFT), join(RIGHT)), (ReadySeat(LEFT, True), ReadySeat(RIGHT, True))]
    played = [(decide(Start()),), *[()] * 120, (decide(Halt()),), (decide(Declare("left")),)]
    for beat, inputs in enumerate([*seated, *played]):
        late_s = 0.3 if beat == 60 else 0.0
        health.begin(0.02 * beat + late_s, late_s, [Door(0, {})] * 2)
        journal.beat(inputs)
    journal.close()
    path = journal.writer.path
    record = Record.read(path)
    assert record.result is not None
    assert record.health is not None
    assert record.health.worst_late_ms == 300.0
    *_, verdict = verify(record)
    assert isinstance(verdict, Verdict)
    assert verdict.kind is VerdictKind.SAME
    said = CliRunner().invoke(app, ["info", str(path)]).output
    assert "Rematch advised: the worst beat began 300 ms late" in said
    exported = json.loads(result_json(record))
    assert exported["health"]["worst_late_ms"] == 300.0
    assert exported["computed"] == "draw"


@pytest.mark.slow
def test_a_simulated_match_has_none(tmp_path: Path) -> None:
    """A simulated match has no health verdict, because it has neither a wall clock nor links."""
    made = setup("othello", {"match": {"duration_s": 0.5}})
    ground = arenas.load("othello")
    simulate(made, [player(ground, seat, "straight") for seat in (0, 1)], tmp_path)
    record = Record.read(tmp_path / "m.mcap")
    assert record.health is None
    assert json.loads(result_json(record))["health"] is None
    assert "without a court" in CliRunner().invoke(app, ["info", str(tmp_path / "m.mcap")]).output
