"""The inputs of a fork, beat by beat: recorded ones, and those that replace or add to them; pure.

A change follows the rules of a court. An event can be taken back only in a halt, so a fork in play
is halted and resumed for that. All inputs that were recorded later are delayed by the same time.
"""

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_server.match.match import Match
from lacoc_shared.decisions import Decision, Halt, Restart, Resume, TakeBack
from lacoc_shared.inputs import Advice, Decide, HeardSeat, Input, KeySeat, SilentSeat
from lacoc_shared.messages import Frame
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S, IN_PLAY, Phase
from lacoc_shared.words import say

REFEREE = "fork"
"""Referee's name in the decisions that a fork adds."""
_SEARCH_BEATS = BEATS_PER_S
"""Number of beats among which one without recorded inputs is searched, for a take-back. If there is
none, the take-back is in the first beat."""
_SILENT_BEATS = BEATS_PER_S
"""Beats after the last recorded one until seats with recorded keys fall silent, as at a court."""
_LATE_TICKS = BEATS_PER_S
"""Longest delay before a bot sees its first frame [ticks]."""
_REACTION_TICKS = BEATS_PER_S // 5
"""Longest delay from a bot's choice of a key to its press [ticks]."""
_OVER = frozenset({Phase.OFFICIAL, Phase.VOID})

Press = Callable[[Match, Frame], Key | None]
"""Called with the match and its frame after each beat of PLAYING; returns the key for the next
beat, or None."""


@dataclass(frozen=True)
class ForkChange:
    """What differs between a fork and its record; by default nothing."""

    take_back: int | None = None
    """Number of the event that is taken back; None: no event is."""
    restart: tuple[str, ...] = ()
    """Ids of the seats whose robots are put back at a start place."""
    players: Mapping[int, Callable[[], Press]] = field(default_factory=dict)
    """Makes the new player of a seat, by index of the seat; all other seats keep their recorded
    keys."""

    @property
    def is_none(self) -> bool:
        """True if the fork has the same inputs as the record."""
        return self.take_back is None and not self.restart and not self.players


class ForkLine:
    """Makes the inputs of a fork, beat by beat.

    Args:
        record: the record of the match, whole.
        match: the match after the beat before the fork.
        change: how the fork differs from the record.
        seconds: how long the fork goes on at most [s]; but it goes on until its change is made.
            None: until play ends.
    """

    def __init__(
        self, record: Record, match: Match, change: ForkChange, seconds: float | None = None
    ) -> None:
        self.match = match
        self.decided_beat: int | None = None
        """Beat in which the decisions of the change are made; None: not yet, or there are none."""
        self.left_out = 0
        """Number of recorded take-backs that were left out: they name events after the fork's first
        beat, and the fork's own events may have other numbers.
        """
        self._change = change
        self._first = match.beats + 1
        self._first_number = match.next_number
        self._recorded = dict(self._kept(record))
        self._last_recorded = record.last_beat if self._kept_seats else match.beats
        self._shift = 0
        self._limit = None if seconds is None else match.beats + round(seconds * BEATS_PER_S)
        self._decides_at = self._free_beat() if change.take_back is not None else self._first
        self._players = {seat: make() for seat, make in change.players.items()}
        self._seqs = {seat: match.seats[seat].applied[0] for seat in self._players}
        self._pressed: list[Input] = []

    @property
    def is_over(self) -> bool:
        """True if the fork is over, so that no further beat is played."""
        match = self.match
        if match.beats < max(self._first, self._decides_at):
            return False
        if self._limit is not None and match.beats >= self._limit:
            return True
        if not self._change.is_none and match.phase is Phase.FINISHED:
            return True  # nobody makes the result of a changed fork official
        if match.beats < self._last_recorded + self._shift:
            return match.phase in _OVER and not self._change.is_none
        ends = bool(match.duration_ticks) or self._limit is not None
        return match.phase not in IN_PLAY or not ends

    def inputs(self) -> list[Input]:
        """Return the inputs of the next beat."""
        match, beat = self.match, self.match.beats + 1
        found: list[Input] = []
        if beat == self._first:
            found += (HeardSeat(seat) for seat in self._players if match.seats[seat].silent)
        if beat <= self._decides_at:
            found += self._recorded.get(beat, ())
        else:
            source = beat - self._shift
            found += self._recorded.get(source, ()) if source > self._decides_at else ()
        if beat == self._decides_at:
            found += self._decisions()
        if beat == self._last_recorded + self._shift + _SILENT_BEATS:
            found += (
                SilentSeat(seat)
                for seat in self._kept_seats
                if match.seats[seat].join and not match.seats[seat].silent
            )
        found += self._pressed
        self._pressed = []
        return found

    def see(self, frame: Frame) -> None:
        """In PLAYING, show the new players the frame of a beat; note the keys that they press."""
        match = self.match
        if match.phase is not Phase.PLAYING:
            return
        for seat, press in self._players.items():
            key = press(match, frame)
            if key is not None:
                self._seqs[seat] += 1
                self._pressed.append(KeySeat(seat, self._seqs[seat], int(key.level), key.key))

    @property
    def _kept_seats(self) -> list[int]:
        """Indices of the seats that press their recorded keys."""
        return [seat.index for seat in self.match.seats if seat.index not in self._change.players]

    def _kept(self, record: Record) -> Iterator[tuple[int, list[Input]]]:
        """Yield each beat of the record with those of its inputs that the fork keeps."""
        for beat, items in record.inputs.items():
            if beat >= self._first and (kept := [item for item in items if self._keeps(item)]):
                yield beat, kept

    def _keeps(self, item: Input) -> bool:
        if isinstance(item, Decide) and isinstance(item.decision, TakeBack):
            is_later = item.decision.event >= self._first_number
            if is_later and not self._change.is_none:
                self.left_out += 1
                return False
        if isinstance(item, Decide | Advice):
            # If others play all seats, the referee's decisions fit nothing any more.
            return bool(self._kept_seats)
        return item.seat not in self._change.players

    def _free_beat(self) -> int:
        """Return the first beat of the fork without recorded inputs: the beat for a take-back.

        A take-back needs a halt, and a halt refuses the keys of its beat. In a beat without keys
        none is refused, so the robots walk as in the record. If there is no such beat within
        `_SEARCH_BEATS`, return the fork's first beat.
        """
        beats = range(self._first, self._first + _SEARCH_BEATS)
        return next((beat for beat in beats if beat not in self._recorded), self._first)

    def _decisions(self) -> Sequence[Input]:
        """Return the decisions that make the change: halt, take-back, restarts, resume.

        If they halt the match, also note by how many beats the later recorded inputs are delayed.
        """
        match, change = self.match, self._change
        decisions: list[Decision] = []
        halts = change.take_back is not None and match.phase in IN_PLAY
        if halts:
            decisions.append(Halt())
            countdown = round(match.rules.countdown_s * BEATS_PER_S)
            left = match.countdown_beats if match.phase is Phase.COUNTDOWN else 1
            # The next tick of play comes after a countdown; in the record, after `left` beats.
            self._shift = countdown + 1 - left
        if change.take_back is not None:
            decisions.append(TakeBack(change.take_back))
        decisions += (Restart(seat) for seat in change.restart)
        if halts or (match.phase is Phase.HALTED and not self._kept_seats):
            decisions.append(Resume())
        found = [Decide(REFEREE, say("reason.fork"), decision) for decision in decisions]
        if found:
            self.decided_beat = match.beats + 1
        return found


def of_bot(bot: BotFactory, seat: int, variant: int = 0) -> Callable[[], Press]:
    """Return a function that makes a new player of a fork's seat: a bot with small delays.

    Args:
        bot: the bot.
        seat: index of its seat.
        variant: 0: the bot reacts at once. Each other number stands for other delays: the bot sees
            its first frame up to a second late, and presses each key up to 0.2 s late. A match has
            no randomness, so only these delays make forks from one beat differ.
    """

    def make() -> Press:
        return _BotPress(bot, seat, variant)

    return make


class _BotPress:
    """Presses the keys of a bot, with the delays that belong to a variant's number."""

    def __init__(self, bot: BotFactory, seat: int, variant: int) -> None:
        self._bot = bot
        self._seat = seat
        self._variant = variant
        self._drawn = 0
        self._brain: Brain | None = None
        self._waits = self._draw(_LATE_TICKS)
        self._pending: Key | None = None
        self._pending_ticks = 0

    def __call__(self, match: Match, frame: Frame) -> Key | None:
        if self._waits > 0:
            self._waits -= 1
            return None
        if self._brain is None:
            self._brain = self._bot(match.sheet(), self._seat)
        key = self._brain(frame)
        if key is not None:
            if self._pending is None:
                self._pending_ticks = self._draw(_REACTION_TICKS)
            self._pending = key
        elif self._pending is None:
            return None
        if self._pending_ticks > 0:
            self._pending_ticks -= 1
            return None
        key, self._pending = self._pending, None
        return key

    def _draw(self, most: int) -> int:
        """Return the next pseudo-random number from 0 to `most`; for variant 0 always 0.

        Each variant of each seat has numbers of its own.
        """
        if not self._variant:
            return 0
        self._drawn += 1
        text = f"{self._variant} {self._seat} {self._drawn}"
        number = hashlib.blake2b(text.encode(), digest_size=4).digest()
        return int.from_bytes(number, "little") % (most + 1)
