"""Pictures of the robots on their field, drawn by MuJoCo without a window."""

import copy
import os
import sys
import weakref
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from lacoc_arenas.checked_game import marker_of_geom
from lacoc_arenas.game import AnyGame
from lacoc_server.world.world import STATE
from lacoc_shared.codec import unpack_states
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

WIDTH, HEIGHT = 640, 480
"""Size of a picture in pixels."""
_TILT_DEG, _CLOSE_TILT_DEG = -68.0, -35.0
_FAR = 1.2
"""Distance of the camera from the middle, as a multiple of the field's longer side."""
_LARGE_M = 5.0
"""Size of a field [m] above which the camera looks at the robot in the first seat."""
_CLOSE_M = 0.9
"""Distance of the camera from the robot in the first seat, on a large field [m]."""
_MOST_GEOMS = 10_000


class Camera:
    """Takes pictures of one model: of the whole field from above, or of the robot on a large field.

    Args:
        model: the compiled model; it is not changed.
        game: the game of the model, for the markers and the size of the field.

    Raises:
        UserError: if this machine can't draw.
    """

    def __init__(self, model: Any, game: AnyGame) -> None:
        self._model = copy.copy(model)
        quality = self._model.vis.quality
        quality.offsamples = 4
        quality.shadowsize = 1024
        self._model.vis.headlight.ambient[:] = 0.45
        self._data = mujoco.MjData(self._model)
        self._markers = len(game.markers)
        shown = (marker_of_geom(game, self._model.geom(g).name) for g in range(self._model.ngeom))
        self._shows = [(geom, *what) for geom, what in enumerate(shown) if what[0] >= 0]
        self._camera = mujoco.MjvCamera()
        self._camera.lookat[:] = 0, 0, 0
        self._follows = max(game.size_m) > _LARGE_M
        self._camera.distance = _CLOSE_M if self._follows else _FAR * max(game.size_m)
        self._camera.azimuth = 90.0
        self._camera.elevation = _CLOSE_TILT_DEG if self._follows else _TILT_DEG
        try:
            self._gl = _graphics()
            self._gl.make_current()
            self._context = mujoco.MjrContext(
                self._model, mujoco.mjtFontScale.mjFONTSCALE_100.value
            )
        except Exception as error:  # each graphics library raises its own
            raise UserError(say("environment.no-picture", error=str(error)[:200])) from None
        # At the latest when the program ends, but before the graphics library ends.
        self._free = weakref.finalize(self, _free, self._context, self._gl)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._scene = mujoco.MjvScene(self._model, _MOST_GEOMS)
        self._option = mujoco.MjvOption()

    def take(self, saved: bytes, board: bytes) -> npt.NDArray[np.uint8]:
        """Return a picture: an array (HEIGHT, WIDTH, 3) of red, green and blue from 0 to 255.

        Args:
            saved: the saved state of the model's world (`World.save`).
            board: states of the markers, as in frames.
        """
        mujoco.mj_setState(self._model, self._data, np.frombuffer(saved[8:]), STATE)
        mujoco.mj_forward(self._model, self._data)
        states = unpack_states(board, self._markers)
        for geom, marker, state in self._shows:
            self._model.geom_rgba[geom, 3] = 1.0 if states[marker] == state else 0.0
        if self._follows:
            self._camera.lookat[:] = self._data.qpos[:3]
        parts = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(
            self._model, self._data, self._option, None, self._camera, parts, self._scene
        )
        self._gl.make_current()
        frame = mujoco.MjrRect(0, 0, WIDTH, HEIGHT)
        mujoco.mjr_render(frame, self._scene, self._context)
        picture = np.empty((HEIGHT, WIDTH, 3), np.uint8)
        mujoco.mjr_readPixels(picture, None, frame, self._context)
        return np.ascontiguousarray(picture[::-1])  # its first row is the lowest one

    def close(self) -> None:
        """Free the memory and context of the graphics library."""
        self._free()


def _free(context: Any, gl: Any) -> None:
    gl.make_current()
    context.free()
    gl.free()


def _graphics() -> Any:
    """Return the graphics library for MuJoCo: the one that MUJOCO_GL names, or one that fits.

    MuJoCo's own choice needs a screen, and ends the program where there is none. EGL needs none.
    """
    screens = ("MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY")
    if sys.platform == "linux" and not any(map(os.environ.get, screens)):
        from mujoco.egl import GLContext

        return GLContext(WIDTH, HEIGHT)
    return mujoco.GLContext(WIDTH, HEIGHT)
