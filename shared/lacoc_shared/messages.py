"""The messages of a court, as they travel (docs/protocol.md has them as tables).

These are not the court's own types: they are the contract with every other program.
All are frozen structs, encoded as msgpack by `codec`. `Frame` and `Command` are
arrays on the wire, because they travel 50 and 10 times a second; all others are maps.
"""

from typing import Any

import msgspec

from lacoc_shared.decisions import Decision
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase

PROTOCOL = 2
"""Version of this contract; both ends must have the same."""

MARKER_STATES = ("neutral", "left", "right", "down")
"""The states of a marker; a frame carries the index in two bits."""

ROOT_FLOATS = 7
"""Numbers of a robot's root in `Frame.poses`: x, y, z, then its quaternion w, x, y, z."""


class SeatFrame(msgspec.Struct, frozen=True, array_like=True):
    """A seat at a beat."""

    flags: int
    """`SeatFlag` bits."""
    score: int
    level: int
    """`Level` of the standing command."""
    key: int
    """Digit of the standing command."""
    posture: int
    """Index of the posture that the robot moves to, in the key's sequence."""
    locked_ticks: int
    """Ticks of clock until keys are taken again after a restart or a freeze; 0: at once."""
    applied_seq: int
    """Sequence number of the seat's newest command that took effect; 0: none yet."""
    applied_beat: int
    """Beat at which it took effect."""
    refused_seq: int
    """Sequence number of the seat's newest command that was refused; 0: none."""
    refused_why: int
    """`No` of that refusal."""


class Frame(msgspec.Struct, frozen=True, array_like=True):
    """The whole match at a beat; self-contained, so that a late comer needs only one."""

    match: int
    """Number of the match at this court, from 1."""
    beat: int
    """Beat of the match, from 0; one every 20 ms of a court that keeps up."""
    phase: int
    """`Phase`."""
    countdown_beats: int
    """Beats until play begins, in COUNTDOWN; else 0."""
    clock_ticks: int
    """Ticks of the clock that have been used; may be negative after a referee's correction."""
    seats: tuple[SeatFrame, ...]
    """One for each seat of the arena, in its order."""
    markers: bytes
    """Two bits a marker, the first in the lowest bits of the first byte."""
    poses: bytes
    """Little-endian float32 for each robot: x, y, z [m, world], quaternion w, x, y, z (body to
    world), then its joint angles [rad] by joint id. Empty before READY."""
    scene: bytes
    """First 8 bytes of the scene's hash: another scene needs another picture."""
    digest: bytes
    """8 bytes chaining the whole state, beat after beat (the proof of a replay)."""


class Command(msgspec.Struct, frozen=True, array_like=True):
    """A key of a seat, repeated 10 times a second with the same sequence number (rules 3)."""

    session: int
    """Number that the court gave with the join."""
    seq: int
    """Counts the seat's commands from 1; 0: no key yet, only a sign of life."""
    level: int
    key: int
    """0-9, or `RESTART_KEY` for [x]."""
    match: int
    """Match of the newest frame that the controller had when it sent this; 0: none yet."""
    seen: int
    """Beat of that frame: how long the link takes is the court's to count."""
    mac: bytes
    """8 bytes of keyed BLAKE2 over everything above and the seat's key expression."""


class SentFile(msgspec.Struct, frozen=True):
    """A file as a contestant's program sends it."""

    name: str
    data: bytes


class Join(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for a seat."""

    protocol: int
    token: str
    name: str
    """The team's name, 1-24 characters."""
    robot: SentFile | None = None
    """A robot file; None: the contest's robot."""
    postures: SentFile | None = None
    """A Loco-data file."""
    locomotion: SentFile | None = None
    """A LocoTra-data file. Neither file: the sample gait of the contest's robot."""


class Joined(msgspec.Struct, frozen=True, kw_only=True):
    """The seat is yours."""

    session: int
    secret: bytes
    """Key for the MACs of this session; 16 bytes."""
    last_seq: int
    """The seat's sequence numbers go on after this one."""
    notes: tuple[Phrase, ...] = ()
    """What the contestant should know (`note.*`)."""


class SeatRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Say ready, take it back, or leave; proven by the session's secret, not the token."""

    session: int
    seq: int
    """Counts the session's requests from 1."""
    ready: bool = True
    mac: bytes


class Done(msgspec.Struct, frozen=True):
    """It was done."""

    said: Phrase | None = None
    """What the one who asked should know (`note.*`)."""


class Refusal(msgspec.Struct, frozen=True):
    """It was not done; the reply's error."""

    why: Phrase
    """A whole sentence; its code says which refusal it is."""
    mistakes: tuple[Mistake, ...] = ()
    again: bool = False
    """The same request may be taken later: nothing is wrong with it, the court can't now."""


class Enter(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Show a referee's token; nothing is decided."""

    token: str


class DecisionRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A referee decides."""

    token: str
    by: str
    """Who decides, for the record."""
    reason: Phrase | str = ""
    """A text that the referee wrote, or a phrase of `reason.*`."""
    decision: Decision


class DecisionReply(msgspec.Struct, frozen=True, kw_only=True):
    """What a decision did; sent when it is on disk."""

    beat: int
    event: int | None = None
    """Number of its event; None for a dry run."""
    said: Phrase
    """What was done (`decision.*`)."""
    scores: tuple[int, ...]
    changes: tuple[Phrase, ...] = ()
    """For take-back: the events that vanish or appear (`change.*`)."""


Outcome = Done | DecisionReply | Refusal
"""What became of an input."""


class Event(msgspec.Struct, frozen=True, kw_only=True):
    """Something happened; numbered, and never lost."""

    number: int
    """Counts the events of a match from 1."""
    match: int
    beat: int
    clock_ticks: int
    kind: str
    """phase, join, leave, ready, silent, heard, restart, decision, fault, result, advice, or a
    game's own: flip, capture, strike."""
    said: Phrase
    """A whole sentence."""
    seat: int = -1
    """Index of the seat it is about; -1: none."""
    data: dict[str, Any] = {}
    """Particulars by name, for programs."""


class SheetSeat(msgspec.Struct, frozen=True, kw_only=True):
    """Who sits in a seat, with what."""

    id: str
    """The arena's name for the seat: "left"."""
    team: str = ""
    """"" while nobody has joined."""
    colour: str
    """#rrggbb"""
    pattern: str
    """Told apart without colours: plain, stripes, dots."""
    robot: str = ""
    legs: tuple[str, ...] = ()
    """Leg labels in leg order; joints are 3 * legs."""
    keys: tuple[tuple[int, ...], tuple[int, ...]] = ((), ())
    """Digits that do something at level A and at level B."""
    postures: tuple[int, ...] = ()
    """Number of postures of each key of level B."""


class MarkerInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A disc, corner or flag of the board."""

    name: str
    kind: str
    x_m: float
    y_m: float
    radius_m: float
    points: int = 0


class Sheet(msgspec.Struct, frozen=True, kw_only=True):
    """Who plays what with which rules: everything that a frame leaves out."""

    protocol: int
    version: str
    """Version of the court's software."""
    court: str
    match: int
    match_id: str = ""
    """Names the match's record, and its lines in logs."""
    arena: str
    title: str
    duration_s: float
    """0: without end (practice)."""
    levels: tuple[int, ...]
    """`Level`s that are open."""
    settings: dict[str, Any]
    """The arena file as played."""
    seats: tuple[SheetSeat, ...]
    markers: tuple[MarkerInfo, ...]
    scene: bytes
    """First 8 bytes of the scene's hash."""


class SceneBody(msgspec.Struct, frozen=True, kw_only=True):
    """A body in the tree; `Frame.poses` moves the roots, its joints the others."""

    name: str
    parent: int
    """Index of the parent; -1 for the world."""
    pos: tuple[float, float, float]
    """In the parent's frame [m]."""
    quat: tuple[float, float, float, float]
    """w, x, y, z."""
    seat: int = -1
    """For a robot's root body: its seat, and the pose is the frame's."""
    joint: int = -1
    """Index in the frame's joint angles of that seat (joint id); -1: no joint."""
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """Hinge axis in this body's frame; the hinge goes through the body's origin."""


class SceneGeom(msgspec.Struct, frozen=True, kw_only=True):
    """A shape on a body."""

    body: int
    type: str
    """plane, sphere, capsule, cylinder, box."""
    size: tuple[float, float, float]
    """MuJoCo's: half sizes [m]."""
    pos: tuple[float, float, float]
    quat: tuple[float, float, float, float]
    rgba: tuple[float, float, float, float]
    marker: int = -1
    """Index of the marker this shape belongs to; -1: none."""
    state: int = -1
    """Shown while the marker is in this state."""
    seat: int = -1
    """Takes this seat's colour and pattern."""


class Scene(msgspec.Struct, frozen=True, kw_only=True):
    """The drawable model, made from the compiled one."""

    bodies: tuple[SceneBody, ...]
    geoms: tuple[SceneGeom, ...]


class SeatHealth(msgspec.Struct, frozen=True, kw_only=True):
    """A seat's link, as the court sees it."""

    id: str
    joined: bool
    session: int = 0
    """Number of the session that holds the seat (a controller sees whether it is its own); 0: none,
    as after a restart of the court."""
    heard_ms: float | None
    """Since the last command; None: nobody."""
    commands_hz: float
    refused: dict[str, int]
    """How often, by the name of `count.*`: "bad-seal"."""
    round_trip_p50_ms: float | None = None
    """From a frame to the beat that has the seat's answer to it, by the court's clock: the median
    of the last 10 s; None: not known."""
    round_trip_p95_ms: float | None = None
    """The longest but 5 %."""
    late: int = 0
    """Commands that came too late for the common delay."""


class LinkVerdict(msgspec.Struct, frozen=True, kw_only=True):
    """How a seat's link was in a match."""

    id: str
    silences: int
    """How often it fell silent in PLAYING."""
    silent_s: float
    """Time of PLAYING in which it was silent [s]."""
    expected: int
    """Repeats of its command that were due in PLAYING: ten a second."""
    arrived: int
    """How many of them came."""
    refused: dict[str, int]
    """What was refused in this match, by the name of `count.*`: at the court's doors and by the
    rules."""


class HealthVerdict(msgspec.Struct, frozen=True, kw_only=True):
    """How well a match was held, so far: measured on the wall clock, and no part of the match."""

    played_beats: int
    """Beats of PLAYING; what follows is of these."""
    real_time_factor: float
    """Their 20 ms each per wall time that they took; 1 is real time."""
    slow_beats: int
    """How many began more than 20 ms late."""
    worst_late_ms: float
    """The latest beginning of one."""
    faults: int
    """How often physics stopped."""
    resumptions: int
    """How often the match went on after its court was killed."""
    seats: tuple[LinkVerdict, ...]
    advice: tuple[Phrase | str, ...]
    """Why a replay is advised: what is beyond the contest's limits (`health.*`; a text in a record
    of protocol 1). Empty: it is not advised."""


class Health(msgspec.Struct, frozen=True, kw_only=True):
    """How the court is; twice a second."""

    match: int
    beat: int
    real_time_factor: float
    """Beats of the last seconds per 20 ms of wall time; 1 is real time."""
    slow_beats: int
    """Beats that started more than 20 ms late."""
    worst_late_ms: float
    seats: tuple[SeatHealth, ...]
    dropped: dict[str, int]
    """Messages that belong to no seat, by the name of `count.*`."""
    decisions: dict[str, Phrase | None]
    """Every decision: None if it is legal now, else why not (`why.*`)."""
    verdict: HealthVerdict | None = None
    """How well this match was held; None: that is not measured."""
    record_trouble: Phrase | None = None
    """What is wrong with the disk of the record: why the match does not go on, or what else that
    disk reports (`record.*`). None while all is well."""
    input_delay_ms: int = 0
    """From a frame to the effect of what was done upon it, the same for all seats; 0: the contest
    does not make links equal."""
    events: int = 0
    """Number of the newest event: whoever has fewer asks for them."""
    sheet: bytes = b""
    """8 bytes of BLAKE2 over the newest sheet: whoever has another asks for it."""
