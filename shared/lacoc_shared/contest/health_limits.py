"""How well a match must be held: beyond these limits a replay is advised."""

from typing import Annotated

import msgspec

_Amount = Annotated[float, msgspec.Meta(ge=0)]
_Percent = Annotated[float, msgspec.Meta(ge=0, le=100)]
_Times = Annotated[int, msgspec.Meta(ge=0)]


class HealthLimits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A match that was held worse than this gets the advice to be played again."""

    real_time_factor: _Amount = 0.98
    """Least over the whole of PLAYING."""
    slow_beats_percent: _Percent = 1.0
    """Most, of the beats of PLAYING."""
    worst_late_ms: _Amount = 200.0
    """The latest that a beat of PLAYING may begin; from 100 on the match runs late."""
    silent_s: _Amount = 5.0
    """Most that a seat may be silent in PLAYING."""
    heard_percent: _Percent = 70.0
    """Least of a seat's repeats that have to arrive."""
    faults: _Times = 0
    """Most stops of physics."""
    resumptions: _Times = 2
    """Most restarts of a killed court."""
