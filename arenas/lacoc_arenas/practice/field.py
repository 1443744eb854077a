"""The field of practice: walls and a grid that shows distances."""

import math

import mujoco

from lacoc_arenas import field

from .rules import Practice

_GRID_M, _LINE_HALF_M, _LINE_TOP_M = 0.2, 0.0015, 0.001


def build(spec: mujoco.MjSpec, game: Practice) -> None:
    """Add the floor, the walls and a line every 20 cm to a model."""
    field.ground(spec, game.size_m)
    half_x_m, half_y_m = game.size_m[0] / 2, game.size_m[1] / 2
    for number in _lines(half_x_m):
        bar = (_LINE_HALF_M, half_y_m)
        field.plate(spec, f"grid:x{number}", (number * _GRID_M, 0.0), bar, *_look(number))
    for number in _lines(half_y_m):
        bar = (half_x_m, _LINE_HALF_M)
        field.plate(spec, f"grid:y{number}", (0.0, number * _GRID_M), bar, *_look(number))


def _lines(half_m: float) -> range:
    most = math.ceil(half_m / _GRID_M) - 1
    return range(-most, most + 1)


def _look(number: int) -> tuple[float, field.Rgba]:
    """Return the height [m] and the colour of a grid line; the two in the middle look different."""
    return (2 * _LINE_TOP_M, field.RIM) if number == 0 else (_LINE_TOP_M, field.LINE)
