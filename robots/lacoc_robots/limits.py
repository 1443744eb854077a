"""The contest's limits for robots (rules 1); each can be set in the contest file."""

from collections.abc import Mapping
from typing import Any

import msgspec

from lacoc_shared.contest.wrong_value import place_and_words
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


class Limits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Limits for a robot, in the units of the files (degrees, metres, kilograms)."""

    legs_min: float = 4
    legs_max: float = 8
    """Most legs; the number of legs must also be even."""
    width_m: float = 0.45
    """Largest extent along x: with every angle 0, in the start posture, and with key 0."""
    length_m: float = 0.45
    """Largest extent along y; otherwise as `width_m`."""
    height_m: float = 0.25
    """Largest extent along z; otherwise as `width_m`."""
    mass_min_kg: float = 0.3
    mass_max_kg: float = 3.0
    part_mass_min_kg: float = 0.005
    part_mass_max_kg: float = 1.0
    link_min_m: float = 0.02
    """Shortest 1st and 2nd link that is allowed; the root link may be as short as its radius."""
    link_max_m: float = 0.12
    radius_min_m: float = 0.005
    radius_max_m: float = 0.03
    range_deg: float = 150.0
    """Largest angle of a joint in either direction."""
    ang_min_deg_s: float = 240.0
    """Largest AngMin: speed at which a commanded angle may move to the target posture."""
    torque_n_m: float = 2.0
    """Largest torque of a servo."""
    hold_s: float = 5.0
    """Longest time that a drive may hold a posture."""
    drop_m: float = 0.05
    """Largest height above the floor of the robot's lowest part, when the robot is put at a start
    place in its start posture."""
    kp_max: float = 200.0
    """Largest stiffness of a servo [N m/rad]: for a stiffer servo the physics step is too long."""
    kv_max: float = 5.0
    """Largest damping of a servo [N m s/rad]."""
    damping_max: float = 1.0
    """Largest damping of a joint [N m s/rad]."""
    armature_min: float = 0.002
    """Smallest inertia of a motor [kg m2]: with less the simulation becomes unstable."""
    armature_max: float = 0.02
    friction_max: float = 1.5

    @classmethod
    def of(cls, overrides: Mapping[str, Any]) -> "Limits":
        """Return the default limits with some of them replaced.

        Raises:
            UserError: if an override is not a limit, or not a number; the message names it.
        """
        try:
            return msgspec.convert(overrides, cls)
        except msgspec.ValidationError as error:
            where, wrong = place_and_words(error)
            known = cls.__struct_fields__
            raise UserError(
                say("limits.wrong", where=where or None, error=wrong, known=known)
            ) from None
