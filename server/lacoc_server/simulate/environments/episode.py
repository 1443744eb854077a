"""An episode: one match from its first beat of play to its end, driven by keys or angles.

With keys it is the match that a court would play with the same inputs, so its record can be proven
as any other. A court takes no angles.
"""

from collections.abc import Sequence
from pathlib import Path
from struct import Struct
from typing import Any, TypeVar

import msgspec

from lacoc_arenas.arena import Arena
from lacoc_arenas.bot import Key
from lacoc_server.journal.journal import Journal
from lacoc_server.match.match import Match
from lacoc_server.simulate.environments.opening import Opening, begun_at, start_place_count
from lacoc_server.simulate.environments.steered import Steered
from lacoc_server.simulate.headless import to_play
from lacoc_server.simulate.inputs import closing
from lacoc_server.world.world import World
from lacoc_shared.codec import BadMessage, decode, encode, message_hash
from lacoc_shared.gait.tables import Level, Posture
from lacoc_shared.inputs import Input, JoinSeat, KeySeat
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.packed import PackedWriter
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

T = TypeVar("T")

COURT = "environment"
"""Name of the court in records of episodes."""
_PRESSED = Struct("<IBBB")
"""Layout of a saved key press: beat, seat, level, digit."""
_MOST_BYTES = 1 << 28


class _SavedEpisode(msgspec.Struct, frozen=True, array_like=True):
    opening: Opening
    angles: bool
    robots: bytes
    """Hash of the files of all seats (`Begun.robots`)."""
    match: bytes
    pressed: bytes
    seqs: tuple[int, ...]
    extra: bytes
    targets: tuple[Posture, ...] = ()
    """For each seat the angles that its robot moves to [rad]; empty if robots follow keys."""


class Begun:
    """Saved matches at their first beat of play, by start place; many episodes can share them.

    Args:
        arena: the arena.
        joins: for each seat, the request of a team to join, with its files.
        angles: whether the robots follow angles instead of keys.
    """

    def __init__(self, arena: Arena, joins: Sequence[JoinSeat], angles: bool = False) -> None:
        self.arena = arena
        self.joins = tuple(joins)
        self.robots = message_hash(encode([_contents(join) for join in joins]))
        """Hash of the files of all seats."""
        self.angles = angles
        self._arenas: dict[int, Arena] = {}
        self._saved: dict[int, bytes] = {}

    def arena_at(self, place: int) -> Arena:
        """Return the arena with a start place moved to the front of its list."""
        if place not in self._arenas:
            self._arenas[place] = begun_at(self.arena, place)
        return self._arenas[place]

    def setup(self, place: int, match_id: str = "") -> Setup:
        """Return the setup of a match that begins at a start place."""
        arena = self.arena_at(place)
        return Setup(
            match_id=match_id,
            court=COURT,
            match=1,
            arena=arena.name,
            settings=arena.settings,
            limits={},
        )

    def has(self, place: int) -> bool:
        """Return whether a match that begins at a start place is saved already."""
        return place in self._saved

    def begin(self, match: Match, place: int) -> None:
        """Lead a match to its first beat of play.

        Raises:
            UserError: if a robot does not stay on its start place, or MuJoCo reports a fault.
            FileRefused: if a file has mistakes.
        """
        if place not in self._saved:
            for _ in to_play(self.joins, match.beat):
                if self.angles and match.phase is Phase.READY:
                    _steer(match)
            if match.phase is not Phase.PLAYING:
                raise UserError(say("environment.no-start", phase=match.phase.word))
            self._saved[place] = match.save()
        match.load(self._saved[place])


class Episode:
    """Plays one episode after another.

    Args:
        begun: matches at their first beat of play.
    """

    def __init__(self, begun: Begun) -> None:
        self.begun = begun
        self._matches: dict[int, Match] = {}
        self.opening = Opening()
        self.late_ticks: tuple[int, ...] = ()
        """For each seat the ticks of play before its first key counts."""
        self._pressed = bytearray()
        self._seqs = [0] * len(begun.joins)
        self._frame: Frame | None = None
        self.match = self._match(0)
        """The match of the episode; before `begin` and `load` one that is only for its sheet."""
        begun.begin(self.match, 0)

    @property
    def has_begun(self) -> bool:
        """True once an episode was begun or loaded."""
        return self._frame is not None

    @property
    def frame(self) -> Frame:
        """The newest frame.

        Raises:
            UserError: if no episode has begun.
        """
        self.require_begun()
        assert self._frame is not None
        return self._frame

    def require_begun(self) -> None:
        """Check that an episode was begun or loaded.

        Raises:
            UserError: if none was.
        """
        if not self.has_begun:
            raise UserError(say("environment.not-begun"))

    def begin(self, opening: Opening) -> Frame:
        """Begin an episode; return the frame of its first beat of play.

        Raises:
            UserError: in the same cases as `Begun.begin`.
        """
        if not self.begun.has(opening.place):
            self._matches.pop(opening.place, None)  # only a match without a beat can be led to play
        self._open(opening)
        self.begun.begin(self.match, opening.place)
        if self.begun.angles:
            _steer(self.match)  # a match that was played has the drives of its last episode
        self._pressed = bytearray()
        self._seqs = [0] * len(self._seqs)
        self._frame = self.match.frame()
        return self._frame

    @property
    def is_on(self) -> bool:
        """True while the match is played."""
        return self.match.phase is Phase.PLAYING

    @property
    def ended(self) -> bool:
        """True if the match has ended by its rules."""
        return self.match.phase is Phase.FINISHED

    @property
    def stopped(self) -> bool:
        """True if the match is halted, because MuJoCo reported a fault."""
        return self.match.phase is Phase.HALTED

    def pass_beats(self, keys: Sequence[Key | None], beats: int = 1) -> None:
        """Let beats pass, at most to the end of the match.

        Args:
            keys: for each seat the key that it presses in the first beat; None: it presses none.
            beats: how many beats.
        """
        match = self.match
        match.skip(self._inputs(keys))
        for _ in range(beats - 1):
            if match.phase is not Phase.PLAYING:
                break
            match.skip()
        self._frame = match.frame()

    def outcome(self, seat: int) -> dict[str, Any]:
        """Return how the match ended: "scores", "winner", and whether the seat has "won".

        The winner is "void" if the match has not ended by its rules.
        """
        match = self.match
        winner = match.winner() if self.ended else "void"
        return {"scores": match.scores(), "winner": winner, "won": winner == match.seats[seat].id}

    def steer(self, seat: int, target: Posture) -> None:
        """Set the angles [rad], by joint id, that a robot moves to from the next beat on."""
        self._drive(seat).target = target

    def pressed(self, seat: int) -> dict[int, Key]:
        """Return the keys that a seat pressed in this episode, by beat."""
        return {
            beat: Key(Level(level), digit)
            for beat, by, level, digit in _PRESSED.iter_unpack(self._pressed)
            if by == seat
        }

    def save(self, extra: object) -> bytes:
        """Return the whole episode; `load` goes on from it bit for bit.

        Args:
            extra: a value of the caller, to be saved too.

        Raises:
            UserError: if no episode has begun.
        """
        self.require_begun()
        seats = len(self._seqs) if self.begun.angles else 0
        return encode(
            _SavedEpisode(
                self.opening,
                self.begun.angles,
                self.begun.robots,
                self.match.save(),
                bytes(self._pressed),
                tuple(self._seqs),
                encode(extra),
                tuple(self._drive(seat).target for seat in range(seats)),
            )
        )

    def load(self, data: bytes, kind: type[T]) -> T:
        """Go on from a saved episode.

        Args:
            data: bytes of `save`.
            kind: type of the caller's value (`extra` of `save`).

        Returns:
            The caller's value.

        Raises:
            UserError: if the bytes are not an episode of this arena, these robots and settings, or
                the value is of another type. The episode is then unchanged.
        """
        try:
            saved = decode(saved_bytes(data), _SavedEpisode, _MOST_BYTES)
            extra = decode(saved.extra, kind, _MOST_BYTES)
            if saved.angles != self.begun.angles:
                raise BadMessage("only one of the two episodes is steered by angles")
            if saved.angles and len(saved.targets) != len(self._seqs):
                raise BadMessage("it lacks the angles that the robots move to")
            if saved.robots != self.begun.robots:
                raise BadMessage("it has other robots or gaits")
            if not 0 <= saved.opening.place < start_place_count(self.begun.arena):
                raise BadMessage("the arena has no such start place")
            before = self.opening
            self._open(saved.opening)
            try:
                self.match.load(saved.match)
            except ValueError:
                self._open(before)
                raise
        except ValueError as error:
            raise UserError(say("environment.other-save", error=str(error)[:200])) from None
        if self.begun.angles:
            _steer(self.match, saved.targets)
        self._pressed, self._seqs = bytearray(saved.pressed), list(saved.seqs)
        self._frame = self.match.frame()
        return extra

    def write_record(self, file: Path) -> None:
        """Write the record of the episode so far: the match is played again from its inputs.

        The result of an episode that has not ended is void.

        Args:
            file: the record; its name without ".mcap" is the id of the match.

        Raises:
            UserError: if no episode has begun, if the robots follow angles, if the name does not
                end in ".mcap", or if the file exists or can't be written.
        """
        self.require_begun()
        if self.begun.angles:
            raise UserError(say("environment.no-record"))
        if file.suffix != ".mcap":
            raise UserError(say("environment.record-name", file=str(file)))
        keys: dict[int, list[Input]] = {}
        seqs = [0] * len(self._seqs)
        for beat, seat, level, digit in _PRESSED.iter_unpack(self._pressed):
            seqs[seat] += 1
            keys.setdefault(beat, []).append(KeySeat(seat, seqs[seat], level, digit))
        setup = self.begun.setup(self.opening.place, file.stem)
        arena = self.begun.arena
        match = Match(setup, World, arena.folder)
        journal = Journal(match, file.parent, writer=PackedWriter)
        try:
            for _ in to_play(self.begun.joins, lambda items: journal.beat(items)[0]):
                pass
            while match.beats < self.match.beats:
                journal.beat(keys.get(match.beats + 1, ()))
            journal.beat([closing(match.phase)])
            journal.close()
        except BaseException:  # Ctrl-C too: the record can be written again
            journal.leave()
            raise

    def _inputs(self, keys: Sequence[Key | None]) -> list[Input]:
        """Return the inputs of the next beat: keys that seats press. Note them for `pressed`."""
        inputs: list[Input] = []
        match = self.match
        for seat, key in enumerate(keys):
            if key is None or match.ticks <= self.late_ticks[seat]:
                continue
            self._seqs[seat] += 1
            level, digit = int(key.level), key.key
            self._pressed += _PRESSED.pack(match.beats + 1, seat, level, digit)
            inputs.append(KeySeat(seat, self._seqs[seat], level, digit))
        return inputs

    def _drive(self, seat: int) -> Steered:
        drive = self.match.seats[seat].drive
        assert isinstance(drive, Steered)
        return drive

    def _open(self, opening: Opening) -> None:
        self.opening = opening
        self.late_ticks = opening.late_ticks or (0,) * len(self._seqs)
        self.match = self._match(opening.place)

    def _match(self, place: int) -> Match:
        if place not in self._matches:
            folder = self.begun.arena.folder
            match = self._matches[place] = Match(self.begun.setup(place), World, folder)
            match.history.keep_nothing()  # an environment has no referee who takes events back
        return self._matches[place]


def saved_bytes(given: Any) -> bytes:
    """Return the argument of `load` as bytes.

    Raises:
        BadMessage: if the argument is not bytes.
    """
    if not isinstance(given, bytes | bytearray | memoryview):
        raise BadMessage(f"{type(given).__name__} instead of bytes")
    return bytes(given)


def _contents(join: JoinSeat) -> list[bytes | None]:
    """Return the contents of a joining team's files, without names: robot, postures, locomotion."""
    files = (join.robot, join.postures, join.locomotion)
    return [None if file is None else file.data for file in files]


def _steer(match: Match, targets: Sequence[Posture] = ()) -> None:
    """Let the robots of a match move to the angles of each seat.

    If `targets` is empty, they move to their start postures.
    """
    for seat in match.seats:
        if seat.entry is not None:
            seat.drive = drive = Steered(seat.entry)
            if targets:
                drive.target = targets[seat.index]
