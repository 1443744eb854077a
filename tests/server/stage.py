"""A match under test: helpers that seat teams and change phases, and physics with a script."""

import functools
import hashlib
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_robots.library import FolderGait, find_robot, sample_gait_files
from lacoc_server.match.entry import Entry, weigh_in
from lacoc_server.match.match import Beat, Match
from lacoc_server.match.physics import Fault, MakePhysics
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode, unpack_states
from lacoc_shared.gait.tables import Level, Posture
from lacoc_shared.inputs import Decide, Input, JoinSeat, KeySeat, ReadySeat
from lacoc_shared.messages import MARKER_STATES, Event, Frame, Outcome, Scene, SentFile
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import RESTART_KEY, Phase
from lacoc_shared.words import Phrase

LEFT, RIGHT = 0, 1
A, B = Level.POSTURE, Level.LOCOMOTION
X = RESTART_KEY
STAND, TURN_LEFT, FORWARD, TURN_RIGHT = range(4)
"""Keys of level B in the sample gait: 0, 1, 2 and 3."""
QUICK = {"match": {"countdown_s": 0.02}}
"""Settings with a countdown of one beat, for tests that are not about the countdown."""


def setup(arena: str, overrides: Mapping[str, Any] | None = None) -> Setup:
    ground = arenas.load(arena, overrides)
    return Setup(
        match_id="m", court="main", match=1, arena=arena, settings=ground.settings, limits={}
    )


def join(
    seat: int,
    team: str | None = None,
    robot: str = "hexapod",
    robot_file: bytes | None = None,
    token_hash: str = "",
) -> JoinSeat:
    """Return a team's join with the files of a sample robot, or with `robot_file` for its robot."""
    (name, data), gait = _files(robot)
    return JoinSeat(
        seat,
        team or ("Ants", "Bees")[seat],
        SentFile(name, robot_file or data),
        *gait,
        token_hash=token_hash,
    )


@functools.cache
def _files(robot: str) -> tuple[tuple[str, bytes], FolderGait]:
    return find_robot(robot), sample_gait_files(robot)


def entry(robot: str = "hexapod") -> Entry:
    was = join(0, robot=robot)
    return weigh_in(was.robot, was.postures, was.locomotion)


def decide(decision: d.Decision, reason: Phrase | str = "agreed", by: str = "Kubota") -> Decide:
    return Decide(by, reason, decision)


@dataclass
class Script:
    """What scripted physics does, by tick: the first is 1, and `begin` starts the count again."""

    poses: dict[int, dict[int, tuple[float, float]]] = field(default_factory=dict)
    """Tick -> seat -> x, y [m]; a robot stays there until a later tick or a restart moves it."""
    touches: dict[int, dict[int, tuple[int, ...]]] = field(default_factory=dict)
    """Tick -> seat -> indices of touched markers; in all other ticks nothing is touched."""
    faults: dict[int, Fault] = field(default_factory=dict)
    """Tick -> the fault that happens in it, once."""


class ScriptedPhysics:
    """Physics in which robots are where a script puts them.

    As a match expects of physics, a fault changes nothing, and the digest is a hash chained over
    the poses of all ticks.
    """

    scene = Scene(bodies=(), geoms=())

    def __init__(self, arena: Arena, entries: Sequence[Entry], script: Script) -> None:
        self.scene_hash = hashlib.blake2b(
            repr([entry.robot.name for entry in entries]).encode(), digest_size=8
        ).digest()
        self.model_hash = self.scene_hash.hex()
        self.digest = bytes(8)
        self.steps = 0
        self.ticks = 0
        self._script = script
        self._places = [arena.game.starts[seat][0][:2] for seat in range(len(entries))]
        self._angles: list[Posture] = [entry.robot.start_posture for entry in entries]

    def begin(self) -> None:
        """Restart the count of ticks: the next tick is 1, the first of PLAYING."""
        self.ticks = 0

    def place(self, seat: int, place: Place) -> None:
        self._places[seat] = place[:2]

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        if (fault := self._script.faults.pop(self.ticks + 1, None)) is not None:
            return fault
        self.steps += 1
        self.ticks += 1
        for seat, at in self._script.poses.get(self.ticks, {}).items():
            self._places[seat] = at
        self._angles = list(angles)
        self.digest = hashlib.blake2b(self.poses(), key=self.digest, digest_size=8).digest()
        return None

    def save(self) -> bytes:
        kept = (self.steps, self.ticks, self._places, self._angles)
        return self.digest + msgspec.msgpack.encode(kept)

    def load(self, saved: bytes) -> None:
        self.digest = saved[:8]
        kind = tuple[int, int, list[tuple[float, float]], list[Posture]]
        kept = msgspec.msgpack.decode(saved[8:], type=kind)
        self.steps, self.ticks, self._places, self._angles = kept

    def poses(self) -> bytes:
        return b"".join(
            struct.pack(f"<{7 + len(angles)}f", x_m, y_m, 0.07, 1.0, 0.0, 0.0, 0.0, *angles)
            for (x_m, y_m), angles in zip(self._places, self._angles, strict=True)
        )

    def touched(self) -> Sequence[tuple[int, ...]]:
        now = self._script.touches.get(self.ticks, {})
        return [tuple(now.get(seat, ())) for seat in range(len(self._places))]


class Stage:
    """A match under test, and all its beats so far."""

    def __init__(
        self,
        arena: str = "othello",
        overrides: Mapping[str, Any] | None = None,
        make_physics: MakePhysics | None = None,
        script: Script | None = None,
    ) -> None:
        self.script = script or Script()
        self.scripted: list[ScriptedPhysics] = []
        self.match = Match(setup(arena, overrides), make_physics or self._make)
        self.beats: list[Beat] = []

    @classmethod
    def real(cls, arena: str = "othello", overrides: Mapping[str, Any] | None = None) -> "Stage":
        """Return a stage with MuJoCo instead of scripted physics."""
        return cls(arena, overrides, World)

    def _make(self, arena: Arena, entries: Sequence[Entry]) -> ScriptedPhysics:
        self.scripted.append(ScriptedPhysics(arena, entries, self.script))
        return self.scripted[-1]

    @property
    def physics(self) -> ScriptedPhysics:
        return self.scripted[-1]

    @property
    def frame(self) -> Frame:
        return self.beats[-1].frame

    @property
    def phase(self) -> Phase:
        return self.match.phase

    @property
    def events(self) -> list[Event]:
        return [event for beat in self.beats for event in beat.events]

    @property
    def scores(self) -> tuple[int, ...]:
        return tuple(seat.score for seat in self.frame.seats)

    @property
    def board(self) -> dict[str, str]:
        """Return the state of each marker that is not neutral, by name."""
        markers = self.match.game.markers
        states = unpack_states(self.frame.markers, len(markers))
        return {
            m.name: MARKER_STATES[state] for m, state in zip(markers, states, strict=True) if state
        }

    def beat(self, *inputs: Input) -> Beat:
        self.beats.append(self.match.beat(inputs))
        return self.beats[-1]

    def send(self, item: Input) -> Outcome:
        """Run one beat with one input; return the input's outcome."""
        return self.beat(item).outcomes[0]

    def decide(self, decision: d.Decision, reason: str = "agreed") -> Any:
        return self.send(decide(decision, reason))

    def run(self, beats: int) -> None:
        for _ in range(beats):
            self.beat()

    def until(self, phase: Phase, at_most: int = 10_000) -> None:
        for _ in range(at_most):
            if self.phase is phase:
                return
            self.beat()
        raise AssertionError(f"no {phase.name}, still {self.phase.name}")

    def numbers(self, *kinds: str) -> list[int]:
        """Return the numbers of all events of the given kinds."""
        return [event.number for event in self.events if event.kind in kinds]

    # Lead the match to a phase.

    def to_ready(self, *joins: JoinSeat) -> "Stage":
        seats = range(len(self.match.seats))
        self.beat(*(joins or [join(seat) for seat in seats]))
        self.beat(*(ReadySeat(seat, True) for seat in seats))
        assert self.phase is Phase.READY
        return self

    def to_playing(self, *joins: JoinSeat) -> "Stage":
        """Lead the match to the last beat before PLAYING, so that the next beat has tick 1.

        A match that starts without a referee stays in READY. Its countdown, if any, begins in the
        next beat.
        """
        self.to_ready(*joins)
        if self.match.rules.start == "referee":
            self.beat(decide(d.Start()))
        while self.phase is Phase.COUNTDOWN and self.match.countdown_beats > 1:
            self.beat()
        if self.scripted:
            self.physics.begin()
            self.let_move()
        return self

    def let_move(self) -> None:
        """Let what a script does to robots count, as if keys had moved them (rules 4)."""
        for seat in self.match.seats:
            seat.idle = False

    def to(self, phase: Phase) -> "Stage":
        """Lead a new match to a phase; PLAYING and all later phases come after 3 ticks of play."""
        match phase:
            case Phase.LOBBY:
                self.beat(join(LEFT), join(RIGHT))
            case Phase.READY:
                self.to_ready()
            case Phase.COUNTDOWN:
                self.to_ready()
                self.beat(decide(d.Start()))
            case Phase.PLAYING:
                self.to_playing()
                self.run(3)
            case Phase.HALTED:
                self.to(Phase.PLAYING)
                self.beat(decide(d.Halt()))
            case Phase.FINISHED:
                self.to(Phase.PLAYING)
                self.beat(decide(d.Clock(-3600.0)))
            case Phase.OFFICIAL:
                self.to(Phase.FINISHED)
                self.beat(decide(d.Official()))
            case Phase.VOID:
                self.to(Phase.PLAYING)
                self.beat(decide(d.Abort()))
        assert self.phase is phase, self.phase
        return self


def key(seat: int, digit: int, seq: int = 1, level: int = B) -> KeySeat:
    return KeySeat(seat, seq, int(level), digit)


def seen(stage: Stage) -> tuple[bytes, ...]:
    """Return all that clients see of a match, encoded: frame, sheet, result and legal decisions.

    The number of the beat is left out.
    """
    frame = stage.frame
    result = stage.match.result()
    return (
        encode(Frame(frame.match, 0, *(getattr(frame, f) for f in frame.__struct_fields__[2:]))),
        encode(stage.match.sheet()),
        encode(type(result)(**{**_fields(result), "beats": 0})),
        encode(stage.match.legality()),
    )


def _fields(struct: Any) -> dict[str, Any]:
    return {name: getattr(struct, name) for name in struct.__struct_fields__}


def after(event: Event) -> str:
    """Return the name of the phase that begins with an event of kind "phase"."""
    return str(event.data["after"])
