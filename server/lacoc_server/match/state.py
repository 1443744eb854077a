"""The state of a match: phase, seats, clock, score and log.

`contestant` and `referee` change it on request; `match` lets its beats pass.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lacoc_arenas import arena as arenas
from lacoc_arenas.game import GameEvent
from lacoc_robots.limits import Limits
from lacoc_server.match.kept.history import History
from lacoc_server.match.physics import Fault, MakePhysics, Physics
from lacoc_server.match.seat import Seat
from lacoc_server.match.staging import Staging
from lacoc_shared import __version__
from lacoc_shared.inputs import THE_COURT, JoinSeat
from lacoc_shared.messages import PROTOCOL, Event, Sheet
from lacoc_shared.record.schema import Result, Setup
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, NOBODY, Phase
from lacoc_shared.words import Phrase, say

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
"""Phases that may follow each phase. After OFFICIAL or VOID, the decision `next` opens a new match.
"""

_ENTERED = {
    Phase.LOBBY: say("event.lobby"),
    Phase.READY: say("event.ready"),
    Phase.COUNTDOWN: say("event.countdown"),
    Phase.PLAYING: say("event.playing"),
    Phase.HALTED: say("event.halted"),
    Phase.OFFICIAL: say("event.official"),
    Phase.VOID: say("event.void"),
}
"""Log text for each phase that is entered; for FINISHED see `enter`."""

_BEGUN = frozenset({Phase.COUNTDOWN, Phase.PLAYING, Phase.HALTED, Phase.FINISHED})
_ENDED = frozenset({Phase.FINISHED, Phase.OFFICIAL, Phase.VOID})
"""Phases in which a match has a result."""


class MatchState:
    """Phase, seats, clock, score and log of one match.

    Args:
        setup: what the match is made from.
        make_physics: builds the field, with or without robots.
        folder: the arena's folder, if the arena is not installed.

    Raises:
        UserError: if the arena is not installed, or if its settings or the limits for
            robots are wrong.
    """

    def __init__(self, setup: Setup, make_physics: MakePhysics, folder: Path | None = None) -> None:
        self.setup = setup
        self.arena = arenas.from_settings(setup.arena, setup.settings, folder)
        self.game = self.arena.game
        self.limits = Limits.of(setup.limits)
        self.rules = self.arena.match
        self.duration_ticks = round(self.rules.duration_s * BEATS_PER_S)
        """Length of the match [ticks]; 0: it has no end."""
        self.phase = Phase.CREATED
        self.beats = -1
        """Number of the present beat; the first is 0, and -1 means that none has begun."""
        self.entered_beat = 0
        """Beat in which this phase began."""
        self.countdown_beats = 0
        self.ticks = 0
        """Ticks of PLAYING so far."""
        self.silent_beats = 0
        """Beats for which all seats have been silent without a break."""
        self.clock_offset = 0
        """Ticks that a referee took off the time left to play; negative: ticks given."""
        self.assigned = setup.assigned
        """The assigned seats and call; None: no court opened the match, or an older one did."""
        self.seats = [
            Seat(index, seat.id, seat.colour, seat.pattern, self._assigned_team(seat.id))
            for index, seat in enumerate(self.arena.seats)
        ]
        self.history = History(self.game)
        self.adjustments: dict[int, tuple[int, int]] = {}
        """Seat and points of each correction, by its event number."""
        self.declared: str | None = None
        """The winner that a referee declared: a seat's id or "draw"; None: none was declared."""
        self.ended: Phrase | None = None
        """Why the match ended; None: it has not."""
        self.advice: tuple[Phrase | str, ...] = ()
        """Why the match should be played again, by the court's measurement; empty: it need not be.
        """
        self.next_wanted = False
        self.fault: Fault | None = None
        """The fault that stopped physics in the newest tick; None: none did."""
        self.survives_rules = False
        """Whether an error of the game's code, which may be somebody else's, is a fault that halts
        the match. False: the error ends the program, so that the author of the game sees it."""
        self.rules_failed = False
        """Whether such an error has halted the match."""
        self.halted_by = THE_COURT
        """In a halt: who decided it; `THE_COURT` if the court or a fault did. Else `THE_COURT`."""
        self.staging = Staging(self.arena, make_physics)
        self.event_count = 0
        """Number of the newest event in the log; the first is 1."""
        self.sheet_is_new = True
        """True if the sheet changed since the last beat."""
        self.told_result: tuple[str, tuple[int, ...]] | None = None
        """Winner by the rules and scores, as last logged; None: not logged since play ended."""
        # Results of this beat so far.
        self._events: list[Event] = []
        self._result_changed = False

    # Questions.

    def _assigned_team(self, seat: str) -> str:
        found = None if self.assigned is None else self.assigned.seat(seat)
        return "" if found is None else found.team

    @property
    def by_office(self) -> bool:
        """Whether the court plays for an office; False if the court was started alone."""
        return self.assigned is not None and not self.assigned.is_alone

    @property
    def physics(self) -> Physics:
        """The robots on their field; in the lobby the field is empty."""
        return self.staging.physics

    @property
    def has_begun(self) -> bool:
        """True from the first countdown to FINISHED, also in a halt; not when OFFICIAL or VOID."""
        return self.phase in _BEGUN

    @property
    def is_over(self) -> bool:
        """True if nothing more is played: the match is official or void, or none is assigned."""
        waits = self.assigned is not None and self.assigned.waits
        return waits or self.phase in (Phase.OFFICIAL, Phase.VOID)

    @property
    def clock_ticks(self) -> int:
        """Ticks of the clock that have been used, with the referee's corrections of the clock."""
        return self.ticks + self.clock_offset

    @property
    def time_is_up(self) -> bool:
        """True if the clock has no ticks left (docs/rules.md 4), also after a referee moved it.

        A match without a time limit never runs out of time.
        """
        return 0 < self.duration_ticks <= self.clock_ticks

    @property
    def next_number(self) -> int:
        """The number that the next event will get."""
        return self.event_count + 1

    def scores(
        self, state: Any = None, adjustments: Mapping[int, tuple[int, int]] | None = None
    ) -> tuple[int, ...]:
        """Add up each seat's points: the game's and the referee's.

        Args:
            state: a state of the game; None: the present one.
            adjustments: corrections by event number; None: the present ones.
        """
        points = self.game.score(self.history.state if state is None else state)
        return self._adjusted(points, adjustments)

    def _adjusted(
        self, points: tuple[int, ...], adjustments: Mapping[int, tuple[int, int]] | None = None
    ) -> tuple[int, ...]:
        """Add the referee's points to the game's."""
        adjustments = self.adjustments if adjustments is None else adjustments
        if not adjustments:
            return points
        scores = list(points)
        for seat, more in adjustments.values():
            scores[seat] += more
        return tuple(scores)

    def winner(self) -> str:
        """Find who wins by the rules if the match ends now: a seat's id, or "draw"."""
        seat = self.game.winner(self.history.state, self.scores())
        return "draw" if seat is None else self.seats[seat].id

    def team(self, seat_id: str) -> str:
        """Return the team of a seat, by the seat's id."""
        return next(seat.team for seat in self.seats if seat.id == seat_id)

    def missing(self) -> list[Phrase]:
        """List everything that the match still needs to become READY (texts `why.*`)."""
        reasons = []
        for seat in self.seats:
            if seat.join is None:
                reasons.append(say("why.nobody-in-seat", seat=seat.id))
            elif not seat.ready:
                reasons.append(say("why.not-ready", seat=seat.id, team=seat.team))
        return reasons

    def next_joins(self) -> list[JoinSeat]:
        """List the requests to join with which the next match begins: the newest of each seat.

        A contestant who left after the match had begun, and did not come back, is not among them.
        """
        joins = [seat.coming or seat.join for seat in self.seats if not seat.left]
        return [join for join in joins if join is not None]

    def sheet(self) -> Sheet:
        """Describe the match: everything that frames leave out."""
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
            call=self.assigned.call if self.assigned else "",
            fixture=self.assigned.fixture if self.assigned and self.by_office else None,
            rule=self.game.rule,
        )

    def result(self) -> Result:
        """Return the present result; fields that are not decided yet are empty."""
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
            reason=self.ended or "",
            clock_s=self.clock_ticks * BEAT_S,
            beats=self.beats + 1,
            digest=self.physics.digest.hex(),
            model=self.physics.model_hash,
        )

    # Changes.

    def enter(self, phase: Phase, **data: Any) -> None:
        """Enter a phase and log it; at the end of the match, also mark the result as changed."""
        assert phase in TRANSITIONS[self.phase], f"{self.phase.name} to {phase.name}"
        before, self.phase, self.entered_beat = self.phase, phase, self.beats
        self.halted_by = THE_COURT
        said = _ENTERED.get(phase) or say("event.finished", why=self.ended)
        self.tell("phase", said, before=before.name, after=phase.name, **data)
        if phase in _ENDED:
            self._result_changed = True

    def build(self) -> None:
        """Put the robots of all seats on the field, and give each seat the drive of its robot."""
        self.staging.build(self.seats)
        self.begin_drives()
        self.sheet_changed()

    def begin_drives(self) -> None:
        """Give each seat its drive, with which its robot stands."""
        level = self.rules.open_levels[0]
        for seat in self.seats:
            seat.begin(self.rules.repeat, level)

    def back_to_lobby(self) -> None:
        """Go from READY back to the lobby and empty the field; in other phases do nothing."""
        if self.phase is not Phase.READY:
            return
        self.staging.clear()
        for seat in self.seats:
            seat.drive = seat.state = None
            seat.restarting = False
        self.sheet_changed()
        self.enter(Phase.LOBBY)

    def begin_countdown(self) -> None:
        """Begin the countdown, after which play starts or goes on."""
        self.countdown_beats = round(self.rules.countdown_s * BEATS_PER_S)
        self.enter(Phase.COUNTDOWN)

    def finish(self, why: Phrase) -> None:
        """End play and log the result.

        Args:
            why: phrase of the texts `over.*`.
        """
        self.ended = why
        self.enter(Phase.FINISHED)
        self.told_result = None
        self.tell_result()

    def take_up(self, physics: Physics, make_physics: MakePhysics) -> None:
        """Replace the physics of the match; the new one steps it from the next beat on.

        Args:
            physics: the robots on their field, where they are now.
            make_physics: builds any later physics.
        """
        self.staging.physics = physics
        self.staging.make_physics = make_physics

    # The log.

    def tell(self, kind: str, said: Phrase, seat: int = NOBODY, **data: Any) -> int:
        """Log an event and return its number."""
        self.event_count += 1
        self._events.append(
            Event(
                number=self.event_count,
                match=self.setup.match,
                beat=self.beats,
                clock_ticks=self.clock_ticks,
                kind=kind,
                said=said,
                seat=seat,
                data=data,
            )
        )
        return self.event_count

    def tell_judged(self, event: GameEvent, again: bool = False) -> None:
        """Log an event that the rules decided.

        Args:
            event: event of the game.
            again: whether the rules judged it again, because an earlier event was taken back.
        """
        said = event.said.with_values(team=self.seats[event.seat].team)
        self.tell(
            event.kind,
            say("event.judged-again", event=said) if again else said,
            seat=event.seat,
            marker=event.marker,
            also=event.also,
            points=event.points,
        )

    def tell_result(self) -> None:
        """In FINISHED, log winner and scores by the rules if they differ from those logged last."""
        if self.phase is not Phase.FINISHED:
            return
        result = winner, scores = self.winner(), self.scores()
        if result == self.told_result:
            return
        self.told_result = result
        if winner == "draw":
            said = say("event.draw", scores=scores)
        else:
            said = say("event.wins", team=self.team(winner), scores=scores)
        self.tell("result", said, winner=winner, scores=scores)

    def result_changed(self) -> None:
        """Mark the result as changed, if there is one: then the present `Beat` has the result."""
        self._result_changed = self.phase in _ENDED

    def sheet_changed(self) -> None:
        """Mark the sheet as changed: then `sheet_changed` is set in the present `Beat`."""
        self.sheet_is_new = True
