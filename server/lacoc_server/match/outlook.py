"""What would happen if play went on: a copy of a match in a halt, played without anybody; pure.

The match itself stays as it is. Nobody presses a key in the copy, so each robot goes on with the
key that it had before the halt. A robot that stands, such as that of a silent seat, keeps standing.
"""

from lacoc_server.match.match import Match
from lacoc_shared.decisions import Decision, Resume
from lacoc_shared.inputs import Decide
from lacoc_shared.messages import Event, Outlook, Refusal
from lacoc_shared.seat import BEATS_PER_S, IN_PLAY, Phase

_BY = "outlook"
"""Stands for the referee's name and the reason in the copy, which is not recorded."""


def look_ahead(copy: Match, decision: Decision | None, seconds: float) -> Outlook | Refusal:
    """Take a decision in a copy of a match, resume it, and let play go on.

    Args:
        copy: the match; it is played on, so nobody else may use it.
        decision: the decision to take before play goes on; None: none.
        seconds: how long play goes on at most [s].

    Returns:
        What happened; or the match's own refusal, if it can't be resumed now or refuses the
        decision.
    """
    beat, first_tick = copy.beats, copy.ticks
    decisions = [Resume()] if decision is None else [decision, Resume()]
    resumed = copy.beat([Decide(_BY, _BY, one) for one in decisions])
    for outcome in resumed.outcomes:
        if isinstance(outcome, Refusal):
            return outcome
    before = copy.scores()
    end_tick = first_tick + round(seconds * BEATS_PER_S)
    events: list[Event] = []
    while copy.phase in IN_PLAY and copy.ticks < end_tick:
        passed = copy.beat()
        if copy.ticks > first_tick:
            events += (event for event in passed.events if not _is_begin(event))
    return Outlook(
        beat=beat,
        clock_ticks=resumed.frame.clock_ticks,
        before=before,
        scores=copy.scores(),
        seconds=(copy.ticks - first_tick) / BEATS_PER_S,
        phase=int(copy.phase),
        events=tuple(events),
    )


def _is_begin(event: Event) -> bool:
    """Return whether an event only says that play goes on."""
    return event.kind == "phase" and event.data.get("after") == Phase.PLAYING.name
