"""What a match needs of a physics: the wall between the rules and MuJoCo.

`world.World` is the real one. A record's poses behind the same protocol judge a match
again without physics.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_server.match.entry import Entry
from lacoc_shared.gait.tables import Posture
from lacoc_shared.messages import Scene
from lacoc_shared.words import Phrase


@dataclass(frozen=True)
class Fault:
    """Physics failed in a tick; everything is as it was before that tick."""

    seat: int
    """The robot that it began with; `NOBODY` if that is not known."""
    why: Phrase
    """`fault.*`."""


class Physics(Protocol):
    """Robots on a field."""

    @property
    def scene(self) -> Scene:
        """The drawable model."""

    @property
    def scene_hash(self) -> bytes:
        """8 bytes; another scene has others."""

    @property
    def model_hash(self) -> str:
        """Hash of the compiled model, hexadecimal: a replay needs the same."""

    @property
    def digest(self) -> bytes:
        """8 bytes that chain the whole state, tick after tick."""

    def place(self, seat: int, place: Place) -> None:
        """Put a robot at a start place: start posture, all velocities zero."""

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        """Let one tick pass.

        Args:
            angles: for each seat the commanded angles [rad], by joint id.

        Returns:
            None, or what went wrong; then nothing has changed.
        """

    def save(self) -> bytes:
        """The whole state after the last tick, from which the same physics goes on bit for bit."""

    def poses(self) -> bytes:
        """The robots as `Frame.poses`."""

    def touched(self) -> Sequence[tuple[int, ...]]:
        """For each seat the markers whose probes it touches now, in ascending order."""


class MakePhysics(Protocol):
    """Builds the physics of a match: once, when all seats are ready."""

    def __call__(self, arena: Arena, entries: Sequence[Entry]) -> Physics:
        """No entries: the empty field, for its scene."""
