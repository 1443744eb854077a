"""What a match needs from physics: the protocol between the rules and MuJoCo.

`world.World` implements it. A record's poses implement it too, and so a match can be judged again
without physics.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_server.match.entry import Entry
from lacoc_shared.gait.tables import Posture
from lacoc_shared.messages import Scene
from lacoc_shared.words import Phrase


@dataclass(frozen=True)
class Fault:
    """A failure of physics in a tick; the robots keep the state from before that tick."""

    seat: int
    """Index of the seat whose robot failed; `NOBODY` if that is not known."""
    why: Phrase
    """Why it failed (texts `fault.*`)."""


class Physics(Protocol):
    """The robots on a field, and the steps of their physics."""

    @property
    def scene(self) -> Scene:
        """The scene: all that pages need to draw the model."""

    @property
    def scene_hash(self) -> bytes:
        """Hash of the scene, 8 bytes."""

    @property
    def model_hash(self) -> str:
        """Hash of the compiled model, hexadecimal; a replay needs the same model."""

    @property
    def digest(self) -> bytes:
        """Hash chain over the states after all ticks, 8 bytes; `place` does not change it."""

    def place(self, seat: int, place: Place) -> None:
        """Put a robot at a start place: start posture, all velocities zero."""

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        """Let one tick pass.

        Args:
            angles: for each seat the commanded angles [rad], by joint id.

        Returns:
            None if the tick passed. Else the fault, with the state as it was before the tick.
        """

    def save(self) -> bytes:
        """Return the whole present state; a `World` can go on from it bit for bit.

        The physics of a record returns the recorded snapshot of this beat, or b"" if there is none.
        """

    def poses(self) -> bytes:
        """Return the poses of the robots, in the form of `Frame.poses`."""

    def touched(self) -> Sequence[tuple[int, ...]]:
        """Return for each seat the markers that its robot touches after the newest tick.

        A marker is given by its index in the game's board. The indices are in ascending order.
        """


@runtime_checkable
class Restorable(Physics, Protocol):
    """Physics that can go on from a saved state; the physics of a record can't."""

    def load(self, saved: bytes) -> None:
        """Go on from a state that `save` of the same model returned.

        Raises:
            ValueError: if it has another length than the states of this model.
        """


class MakePhysics(Protocol):
    """Builds the physics of a match: the empty field, or the robots once all seats are ready."""

    def __call__(self, arena: Arena, entries: Sequence[Entry]) -> Physics:
        """Build the physics of the robots; without entries, the physics of the empty field."""
