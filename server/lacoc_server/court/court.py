"""A court: the loop that gives a match its beats. No other part of it reads the monotonic clock.

The loop, the outbox that sends, the stand tests, and the archive that stores the records of
finished matches each have a thread. A beat takes what arrived, passes it to the match and records
it, and only then answers and publishes: everything that anybody is told is on disk
(docs/architecture.md). While the disk refuses writes, the court waits and no beat passes.
"""

import hashlib
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from lacoc_arenas.arena import Arena
from lacoc_server.court import unjudged
from lacoc_server.court.archive import RecordArchive
from lacoc_server.court.assigning import Prepared, staying
from lacoc_server.court.health import MatchHealth
from lacoc_server.court.key_trials import KeyTrials
from lacoc_server.court.log import CourtLog
from lacoc_server.court.metrics import CourtMetrics
from lacoc_server.court.outlooks import Outlooks
from lacoc_server.court.pace import Pace
from lacoc_server.court.try_outs import TryOuts
from lacoc_server.doors.network import Arrival, CourtNetwork
from lacoc_server.doors.office_desk import OfficeDesk, WantedMatch
from lacoc_server.journal.journal import Journal
from lacoc_server.journal.recovery import Unfinished
from lacoc_server.match.match import Beat, Match
from lacoc_server.world.world import World
from lacoc_shared.command.priority import go_first, take_turns
from lacoc_shared.contest.health_limits import HealthLimits
from lacoc_shared.decisions import Abort, Halt
from lacoc_shared.inputs import THE_COURT, Advice, Decide, Input, JoinSeat
from lacoc_shared.messages import Gains, Health, HealthVerdict, Outcome
from lacoc_shared.messages.office import WAITING, Assigned
from lacoc_shared.mistakes import UserError
from lacoc_shared.network import heap
from lacoc_shared.record.matches import MatchName
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import BEATS_PER_S, IN_PLAY, Phase
from lacoc_shared.words import Phrase, say

HEALTH_BEATS = BEATS_PER_S // 2
"""Beats between two health messages: two messages a second."""
_LEAST_FACTOR = 0.9
"""Real-time factor below which the court does not raise its priority over other programs."""


@dataclass(frozen=True)
class CourtSettings:
    """Settings that a court is started with."""

    name: str
    arena: Arena
    limits: Mapping[str, float]
    """Contest limits for robots, where they differ from the defaults of rules 1."""
    recordings: Path | None
    """Folder of the records; None: no record."""
    assigned: Assigned = WAITING
    """The match to play before the office assigns one. A court of a contest waits; a court that was
    started alone repeats an open match."""
    speed: float = 1.0
    """Multiple of real time: at 1 a beat takes 20 ms, at 2 it takes 10 ms."""
    health: HealthLimits = field(default_factory=HealthLimits)
    """Limits beyond which a match should be played again."""


class _Made(NamedTuple):
    """A computed beat. Its frame, and the outcomes of what arrived for it, are still to be sent."""

    beat: Beat
    frame: bytes
    arrivals: Sequence[Arrival]
    outcomes: Sequence[Outcome]
    """One outcome for each arrival."""


class Court:
    """Holds one match at a time.

    Args:
        settings: the settings that the court is started with.
        network: connects the court to others; opened by the caller.
        left: the match of an earlier court, to go on with, or to show again if it is over.
        office: the desk of the contest's office, if it has one: the court then plays only what the
            office assigns.
        outlooks: answers referees who ask what would happen if play went on.
        key_trials: says what the keys of seated robots do.
        try_outs: lets players try their keys in the lobby.
    """

    def __init__(
        self,
        settings: CourtSettings,
        network: CourtNetwork,
        left: Unfinished | None = None,
        office: OfficeDesk[Prepared] | None = None,
        outlooks: Outlooks | None = None,
        key_trials: KeyTrials | None = None,
        try_outs: TryOuts | None = None,
    ) -> None:
        self._office = office
        self._outlooks = outlooks
        self._key_trials = key_trials
        self._try_outs = try_outs
        self._settings = settings
        self._network = network
        self._log = CourtLog(settings.name)
        self.metrics = CourtMetrics(settings.name)
        """The court's numbers for Prometheus."""
        self._scene = b""
        self._archive = RecordArchive(settings.recordings, settings.name, self._log)
        self._pace = Pace(time.monotonic(), settings.speed, _offset_s(network.locators))
        self._inputs: list[Input] = []
        """The court's own inputs for the next beat."""
        self._made: _Made | None = None
        """A computed beat that has not been sent yet."""
        self._frame = b""
        """The newest published frame, encoded; empty before the first."""
        self._trouble: Phrase | None = None
        """The problem with the record's disk (texts `record.*`); None: there is none."""
        self._told_gains: tuple[Gains, ...] = ()
        """What each robot would gain next, as the newest health message said."""
        self._waits = 0
        """Number of beats skipped in a row because the disk refuses writes."""
        if left is None:
            self._journal = self._open(1, None)
        else:
            folder = None if left.is_recorded else settings.recordings
            self._journal = self._journal_of(left.match, folder, left.segment, left.health)
            self._inputs = left.inputs
            network.publish_sheet(left.match.sheet())
            for event in left.events:
                network.publish_event(event)
        self._network.admit(self._assigned, [*range(len(self._journal.match.seats))])

    @property
    def match_id(self) -> str:
        """Id of the open match; it names the record."""
        return self._journal.match.setup.match_id

    @property
    def is_idle(self) -> bool:
        """Whether no match is in play: none has begun, or it is over."""
        match = self._journal.match
        return match.is_over or not match.has_begun

    def run(self, stopping: Callable[[], bool]) -> None:
        """Give the match its beats until `stopping` returns True; then finish the record.

        An error in the loop ends the court but not its match: when the court is started again, it
        goes on with the match. It also goes on with an assigned match that was not over when the
        court was stopped, because the office waits for the result.
        """
        pace = self._pace
        self._archive.pack(self.match_id)
        try:
            while not stopping():
                time.sleep(pace.wait_s(time.monotonic()))
                now_s = time.monotonic()
                pace.begin(now_s)
                self._health.begin(now_s, pace.late_s, self._network.doors())
                self._beat(now_s)
                self.metrics.beat(time.monotonic() - now_s)
                if self._journal.match.beats % HEALTH_BEATS == 0:
                    self._choose_priority()
        except BaseException:
            self._journal.leave()
            raise
        finally:
            take_turns()
        match = self._journal.match
        if match.by_office and not match.is_over:
            self._journal.leave()
        else:
            self._close()
        self._archive.close()

    def _choose_priority(self) -> None:
        """Raise this thread's priority while the court keeps real time; else use normal priority.

        A court that is behind never sleeps: at a high priority it would starve other processes.
        """
        if self._settings.speed <= 1 and self._pace.real_time_factor > _LEAST_FACTOR:
            go_first()
        else:
            take_turns()

    def _beat(self, now_s: float) -> None:
        try:
            if self._made is None:
                if self._journal.match.next_wanted or self._may_open:
                    self._open_next()
                self._made = self._make(now_s)
            self._journal.flush()
        except UserError as trouble:
            self._wait(now_s, trouble.phrase)
            return
        made, self._made, self._waits = self._made, None, 0
        if self._office is not None:
            assigned = self._journal.match.assigned
            self._office.hold(assigned.call if assigned else "", self._journal.match.phase)
        self._inputs = self._follow()
        self._tell(made, now_s)

    def _make(self, now_s: float) -> _Made:
        """Compute one beat of the match."""
        own, self._inputs = self._inputs, []
        match, network = self._journal.match, self._network
        silent = [seat.silent for seat in match.seats]
        # In its first beat a match takes the teams of the last one.
        coming = {item.seat: item for item in own if isinstance(item, JoinSeat)}
        held = [coming.get(seat.index) or seat.coming or seat.join for seat in match.seats]
        network.hold(held, match.has_begun)
        if self._outlooks is not None:
            self._outlooks.hold(match)
        if self._try_outs is not None:
            self._try_outs.hold(match)
        arrivals = network.poll(now_s, match.setup.match, match.beats + 1, silent)
        beat, frame = self._journal.beat([*own, *(arrival.input for arrival in arrivals)])
        return _Made(beat, frame, arrivals, beat.outcomes[len(own) :])

    def _wait(self, now_s: float, trouble: Phrase) -> None:
        """Skip a beat, because nobody may be told what is not on disk.

        The last frame is published again, so that nobody thinks the court is dead. Requests are
        refused with the disk's trouble.
        """
        self._trouble = trouble
        self._network.turn_away(trouble)
        if self._frame:
            self._network.publish_again(self._frame)
        if self._waits % HEALTH_BEATS == 0:
            self._say_health(now_s)
        self._waits += 1

    def _tell(self, made: _Made, now_s: float) -> None:
        """Answer and publish the results of a beat."""
        match, network, beat = self._journal.match, self._network, made.beat
        for arrival, outcome in zip(made.arrivals, made.outcomes, strict=True):
            if arrival.answer is not None:
                arrival.answer(outcome)
        self._frame = made.frame
        network.publish_frame(made.frame, time.monotonic())
        for event in beat.events:
            network.publish_event(event)
            self._log.event(self.match_id, event, match.duration_ticks)
        if match.physics.scene_hash != self._scene:
            self._scene = match.physics.scene_hash
            network.publish_scene(match.physics.scene)
        if beat.sheet_changed:
            network.publish_sheet(match.sheet())
        if match.beats % HEALTH_BEATS == 0 or self._gains() != self._told_gains:
            self._say_health(now_s)

    def _gains(self) -> tuple[Gains, ...]:
        """Return the points that each robot could gain next; () if the game's code is wrong."""
        try:
            return self._journal.match.gains()
        except UserError as wrong:
            self._log.rules(self.match_id, wrong.phrase)
            return ()

    def _moves(self) -> tuple[tuple[str, ...], ...]:
        """Return in a word what each key of each seat does, as far as the keys were tried.

        No key is tried while two robots may play.
        """
        match, trials = self._journal.match, self._key_trials
        if trials is None:
            return ()
        may_begin = match.phase <= Phase.LOBBY or len(match.seats) == 1
        return tuple(trials(seat, may_begin) for seat in match.seats)

    def _open_next(self) -> None:
        # Making a match takes longer than a beat: while the disk fails, try it twice a second.
        if self._waits % HEALTH_BEATS:
            raise UserError(self._trouble or "")
        match, wanted = self._journal.match, self._wanted
        following = self._open(match.setup.match + 1, wanted and wanted.prepared)
        self._close()
        self._journal = following
        heap.give_back()  # return the memory of the last match's models
        joins = staying(match.next_joins(), self._assigned, [seat.id for seat in match.seats])
        if not self._assigned.is_alone:
            self._log.assigned(self.match_id, self._assigned)
        self._inputs = list(joins)
        self._network.admit(self._assigned, [join.seat for join in joins])

    @property
    def _assigned(self) -> Assigned:
        """What is assigned to this match; if the court was started alone, what its settings say.

        After a restart the settings have new tokens, which the interrupted match does not have.
        """
        assigned, own = self._journal.match.assigned, self._settings.assigned
        return own if assigned is None or assigned.is_alone else assigned

    @property
    def _wanted(self) -> WantedMatch[Prepared] | None:
        return None if self._office is None else self._office.wanted

    @property
    def _may_open(self) -> bool:
        """Whether the next match may open: the office wants one, and the present one is over."""
        return self._wanted is not None and self._journal.match.is_over

    def _follow(self) -> list[Input]:
        """Return the court's own inputs for the next beat: decisions, or advice to play again."""
        match, before = self._journal.match, self._trouble
        wanted = self._wanted
        if wanted is not None and not match.is_over and (wanted.ends or not match.has_begun):
            reason = say("reason.office-takes-match", why=wanted.why)
            return [Decide(THE_COURT, reason, Abort())]
        self._trouble = now = self._journal.trouble
        why = before or now
        if before != now and why is not None and match.phase in IN_PLAY:
            return [Decide(THE_COURT, why, Halt())]
        if match.phase is Phase.FINISHED:
            reasons = self._health.verdict().advice
            if reasons != match.advice:
                return [Advice(reasons)]
        if match.rules.start == "ready":
            return unjudged.decisions(match, self._held)
        return []

    def _held(self) -> list[bool]:
        return [bool(one.session) for one in self._network.seat_health(time.monotonic())]

    def _open(self, number: int, prepared: Prepared | None) -> Journal:
        settings = self._settings
        arena, limits, assigned = settings.arena, settings.limits, settings.assigned
        if prepared is not None:
            arena, limits, assigned = prepared.arena, prepared.limits, prepared.assigned
        setup = Setup(
            match_id=str(MatchName.new(settings.recordings, settings.name, number)),
            court=settings.name,
            match=number,
            arena=arena.name,
            settings=arena.settings,
            limits=dict(limits),
            assigned=assigned,
        )
        folder = None if assigned.waits else settings.recordings
        match = Match(setup, World, arena.folder)
        match.survives_rules = True  # other matches go on at this court
        return self._journal_of(match, folder)

    def _journal_of(
        self,
        match: Match,
        folder: Path | None,
        segment: int = 0,
        before: HealthVerdict | None = None,
    ) -> Journal:
        settings = self._settings
        self._health = MatchHealth(
            match,
            settings.health,
            self._network.doors(),
            speed=settings.speed,
            before=before,
            resumptions=segment,
        )
        return Journal(match, folder, segment, self._health.measure)

    def _close(self) -> None:
        """Have the archive close the record of this match, and make one file of it."""
        self._archive.take(self.match_id, self._journal.writer)

    def _say_health(self, now_s: float) -> None:
        pace, match = self._pace, self._journal.match
        self._told_gains = self._gains()
        health = Health(
            match=match.setup.match,
            beat=match.beats,
            real_time_factor=pace.real_time_factor,
            slow_beats=pace.slow_beats,
            worst_late_ms=pace.worst_late_s * 1000,
            seats=self._network.seat_health(now_s),
            dropped=self._network.dropped,
            decisions=match.legality(),
            verdict=self._health.verdict(),
            record_trouble=self._trouble,
            input_delay_ms=self._network.input_delay_ms,
            events=self._network.newest_event,
            sheet=self._network.sheet_hash,
            gains=self._told_gains,
            moves=self._moves(),
        )
        self._network.publish_health(health)
        self._log.health(self.match_id, health)
        self.metrics.health(self.match_id, health, self._network.doors())


def _offset_s(locators: tuple[str, ...]) -> float:
    """Return the fraction of a second by which a court's beats are shifted.

    The fraction is made from the court's addresses: two courts on a machine may share a name, but
    never an address.
    """
    return int.from_bytes(hashlib.blake2b(repr(locators).encode(), digest_size=4).digest()) / 2**32
