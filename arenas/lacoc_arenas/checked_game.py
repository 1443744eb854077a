"""Check what a game returns, and report mistakes to its author.

Games come from other people's folders and packages. The result of `make` is checked when the
arena is loaded, and each result of its rules while the match runs. A mistake is one sentence
with its place in the code: in a headless match, at a court and in a replay.
"""

import traceback
from collections.abc import Callable
from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple

import msgspec

from lacoc_arenas.game import DOWN, AnyGame, Claim, GameEvent, NoSuchState, Observation, Place
from lacoc_shared.messages import MARKER_STATES, Gains, MarkerInfo
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import Phrase, say

_VALUES = ("state_type", "markers", "starts", "size_m")
_RULES = ("start", "step", "board", "score", "over", "winner", "set")


class ArenaCode(NamedTuple):
    """The name of an arena, and the folder of its code, for error messages about the code."""

    arena: str
    folder: str

    def wrong(self, what: Phrase) -> UserError:
        """Make the error that says what is wrong with the arena's code, and in which arena."""
        return UserError(say("arena.wrong-code", name=self.arena, error=what))

    def call(
        self, what: str, function: Callable[..., Any], *arguments: object, refuses: bool = False
    ) -> Any:
        """Call a function of the arena's code, and turn its errors into sentences.

        Args:
            what: the function's name.
            function: the function.
            arguments: its arguments.
            refuses: whether the function may raise ValueError, because a setting or a state of a
                marker is wrong.

        Raises:
            UserError: if the function raises anything else. Unless it is a UserError of its own, it
                has the line of the arena's code, if there is one.
            ValueError: if the function raises it and `refuses` is true.
        """
        try:
            return function(*arguments)
        except Exception as error:  # whatever a person's code may raise
            if isinstance(error, UserError) or (refuses and isinstance(error, ValueError)):
                raise
            raise self.wrong(self._raised(what, error)) from error

    def _raised(self, what: str, error: Exception) -> Phrase:
        calls = traceback.extract_tb(error.__traceback__)
        own = [call for call in calls if call.filename.startswith(self.folder)]
        file, line = (own[-1].filename, own[-1].lineno) if own else (None, None)
        told = str(error)
        if isinstance(error, SyntaxError):
            file, line, told = error.filename, error.lineno, error.msg
        kind, told = type(error).__name__, printable(told, 200)
        return say("game.raised", what=what, file=file, line=line, kind=kind, error=told)


def checked(source: ArenaCode, game: Any) -> AnyGame:
    """Check a game of another author, and everything that it returns later.

    Args:
        source: the arena, for error messages.
        game: the result of `make`.

    Returns:
        The same game. Its rules raise UserError if they break, or if they return something
        that is not allowed.

    Raises:
        UserError: if the game lacks something, or its first state is wrong.
    """
    missing = [name for name in _VALUES if not hasattr(game, name)]
    missing += [name for name in _RULES if not callable(getattr(game, name, None))]
    if missing:
        found = printable(repr(game), 80)
        raise source.wrong(say("game.lacks", found=found, missing=missing))
    _check_values(source, game)
    held = CheckedGame(source, game)
    state = held.start()
    for seat in range(len(game.starts)):
        held.gains(state, seat)
    return held


class CheckedGame:
    """A game that checks each result of its rules; all other attributes are the game's own."""

    def __init__(self, source: ArenaCode, game: AnyGame) -> None:
        self._source = source
        self._game = game
        self.rule = getattr(game, "rule", None)
        self.state_type = game.state_type
        self.markers = game.markers
        self.starts = game.starts
        self.size_m = game.size_m
        self._seats = len(game.starts)
        self._names = {marker.name for marker in game.markers}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._game, name)  # what a game has for its own field and bots

    def __reduce__(self) -> tuple[Any, ...]:
        return CheckedGame, (self._source, self._game)

    def start(self) -> Any:
        """Return the first state (`Game.start`), checked: msgpack must be able to store it."""
        state = self._state("start", self._source.call("start", self._game.start))
        try:
            packed = msgspec.msgpack.encode(state)
            again = msgspec.msgpack.decode(packed, type=self.state_type)
        except (TypeError, ValueError) as error:
            expected = say("game-expects.recordable", error=str(error))
            raise self._wrong("start", state, expected) from None
        if again != state:
            raise self._wrong("start", state, say("game-expects.same-state"))
        return state

    def step(
        self,
        state: Any,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[Any, tuple[GameEvent, ...]]:
        """Judge one tick (`Game.step`), and check the new state and the events."""
        found = self._source.call("step", self._game.step, state, observation, dt_s, struck)
        match found:
            case (after, tuple() as events):
                for event in events:
                    self._check_event(event)
                return state if after is state else self._state("step", after), events
        raise self._wrong("step", found, say("game-expects.step"))

    def board(self, state: Any) -> tuple[int, ...]:
        """Return the state of each marker (`Game.board`), checked."""
        found = self._source.call("board", self._game.board, state)
        if not _whole_numbers(found, len(self.markers)) or any(not 0 <= s <= DOWN for s in found):
            expected = say("game-expects.board", markers=len(self.markers), most=DOWN)
            raise self._wrong("board", found, expected)
        return tuple(found)

    def score(self, state: Any) -> tuple[int, ...]:
        """Return the points of each seat (`Game.score`), checked."""
        found = self._source.call("score", self._game.score, state)
        if not _whole_numbers(found, self._seats):
            expected = say("game-expects.score", seats=self._seats)
            raise self._wrong("score", found, expected)
        return tuple(found)

    def over(self, state: Any) -> Phrase | None:
        """Return why the match is over, or None (`Game.over`), checked."""
        found = self._source.call("over", self._game.over, state)
        if not (found is None or isinstance(found, Phrase)):
            raise self._wrong("over", found, say("game-expects.over"))
        return found

    def winner(self, state: Any, scores: tuple[int, ...]) -> int | None:
        """Return the winner's seat, or None for a draw (`Game.winner`), checked."""
        found: int | None = self._source.call("winner", self._game.winner, state, scores)
        if found is not None and not (_is_whole(found) and 0 <= found < self._seats):
            raise self._wrong("winner", found, say("game-expects.winner", last=self._seats - 1))
        return found

    def gains(self, state: Any, seat: int) -> Gains:
        """Return which points a robot could gain next (`Game.gains`), checked.

        If the game has no `gains`, return that it gains nothing.
        """
        rule = getattr(self._game, "gains", None)
        if rule is None:
            return Gains()
        found: Gains = self._source.call("gains", rule, state, seat)
        if not (isinstance(found, Gains) and found.points.keys() <= self._names):
            raise self._wrong("gains", found, say("game-expects.gains"))
        return found

    def set(self, state: Any, marker: int, value: int) -> Any:
        """Set a marker, as a referee has decided (`Game.set`), and check the match's new state."""
        rule = self._game.set
        try:
            found = self._source.call("set", rule, state, marker, value, refuses=True)
        except NoSuchState:
            raise
        except ValueError as error:  # a game may give its reason as a plain sentence
            raise NoSuchState(say("plain.text", text=str(error))) from error
        return self._state("set", found)

    def _state(self, rule: str, found: Any) -> Any:
        if not isinstance(found, self.state_type):
            raise self._wrong(rule, found, say("game-expects.state", type=self.state_type.__name__))
        # A state that the other rules can't judge is found here, before the match has it.
        self.board(found)
        self.winner(found, self.score(found))
        self.over(found)
        return found

    def _check_event(self, event: Any) -> None:
        if not isinstance(event, GameEvent):
            raise self._wrong("step", event, say("game-expects.events"))
        if not (_is_whole(event.seat) and 0 <= event.seat < self._seats):
            raise self._wrong("step", event, say("game-expects.seat", last=self._seats - 1))
        unknown = [name for name in (event.marker, *event.also) if name not in self._names]
        if unknown:
            raise self._wrong("step", event, say("game-expects.markers", unknown=str(unknown[0])))
        if not isinstance(event.said, Phrase):
            raise self._wrong("step", event, say("game-expects.said"))

    def _wrong(self, rule: str, found: object, expected: Phrase) -> UserError:
        shown = printable(repr(found), 120)
        return self._source.wrong(say("game.returned", rule=rule, found=shown, expected=expected))


def _check_values(source: ArenaCode, game: AnyGame) -> None:
    """Check the values of a game that are not rules: markers, starts, size and the like.

    Raises:
        UserError: at the first value that is wrong.
    """

    def require(right: bool, name: str, expected: Phrase) -> None:
        if not right:
            shown = printable(repr(getattr(game, name)), 120)
            raise source.wrong(say("game.value", name=name, found=shown, expected=expected))

    rule = getattr(game, "rule", None)
    require(rule is None or isinstance(rule, Phrase), "rule", say("game-expects.rule"))
    kind: object = game.state_type
    is_struct = isinstance(kind, type) and issubclass(kind, msgspec.Struct)
    require(is_struct, "state_type", say("game-expects.struct"))
    markers: Any = game.markers
    are_markers = isinstance(markers, tuple) and all(isinstance(m, MarkerInfo) for m in markers)
    require(are_markers, "markers", say("game-expects.marker-tuple"))
    names = [marker.name for marker in game.markers]
    require(len(set(names)) == len(names), "markers", say("game-expects.other-names"))
    require(all(n and ":" not in n for n in names), "markers", say("game-expects.no-colon"))
    starts: Any = game.starts
    require(
        isinstance(starts, tuple)
        and bool(starts)
        and all(
            isinstance(s, tuple) and s and all(isinstance(p, Place) for p in s) for s in starts
        ),
        "starts",
        say("game-expects.starts"),
    )
    size: Any = game.size_m
    require(
        isinstance(size, tuple) and len(size) == 2 and all(_is_length(length) for length in size),
        "size_m",
        say("game-expects.size"),
    )


def marker_of_geom(game: AnyGame, geom: str) -> tuple[int, int]:
    """Return which marker a geom belongs to, and in which state of the marker it is shown.

    Both are indices; (-1, -1) if the geom does not belong to a marker.

    Raises:
        UserError: if the geom's name begins with "marker:", and there is no such marker or state.
    """
    kind, _, rest = geom.partition(":")
    if kind != "marker":
        return -1, -1
    names = [marker.name for marker in game.markers]
    name, _, state = rest.partition(":")
    state = state.partition(":")[0]
    if name in names and state in MARKER_STATES:
        return names.index(name), MARKER_STATES.index(state)
    known = printable(", ".join(names), 80) or say("game.no-markers")
    raise UserError(say("game.geom", geom=printable(geom, 80), names=known, states=MARKER_STATES))


def _whole_numbers(found: object, count: int) -> bool:
    return isinstance(found, tuple | list) and len(found) == count and all(map(_is_whole, found))


def _is_whole(found: object) -> bool:
    return isinstance(found, int) and not isinstance(found, bool)


def _is_length(found: object) -> bool:
    return isinstance(found, int | float) and 0 < found <= 20
