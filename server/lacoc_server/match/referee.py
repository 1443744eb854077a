"""The referee's decisions: when each is legal, why it is not, and what it does.

Workshop 5-1 rule 8 and 5-2 rule 9: "In the event of an unexpected event, the referee will consult
and make a decision." Every decision that is carried out is an event with referee, beat and reason;
no event is deleted (rules 4.1).
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import msgspec

from lacoc_arenas.game import NoSuchState
from lacoc_server.match import contestant
from lacoc_server.match.kept.history import Fold
from lacoc_server.match.seat import Seat
from lacoc_server.match.state import MatchState
from lacoc_shared import decisions as d
from lacoc_shared.inputs import THE_COURT, Decide
from lacoc_shared.messages import MARKER_STATES, DecisionReply, Refusal
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEATS_PER_S, Phase
from lacoc_shared.words import Phrase, say

MAX_FREEZE_S = 600.0
MAX_CLOCK_S = 3600.0
MAX_POINTS = 1000


class Illegal(ValueError):
    """Raised when a decision is not legal.

    Args:
        why: the reason for the referee (texts `why.*`).
    """

    def __init__(self, why: Phrase) -> None:
        super().__init__(why)
        self.why = why


@dataclass(frozen=True)
class _DecisionRule:
    """The rule of one kind of decision: when it is legal, and what it does."""

    phases: frozenset[Phase]
    act: Callable[[MatchState, Any], Phrase]
    """Carries the decision out and returns the sentence for the log. If the decision is not legal,
    it raises `Illegal` and changes nothing.
    """
    then: Callable[[MatchState, Any], object] = lambda match, decision: None
    """Makes the further changes of the match (such as its phase), logged after the decision."""
    also: Callable[[MatchState], Phrase | None] = lambda match: None
    """Returns a further reason why the decision is not legal; None if there is none."""

    def why_not(self, match: MatchState) -> Phrase | None:
        """Say why every decision of this kind is refused now; None if one can be legal."""
        if match.assigned is not None and match.assigned.waits:
            return say("why.waits-for-office")
        if match.phase in self.phases:
            return self.also(match)
        return say(
            "why.phase",
            phase=match.phase.word,
            phases=[phase.word for phase in sorted(self.phases)],
            missing=self._missing(match),
        )

    def _missing(self, match: MatchState) -> list[Phrase]:
        before_ready = match.phase is Phase.LOBBY and self.phases == {Phase.READY}
        return match.missing() if before_ready else []


def legality(match: MatchState) -> dict[str, Phrase | None]:
    """Return for each decision, by name, None if it is legal now, else why not."""
    return {name: _RULES[kind].why_not(match) for name, kind in d.DECISIONS.items()}


def decide(match: MatchState, item: Decide) -> DecisionReply | Refusal:
    """Take a decision, or refuse it with the reason; a refused one changes nothing."""
    before = match.phase
    answer = _decide(match, item)
    if before is not match.phase is Phase.HALTED:
        match.halted_by = item.by
    return answer


def _decide(match: MatchState, item: Decide) -> DecisionReply | Refusal:
    rule, decision = _RULES[type(item.decision)], item.decision
    name = str(decision.__struct_config__.tag)
    if why := rule.why_not(match):
        return _refusal(name, why)
    only_asks = isinstance(decision, d.TakeBack) and decision.dry_run
    if name in d.NEED_A_REASON and not only_asks and _is_empty(item.reason):
        return _refusal(name, say("why.needs-reason"))
    try:
        if isinstance(decision, d.TakeBack):
            return _take_back(match, item, decision)
        did = rule.act(match, decision)
    except Illegal as illegal:
        return _refusal(name, illegal.why)
    number = _log(match, item, name, did)
    rule.then(match, decision)
    match.tell_result()
    return DecisionReply(beat=match.beats, event=number, said=did, scores=match.scores())


def _refusal(name: str, why: Phrase) -> Refusal:
    return Refusal(say("refused.decision", decision=name, why=why))


def _is_empty(reason: Phrase | str) -> bool:
    return isinstance(reason, str) and not reason.strip()


def _log(match: MatchState, item: Decide, name: str, did: Phrase, **data: Any) -> int:
    match.result_changed()
    reason = item.reason or None
    said = say("event.decided", by=item.by, did=did, reason=reason)
    if item.by == THE_COURT:
        said = say("event.court-decided", did=did, reason=reason)
    return match.tell(
        "decision",
        said,
        decision=name,
        by=item.by,
        reason=msgspec.to_builtins(item.reason),
        arguments=msgspec.to_builtins(item.decision),
        **data,
    )


@contextmanager
def _breaks_as_refusal() -> Iterator[None]:
    """In the block, raise `Illegal` if the game refuses a marker's state, or if its code breaks."""
    try:
        yield
    except NoSuchState as error:
        raise Illegal(error.why) from None
    except UserError as error:  # another author's code is wrong
        raise Illegal(error.phrase) from None


def _seat(match: MatchState, seat_id: str) -> Seat:
    for seat in match.seats:
        if seat.id == seat_id:
            return seat
    raise Illegal(say("why.no-seat", seat=seat_id, seats=[seat.id for seat in match.seats]))


def _is_within(value: float, most: float) -> bool:
    return -most <= value <= most and value != 0  # NaN fails the comparison


def _ticks(seconds: float) -> int:
    ticks = round(seconds * BEATS_PER_S)
    if ticks == 0:
        raise Illegal(say("why.less-than-tick", seconds=seconds))
    return ticks


def _ready(match: MatchState, decision: d.Ready) -> Phrase:
    seat = _seat(match, decision.seat)
    if seat.join is None:
        raise Illegal(say("why.nobody-in-seat", seat=seat.id))
    return say("decision.ready", team=seat.team)


def _start(match: MatchState, decision: d.Start) -> Phrase:
    return say("decision.start", seconds=match.rules.countdown_s)


def _resume(match: MatchState, decision: d.Resume) -> Phrase:
    return say("decision.resume", seconds=match.rules.countdown_s)


def _restart(match: MatchState, decision: d.Restart) -> Phrase:
    seat = _seat(match, decision.seat)
    seat.restart()
    return say("decision.restart", team=seat.team)


def _freeze(match: MatchState, decision: d.Freeze) -> Phrase:
    seat = _seat(match, decision.seat)
    if not 0 < decision.seconds <= MAX_FREEZE_S:
        raise Illegal(say("why.bad-freeze", seconds=decision.seconds, most=MAX_FREEZE_S))
    seat.frozen_until = match.ticks + _ticks(decision.seconds)
    seat.stand()
    return say("decision.freeze", team=seat.team, seconds=decision.seconds)


def _unfreeze(match: MatchState, decision: d.Unfreeze) -> Phrase:
    seat = _seat(match, decision.seat)
    if seat.frozen_until <= match.ticks:
        raise Illegal(say("why.not-frozen", team=seat.team))
    seat.frozen_until = 0
    return say("decision.unfreeze", team=seat.team)


def _adjust(match: MatchState, decision: d.Adjust) -> Phrase:
    seat = _seat(match, decision.seat)
    points = decision.points
    if not _is_within(points, MAX_POINTS):
        raise Illegal(say("why.bad-points", points=points, most=MAX_POINTS))
    match.adjustments[match.next_number] = (seat.index, points)
    score = _score(match, match.scores())
    return say("decision.adjust", points=points, team=seat.team, score=score)


def _set(match: MatchState, decision: d.Set) -> Phrase:
    names = [marker.name for marker in match.game.markers]
    if decision.marker not in names:
        raise Illegal(say("why.no-marker", marker=decision.marker, markers=names))
    if decision.state not in MARKER_STATES:
        raise Illegal(say("why.no-state", state=decision.state, states=MARKER_STATES))
    index = names.index(decision.marker)
    with _breaks_as_refusal():
        match.history.set(index, MARKER_STATES.index(decision.state), match.next_number)
    score = _score(match, match.scores())
    for seat in match.seats:
        if seat.id == decision.state:
            return say("decision.set-for", marker=decision.marker, team=seat.team, score=score)
    return say("decision.set-so", marker=decision.marker, state=decision.state, score=score)


def _score(match: MatchState, scores: tuple[int, ...]) -> Phrase | None:
    """Return a sentence with both teams and their points; None if there are not two seats."""
    if len(scores) != 2:
        return None
    left, right = match.seats
    points, conceded = scores
    return say("score.two", left=left.team, points=points, conceded=conceded, right=right.team)


def _clock(match: MatchState, decision: d.Clock) -> Phrase:
    # Records of protocol 1 have `seconds`, which took time away; `gives_s` adds time.
    given_s = -decision.seconds if decision.seconds else decision.gives_s
    if not _is_within(given_s, MAX_CLOCK_S):
        raise Illegal(say("why.bad-clock", seconds=given_s, most=MAX_CLOCK_S))
    if match.phase is Phase.FINISHED and given_s < 0:
        raise Illegal(say("why.no-time-left"))
    match.clock_offset -= _ticks(given_s)
    if given_s < 0:
        return say("decision.clock-less", seconds=-given_s)
    return say("decision.clock-more", seconds=given_s)


def _abort(match: MatchState, decision: d.Abort) -> Phrase:
    match.ended = match.ended or say("over.aborted")
    return say("decision.abort")


def _declare(match: MatchState, decision: d.Declare) -> Phrase:
    choices = [*(seat.id for seat in match.seats), "draw"]
    if decision.winner not in choices:
        raise Illegal(say("why.can-not-win", winner=decision.winner, choices=choices))
    match.declared = decision.winner
    if decision.winner == "draw":
        return say("decision.declare-draw")
    return say("decision.declare", team=match.team(decision.winner))


def _end_play(match: MatchState, decision: d.Declare) -> None:
    if match.phase is Phase.HALTED:
        match.finish(say("over.ended"))


def _official(match: MatchState, decision: d.Official) -> Phrase:
    winner = match.declared or match.winner()
    if winner == "draw":
        return say("decision.official-draw")
    return say("decision.official", team=match.team(winner))


def _next(match: MatchState, decision: d.Next) -> Phrase:
    match.next_wanted = True
    return say("decision.next")


def _take_back(match: MatchState, item: Decide, decision: d.TakeBack) -> DecisionReply:
    """Take back one event, or one correction of a score (rules 4.1).

    After an event of the game or a change of a marker, judge the match again without it. A dry run
    changes nothing, and only reports the scores and what would change.
    """
    if decision.event in match.adjustments:
        seat, points = match.adjustments[decision.event]
        struck = say("struck.adjust", points=points, team=match.seats[seat].team)
        adjustments = {n: a for n, a in match.adjustments.items() if n != decision.event}
        scores = match.scores(adjustments=adjustments)
        if not decision.dry_run:
            match.adjustments = adjustments
        vanished: list[int] = []
        changes: tuple[Phrase, ...] = ()
        fold = None
    elif match.history.knows(decision.event):
        with _breaks_as_refusal():
            fold = match.history.without(decision.event)
        struck = _struck(match, decision.event)
        scores = match.scores(fold.state)
        vanished = [number for number, _ in fold.vanished]
        changes = (*_changes(fold), *_phase_after(match, fold.over))
    else:
        raise Illegal(say("why.can-not-take-back", event=decision.event))
    did = say("decision.took-back", what=struck, score=_score(match, scores))
    if decision.dry_run:
        return DecisionReply(beat=match.beats, said=did, scores=scores, changes=changes)
    number = _log(match, item, "take-back", did, vanished=vanished, scores=scores)
    if fold is not None:
        match.history.accept(fold, match.next_number)
        for _, _, event in fold.appeared:
            match.tell_judged(event, again=True)
        _follow(match, fold.over)
    match.tell_result()
    return DecisionReply(
        beat=match.beats, event=number, said=did, scores=match.scores(), changes=changes
    )


def _struck(match: MatchState, number: int) -> Phrase:
    """Describe, for the log, an event that the referee takes back."""
    event = match.history.event(number)
    if isinstance(event, int):
        return say("struck.set", marker=match.game.markers[event].name)
    team = match.seats[event.seat].team
    return say("struck.event", kind=event.kind, marker=event.marker, team=team)


def _changes(fold: Fold) -> tuple[Phrase, ...]:
    """List the events that a take-back removes, then those that it makes new."""
    vanished = [
        say("change.vanishes", kind=event.kind, marker=event.marker) for _, event in fold.vanished
    ]
    appeared = [
        say("change.appears", kind=event.kind, marker=event.marker) for _, _, event in fold.appeared
    ]
    return (*vanished, *appeared)


def _phase_after(match: MatchState, over: Phrase | None) -> tuple[Phrase, ...]:
    """Say whether a take-back ends the match or lets it go on, as `_follow` does."""
    if match.phase is Phase.HALTED and over:
        return (say("change.ends", why=over),)
    if match.phase is Phase.FINISHED and _goes_on(match, over):
        return (say("change.goes-on"),)
    return ()


def _goes_on(match: MatchState, over: Phrase | None) -> bool:
    return not (over or match.time_is_up or match.declared)


def _follow(match: MatchState, over: Phrase | None) -> None:
    """Change the phase after a take-back or a change of the clock, if the game requires it.

    A halted match whose game is now over is finished. A finished match whose game is not over any
    longer is halted, unless its time is up or a winner was declared. If it stays finished without a
    declared winner, the reason of its end becomes the one that is true now.
    """
    if match.phase is Phase.HALTED and over:
        match.finish(over)
    elif match.phase is Phase.FINISHED and _goes_on(match, over):
        match.ended = None
        match.enter(Phase.HALTED)
    elif match.phase is Phase.FINISHED and not match.declared:
        match.ended = over or say("over.time")


def _no_board(match: MatchState) -> Phrase | None:
    return None if match.game.markers else say("why.no-board")


def _nobody(match: MatchState) -> Phrase | None:
    return None if any(seat.join for seat in match.seats) else say("why.nobody-joined")


def _missing(match: MatchState) -> Phrase | None:
    missing = match.missing()  # includes changes from earlier in this beat
    return say("plain.sentences", sentences=missing) if missing else None


def _by_office(match: MatchState) -> Phrase | None:
    return say("why.office-opens-next") if match.by_office else None


def _no_clock(match: MatchState) -> Phrase | None:
    if not match.duration_ticks:
        return say("why.no-end")
    if match.phase is Phase.FINISHED and (match.history.over or match.declared):
        return say("why.not-over-by-time")
    return None


_PLAY = frozenset({Phase.PLAYING, Phase.HALTED})
_SCORED = _PLAY | {Phase.FINISHED}
_OPEN = _SCORED | {Phase.LOBBY, Phase.READY, Phase.COUNTDOWN}


def _begin_countdown(match: MatchState, decision: d.Decision) -> None:
    match.begin_countdown()


def _enter(phase: Phase) -> Callable[[MatchState, d.Decision], None]:
    return lambda match, decision: match.enter(phase)


_RULES: dict[type[d.Decision], _DecisionRule] = {
    d.Ready: _DecisionRule(
        frozenset({Phase.LOBBY}),
        _ready,
        lambda match, decision: contestant.ready(match, _seat(match, decision.seat), True),
        also=_nobody,
    ),
    d.Start: _DecisionRule(frozenset({Phase.READY}), _start, _begin_countdown, also=_missing),
    d.Halt: _DecisionRule(
        frozenset({Phase.COUNTDOWN, Phase.PLAYING}),
        lambda match, decision: say("decision.halt"),
        _enter(Phase.HALTED),
    ),
    d.Resume: _DecisionRule(frozenset({Phase.HALTED}), _resume, _begin_countdown),
    d.Restart: _DecisionRule(_PLAY, _restart),
    d.Freeze: _DecisionRule(_PLAY, _freeze),
    d.Unfreeze: _DecisionRule(_PLAY, _unfreeze),
    d.Adjust: _DecisionRule(_SCORED, _adjust),
    d.Set: _DecisionRule(_SCORED, _set, also=_no_board),
    d.TakeBack: _DecisionRule(
        frozenset({Phase.HALTED, Phase.FINISHED}),
        lambda match, decision: _struck(match, decision.event),  # `decide` has its own way
    ),
    d.Clock: _DecisionRule(
        _SCORED,  # time that was taken away by mistake can be given back after the end
        _clock,
        lambda match, decision: _follow(match, match.history.over),
        also=_no_clock,
    ),
    d.Abort: _DecisionRule(_OPEN, _abort, _enter(Phase.VOID)),
    d.Declare: _DecisionRule(frozenset({Phase.HALTED, Phase.FINISHED}), _declare, _end_play),
    d.Official: _DecisionRule(frozenset({Phase.FINISHED}), _official, _enter(Phase.OFFICIAL)),
    d.Next: _DecisionRule(frozenset({Phase.OFFICIAL, Phase.VOID}), _next, also=_by_office),
}
