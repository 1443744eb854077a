"""The messages of a studio on the wire (docs/protocol.md has them as tables).

A studio lets robots walk and searches for better gaits, for whoever asks it. It holds no state
that an answer depends on: each request has the files that it is about.
"""

from dataclasses import dataclass
from typing import Any

import msgspec

from lacoc_shared.keyspace import check_name
from lacoc_shared.messages import Scene, SentFile, Sheet
from lacoc_shared.words import Phrase

STUDIO_MAX_BYTES = 131_072
"""Largest request that a studio reads."""
TRIAL_REPLY_MAX_BYTES = 2 << 20
"""Largest reply of a studio: a trial of 60 s with eight legs has 1.1 MB."""
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
        """Key expression that is announced while the studio is connected (Zenoh's liveliness)."""
        return f"lacoc/{self.studio}/live/studio"

    def request(self, what: str) -> str:
        """Return the key expression of a request.

        Args:
            what: robot, trial, coach, map, variants or cancel; `*` for all.
        """
        return f"{self.root}/ask/{what}"

    def progress(self, job: str) -> str:
        """Return the key expression on which the studio tells how far a search is."""
        return f"{self.root}/progress/{job}"


class GaitFiles(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The files that a request is about, as those of a join: text, no workbooks."""

    robot: SentFile | None = None
    """None: the workshop's hexapod."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    """With neither file and no robot: the workshop's sample gait."""
    sequences: tuple[tuple[int, ...], ...] | None = None
    """Digits of the postures of each key of level B, if there is no locomotion file; None: as in
    the sample's keys."""


class RobotRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask what a robot file describes."""

    protocol: int
    robot: SentFile | None = None


class RobotReply(msgspec.Struct, frozen=True, kw_only=True):
    """A robot, as pages draw it and tables have their columns."""

    name: str
    legs: tuple[str, ...]
    """Leg labels in leg order; joints are 3 * legs."""
    ranges_deg: tuple[tuple[float, float], ...]
    """Lowest and highest angle of each joint, by joint id."""
    start_deg: tuple[float, ...]
    """Angles in which the robot is put on the floor, by joint id."""
    start_z_m: float
    """Height of the body's origin above the floor in that posture."""
    facts: dict[str, Any]
    """Sizes, masses and speeds by name, with units in the names (docs/protocol.md). What legs can
    differ in is a pair: lowest and highest."""
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
    """Keys as `lacoc trial --keys` has them; "": the key for forward."""
    seconds: float | None = None
    """How long the last key is pressed; None: whole cycles."""


class CellPlace(msgspec.Struct, frozen=True, kw_only=True):
    """A place in a key's sequence."""

    posture: int
    """Index in the sequence."""
    joint: int
    """Joint id."""


class Sentence(msgspec.Struct, frozen=True, kw_only=True):
    """One sentence that explains a walk."""

    said: Phrase
    """`explain.*`"""
    cell: CellPlace | None = None
    leg: int = -1
    """Index of the leg that it is about; -1: the whole robot."""


class TrialReply(msgspec.Struct, frozen=True, kw_only=True):
    """What was seen of a trial of `ticks` ticks; arrays are little-endian, tick by tick."""

    level: int
    key: int
    """Level and digit of the key that was measured."""
    figures: dict[str, Any]
    """By the names of docs/studio.md 2."""
    explained: tuple[Sentence, ...]
    notes: tuple[Phrase, ...] = ()
    """What a reader of the figures must know."""
    fault: Phrase | None = None
    """Why physics stopped before the end; None: it did not."""
    ticks: int
    first: int
    end: int
    """The figures are of the ticks from `first` to before `end`."""
    starts: tuple[int, ...]
    """Ticks in which a cycle of the key's sequence begins."""
    posture: bytes
    """uint8 (ticks,): index of the target posture in the key's sequence."""
    down: bytes
    """uint8 (ticks,): bit i is set while the foot of leg i is down."""
    poses: bytes
    """float32 (ticks, 7 + joints): as `Frame.poses`."""
    commanded_rad: bytes
    """float32 (ticks, joints)."""
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
    """State hash after the last tick, as in a match's frames."""


class CoachRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask which numbers of a key matter, and for better ones."""

    protocol: int
    job: str
    """Name that the asker chooses, for progress and for a cancel: a-z, 0-9 and hyphens."""
    files: GaitFiles
    key: int | None = None
    """Key of level B; None: the one for the goal."""
    goal: str = "forward"
    """forward, right or left."""
    size: str | None = None
    """How much may change: cell, three or table; None: only say which numbers matter."""
    seconds: float = 30.0
    """How long to search: from 0 to 120. Before it the studio finds which numbers matter, and after
    it undoes what hardly helps."""
    seed: int = 0


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
    """End a search early; the reply is `Done`, and the search's own reply has the best so far.

    A search that still waits is refused.
    """

    protocol: int
    job: str


class Progress(msgspec.Struct, frozen=True, kw_only=True):
    """How far a search is; several times a second."""

    stage: str
    """waiting (for the searches of others), matters, search, undo, map or variants."""
    done: float
    """Share of the stage, from 0 to 1."""
    trials: int
    score: float | None = None
    """Score of the best table so far."""
    filled: int | None = None
    """Cells of a map that have a gait, or variants that walk, so far."""


class Weight(msgspec.Struct, frozen=True, kw_only=True):
    """What a change of one number does to the score."""

    cell: CellPlace
    up: float
    down: float


class Change(msgspec.Struct, frozen=True, kw_only=True):
    """A number that the coach changed."""

    cell: CellPlace
    from_deg: float
    to_deg: float


class CoachReply(msgspec.Struct, frozen=True, kw_only=True):
    """What the coach found."""

    key: int
    matters: tuple[Weight, ...]
    """All numbers of the key, those that matter most first."""
    changes: tuple[Change, ...]
    before: dict[str, Any]
    after: dict[str, Any]
    """Figures of the own gait and of the best one."""
    score_before: float
    score_after: float
    trials: int
    cancelled: bool = False


class Difference(msgspec.Struct, frozen=True, kw_only=True):
    """A direction in which a gait looks different from the own one."""

    way: str
    """height, lift, stride, width, lean, limp, bob or sway (docs/studio.md 4)."""
    steps: float
    """How much: 1 can be seen; negative: the other way."""


class OtherGait(msgspec.Struct, frozen=True, kw_only=True):
    """A gait that was found."""

    table: tuple[int, ...]
    """All angles [deg], posture by posture in order of first use: 3 * legs each."""
    changes: tuple[Change, ...]
    """What differs from the table of the request's files."""
    differences: tuple[Difference, ...]
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
