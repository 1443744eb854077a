"""The referee's decisions: when each is legal, why it is not, and what it does.

Workshop 5-1 rule 8 and 5-2 rule 9: "In the event of an unexpected event, the referee
will consult and make a decision." Every decision is an event with who, beat and reason;
nothing is edited away (rules 4).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import msgspec

from lacoc_server.match import contestant
from lacoc_server.match.seat import Seat
from lacoc_server.match.state import MatchState
from lacoc_shared import decisions as d
from lacoc_shared.inputs import Decide
from lacoc_shared.messages import MARKER_STATES, DecisionReply, Refusal
from lacoc_shared.seat import BEATS_PER_S, Phase

MAX_FREEZE_S = 600.0
MAX_CLOCK_S = 3600.0
MAX_POINTS = 1000


class Illegal(ValueError):
    """A decision can't be taken; the message is the reason for the referee."""


@dataclass(frozen=True)
class _Rule:
    """When a decision is legal and what it does."""

    phases: frozenset[Phase]
    act: Callable[[MatchState, Any], str]
    """Does it and returns the sentence for the log; raises `Illegal` before changing anything."""
    then: Callable[[MatchState, Any], object] = lambda match, decision: None
    """What follows and is told as events of its own, after the decision."""
    needs_reason: bool = False
    also: Callable[[MatchState], str] = lambda match: ""
    """Further reason why not; "" if there is none."""

    def why_not(self, match: MatchState) -> str:
        """Why no decision of this kind is legal now; "" if one may be."""
        if match.phase not in self.phases:
            names = " or ".join(phase.name for phase in sorted(self.phases))
            missing = "".join(f"; {reason}" for reason in self._missing(match))
            return f"only in {names}; the match is {match.phase.name}{missing}"
        return self.also(match)

    def _missing(self, match: MatchState) -> list[str]:
        before_ready = match.phase is Phase.LOBBY and self.phases == {Phase.READY}
        return match.missing() if before_ready else []


def legality(match: MatchState) -> dict[str, str]:
    """Every decision by name: "" if it is legal now, else why not."""
    return {name: _RULES[kind].why_not(match) for name, kind in d.DECISIONS.items()}


def decide(match: MatchState, item: Decide) -> DecisionReply | Refusal:
    """Take a decision, or say why it can't be taken; an illegal one changes nothing."""
    rule, decision = _RULES[type(item.decision)], item.decision
    name = str(decision.__struct_config__.tag)
    if reason := rule.why_not(match):
        return Refusal(f"{name}: {reason}.")
    only_asks = isinstance(decision, d.TakeBack) and decision.dry_run
    if rule.needs_reason and not only_asks and not item.reason.strip():
        return Refusal(f"{name}: give a reason; it goes into the record.")
    try:
        if isinstance(decision, d.TakeBack):
            return _take_back(match, item, decision)
        text = rule.act(match, decision)
    except Illegal as illegal:
        return Refusal(f"{name}: {illegal}")
    number = _log(match, item, name, text)
    rule.then(match, decision)
    match.tell_result()
    return DecisionReply(beat=match.beats, event=number, text=text, scores=match.scores())


def _log(match: MatchState, item: Decide, name: str, text: str, **data: Any) -> int:
    because = f" Reason: {item.reason}" if item.reason else ""
    match.result_changed()
    return match.tell(
        "decision",
        f"Referee {item.by}: {text}{because}",
        decision=name,
        by=item.by,
        reason=item.reason,
        arguments=msgspec.to_builtins(item.decision),
        **data,
    )


def _seat(match: MatchState, seat_id: str) -> Seat:
    for seat in match.seats:
        if seat.id == seat_id:
            return seat
    raise Illegal(f"there is no seat {seat_id!r}; there are {_list(s.id for s in match.seats)}.")


def _list(names: Any) -> str:
    return ", ".join(names)


def _number(value: float, limit: float, what: str) -> float:
    if not -limit <= value <= limit or value == 0:  # NaN fails the comparison
        raise Illegal(f"{value:g} {what}? Give a number between {-limit:g} and {limit:g}, not 0.")
    return value


def _ticks(seconds: float) -> int:
    ticks = round(seconds * BEATS_PER_S)
    if ticks == 0:
        raise Illegal(f"{seconds:g} s is less than a tick of 20 ms.")
    return ticks


def _ready(match: MatchState, decision: d.Ready) -> str:
    seat = _seat(match, decision.seat)
    if seat.join is None:
        raise Illegal(f"nobody has joined {seat.id}.")
    return f"ready for {seat.team}."


def _start(match: MatchState, decision: d.Start) -> str:
    return f"play begins in {match.rules.countdown_s:g} s."


def _resume(match: MatchState, decision: d.Resume) -> str:
    return f"play goes on in {match.rules.countdown_s:g} s."


def _restart(match: MatchState, decision: d.Restart) -> str:
    seat = _seat(match, decision.seat)
    seat.restart()
    return f"{seat.team} goes back to the start."


def _freeze(match: MatchState, decision: d.Freeze) -> str:
    seat = _seat(match, decision.seat)
    if not 0 < decision.seconds <= MAX_FREEZE_S:
        raise Illegal(f"{decision.seconds:g} s? Freeze for more than 0 and at most 600 s.")
    seat.frozen_until = match.ticks + _ticks(decision.seconds)
    seat.stand()
    return f"{seat.team} is frozen for {decision.seconds:g} s."


def _unfreeze(match: MatchState, decision: d.Unfreeze) -> str:
    seat = _seat(match, decision.seat)
    if seat.frozen_until <= match.ticks:
        raise Illegal(f"{seat.team} is not frozen.")
    seat.frozen_until = 0
    return f"{seat.team} may move again."


def _adjust(match: MatchState, decision: d.Adjust) -> str:
    seat = _seat(match, decision.seat)
    points = int(_number(decision.points, MAX_POINTS, "points"))
    match.adjustments[match.next_number] = (seat.index, points)
    return f"{points:+d} for {seat.team}."


def _set(match: MatchState, decision: d.Set) -> str:
    names = [marker.name for marker in match.game.markers]
    if decision.marker not in names:
        raise Illegal(f"there is no {decision.marker!r} on this board; there are {_list(names)}.")
    if decision.state not in MARKER_STATES:
        raise Illegal(f"{decision.state!r} is no state; there are {_list(MARKER_STATES)}.")
    try:
        match.history.set(
            names.index(decision.marker),
            MARKER_STATES.index(decision.state),
            match.next_number,
        )
    except ValueError as error:
        raise Illegal(str(error)) from None
    return f"{decision.marker} is set to {decision.state}."


def _clock(match: MatchState, decision: d.Clock) -> str:
    if decision.seconds:  # an old record's: it must give the same match and words again
        taken = _number(decision.seconds, MAX_CLOCK_S, "s")
        match.clock_offset += _ticks(taken)
        return f"the clock moves by {taken:+g} s."
    given = _number(decision.gives_s, MAX_CLOCK_S, "s")
    match.clock_offset -= _ticks(given)
    return f"{given:+g} s to play."


def _abort(match: MatchState, decision: d.Abort) -> str:
    match.ended = match.ended or "aborted by the referee"
    return "the match is void."


def _declare(match: MatchState, decision: d.Declare) -> str:
    choices = [*(seat.id for seat in match.seats), "draw"]
    if decision.winner not in choices:
        raise Illegal(f"{decision.winner!r} can't win; there are {_list(choices)}.")
    match.declared = decision.winner
    if decision.winner == "draw":
        return "the match is declared a draw."
    return f"{_seat(match, decision.winner).team} is declared the winner."


def _end_play(match: MatchState, decision: d.Declare) -> None:
    if match.phase is Phase.HALTED:
        match.finish("ended by the referee")


def _official(match: MatchState, decision: d.Official) -> str:
    return f"the result is official: {match.declared or match.winner()}."


def _next(match: MatchState, decision: d.Next) -> str:
    match.next_wanted = True
    return "the next match opens."


def _take_back(match: MatchState, item: Decide, decision: d.TakeBack) -> DecisionReply:
    """Strike out one event and judge the match again without it (rules 4, take-back)."""
    if decision.event in match.adjustments:
        adjustments = {n: a for n, a in match.adjustments.items() if n != decision.event}
        scores = match.scores(adjustments=adjustments)
        if not decision.dry_run:
            match.adjustments = adjustments
        changes: tuple[str, ...] = ()
        fold = None
    elif match.history.knows(decision.event):
        fold = match.history.without(decision.event)
        scores = match.scores(fold.state)
        changes = (
            *(
                f"event {number} vanishes: {event.kind} {event.marker}"
                for number, event in fold.vanished
            ),
            *(f"appears: {event.kind} {event.marker}" for _, _, event in fold.appeared),
        )
    else:
        raise Illegal(
            f"event {decision.event} can't be taken back: give the number of a capture, flip, "
            "strike, adjust or set that stands."
        )
    text = f"event {decision.event} is taken back."
    if decision.dry_run:
        return DecisionReply(beat=match.beats, text=text, scores=scores, changes=changes)
    number = _log(match, item, "take-back", text, changes=changes, scores=scores)
    if fold is not None:
        match.history.accept(fold, match.next_number)
        for _, _, event in fold.appeared:
            team = match.seats[event.seat].team
            match.tell(
                event.kind,
                f"Judged again: {event.text.format(team=team)}",
                seat=event.seat,
                marker=event.marker,
                also=event.also,
                points=event.points,
            )
        _follow(match, fold.over)
    match.tell_result()
    return DecisionReply(
        beat=match.beats, event=number, text=text, scores=match.scores(), changes=changes
    )


def _follow(match: MatchState, over: str) -> None:
    """Let the phase follow from what the game is after a take-back."""
    if match.phase is Phase.HALTED and over:
        match.finish(over)
    elif match.phase is Phase.FINISHED and not (over or match.time_is_up or match.declared):
        match.ended = ""
        match.enter(Phase.HALTED)
    elif match.phase is Phase.FINISHED and not match.declared:
        match.ended = over or "time is up"


def _no_board(match: MatchState) -> str:
    return "" if match.game.markers else "this game has no board"


def _nobody(match: MatchState) -> str:
    return "" if any(seat.join for seat in match.seats) else "nobody has joined"


def _missing(match: MatchState) -> str:
    return "; ".join(match.missing())  # also what changed a moment ago, in this beat


def _no_end(match: MatchState) -> str:
    return "" if match.duration_ticks else "this match has no end"


_PLAY = frozenset({Phase.PLAYING, Phase.HALTED})
_SCORED = _PLAY | {Phase.FINISHED}
_OPEN = _SCORED | {Phase.LOBBY, Phase.READY, Phase.COUNTDOWN}


def _begin_countdown(match: MatchState, decision: d.Decision) -> None:
    match.begin_countdown()


def _enter(phase: Phase) -> Callable[[MatchState, d.Decision], None]:
    return lambda match, decision: match.enter(phase)


_RULES: dict[type[d.Decision], _Rule] = {
    d.Ready: _Rule(
        frozenset({Phase.LOBBY}),
        _ready,
        lambda match, decision: contestant.ready(match, _seat(match, decision.seat), True),
        also=_nobody,
    ),
    d.Start: _Rule(frozenset({Phase.READY}), _start, _begin_countdown, also=_missing),
    d.Halt: _Rule(
        frozenset({Phase.COUNTDOWN, Phase.PLAYING}),
        lambda match, decision: "halted.",
        _enter(Phase.HALTED),
    ),
    d.Resume: _Rule(frozenset({Phase.HALTED}), _resume, _begin_countdown),
    d.Restart: _Rule(_PLAY, _restart, needs_reason=True),
    d.Freeze: _Rule(_PLAY, _freeze, needs_reason=True),
    d.Unfreeze: _Rule(_PLAY, _unfreeze),
    d.Adjust: _Rule(_SCORED, _adjust, needs_reason=True),
    d.Set: _Rule(_SCORED, _set, needs_reason=True, also=_no_board),
    d.TakeBack: _Rule(
        frozenset({Phase.HALTED, Phase.FINISHED}),
        lambda match, decision: "",
        needs_reason=True,
    ),
    d.Clock: _Rule(_PLAY, _clock, needs_reason=True, also=_no_end),
    d.Abort: _Rule(_OPEN, _abort, _enter(Phase.VOID), needs_reason=True),
    d.Declare: _Rule(
        frozenset({Phase.HALTED, Phase.FINISHED}), _declare, _end_play, needs_reason=True
    ),
    d.Official: _Rule(frozenset({Phase.FINISHED}), _official, _enter(Phase.OFFICIAL)),
    d.Next: _Rule(frozenset({Phase.OFFICIAL, Phase.VOID}), _next),
}
