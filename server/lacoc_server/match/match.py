"""A match: one beat after another (docs/rules.md 4).

A match is a pure function of its setup and its inputs. It reads no clock, opens no socket and knows
physics only as a protocol. Live, headless and in a replay the same inputs give the same match, bit
for bit.

A beat favours no seat. Its order: requests of contestants, silences, the referee's decisions, every
seat's [x], every seat's digit, one tick of physics, the rules.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec

from lacoc_robots.standing import FARTHEST_M
from lacoc_server.match import contestant, referee
from lacoc_server.match.kept import saved
from lacoc_server.match.physics import Fault, MakePhysics
from lacoc_server.match.state import MatchState
from lacoc_shared.codec import pack_states
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
from lacoc_shared.messages import Done, Event, Frame, Gains, Outcome
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.schema import Result, Setup, Touch
from lacoc_shared.seat import RESTART_KEY, Phase
from lacoc_shared.words import Phrase, say

PHYSICS_RUNS = frozenset({Phase.READY, Phase.PLAYING})
# Each beat asks for these, and Python looks up a member of an enum slowly.
_CREATED, _COUNTDOWN, _PLAYING = Phase.CREATED, Phase.COUNTDOWN, Phase.PLAYING

MOST_STRAYS = 3
"""When a robot has left its start place this often before play, its team is no longer ready."""


class Beat(msgspec.Struct, frozen=True):
    """The results of a beat."""

    frame: Frame
    events: tuple[Event, ...]
    outcomes: tuple[Outcome, ...]
    """One for each input, in the order of the inputs."""
    ticked: bool
    """True if a tick of physics passed; False also after a fault."""
    touch: Touch | None
    """Touches and new places of robots, which poses do not show; None: there were none."""
    result: Result | None
    """The result, in a beat that ended the match or decided something after its end; else None."""
    sheet_changed: bool


class Match(MatchState):
    """One match, from CREATED to OFFICIAL or VOID: its state, and the beats that change it."""

    def __init__(self, setup: Setup, make_physics: MakePhysics, folder: Path | None = None) -> None:
        super().__init__(setup, make_physics, folder)
        self._touch: Touch | None = None
        self._shown: tuple[Any, bytes, tuple[int, ...]] = (None, b"", ())
        """The last game state that was packed, its board as in frames, and each seat's points."""
        self._gains: tuple[Any, tuple[Gains, ...]] = (None, ())
        """The last game state for which gains were computed, and the gains of each seat."""

    def legality(self) -> dict[str, Phrase | None]:
        """Return for each decision, by name, None if it is legal now, else why not."""
        return referee.legality(self)

    def gains(self) -> tuple[Gains, ...]:
        """Return the points that each robot could gain next; empty before READY and after play.

        Raises:
            UserError: if the code of the game, which may be somebody else's, is wrong.
        """
        if not Phase.READY <= self.phase <= Phase.HALTED:
            return ()
        state = self.history.state
        if state is not self._gains[0]:
            seats = range(len(self.seats))
            self._gains = (state, tuple(self.game.gains(state, seat) for seat in seats))
        return self._gains[1]

    def save(self) -> bytes:
        """Return all that the match is between two beats, its physics too.

        After `load` the same inputs then give the same beats, bit for bit. The bytes of a match
        of three minutes are 1 MB, or 10 kB if its `history` keeps nothing.
        """
        return saved.save(self)

    def load(self, data: bytes) -> None:
        """Go on from a saved match: the same inputs then give the same beats, bit for bit.

        The match may be a new one. Robots are built only if the field has none, or other ones.

        Args:
            data: bytes of `save`, from a match with the same arena, settings and limits. The id of
                the match, and what an office assigned, may differ.

        Raises:
            ValueError: if the bytes are not of such a match, or if this match has the poses of a
                record instead of physics.
        """
        saved.load(self, data)

    def beat(self, inputs: Sequence[Input] = ()) -> Beat:
        """Let one beat pass.

        Args:
            inputs: inputs of the beat, in any order. They are applied in the order of their ranks.

        Returns:
            The results of the beat, with an outcome for each input.
        """
        outcomes, ticked = self._pass(inputs)
        sheet_changed, self.sheet_is_new = self.sheet_is_new, False
        return Beat(
            self.frame(),
            tuple(self._events),
            outcomes,
            ticked,
            self._touch,
            self.result() if self._result_changed else None,
            sheet_changed,
        )

    def skip(self, inputs: Sequence[Input] = ()) -> None:
        """Let one beat pass whose results nobody needs; `frame` shows the match after it."""
        self._pass(inputs)

    def _pass(self, inputs: Sequence[Input]) -> tuple[tuple[Outcome, ...], bool]:
        """Let one beat pass; return the outcomes, and whether a tick of physics passed."""
        self.beats += 1
        self._events = []
        self._touch = None
        self._result_changed = False
        if self.phase is _CREATED:
            self.enter(Phase.LOBBY)
        if self.phase is _COUNTDOWN:
            self.countdown_beats -= 1
        outcomes = self._take_all(inputs) if inputs else ()
        self.staging.put_back(self.seats)
        self._move_on()
        return outcomes, self.phase in PHYSICS_RUNS and self._tick()

    def _take_all(self, inputs: Sequence[Input]) -> tuple[Outcome, ...]:
        """Apply a beat's inputs by rank; return the outcomes in the order of the inputs."""
        outcomes: list[Outcome] = [Done()] * len(inputs)
        for index in sorted(range(len(inputs)), key=lambda index: _rank(inputs[index])):
            outcomes[index] = self._take(inputs[index])
        return tuple(outcomes)

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

    def _take_advice(self, reasons: tuple[Phrase | str, ...]) -> Done:
        """Log the court's advice; whether to play again is the referee's decision."""
        self.advice = reasons
        advised = say("event.advised", reasons=reasons) if reasons else say("event.not-advised")
        self.tell("advice", advised)
        return Done()

    def _move_on(self) -> None:
        """Change the phase if that needs no decision: readiness, countdown, time and absence."""
        heard = [seat for seat in self.seats if not seat.silent]
        self.silent_beats = 0 if heard else self.silent_beats + 1
        if self.phase is not _PLAYING:
            self._move_to_play()
        if self.phase is _PLAYING and self.time_is_up:  # after a referee moved the clock
            self.finish(say("over.time"))
        # A match without a referee ends when nobody is there, but never in a countdown.
        if self.rules.start == "ready" and self.phase in (Phase.PLAYING, Phase.HALTED):
            why = contestant.unattended(self)
            if why:
                self.finish(why)

    def _move_to_play(self) -> None:
        """Enter READY when every seat is ready; go back to the lobby when one no longer is.

        Without a referee, also begin the countdown. Enter PLAYING at the end of every countdown.
        """
        if self.phase is Phase.LOBBY and not self.missing():
            self.build()
            self.enter(Phase.READY, model=self.physics.model_hash)
        elif self.phase is Phase.READY and self.missing():
            self.back_to_lobby()
        elif self.phase is Phase.READY and self.rules.start == "ready":
            self.begin_countdown()
        if self.phase is _COUNTDOWN and self.countdown_beats <= 0:
            self.enter(Phase.PLAYING)

    def _tick(self) -> bool:
        """Let a tick of physics pass; in PLAYING, let the rules judge it.

        Returns:
            Whether the tick passed; False after a fault.
        """
        states = [seat.drive.tick(seat.state) for seat in self.seats if seat.drive and seat.state]
        self.fault = self.physics.step([state.angles for state in states])
        if self.fault is not None:
            self._fail(self.fault)
            return False
        for seat, state in zip(self.seats, states, strict=True):
            seat.state = state
        self.staging.look()
        if self.phase is _PLAYING:
            self._judge()
        else:
            self._hold_places()
        return True

    def _hold_places(self) -> None:
        """Mark robots that have left their start places before play, so that they are put back.

        A seat whose robot strayed `MOST_STRAYS` times is no longer ready.
        """
        for seat in self.seats:
            gone_m = self.staging.from_start_m(seat.index)
            if gone_m <= FARTHEST_M:
                continue
            seat.strays += 1
            said = say("event.strayed", team=seat.team, distance_m=gone_m)
            if seat.strays == MOST_STRAYS:
                said = say("event.strayed-often", team=seat.team, times=MOST_STRAYS)
                seat.ready = False
            self.tell("strayed", said, seat=seat.index, distance_m=gone_m, times=seat.strays)
            seat.restart()

    def _judge(self) -> None:
        self.ticks += 1
        observation, self._touch = self.staging.observe()
        idle = tuple([seat.index for seat in self.seats if seat.idle])
        try:
            events = self.history.observe(observation, self.next_number, idle)
        except UserError as wrong:
            if not self.survives_rules:
                raise
            self.rules_failed = True
            self.tell("rules", say("event.rules-failed", why=wrong.phrase))
            self.enter(Phase.HALTED)
            return
        for event in events:
            self.tell_judged(event)
        if self.history.over:
            self.finish(self.history.over)
        elif self.time_is_up:
            self.finish(say("over.time"))

    def _fail(self, fault: Fault) -> None:
        """Log a fault. A match in play halts; before play no seat is ready any more."""
        self.tell("fault", say("event.fault", why=fault.why), seat=fault.seat)
        if self.phase is _PLAYING:
            self.enter(Phase.HALTED)
        else:
            for seat in self.seats:
                seat.ready = False

    def frame(self) -> Frame:
        """Return the frame of the newest beat."""
        game, state = self.game, self.history.state
        if state is not self._shown[0]:  # the state changes seldom, and there are many frames
            self._shown = (state, pack_states(game.board(state)), game.score(state))
        _, board, points = self._shown
        seats, scores, ticks = self.seats, self._adjusted(points), self.ticks
        return Frame(
            self.setup.match,
            self.beats,
            int(self.phase),
            self.countdown_beats if self.phase is _COUNTDOWN else 0,
            self.clock_ticks,
            tuple([seat.frame(score, ticks) for seat, score in zip(seats, scores, strict=True)]),
            board,
            self.staging.poses,
            self.physics.scene_hash,
            self.physics.digest,
        )


def _rank(item: Input) -> int:
    """Return an input's rank in a beat's order; a seat's [x] comes before its digit."""
    match item:
        case JoinSeat() | LeaveSeat() | ReadySeat():
            return 0
        case SilentSeat() | HeardSeat() | Advice():
            return 1
        case Decide():
            return 2
        case KeySeat():
            return 3 if item.key == RESTART_KEY else 4
