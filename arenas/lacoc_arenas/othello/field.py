"""The field of Robot-Othello: a board of 36 discs, with one geom for each colour of a disc."""

import mujoco

from lacoc_arenas import field
from lacoc_arenas.game import LEFT, NEUTRAL, RIGHT
from lacoc_shared.messages import MARKER_STATES

from .rules import Othello

_PANEL_TOP_M, _RIM_TOP_M, _DISC_TOP_M = 0.001, 0.0015, 0.003
_RIM_M, _MARGIN_M = 0.006, 0.03


def build(spec: mujoco.MjSpec, game: Othello) -> None:
    """Add the floor, the walls, the board and the discs to a model."""
    field.ground(spec, game.size_m)
    radius_m = game.settings.disc_radius_m
    edge_m = game.markers[-1].x_m + radius_m + min(_MARGIN_M, game.settings.wall_m / 2)
    field.plate(spec, "board", (0.0, 0.0), (edge_m, edge_m), _PANEL_TOP_M, field.PANEL)
    for disc in game.markers:
        at_m = (disc.x_m, disc.y_m)
        field.disc(spec, f"rim:{disc.name}", at_m, radius_m, _RIM_TOP_M, field.RIM)
        for state in (NEUTRAL, LEFT, RIGHT):
            tint = field.TINTS[MARKER_STATES[state]]
            name = field.marker_geom(disc.name, state)
            field.disc(spec, name, at_m, radius_m - _RIM_M, _DISC_TOP_M, tint)
