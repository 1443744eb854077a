"""Limits for how well a match must run; a match beyond one of them should be played again."""

from typing import Annotated

import msgspec

_Amount = Annotated[float, msgspec.Meta(ge=0)]
_Percent = Annotated[float, msgspec.Meta(ge=0, le=100)]
_Times = Annotated[int, msgspec.Meta(ge=0)]


class HealthLimits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Limits of a match's health; beyond any of them the match should be played again."""

    real_time_factor: _Amount = 0.98
    """Least real-time factor over all of PLAYING."""
    slow_beats_percent: _Percent = 1.0
    """Largest share of slow beats in PLAYING [%]."""
    worst_late_ms: _Amount = 200.0
    """Largest delay with which a beat of PLAYING may begin [ms]; a delay above 100 ms is not made
    up for."""
    silent_s: _Amount = 5.0
    """Longest time of PLAYING for which a seat may be silent, all its silences together [s]."""
    heard_percent: _Percent = 70.0
    """Least share of a seat's repeated keys that must arrive [%]."""
    faults: _Times = 0
    """How many times physics may stop."""
    resumptions: _Times = 2
    """How many times the court may be restarted after it was killed."""
