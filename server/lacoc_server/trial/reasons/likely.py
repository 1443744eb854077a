"""Finds the mistake that a table probably has, from its numbers alone, without a trial."""

from typing import NamedTuple

import numpy as np

from lacoc_server.trial.reasons.form import KeyForm
from lacoc_server.trial.reasons.reach import reach_repairs
from lacoc_server.trial.reasons.repairs import Repair, partner_repairs
from lacoc_server.trial.reasons.shared import same_feet_repairs, shared_repairs

_THRUST_DEG = 60.0
"""Degrees of oddness (`KeyForm.oddness_deg`) that the largest thrust of all repairs outweighs."""
_WAY = 0.03
"""Cost of each degree that a joint turns between rows: of two rows that differ, the one with larger
motions is taken to be wrong."""
_CLOSE = 24
"""Number of repairs for which the thrust is computed: those whose tables are the least odd."""
_SURE_DEG = 12.0
"""A repair is sure only if it is worth more than this."""
_LEFT = 0.5
"""A repair of a part is sure only if it leaves at most this share of the oddness that the best
repair takes away."""


class Weighed(NamedTuple):
    """A repair, and how probable it is."""

    worth: float
    """How much less odd the table becomes (`KeyForm.oddness_deg`), plus the gain in thrust, minus
    how rare the mistake is [deg]."""
    repair: Repair
    is_sure: bool


def weigh_repairs(form: KeyForm) -> list[Weighed]:
    """Return the repairs of a table that are worth trying, the most probable first."""
    # While feet are in the air for ever, nothing else that they do can be seen.
    whole = reach_repairs(form) or same_feet_repairs(form)
    if whole:
        return [Weighed(_THRUST_DEG - one.rare, one, is_sure=True) for one in whole]
    now = _strange_deg(form)
    parts = [(_strange_deg(one.form), one) for one in partner_repairs(form)]
    parts.sort(key=lambda found: found[0] + found[1].rare)
    # Mates often swing less than each other. What no repair takes away is no mistake.
    usual = min([now, *(odd for odd, _ in parts)])
    parts = parts[:_CLOSE]
    # A fault of all legs need not be in a difference between them.
    shared = [(min(now, _strange_deg(one.form)), one) for one in shared_repairs(form)]
    repairs = [*parts, *shared]
    thrusts = [sum(one.form.thrust_m2) for _, one in repairs]
    own_m2 = sum(form.thrust_m2)
    most_m2 = max([abs(own_m2), *map(abs, thrusts), 1e-9])
    found = []
    for index, ((odd, one), thrust) in enumerate(zip(repairs, thrusts, strict=True)):
        worth = now - odd - one.rare + _THRUST_DEG * (thrust - own_m2) / most_m2
        is_whole = index >= len(parts) or odd - usual <= min(_LEFT * (now - usual), now - usual - 1)
        if worth > 0:
            found.append(Weighed(worth, one, is_whole and worth > _SURE_DEG))
    return sorted(found, key=lambda one: -one.worth)


def likely_mistake(form: KeyForm) -> Repair | None:
    """Return the most probable of the repairs that are sure enough to be told; None: none is."""
    return next((one.repair for one in weigh_repairs(form) if one.is_sure), None)


def _strange_deg(form: KeyForm) -> float:
    """Return how strange a table is [deg]: by the differences of legs, and how far joints turn."""
    angles = form.angles_deg
    way_deg = float(np.abs(angles - np.roll(angles, 1, axis=0)).sum())
    return form.oddness_deg + _WAY * way_deg
