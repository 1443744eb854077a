"""The messages of a court on the wire (docs/protocol.md has them as tables).

They are separate from the types that the court uses inside, because they are the contract with
every other program. All are frozen structs, encoded as msgpack by `codec`. `Frame`, `SeatFrame`,
`Command` and `TriedKey` are arrays on the wire, because many of them are sent; all others are maps.
"""

from typing import Annotated, Any

import msgspec

from lacoc_shared.decisions import Decision
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase

PROTOCOL = 2
"""Version of this contract; both ends must have the same version."""

MARKER_STATES = ("neutral", "left", "right", "down")
"""The states of a marker. A frame has the index of a state, in two bits."""

OUTLOOK_MOST_S = 30.0
"""Longest outlook that a referee may ask for [s]."""

TRY_OUT_TICKS = 3000
"""Longest try-out before a match [ticks]: a minute."""
TRY_OUT_ASKED_TICKS = 150
"""Longest part of a try-out in one reply [ticks]."""
TRY_OUT_KEYS = 64
"""Most keys of one try-out."""

ROOT_FLOATS = 7
"""How many numbers of `Frame.poses` describe a robot's root: x, y, z, then its quaternion w, x, y,
z."""


class SeatFrame(msgspec.Struct, frozen=True, array_like=True):
    """The state of a seat at a beat."""

    flags: int
    """Bits of `SeatFlag`."""
    score: int
    level: int
    """`Level` of the current command, as a number."""
    key: int
    """Digit of the current command."""
    posture: int
    """Index of the posture that the robot moves to, within the key's sequence."""
    locked_ticks: int
    """Clock ticks until keys are accepted again after a restart or a freeze; 0: accepted now."""
    applied_seq: int
    """Sequence number of the seat's newest command that took effect; 0: none has yet."""
    applied_beat: int
    """Beat at which that command took effect."""
    refused_seq: int
    """Sequence number of the seat's newest command that was refused; 0: none was."""
    refused_why: int
    """`No` code of that refusal."""


class Frame(msgspec.Struct, frozen=True, array_like=True):
    """The whole match at a beat.

    With sheet and scene, one frame is enough to show the match, also to somebody who comes late.
    """

    match: int
    """Number of the match at this court, from 1."""
    beat: int
    """Beat of the match, from 0; one every 20 ms unless the court is late."""
    phase: int
    """`Phase` of the match, as a number."""
    countdown_beats: int
    """Beats until play begins, in COUNTDOWN; else 0."""
    clock_ticks: int
    """Ticks of the clock that have been used; after a referee's correction the number may be
    negative."""
    seats: tuple[SeatFrame, ...]
    """One entry for each seat of the arena, in the arena's order."""
    markers: bytes
    """The state of each marker in two bits; the first marker is in the lowest bits of the first
    byte."""
    poses: bytes
    """Little-endian float32 for each robot: x, y, z [m, world], quaternion w, x, y, z (body to
    world), then its joint angles [rad] by joint id. Empty before READY."""
    scene: bytes
    """Hash of the scene, 8 bytes; if it changes, clients must fetch the scene again."""
    digest: bytes
    """Hash chain over the states of physics after all ticks so far, 8 bytes; a replay compares
    it."""


class Command(msgspec.Struct, frozen=True, array_like=True):
    """A seat's newest key; the controller sends it 10 times a second, with the same number."""

    session: int
    """Number that the court gave in its reply to the join."""
    seq: int
    """Sequence number of the command, from 1 for each seat in each match; 0: no key was pressed
    yet, the message is only a sign of life."""
    level: int
    key: int
    """0-9, or `RESTART_KEY` for [x]."""
    match: int
    """Match of the newest frame that the player had seen; 0: none yet."""
    seen: int
    """Beat of that frame; from it the court computes the link's delay."""
    mac: bytes
    """8 bytes of keyed BLAKE2 over everything above and the seat's key expression."""


class SentFile(msgspec.Struct, frozen=True):
    """A file that a contestant's program sends: its name and its bytes."""

    name: str
    data: bytes


class Join(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request of a controller to take a seat."""

    protocol: int
    token: str
    name: str
    """The team's name, 1-24 characters."""
    robot: SentFile | None = None
    """A robot file; None: the contest's robot."""
    postures: SentFile | None = None
    """A Loco-data file."""
    locomotion: SentFile | None = None
    """A LocoTra-data file. If a join has no file at all: the files of the seat stay if the
    team of this name has it; otherwise the contest's robot and this robot's sample are used."""


class Joined(msgspec.Struct, frozen=True, kw_only=True):
    """The reply to a controller that has taken a seat."""

    session: int
    secret: bytes
    """Key for the seals of this session, 16 bytes."""
    last_seq: int
    """Highest sequence number that the seat has used so far; its next command has this number plus
    1."""
    notes: tuple[Phrase, ...] = ()
    """Remarks for the contestant (`note.*`)."""


class SeatRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request to be ready, or no longer ready, or to leave. The session's secret seals it."""

    session: int
    seq: int
    """Sequence number of the request, from 1 in each session."""
    ready: bool = True
    mac: bytes

    @property
    def sealed(self) -> tuple[int, ...]:
        """The numbers of this request that its seal proves, besides `session` and `seq`."""
        return (int(self.ready),)


class TriedKey(msgspec.Struct, frozen=True, array_like=True, forbid_unknown_fields=True):
    """A key that is pressed in a try-out."""

    tick: Annotated[int, msgspec.Meta(ge=0, lt=TRY_OUT_TICKS)]
    """Tick of the try-out at which the key is pressed, from 0."""
    level: Annotated[int, msgspec.Meta(ge=0, le=1)]
    """`Level` of the key, as a number."""
    key: Annotated[int, msgspec.Meta(ge=0, le=9)]


class TryOutRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A player's question in the lobby: how would the robot walk, alone, with some keys?

    It is sealed like a `SeatRequest`. If it overtakes a `SeatRequest` on the way, the court still
    accepts the `SeatRequest`.
    """

    session: int
    seq: int
    drawn: bool
    """Whether the reply must contain the scene."""
    first: Annotated[int, msgspec.Meta(ge=0, lt=TRY_OUT_TICKS)]
    """Tick of the first picture that is asked for."""
    until: Annotated[int, msgspec.Meta(ge=0, le=TRY_OUT_TICKS)]
    """No picture is later than this tick; it may be `TRY_OUT_ASKED_TICKS` after `first` at most."""
    keys: Annotated[tuple[TriedKey, ...], msgspec.Meta(max_length=TRY_OUT_KEYS)]
    """All keys since the try-out began, in the order of their ticks; at most one in a tick."""
    mac: bytes

    @property
    def sealed(self) -> tuple[int, ...]:
        """The numbers of this request that its seal proves, besides `session` and `seq`."""
        pressed = [number for key in self.keys for number in (key.tick, key.level, key.key)]
        return (int(self.drawn), self.first, self.until, *pressed)


class TryOutReply(msgspec.Struct, frozen=True, kw_only=True):
    """How a robot walked alone in a try-out, on the field of its match, as pictures."""

    scene: bytes
    """Hash of the scene with the field and only this robot, 8 bytes."""
    drawn: "Scene | None"
    """This scene, if it was asked for; else None."""
    first: int
    """Tick of the first picture."""
    every: int
    """Ticks from one picture to the next."""
    poses: tuple[bytes, ...]
    """The pose of this robot in each picture, in the form of `Frame.poses`. There are fewer
    pictures than were asked for if physics stopped."""


class Done(msgspec.Struct, frozen=True):
    """The reply to a request that the court has carried out."""

    said: Phrase | None = None
    """A remark for the sender (`note.*`)."""


class Refusal(msgspec.Struct, frozen=True):
    """The court's reply to a request that it refused; sent as an error."""

    why: Phrase
    """Why the request was refused, as a whole sentence; its code says which kind of refusal it
    is."""
    mistakes: tuple[Mistake, ...] = ()
    again: bool = False
    """Whether to send the request again later: it is right, but the court can't accept it now."""


class Enter(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A request that only shows a referee's token, and makes no decision."""

    token: str


class DecisionRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A referee's request to make a decision."""

    token: str
    by: str
    """Name of the referee, for the record."""
    reason: Phrase | str = ""
    """A text that the referee wrote, or a phrase of `reason.*`."""
    decision: Decision


class DecisionReply(msgspec.Struct, frozen=True, kw_only=True):
    """The court's reply to a decision: its effect. It is sent when the decision is on disk."""

    beat: int
    event: int | None = None
    """Number of the event of this decision; None after a dry run."""
    said: Phrase
    """What was done (`decision.*`)."""
    scores: tuple[int, ...]
    changes: tuple[Phrase, ...] = ()
    """After a take-back: the events that vanish or appear (`change.*`)."""


Outcome = Done | DecisionReply | Refusal
"""The result of an input."""


class Event(msgspec.Struct, frozen=True, kw_only=True):
    """Something that happened in a match; events are numbered, so that a lost one is noticed."""

    number: int
    """Number of the event in its match, from 1."""
    match: int
    beat: int
    clock_ticks: int
    kind: str
    """phase, join, leave, ready, strayed, silent, heard, restart, decision, fault, result, advice,
    or a game's own: flip, capture, strike."""
    said: Phrase
    """What happened, as a whole sentence."""
    seat: int = -1
    """Index of the seat that the event is about; -1: none."""
    data: dict[str, Any] = {}
    """Details by name, for programs."""


class OutlookRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A referee's question during a halt: what would happen if play went on?"""

    token: str
    decision: Decision | None = None
    """A decision that would be made before play goes on; None: no decision."""
    seconds: Annotated[float, msgspec.Meta(gt=0, le=OUTLOOK_MOST_S)] = 10.0
    """How long play would go on [s]."""


class Outlook(msgspec.Struct, frozen=True, kw_only=True):
    """What would happen if play went on, without another key or decision."""

    beat: int
    """Beat of the match from which play would go on."""
    clock_ticks: int
    """Ticks of the clock when play would go on."""
    before: tuple[int, ...]
    """For each seat the score when play would go on, after the decision."""
    scores: tuple[int, ...]
    """For each seat the score at the end."""
    seconds: float
    """How long play would go on [s]: less than was asked for if the match ended."""
    phase: int
    """The phase at the end."""
    events: tuple[Event, ...]
    """The events that would happen, in order. In the match itself their numbers may belong to other
    events."""


class SheetSeat(msgspec.Struct, frozen=True, kw_only=True):
    """A seat in the sheet of a match: its team, look, robot and keys."""

    id: str
    """Id of the seat in the arena, such as "left"."""
    team: str = ""
    """Name of the team. "": nobody has joined, and the office has not assigned a team."""
    colour: str
    """Colour of the seat, as "#rrggbb"."""
    pattern: str
    """Pattern by which people who can't see the colours tell the seats apart: plain, stripes or
    dots."""
    robot: str = ""
    legs: tuple[str, ...] = ()
    """Labels of the legs in leg order. The robot has three joints for each leg."""
    keys: tuple[tuple[int, ...], tuple[int, ...]] = ((), ())
    """Digits of the keys that do something, at level A and at level B."""
    postures: tuple[int, ...] = ()
    """Number of postures of each key of level B."""


class MarkerInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A disc, corner or flag of the board: its name and place."""

    name: str
    kind: str
    x_m: float
    y_m: float
    radius_m: float
    points: int = 0


class Sheet(msgspec.Struct, frozen=True, kw_only=True):
    """Teams, robots, board and rules of a match: everything that a frame leaves out."""

    protocol: int
    version: str
    """Version of the court's software."""
    court: str
    match: int
    match_id: str = ""
    """Id of the match. Its record is named by it, and logs name the match by it."""
    arena: str
    title: str
    duration_s: float
    """Length of the match [s]; 0: it has no time limit (practice)."""
    levels: tuple[int, ...]
    """The `Level`s that are open, as numbers."""
    settings: dict[str, Any]
    """The arena file as it is played, with the overrides of the contest."""
    seats: tuple[SheetSeat, ...]
    markers: tuple[MarkerInfo, ...]
    scene: bytes
    """Hash of the scene, 8 bytes."""
    call: str = ""
    """Id of the call with which the office gave this match to the court; "": no call, or the court
    has no office."""
    fixture: Phrase | None = None
    """Name of the match in its contest, or that the court waits for the office (`fixture.*`); None:
    the court has no office."""
    rule: Phrase | None = None
    """What the game is about and how one scores (`rule.*`). None: the arena does not tell this, or
    the sheet is of an earlier version."""


class SceneBody(msgspec.Struct, frozen=True, kw_only=True):
    """A body of the scene. `Frame.poses` has the pose of a robot's root body, and joint angles."""

    name: str
    parent: int
    """Index of the parent body; -1: the world."""
    pos: tuple[float, float, float]
    """Position in the parent's frame [m]."""
    quat: tuple[float, float, float, float]
    """Orientation in the parent's frame: w, x, y, z."""
    seat: int = -1
    """Seat of a robot's root body, whose pose is in the frame; -1: another body."""
    joint: int = -1
    """Joint id of this body's hinge: its index in the frame's joint angles of that seat; -1: the
    body has no hinge."""
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """Hinge axis in this body's frame; the hinge goes through the body's origin."""


class SceneGeom(msgspec.Struct, frozen=True, kw_only=True):
    """A shape of a body of the scene."""

    body: int
    type: str
    """plane, sphere, capsule, cylinder, box or ellipsoid."""
    size: tuple[float, float, float]
    """Sizes as MuJoCo has them: radii and half lengths [m]."""
    pos: tuple[float, float, float]
    quat: tuple[float, float, float, float]
    rgba: tuple[float, float, float, float]
    marker: int = -1
    """Index of the marker that this shape belongs to; -1: none."""
    state: int = -1
    """The shape is shown while the marker is in this state; -1: it belongs to no marker."""
    seat: int = -1
    """Seat whose colour and pattern the shape has; -1: the shape has a colour of its own."""


class Scene(msgspec.Struct, frozen=True, kw_only=True):
    """The bodies and shapes of a match for drawing, made from the compiled MuJoCo model."""

    bodies: tuple[SceneBody, ...]
    geoms: tuple[SceneGeom, ...]


class Gains(msgspec.Struct, frozen=True, kw_only=True):
    """Which points a robot could gain next, from the place where it is now."""

    said: Phrase | None = None
    """For the robot's player: where the robot comes from and what it can do next (`gains.*`)."""
    points: dict[str, int] = {}
    """Points that each marker would bring if the robot went there now, by the marker's name."""


class SeatHealth(msgspec.Struct, frozen=True, kw_only=True):
    """How well a seat's link works now, measured by the court."""

    id: str
    joined: bool
    session: int = 0
    """Number of the session that holds the seat, by which a controller sees whether it still holds
    it; 0: nobody does, as after a restart of the court."""
    heard_ms: float | None
    """Time since the seat's join or its last valid command [ms]; None: there was neither."""
    commands_hz: float
    refused: dict[str, int]
    """Number of refused messages by reason, a name of `count.*` such as "bad-seal"; it begins again
    at 0 when another team takes the seat."""
    round_trip_p50_ms: float | None = None
    """Time from a frame to the beat that takes the seat's answer to it, by the court's clock: the
    median of the last 10 s [ms]; None: not known."""
    round_trip_p95_ms: float | None = None
    """The 95th percentile of the same times [ms]."""
    late: int = 0
    """Number of commands that came too late for the common delay."""


class LinkVerdict(msgspec.Struct, frozen=True, kw_only=True):
    """How well a seat's link has worked during a match."""

    id: str
    silences: int
    """How often the seat fell silent in PLAYING."""
    silent_s: float
    """Time of PLAYING during which the seat was silent [s]."""
    expected: int
    """Repeats of the seat's command that were due in PLAYING: ten in a second of wall time."""
    arrived: int
    """Number of these repeats that arrived."""
    refused: dict[str, int]
    """Number of refusals in this match by reason, a name of `count.*`: at the court's doors and by
    the rules."""
    walked_m: float = 0.0
    """How far the robot has walked in PLAYING [m]; sways of less than 10 mm do not count."""
    keys: dict[str, int] = {}
    """How often each key took effect, by the key: level and digit ("B2"), or "x"."""


class HealthVerdict(msgspec.Struct, frozen=True, kw_only=True):
    """How well a match has run so far: measured by the wall clock, and not part of the match."""

    played_beats: int
    """Number of beats of PLAYING; the next three fields are about these beats."""
    real_time_factor: float
    """Duration of these beats at 20 ms each, divided by the wall time that they took; 1 is real
    time."""
    slow_beats: int
    """Beats that began more than 20 ms late."""
    worst_late_ms: float
    """Largest delay with which a beat began [ms]."""
    faults: int
    """Number of times that physics stopped."""
    resumptions: int
    """Number of times that the match continued after its court was killed."""
    seats: tuple[LinkVerdict, ...]
    advice: tuple[Phrase | str, ...]
    """Why the match should be played again: the limits of the contest that were broken (`health.*`;
    a text in a record of protocol 1). Empty: it need not be played again.
    """


class Health(msgspec.Struct, frozen=True, kw_only=True):
    """How a court and its links work now; sent twice a second, and whenever `gains` changes.

    `gains` says what each robot could gain next.
    """

    match: int
    beat: int
    real_time_factor: float
    """Duration of the beats of the last seconds at 20 ms each, divided by their wall time; 1 is
    real time."""
    slow_beats: int
    """Number of beats since the court's start that began more than 20 ms late."""
    worst_late_ms: float
    seats: tuple[SeatHealth, ...]
    dropped: dict[str, int]
    """Number of messages that belong to no seat and were refused since the court's start, by
    reason: a name of `count.*`."""
    decisions: dict[str, Phrase | None]
    """Every decision by name: None if it is legal now, else why not (`why.*`)."""
    verdict: HealthVerdict | None = None
    """How well this match has run; None: not measured."""
    record_trouble: Phrase | None = None
    """A problem with the disk of the record (`record.*`): it may keep the match from going on.
    None: there is no problem."""
    input_delay_ms: int = 0
    """Common delay: from a frame to the effect of a key that answers it, the same for all seats
    [ms]. 0: the contest does not make links equal."""
    events: int = 0
    """Number of the newest event: a client that has fewer asks for the rest."""
    sheet: bytes = b""
    """Hash of the newest sheet: 8 bytes of BLAKE2. A client with another sheet requests this
    one."""
    gains: tuple[Gains, ...] = ()
    """For each seat what its robot would gain next; empty before READY and after play."""
    moves: tuple[tuple[str, ...], ...] = ()
    """For each seat, what its keys of level B do: a name of `move.*` for each key from 0 on, or ""
    if it is not known yet."""
