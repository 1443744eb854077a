"""The messages of a studio on the wire (docs/protocol.md has them as tables).

A studio lets robots walk, and searches for better gaits, for everybody who sends it a request. It
remembers nothing between requests: each request has all the files that it needs.
"""

from dataclasses import dataclass
from typing import Any

import msgspec

from lacoc_shared.keyspace import check_name
from lacoc_shared.messages import Scene, SentFile, Sheet
from lacoc_shared.words import Phrase

STUDIO_MAX_BYTES = 131_072
"""Largest request that a studio reads [bytes]."""
TRIAL_REPLY_MAX_BYTES = 2 << 20
"""Largest reply of a studio [bytes]; a trial of 60 s with eight legs has 1.1 MB."""
EVERY_STUDIO = "lacoc/*/live/studio"
"""Key expression for the announcements of all studios that can be reached (Zenoh's liveliness)."""


@dataclass(frozen=True)
class StudioKeys:
    """The key expressions of one studio.

    Raises:
        UserError: if the studio's name is not made of a-z, 0-9 and hyphens.
    """

    studio: str

    def __post_init__(self) -> None:
        check_name(self.studio)

    @property
    def root(self) -> str:
        """Prefix of all key expressions of the studio."""
        return f"lacoc/{self.studio}/studio"

    @property
    def alive(self) -> str:
        """Key expression that the studio announces while it is connected (Zenoh's liveliness)."""
        return f"lacoc/{self.studio}/live/studio"

    def request(self, what: str) -> str:
        """Return the key expression of a request.

        Args:
            what: robot, trial, coach, map, variants or cancel; `*` for all.
        """
        return f"{self.root}/ask/{what}"

    def progress(self, job: str) -> str:
        """Return the key expression on which the studio sends the progress of a search."""
        return f"{self.root}/progress/{job}"


class GaitFiles(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The files of a request, in the format of those of a join: text, no workbooks."""

    robot: SentFile | None = None
    """None: the workshop's hexapod."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    """With neither file and no robot: the workshop's sample gait."""
    sequences: tuple[tuple[int, ...], ...] | None = None
    """For each key of level B the digits of its postures, if there is no locomotion file; None: the
    sequences of the sample's keys."""


class RobotRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask what a robot file describes."""

    protocol: int
    robot: SentFile | None = None


class LegShape(msgspec.Struct, frozen=True, kw_only=True):
    """A leg of a robot, so that a page can bend it (docs/robot-file.md)."""

    label: str
    """The leg's name in tables, such as "R,F"."""
    position_mm: tuple[float, float, float]
    """The root hinge in the body frame."""
    outward_deg: float
    """Direction of the leg at Root 0: 0 = right, 90 = forward, 180 = left."""
    lengths_mm: tuple[float, float, float]
    """L0, L1 and L2, from hinge to hinge; the last one to the foot."""
    range_deg: tuple[float, float]
    """Lowest and highest angle of each of the three joints."""


class RobotReply(msgspec.Struct, frozen=True, kw_only=True):
    """A robot: what a page needs to draw it, and to make the columns of its table."""

    name: str
    legs: tuple[str, ...]
    """Leg labels in leg order; each leg has three joints."""
    shapes: tuple[LegShape, ...]
    """The legs in leg order."""
    ranges_deg: tuple[tuple[float, float], ...]
    """Lowest and highest angle of each joint, by joint id."""
    start_deg: tuple[float, ...]
    """Angles in which the robot is put on the floor, by joint id."""
    start_z_m: float
    """Height of the body's origin above the floor in that posture."""
    facts: dict[str, Any]
    """Sizes, masses and speeds by name, with units in the names (docs/protocol.md). Where legs can
    differ, the value is a pair: the lowest and the highest."""
    limits: dict[str, tuple[float | None, float | None]]
    """Lowest and highest value that the rules allow, for facts of the same name."""
    sheet: Sheet
    """A sheet with the robot in its only seat, for drawing."""
    scene: Scene


class TrialRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for a trial of at most 60 s."""

    protocol: int
    files: GaitFiles
    keys: str = ""
    """Keys in the form of `lacoc trial --keys`; "": the key for forward."""
    seconds: float | None = None
    """How long the last key is pressed [s]; None: whole cycles."""


class CellPlace(msgspec.Struct, frozen=True, kw_only=True):
    """The place of a cell in a key's sequence."""

    posture: int
    """Index in the sequence."""
    joint: int
    """Joint id."""


class Sentence(msgspec.Struct, frozen=True, kw_only=True):
    """One sentence that explains a walk."""

    said: Phrase
    """The sentence; its code is `explain.*`."""
    cell: CellPlace | None = None
    """Cell that the sentence is about; None: it is about no cell."""
    leg: int = -1
    """Index of the leg that the sentence is about; -1: the whole robot."""


class TrialReply(msgspec.Struct, frozen=True, kw_only=True):
    """The measurements of a trial of `ticks` ticks; arrays are little-endian, tick by tick."""

    level: int
    key: int
    """Level and digit of the key that was measured."""
    figures: dict[str, Any]
    """Figures of the walk, by the names in docs/studio.md 2."""
    explained: tuple[Sentence, ...]
    notes: tuple[Phrase, ...] = ()
    """Remarks on the files, and for a reader of the figures."""
    fault: Phrase | None = None
    """Why physics stopped before the end; None: it did not."""
    ticks: int
    first: int
    end: int
    """The figures are for the ticks from `first` up to, but without, `end`."""
    starts: tuple[int, ...]
    """Ticks in which a cycle of the key's sequence begins."""
    posture: bytes
    """uint8 (ticks,): index of the target posture in the key's sequence."""
    down: bytes
    """uint8 (ticks,): bit i is set while the foot of leg i is down."""
    poses: bytes
    """float32 (ticks, 7 + joints): pose and joint angles, as in `Frame.poses`."""
    commanded_rad: bytes
    """float32 (ticks, joints): commanded joint angles, by joint id."""
    contact_w_m: bytes
    """float32 (ticks, legs, 2): where each shank touches the floor; 0 without contact."""
    centre_w_m: bytes
    """float32 (ticks, 2): centre of mass in the plane of the floor."""
    margin_m: bytes
    """float32 (ticks,): support margin; NaN while no foot is down."""
    slip_m_s: bytes
    """float32 (ticks, legs): speed of each shank along the floor where it touches."""
    tip_m: bytes
    """float32 (ticks, legs): height of each foot's lowest point above the floor."""
    digest: bytes
    """State hash after the last tick, as in the frames of a match."""


class CoachRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask which numbers of a key matter, and for better numbers."""

    protocol: int
    job: str
    """Name that the asker chooses for the search: a-z, 0-9 and hyphens. Its progress and a cancel
    have this name too."""
    files: GaitFiles
    key: int | None = None
    """Key of level B to change; None: the sample's key for the goal."""
    goal: str = "forward"
    """forward, right or left."""
    size: str | None = None
    """How much may change: cell, three or table; None: only say which numbers matter."""
    seconds: float = 30.0
    """How long to search [s], from 0 to 120. The time to rank the numbers before the search, and to
    undo changes after it, does not count."""
    seed: int = 0
    """Seed of the search's random numbers."""


class MapRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for a map of gaits: one for each speed and arousal that the table can reach."""

    protocol: int
    job: str
    """As in `CoachRequest`."""
    files: GaitFiles
    key: int | None = None
    """Key of level B; None: the one for forward."""
    seconds: float = 30.0
    """How long to search: from 0 to 120."""
    seed: int = 0


class VariantsRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for six gaits that look different, bred from one table or from two."""

    protocol: int
    job: str
    """As in `CoachRequest`."""
    files: GaitFiles
    key: int | None = None
    """Key of level B; None: the one for forward."""
    keep: tuple[tuple[int, ...], ...] = ()
    """`table` of one or two gaits to breed from; empty: from the table of `files`."""
    before: tuple[tuple[int, ...], ...] = ()
    """`table` of gaits that were shown before: new ones differ from them."""
    round: int = 0
    """How many rounds were before; later ones change less."""
    seed: int = 0


class CancelRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """End a search early: the reply is `Done`, and the search's own reply has the best so far.

    The reply to a search that still waits is a refusal.
    """

    protocol: int
    job: str


class Progress(msgspec.Struct, frozen=True, kw_only=True):
    """The progress of a search; a studio sends it several times a second."""

    stage: str
    """waiting (until earlier searches end), repair, matters, search, undo, map or variants."""
    done: float
    """Share of the stage, from 0 to 1."""
    trials: int
    score: float | None = None
    """Score of the best table so far."""
    filled: int | None = None
    """Cells of a map that have a gait, or variants that walk, so far."""


class Weight(msgspec.Struct, frozen=True, kw_only=True):
    """How a change of one number changes the score."""

    cell: CellPlace
    up: float
    """Change of the score when the number is 10 degrees larger."""
    down: float
    """Change of the score when the number is 10 degrees smaller."""


class CellChange(msgspec.Struct, frozen=True, kw_only=True):
    """A number that the coach changed."""

    cell: CellPlace
    from_deg: float
    to_deg: float


class RepairTold(msgspec.Struct, frozen=True, kw_only=True):
    """A mistake that the coach repaired before it searched."""

    said: Phrase
    """What was wrong; its code is `explain.*`."""
    cell: CellPlace
    """A cell that was wrong."""
    before: float
    after: float
    """The figure of the goal: forward speed [mm/s], or turning to the goal's side [deg/s]."""


class CoachReply(msgspec.Struct, frozen=True, kw_only=True):
    """The result of a search."""

    key: int
    """Key of level B that the search changed."""
    matters: tuple[Weight, ...]
    """All numbers of the key, those that matter most first."""
    changes: tuple[CellChange, ...]
    before: dict[str, Any]
    """Figures of the student's own gait, by the names in docs/studio.md 2."""
    after: dict[str, Any]
    """Figures of the best gait that was found."""
    repairs: tuple[RepairTold, ...] = ()
    """Mistakes that were repaired, in this order. Their changes are among `changes`."""
    worse: tuple[str, ...] = ()
    """Names of the shown figures that became worse (docs/studio.md 4)."""
    score_before: float
    score_after: float
    trials: int
    cancelled: bool = False


class GaitDifference(msgspec.Struct, frozen=True, kw_only=True):
    """A direction in which a gait looks different from the gait in the request."""

    way: str
    """height, lift, stride, width, lean, limp, bob or sway (docs/studio.md 4)."""
    steps: float
    """How much: 1 can be seen; negative: the other way."""


class OtherGait(msgspec.Struct, frozen=True, kw_only=True):
    """A gait that was found."""

    table: tuple[int, ...]
    """All angles [deg], posture by posture in order of first use: 3 * legs each."""
    changes: tuple[CellChange, ...]
    """What differs from the table of the request's files."""
    differences: tuple[GaitDifference, ...]
    """How it looks different from that table, what is easiest to see first."""
    figures: dict[str, Any]
    """Over three cycles."""


class MapCell(msgspec.Struct, frozen=True, kw_only=True):
    """A cell of a map, with the best gait that was found for it."""

    speed: int
    arousal: int
    """Index along each axis."""
    gait: OtherGait


class MapReply(msgspec.Struct, frozen=True, kw_only=True):
    """A map of gaits."""

    key: int
    speeds_mm_s: tuple[float, ...]
    """Lower end of each cell along the axis of forward speed; the last has no upper end."""
    arousals_mm_s: tuple[float, ...]
    """The same for arousal: height of the feet over the period."""
    cells: tuple[MapCell, ...]
    """The cells that have a gait, by speed and then by arousal."""
    own: tuple[int, int] | None
    """Speed and arousal of the own gait, as indices; None if it goes backward or has no cycle."""
    before: dict[str, Any]
    """Figures of the own gait."""
    trials: int
    cancelled: bool = False


class VariantsReply(msgspec.Struct, frozen=True, kw_only=True):
    """Gaits to choose from."""

    key: int
    variants: tuple[OtherGait, ...]
    """Six; fewer if the search was cancelled, or if too few walked upright."""
    trials: int
    cancelled: bool = False
