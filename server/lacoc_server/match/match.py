"""A match: phases, seats, clock and score, one beat after another (rules 4).

A match is a pure function of its setup and its inputs. It reads no clock, opens no
socket and knows physics only as a protocol: live, headless and in a replay the same
inputs give the same match, bit for bit.

The order of a beat (design.md, "One beat") favours no seat: requests of contestants,
silences, the referee's decisions, every seat's [x], every seat's digit, one tick of
physics, the rules.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lacoc_arenas import arena as arenas
from lacoc_robots.limits import Limits
from lacoc_server.match import contestant, referee
from lacoc_server.match.history import History
from lacoc_server.match.physics import Fault, MakePhysics, Physics
from lacoc_server.match.seat import Seat
from lacoc_server.match.staging import Staging
from lacoc_shared import __version__
from lacoc_shared.inputs import (
    Advice,
    Decide,
    HeardSeat,
    Input,
    JoinSeat,
    KeySeat,
    LeaveSeat,
    ReadySeat,
    SilentSeat,
)
from lacoc_shared.marker_states import pack_states
from lacoc_shared.messages import (
    PROTOCOL,
    DecisionReply,
    Done,
    Event,
    Frame,
    Refusal,
    Sheet,
)
from lacoc_shared.record.schema import Result, Setup, Touch
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, NOBODY, RESTART_KEY, Phase

TRANSITIONS: dict[Phase, frozenset[Phase]] = {
    Phase.CREATED: frozenset({Phase.LOBBY}),
    Phase.LOBBY: frozenset({Phase.READY, Phase.VOID}),
    Phase.READY: frozenset({Phase.LOBBY, Phase.COUNTDOWN, Phase.VOID}),
    Phase.COUNTDOWN: frozenset({Phase.PLAYING, Phase.HALTED, Phase.VOID}),
    Phase.PLAYING: frozenset({Phase.HALTED, Phase.FINISHED, Phase.VOID}),
    Phase.HALTED: frozenset({Phase.COUNTDOWN, Phase.FINISHED, Phase.VOID}),
    Phase.FINISHED: frozenset({Phase.HALTED, Phase.OFFICIAL, Phase.VOID}),
    Phase.OFFICIAL: frozenset(),
    Phase.VOID: frozenset(),
}
"""Where a match can go from each phase; `next` is a new match."""

PHYSICS_RUNS = frozenset({Phase.READY, Phase.PLAYING})

Outcome = Done | DecisionReply | Refusal
"""What became of an input."""


@dataclass(frozen=True)
class Beat:
    """What a beat made."""

    frame: Frame
    events: tuple[Event, ...]
    outcomes: tuple[Outcome, ...]
    """For each input, in the order they were given."""
    ticked: bool
    """Whether physics ran."""
    touch: Touch | None
    """What the rules saw beside the poses, if there was any."""
    result: Result | None
    """The result, in a beat that changed it."""
    sheet_changed: bool


class Match:
    """One match, from CREATED to OFFICIAL or VOID.

    Args:
        setup: what it is made from.
        make_physics: builds the robots on their field.
        folder: of the arena, if it is not installed.

    Raises:
        UserError: if the arena is not installed or its settings are wrong.
    """

    def __init__(self, setup: Setup, make_physics: MakePhysics, folder: Path | None = None) -> None:
        self.setup = setup
        self.arena = arenas.from_settings(setup.arena, setup.settings, folder)
        self.game = self.arena.game
        self.limits = Limits.of(setup.limits)
        self.rules = self.arena.match
        self.phase = Phase.CREATED
        self.beats = -1
        """Number of the beat; the first is 0."""
        self.entered_beat = 0
        """When this phase began."""
        self.countdown_beats = 0
        self.ticks = 0
        """Ticks of PLAYING."""
        self.silent_beats = 0
        """Beats since the last in which a seat was not silent."""
        self.clock_offset = 0
        """Ticks that a referee added to the clock."""
        self.seats = [
            Seat(index, seat.id, seat.colour, seat.pattern)
            for index, seat in enumerate(self.arena.seats)
        ]
        self.history = History(self.game)
        self.adjustments: dict[int, tuple[int, int]] = {}
        """Event number -> seat, points."""
        self.declared: str | None = None
        self.ended = ""
        """Why play ended."""
        self.advice: tuple[str, ...] = ()
        """Why the court advises a replay."""
        self.next_wanted = False
        self.fault: Fault | None = None
        """What stopped physics in the last tick that was tried."""
        self.staging = Staging(self.arena, make_physics)
        self._shown: tuple[Any, bytes] = (None, b"")
        """A state of the game and its board as frames carry it."""
        self._event_count = 0
        self._events: list[Event] = []
        self._touch: Touch | None = None
        self._result_changed = False
        self._told_result: tuple[str, tuple[int, ...]] | None = None
        """Winner by the rules and score, as the log has them."""
        self._sheet_changed = True

    # What can be asked.

    @property
    def physics(self) -> Physics:
        """The robots on their field; before READY the empty field."""
        return self.staging.physics

    @property
    def clock_ticks(self) -> int:
        """Ticks of the clock that have been used."""
        return self.ticks + self.clock_offset

    @property
    def duration_ticks(self) -> int:
        """Ticks that the match lasts; 0: without end."""
        return round(self.rules.duration_s * BEATS_PER_S)

    @property
    def next_number(self) -> int:
        """Number that the next event will get."""
        return self._event_count + 1

    def scores(
        self, state: Any = None, adjustments: dict[int, tuple[int, int]] | None = None
    ) -> tuple[int, ...]:
        """Points of each seat: the game's and the referee's."""
        scores = list(self.game.score(self.history.state if state is None else state))
        for seat, points in (self.adjustments if adjustments is None else adjustments).values():
            scores[seat] += points
        return tuple(scores)

    def winner(self) -> str:
        """Who wins by the rules if the match ends now: a seat's id, or "draw"."""
        seat = self.game.winner(self.history.state, self.scores())
        return "draw" if seat is None else self.seats[seat].id

    @property
    def time_is_up(self) -> bool:
        """Whether the last tick has been played: no other one is (rules 4)."""
        return 0 < self.duration_ticks <= self.clock_ticks

    def missing(self) -> list[str]:
        """Why the match can't be READY: everything at once, in words."""
        reasons = []
        for seat in self.seats:
            if seat.join is None:
                reasons.append(f"nobody has joined {seat.id}")
            elif not seat.ready:
                reasons.append(f"{seat.id} ({seat.team}) has not said ready")
        return reasons

    def next_joins(self) -> list[JoinSeat]:
        """Who sits where in the match after this one, with the files that they sent last."""
        joins = [seat.coming or seat.join for seat in self.seats if not seat.left]
        return [join for join in joins if join is not None]

    def legality(self) -> dict[str, str]:
        """Every decision: "" if it is legal now, else why not."""
        return referee.legality(self)

    def sheet(self) -> Sheet:
        """Everything that frames leave out."""
        return Sheet(
            protocol=PROTOCOL,
            version=__version__,
            court=self.setup.court,
            match=self.setup.match,
            match_id=self.setup.match_id,
            arena=self.arena.name,
            title=self.arena.title,
            duration_s=self.rules.duration_s,
            levels=tuple(int(level) for level in self.rules.open_levels),
            settings=self.arena.settings,
            seats=tuple(seat.sheet() for seat in self.seats),
            markers=self.game.markers,
            scene=self.physics.scene_hash,
        )

    def result(self) -> Result:
        """The result as it stands."""
        official = {Phase.OFFICIAL: self.declared or self.winner(), Phase.VOID: "void"}
        return Result(
            match_id=self.setup.match_id,
            court=self.setup.court,
            match=self.setup.match,
            arena=self.arena.name,
            teams=tuple(seat.team for seat in self.seats),
            scores=self.scores(),
            computed=self.winner() if self.ended else "",
            official=official.get(self.phase, ""),
            reason=self.ended,
            clock_s=self.clock_ticks * BEAT_S,
            beats=self.beats + 1,
            digest=self.physics.digest.hex(),
            model=self.physics.model_hash,
        )

    # One beat.

    def beat(self, inputs: Sequence[Input] = ()) -> Beat:
        """Let one beat pass."""
        self.beats += 1
        self._events = []
        self._touch = None
        self._result_changed = False
        if self.phase is Phase.CREATED:
            self.enter(Phase.LOBBY)
        if self.phase is Phase.COUNTDOWN:
            self.countdown_beats -= 1
        outcomes: list[Outcome] = [Done()] * len(inputs)
        for index in sorted(range(len(inputs)), key=lambda index: _rank(inputs[index])):
            outcomes[index] = self._take(inputs[index])
        self.staging.put_back(self.seats)
        self._move_on()
        ticked = self.phase in PHYSICS_RUNS and self._tick()
        sheet_changed, self._sheet_changed = self._sheet_changed, False
        return Beat(
            self._frame(),
            tuple(self._events),
            tuple(outcomes),
            ticked,
            self._touch,
            self.result() if self._result_changed else None,
            sheet_changed,
        )

    def _take(self, item: Input) -> Outcome:
        match item:
            case JoinSeat():
                return contestant.join(self, item)
            case LeaveSeat():
                return contestant.leave(self, self.seats[item.seat])
            case ReadySeat():
                return contestant.ready(self, self.seats[item.seat], item.ready)
            case SilentSeat():
                return contestant.silent(self, self.seats[item.seat])
            case HeardSeat():
                return contestant.heard(self, self.seats[item.seat])
            case Decide():
                return referee.decide(self, item)
            case Advice():
                return self._take_advice(item.reasons)
            case KeySeat():
                return contestant.key(self, self.seats[item.seat], item)

    def _take_advice(self, reasons: tuple[str, ...]) -> Done:
        """Log what the court measured; whether to play again is the referee's word."""
        self.advice = reasons
        because = f"Replay advised: {'; '.join(reasons)}."
        self.tell("advice", because if reasons else "A replay is not advised any more.")
        return Done()

    def _move_on(self) -> None:
        """Change phase where that needs nobody's word."""
        self.silent_beats = (self.silent_beats + 1) * all(seat.silent for seat in self.seats)
        if self.phase is Phase.LOBBY and not self.missing():
            self._build()
            self.enter(Phase.READY, model=self.physics.model_hash)
        elif self.phase is Phase.READY and self.missing():
            self.back_to_lobby()
        elif self.phase is Phase.READY and self.rules.start == "ready":
            self.begin_countdown()
        if self.phase is Phase.COUNTDOWN and self.countdown_beats <= 0:
            self.enter(Phase.PLAYING)
        if self.phase is Phase.PLAYING and self.time_is_up:  # a referee moved the clock
            self.finish("time is up")
        on = self.phase in (Phase.PLAYING, Phase.HALTED)  # a countdown leads to PLAYING
        if on and (why := contestant.unattended(self)):
            self.finish(why)

    def _tick(self) -> bool:
        """One tick of physics, judged by the rules while the match is played."""
        states = [seat.drive.tick(seat.state) for seat in self.seats if seat.drive and seat.state]
        self.fault = self.physics.step([state.angles for state in states])
        if self.fault is not None:
            self._fail(self.fault)
            return False
        for seat, state in zip(self.seats, states, strict=True):
            seat.state = state
        self.staging.look()
        if self.phase is Phase.PLAYING:
            self._judge()
        return True

    def _judge(self) -> None:
        self.ticks += 1
        observation, self._touch = self.staging.observe()
        for event in self.history.observe(observation, self.next_number):
            self.tell(
                event.kind,
                event.text.format(team=self.seats[event.seat].team),
                seat=event.seat,
                marker=event.marker,
                also=event.also,
                points=event.points,
            )
        if self.history.over:
            self.finish(self.history.over)
        elif self.time_is_up:
            self.finish("time is up")

    def _fail(self, fault: Fault) -> None:
        """MuJoCo's warning or reset: the state before the tick stands, and the match halts."""
        self.tell("fault", f"Physics stopped: {fault.text}.", seat=fault.seat, words=fault.text)
        if self.phase is Phase.PLAYING:
            self.enter(Phase.HALTED)
        else:
            for seat in self.seats:
                seat.ready = False

    # What the match does.

    def enter(self, phase: Phase, **data: Any) -> None:
        """Change the phase."""
        assert phase in TRANSITIONS[self.phase], f"{self.phase.name} to {phase.name}"
        before, self.phase, self.entered_beat = self.phase, phase, self.beats
        self.tell(
            "phase",
            f"{phase.name}" + (f": {self.ended}." if phase is Phase.FINISHED else "."),
            before=before.name,
            after=phase.name,
            **data,
        )
        if phase in (Phase.FINISHED, Phase.OFFICIAL, Phase.VOID):
            self._result_changed = True

    def back_to_lobby(self) -> None:
        """Leave READY: a robot of the model that was built is not there any more."""
        if self.phase is not Phase.READY:
            return
        self.staging.clear()
        for seat in self.seats:
            seat.drive = seat.state = None
        self._sheet_changed = True
        self.enter(Phase.LOBBY)

    def sheet_changed(self) -> None:
        """Have this beat carry the sheet."""
        self._sheet_changed = True

    def begin_countdown(self) -> None:
        """Start or resume: play begins after the countdown."""
        self.countdown_beats = round(self.rules.countdown_s * BEATS_PER_S)
        self.enter(Phase.COUNTDOWN)

    def finish(self, reason: str) -> None:
        """End play."""
        self.ended = reason
        self.enter(Phase.FINISHED)
        self._told_result = None
        self.tell_result()

    def tell_result(self) -> None:
        """Log who wins by the rules, as often as that or the score changes once play has ended."""
        if self.phase is not Phase.FINISHED:
            return
        result = winner, scores = self.winner(), self.scores()
        if result == self._told_result:
            return
        self._told_result = result
        word = "a draw" if winner == "draw" else f"{self._team(winner)} wins"
        text = f"By the rules: {word}, {' : '.join(map(str, scores))}."
        self.tell("result", text, winner=winner, scores=scores)

    def tell(self, kind: str, text: str, seat: int = NOBODY, **data: Any) -> int:
        """Log an event; returns its number."""
        self._event_count += 1
        self._events.append(
            Event(
                number=self._event_count,
                match=self.setup.match,
                beat=self.beats,
                clock_ticks=self.clock_ticks,
                kind=kind,
                text=text,
                seat=seat,
                data=data,
            )
        )
        return self._event_count

    def result_changed(self) -> None:
        """Have this beat carry the result."""
        self._result_changed = self.phase in (Phase.FINISHED, Phase.OFFICIAL, Phase.VOID)

    def _team(self, seat_id: str) -> str:
        return next(seat.team for seat in self.seats if seat.id == seat_id)

    def _build(self) -> None:
        self.staging.build(self.seats)
        level = self.rules.open_levels[0]
        for seat in self.seats:
            seat.begin(self.rules.repeat, level)
        self._sheet_changed = True

    def _frame(self) -> Frame:
        state = self.history.state
        if state is not self._shown[0]:  # it changes seldom, and frames are many
            self._shown = (state, pack_states(self.game.board(state)))
        scores = self.scores()
        return Frame(
            self.setup.match,
            self.beats,
            int(self.phase),
            self.countdown_beats if self.phase is Phase.COUNTDOWN else 0,
            self.clock_ticks,
            tuple(
                seat.frame(score, self.ticks)
                for seat, score in zip(self.seats, scores, strict=True)
            ),
            self._shown[1],
            self.staging.poses,
            self.physics.scene_hash,
            self.physics.digest,
        )


def _rank(item: Input) -> int:
    """Place of an input in the order of a beat; a seat's [x] comes before its digit."""
    match item:
        case JoinSeat() | LeaveSeat() | ReadySeat():
            return 0
        case SilentSeat() | HeardSeat() | Advice():
            return 1
        case Decide():
            return 2
        case KeySeat():
            return 3 if item.key == RESTART_KEY else 4
