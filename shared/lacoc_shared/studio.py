"""The messages of a studio on the wire (docs/protocol.md has them as tables).

A studio lets robots walk, and searches for better gaits, for everybody who sends it a request. It
keeps nothing between requests: each request contains all files that are needed.
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
        UserError: if the studio's name is not allowed (`keyspace.check_name`).
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
        """Return the key expression on which a studio gets requests of one kind.

        Args:
            what: robot, trial, coach, map, variants or cancel; `*` means all of them.
        """
        return f"{self.root}/ask/{what}"

    def progress(self, job: str) -> str:
        """Return the key expression on which the studio sends the progress of a search."""
        return f"{self.root}/progress/{job}"


class GaitFiles(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The robot and gait files of a request to a studio: text, no workbooks."""

    robot: SentFile | None = None
    """Robot file; None: the workshop's hexapod."""
    postures: SentFile | None = None
    locomotion: SentFile | None = None
    """LocoTra-data file. If there is neither a gait file nor a robot file, the workshop's sample
    gait is used."""
    sequences: tuple[tuple[int, ...], ...] | None = None
    """For each key of level B the digits of its postures, for use without a locomotion file; None:
    the sequences of the sample gait."""


class RobotRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask a studio for a description of the robot in a robot file."""

    protocol: int
    robot: SentFile | None = None


class LegShape(msgspec.Struct, frozen=True, kw_only=True):
    """A leg of a robot, with all that a page needs to bend it (docs/robot-file.md)."""

    label: str
    """The leg's name in tables, such as "R,F"."""
    position_mm: tuple[float, float, float]
    """Position of the root hinge in the body frame."""
    outward_deg: float
    """Direction of the leg at Root 0: 0 = right, 90 = forward, 180 = left."""
    lengths_mm: tuple[float, float, float]
    """Lengths of the links L0, L1 and L2, from hinge to hinge; of the last one, from hinge to
    foot."""
    range_deg: tuple[float, float]
    """Lowest and highest angle of each of the three joints."""


class RobotReply(msgspec.Struct, frozen=True, kw_only=True):
    """A robot, with all that a page needs to draw it and to make the columns of its table."""

    name: str
    legs: tuple[str, ...]
    """Leg labels in leg order; each leg has three joints."""
    shapes: tuple[LegShape, ...]
    """The legs in leg order."""
    ranges_deg: tuple[tuple[float, float], ...]
    """Lowest and highest angle of each joint, by joint id."""
    start_deg: tuple[float, ...]
    """Angle of each joint, by joint id, with which the robot is put on the floor."""
    start_z_m: float
    """Height of the body's origin above the floor in that posture."""
    facts: dict[str, Any]
    """Sizes, masses and speeds of the robot by name, with units in the names (docs/protocol.md). If
    legs can differ in a value, it is a pair: the lowest and the highest."""
    limits: dict[str, tuple[float | None, float | None]]
    """Lowest and highest value that the rules allow, for the facts of the same names."""
    sheet: Sheet
    """A sheet with the robot in its only seat, as it is needed for drawing."""
    scene: Scene


class TrialRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask a studio for a trial of at most 60 s."""

    protocol: int
    files: GaitFiles
    keys: str = ""
    """The keys to press, in the form of `lacoc trial --keys`; "": the key for forward."""
    seconds: float | None = None
    """For how long the last key is pressed [s]; None: for a number of whole cycles."""


class CellPlace(msgspec.Struct, frozen=True, kw_only=True):
    """The place of a number in the sequence of a key."""

    posture: int
    """Index of the posture in the sequence."""
    joint: int
    """Joint id."""


class Sentence(msgspec.Struct, frozen=True, kw_only=True):
    """One sentence of the explanation why a robot walked as it did in a trial."""

    said: Phrase
    """The sentence (`explain.*`)."""
    cell: CellPlace | None = None
    """The cell that the sentence is about; None: it is not about one cell."""
    leg: int = -1
    """Index of the leg that the sentence is about; -1: it is about the whole robot."""


class TrialReply(msgspec.Struct, frozen=True, kw_only=True):
    """The measurements of a trial of `ticks` ticks.

    Arrays are little-endian, with one entry for each tick.
    """

    level: int
    key: int
    """Level and digit of the key that was measured."""
    figures: dict[str, Any]
    """Figures of the walk, by the names in docs/studio.md 2."""
    explained: tuple[Sentence, ...]
    notes: tuple[Phrase, ...] = ()
    """Remarks on the files and on the figures."""
    fault: Phrase | None = None
    """Why physics stopped before the end of the trial; None: it did not stop."""
    ticks: int
    first: int
    end: int
    """The figures are computed from the ticks from `first` up to, but not including, `end`."""
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
    """Hash chain over the states of physics up to the last tick, as in the frames of a match."""


class CoachRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask the coach which numbers of a key matter most, and for better numbers."""

    protocol: int
    job: str
    """Name that the asker chooses for the search: a-z, 0-9 and hyphens. Reports on the search and a
    `CancelRequest` use it."""
    files: GaitFiles
    key: int | None = None
    """Key of level B that is changed; None: the key of the sample gait for this goal."""
    goal: str = "forward"
    """What the robot should do: forward, right or left."""
    size: str | None = None
    """How much may be changed: cell, three or table; None: nothing, the reply only says which
    numbers matter."""
    seconds: float = 30.0
    """How long to search [s], from 0 to 120, without the time to rank the numbers before the search
    and to undo changes after it."""
    seed: int = 0
    """Seed of the search's random numbers."""


class MapRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for a table of gaits: one for each speed and arousal (how excited the robot looks)."""

    protocol: int
    job: str
    """Name of the search; see `CoachRequest`."""
    files: GaitFiles
    key: int | None = None
    """Key of level B; None: the key for forward."""
    seconds: float = 30.0
    """How long to search [s], from 0 to 120."""
    seed: int = 0


class VariantsRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask the coach for six gaits that look different, made from one table or from two."""

    protocol: int
    job: str
    """Name of the search; see `CoachRequest`."""
    files: GaitFiles
    key: int | None = None
    """Key of level B; None: the key for forward."""
    keep: tuple[tuple[int, ...], ...] = ()
    """Tables (`OtherGait.table`) of one or two gaits from which the new ones are made; empty: they
    are made from the table in `files`."""
    before: tuple[tuple[int, ...], ...] = ()
    """Tables of gaits that were shown before: the new gaits must look different."""
    round: int = 0
    """How many rounds of six gaits there were before; later rounds change less."""
    seed: int = 0


class CancelRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """End a search of the coach early. The reply to this request is `Done`.

    The request that began the search is then answered with the best result so far; if the search
    still waits, it is refused.
    """

    protocol: int
    job: str


class Progress(msgspec.Struct, frozen=True, kw_only=True):
    """The progress of a search of the coach; a studio sends it several times a second."""

    stage: str
    """What the studio is doing: waiting (until earlier searches end), repair, matters, search,
    undo, map or variants."""
    done: float
    """Share of this stage that is done, from 0 to 1."""
    trials: int
    score: float | None = None
    """Score of the best table that was found so far."""
    filled: int | None = None
    """How many cells of a map have a gait so far, or how many variants walk."""


class Weight(msgspec.Struct, frozen=True, kw_only=True):
    """How much the score of a gait would change if one number of it were changed."""

    cell: CellPlace
    up: float
    """Change of the score when the number is 10 degrees larger."""
    down: float
    """Change of the score when the number is 10 degrees smaller."""


class CellChange(msgspec.Struct, frozen=True, kw_only=True):
    """A number of a gait that the coach changed."""

    cell: CellPlace
    from_deg: float
    to_deg: float


class RepairTold(msgspec.Struct, frozen=True, kw_only=True):
    """A mistake in the gait that the coach repaired before it searched."""

    said: Phrase
    """The mistake, as a sentence (`explain.*`)."""
    cell: CellPlace
    """One of the cells that were wrong."""
    before: float
    after: float
    """Figure of the goal after the repair: forward speed [mm/s], or speed of turning to the goal's
    side [deg/s]."""


class CoachReply(msgspec.Struct, frozen=True, kw_only=True):
    """The result of a search of the coach."""

    key: int
    """Key of level B that was changed."""
    matters: tuple[Weight, ...]
    """All numbers of the key; those that change the score most come first."""
    changes: tuple[CellChange, ...]
    before: dict[str, Any]
    """Figures of the student's own gait, by the names in docs/studio.md 2."""
    after: dict[str, Any]
    """Figures of the best gait that was found."""
    repairs: tuple[RepairTold, ...] = ()
    """Mistakes that were repaired, in the order of the repairs. The changed numbers are in
    `changes` too."""
    worse: tuple[str, ...] = ()
    """Names of the shown figures that became worse (docs/studio.md 4)."""
    score_before: float
    score_after: float
    trials: int
    cancelled: bool = False


class GaitDifference(msgspec.Struct, frozen=True, kw_only=True):
    """A visible difference between a gait that the coach found and the gait of the request."""

    way: str
    """What differs: height, lift, stride, width, lean, limp, bob or sway (docs/studio.md 4)."""
    steps: float
    """How much it differs: 1 is a difference that can be seen; negative: in the other direction."""


class OtherGait(msgspec.Struct, frozen=True, kw_only=True):
    """A gait that the coach found."""

    table: tuple[int, ...]
    """All angles [deg]: posture by posture in the order of first use, with 3 * legs angles each."""
    changes: tuple[CellChange, ...]
    """The numbers that differ from the table in the request's files."""
    differences: tuple[GaitDifference, ...]
    """The visible differences from the gait of that table; the clearest comes first."""
    figures: dict[str, Any]
    """Figures of the gait, measured over three cycles."""


class MapCell(msgspec.Struct, frozen=True, kw_only=True):
    """A cell of the table of speeds and arousals, with the best gait that was found for it."""

    speed: int
    arousal: int
    """Index of the cell along the axis of arousal."""
    gait: OtherGait


class MapReply(msgspec.Struct, frozen=True, kw_only=True):
    """A table of gaits by speed and arousal, as the coach found them."""

    key: int
    speeds_mm_s: tuple[float, ...]
    """Lower end of each cell along the axis of forward speed; the last cell has no upper end."""
    arousals_mm_s: tuple[float, ...]
    """Lower end of each cell along the axis of arousal: height of the feet divided by the
    period."""
    cells: tuple[MapCell, ...]
    """The cells that have a gait, by speed and then by arousal."""
    own: tuple[int, int] | None
    """The cell of the student's own gait, as indices of speed and arousal; None: this gait goes
    backward or has no cycle."""
    before: dict[str, Any]
    """Figures of the student's own gait."""
    trials: int
    cancelled: bool = False


class VariantsReply(msgspec.Struct, frozen=True, kw_only=True):
    """The gaits that the coach offers, so that somebody can choose one."""

    key: int
    variants: tuple[OtherGait, ...]
    """Six gaits; fewer if the search was cancelled, or if too few walked upright."""
    trials: int
    cancelled: bool = False
