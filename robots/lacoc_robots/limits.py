"""The contest's limits for robots (rules 1), each a setting."""

from collections.abc import Mapping
from typing import Any

import msgspec

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class Limits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a robot may be; the units are those of the files (degrees, metres, kilograms)."""

    legs_min: float = 4
    legs_max: float = 8
    """The number of legs is even."""
    width_m: float = 0.45
    """Largest extent along x with every angle 0."""
    length_m: float = 0.45
    """Largest extent along y with every angle 0."""
    height_m: float = 0.25
    """Largest extent along z with every angle 0."""
    mass_min_kg: float = 0.3
    mass_max_kg: float = 3.0
    part_mass_min_kg: float = 0.005
    part_mass_max_kg: float = 1.0
    link_min_m: float = 0.02
    """Shortest 1st and 2nd link; the root link may be as short as its radius."""
    link_max_m: float = 0.12
    radius_min_m: float = 0.005
    radius_max_m: float = 0.03
    range_deg: float = 150.0
    """Farthest that a joint may turn either way."""
    ang_min_deg_s: float = 240.0
    torque_n_m: float = 2.0
    hold_s: float = 5.0
    drop_m: float = 0.05
    """Farthest that the lowest part may be above the floor at the start."""
    kp_max: float = 200.0
    """Stiffest servo [N m/rad]: a stiffer one is more than the time step can follow."""
    kv_max: float = 5.0
    """Strongest damping in a servo [N m s/rad]."""
    damping_max: float = 1.0
    """Strongest damping in a joint [N m s/rad]."""
    armature_min: float = 0.002
    """Smallest inertia of a motor [kg m2]: less makes the simulation fragile."""
    armature_max: float = 0.02
    friction_max: float = 1.5

    @classmethod
    def of(cls, overrides: Mapping[str, Any]) -> "Limits":
        """Take the defaults with some replaced.

        Raises:
            UserError: if an override is no limit, or no number; the message names it.
        """
        try:
            return msgspec.convert(overrides, cls)
        except msgspec.ValidationError as error:
            raise UserError(
                say("limits.wrong", error=str(error), known=cls.__struct_fields__)
            ) from None
