"""The trial that the rules of `explain` look at, and the findings that they return."""

from dataclasses import dataclass
from typing import NamedTuple

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.form import KeyForm, TableCell
from lacoc_server.trial.walk import Walk
from lacoc_shared.gait.tables import Posture
from lacoc_shared.words import Phrase

_MOSTLY = 0.5


class TrialFinding(NamedTuple):
    """A situation in a trial that a rule found, with the sentence that explains it."""

    rank: float
    """The finding with the highest rank is told first."""
    said: Phrase
    leg: int = -1
    """Index of the leg that the finding is about; -1: the whole robot."""
    cell: TableCell | None = None


@dataclass(frozen=True)
class SeenTrial:
    """A trial with its figures and its key's table, for the rules that explain it."""

    robot: RobotSpec
    walk: Walk
    figures: Figures
    form: KeyForm
    """The table of the measured key."""
    before: tuple[int, Posture] | None = None
    """Digit and posture [rad] of the key of level A that came before a measured key of level A."""

    @property
    def part(self) -> slice:
        """The measured ticks, as a slice of all ticks."""
        return slice(self.walk.span.first, self.walk.span.end)

    @property
    def stands(self) -> bool:
        """Whether the robot stands on its feet, and not on its body, for most of the time."""
        return self.figures.few_feet_share < _MOSTLY and self.figures.belly_share < _MOSTLY

    @property
    def no_feet_share(self) -> float:
        """Share of the measured ticks in which no foot is down."""
        down = self.walk.down[self.part]
        return float((down.sum(axis=1) == 0).mean()) if len(down) else 0.0
