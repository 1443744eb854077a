"""Computes the figures of a walk (docs/studio.md 2)."""

import math
from dataclasses import dataclass

import numpy as np

from lacoc_server.trial.feet import DOWN_SHARE, changes_hz, duty, phases
from lacoc_server.trial.support import margins_m
from lacoc_server.trial.walk import Floats, Walk
from lacoc_shared.seat import BEAT_S

_LEAST_M_S = 1e-3
"""Speed, forward or backward, up to which no slip ratio is computed [m/s]."""
_LEAST_M = 1e-2
"""Distance up to which cost of transport, straightness and turning per metre are None [m]."""


@dataclass(frozen=True)
class Figures:
    """The figures of a trial, over whole cycles if there are any."""

    seconds: float
    """Length of the measurement [s]."""
    cycles: int
    """Number of measured cycles; 0: none after the first was completed, or physics stopped."""
    cycle_s: float | None
    """Period of the gait [s]; None if no cycle was measured."""
    speed_mm_s: float
    """Forward speed [mm/s], in the direction that the robot faced when the measurement began."""
    lateral_mm_s: float
    """Speed to the left [mm/s], seen in the direction of `speed_mm_s`."""
    drift_deg_s: float
    """Turning speed to the left [deg/s]."""
    drift_deg_m: float | None
    """Turning to the left [deg] per metre between the ends of the path; None if they are hardly
    apart."""
    straightness: float | None
    """Distance between the ends of the path, divided by the length of the path; from 0 to 1. None
    if the robot hardly moved."""
    duty: list[float]
    """For each leg, the share of ticks in which its foot is down."""
    phase: list[float | None]
    """For each leg, when in a cycle its foot comes down, from 0 to 1; None if it never comes down.
    """
    changes_hz: list[float]
    """For each leg, how often its foot comes down or goes up [1/s]."""
    few_feet_share: float
    """Share of ticks with fewer than three feet down."""
    margin_mm: float | None
    """Median of the support margin [mm]; None if in half of the ticks or more no foot is down."""
    margin_low_mm: float | None
    """5th percentile of the support margin [mm] while a foot is down; None if `margin_mm` is."""
    stable_share: float
    """Share of ticks with the centre of mass inside the support polygon."""
    slip_mm_s: float
    """Speed of the loaded feet along the floor, weighted by their load [mm/s]."""
    slip_legs_mm_s: list[float]
    """`slip_mm_s` of each leg."""
    slip_ratio: float | None
    """`slip_mm_s` divided by the forward speed; None if this speed is almost 0."""
    cost_of_transport: float | None
    """Work of the motors (without braking), divided by weight times the distance between the ends
    of the path; None if they are hardly apart."""
    clearance_mm: float
    """95th percentile of the height of all feet above the floor [mm]."""
    clearance_legs_mm: list[float]
    """`clearance_mm` of each leg."""
    belly_share: float
    """Share of ticks in which parts other than shanks bear more than 2 % of the weight."""
    upright: float
    """Smallest cosine of the angle between the body's up and the world's: 1 is upright, 0 is on the
    side, -1 is on the back."""


def measure(walk: Walk) -> Figures:
    """Compute the figures of a walk over its `span`: the ticks that are measured."""
    span = walk.span
    part = slice(span.first, span.end)
    seconds = max(span.seconds, BEAT_S)
    down = walk.down
    cycles = [
        (begin, end)
        for begin, end in zip(walk.starts[1:], [*walk.starts[2:], span.end], strict=False)
        if span.cycles and begin < end <= span.end
    ]
    before = max(0, span.first - 1)
    path_m = walk.body_w[before : span.end, :2]
    way_m = path_m[-1] - path_m[0] if len(path_m) else np.zeros(2)
    yaws = np.unwrap([yaw_rad(pose) for pose in walk.body_w[before : span.end]] or [0.0])
    ahead = np.array([-math.sin(yaws[0]), math.cos(yaws[0])])  # the body's forward is its +y
    forward_m, left_m = float(way_m @ ahead), float(way_m @ (-ahead[1], ahead[0]))
    way, path = float(np.hypot(*way_m)), float(np.hypot(*np.diff(path_m, axis=0).T).sum())
    turn_deg = math.degrees(yaws[-1] - yaws[0])
    margins = margins_m(down[part], walk.contact_w_m[part], walk.centre_w_m[part])
    known = margins[~np.isnan(margins)]
    has_margin = 2 * len(known) > len(margins)
    grip = walk.grip_n[part]
    load, slip = grip.sum(axis=0), (grip * walk.slip_m_s[part]).sum(axis=0)
    slip_m_s = _ratio(slip.sum(), load.sum())
    speed_m_s = forward_m / seconds
    tips = walk.tip_m[part]
    x, y = walk.body_w[part, 4:6].T
    ups = 1 - 2 * (x * x + y * y)
    ticks = max(1, span.ticks)
    return Figures(
        seconds=span.seconds,
        cycles=span.cycles,
        cycle_s=span.seconds / span.cycles if span.cycles else None,
        speed_mm_s=1000 * speed_m_s,
        lateral_mm_s=1000 * left_m / seconds,
        drift_deg_s=turn_deg / seconds,
        drift_deg_m=turn_deg / way if way > _LEAST_M else None,
        straightness=way / path if path > _LEAST_M else None,
        duty=duty(down[part]),
        phase=phases(down, span.first, cycles),
        changes_hz=changes_hz(down[part], span.seconds),
        few_feet_share=float((down[part].sum(axis=1) < 3).sum()) / ticks,
        margin_mm=1000 * float(np.median(known)) if has_margin else None,
        margin_low_mm=1000 * float(np.percentile(known, 5)) if has_margin else None,
        stable_share=float((known > 0).sum()) / ticks,
        slip_mm_s=1000 * slip_m_s,
        slip_legs_mm_s=[1000 * _ratio(one, all_n) for one, all_n in zip(slip, load, strict=True)],
        slip_ratio=slip_m_s / abs(speed_m_s) if abs(speed_m_s) > _LEAST_M_S else None,
        cost_of_transport=(
            float(walk.power_w[part].sum()) * BEAT_S / (walk.weight_n * way)
            if way > _LEAST_M
            else None
        ),
        clearance_mm=_height_mm(tips),
        clearance_legs_mm=[_height_mm(tips[:, leg]) for leg in range(tips.shape[1])],
        belly_share=float((walk.other_load_n[part] > DOWN_SHARE * walk.weight_n).sum()) / ticks,
        upright=float(ups.min()) if len(ups) else 1.0,
    )


def yaw_rad(pose: Floats) -> float:
    """Return the heading of a body: 0 if it faces the world's +y, positive to the left."""
    w, x, y, z = pose[3:]
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def _ratio(part: float, whole: float) -> float:
    return float(part / whole) if whole > 0 else 0.0


def _height_mm(tips_m: Floats) -> float:
    return 1000 * float(np.percentile(tips_m, 95)) if tips_m.size else 0.0
