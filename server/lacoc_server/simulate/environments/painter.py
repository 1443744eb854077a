"""Draws the pictures that an environment's `render` returns."""

from typing import Any

import numpy as np
import numpy.typing as npt

from lacoc_arenas.game import AnyGame
from lacoc_server.world.picture import Camera
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class Painter:
    """Draws the pictures of an environment.

    Args:
        render_mode: "rgb_array", or None for no pictures.

    Raises:
        UserError: if there is no such mode.
    """

    def __init__(self, render_mode: str | None) -> None:
        if render_mode not in (None, "rgb_array"):
            raise UserError(say("environment.render-mode", found=str(render_mode)[:40]))
        self._draws = render_mode is not None
        self._camera: Camera | None = None
        self._model: str = ""

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_camera": None}  # a copy draws with a camera of its own

    def draw(self, physics: Any, game: AnyGame, board: bytes) -> npt.NDArray[np.uint8] | None:
        """Return a picture; None without a render mode.

        Args:
            physics: the robots on their field, as a `World`.
            game: the game.
            board: states of the markers, as in frames.
        """
        if not self._draws:
            return None
        if self._camera is None or self._model != physics.model_hash:
            self.close()
            self._camera, self._model = Camera(physics.whole, game), physics.model_hash
        return self._camera.take(physics.save(), board)

    def close(self) -> None:
        """Free the camera that draws the pictures."""
        if self._camera is not None:
            self._camera.close()
            self._camera = None
