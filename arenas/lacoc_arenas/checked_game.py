"""A game whose mistakes are told as its author needs them.

Games come from folders and packages of others. What `make` gives back is looked at when the arena
is loaded, and each answer of its rules while the match runs, so that a mistake is one sentence
with its place: headless, at a court and in a replay alike.
"""

import traceback
from collections.abc import Callable
from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple

import msgspec

from lacoc_arenas.game import DOWN, AnyGame, Claim, GameEvent, NoSuchState, Observation, Place
from lacoc_shared.messages import MARKER_STATES, MarkerInfo
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import Phrase, say

_DESCRIBED = "docs/write-an-arena.md says what a game has."
_VALUES = ("state_type", "markers", "starts", "size_m")
_RULES = ("start", "step", "board", "score", "over", "winner", "set")


class Source(NamedTuple):
    """Where an arena's code lies, as mistakes name it."""

    arena: str
    folder: str

    def wrong(self, what: str) -> UserError:
        """Make the error that says what is wrong with the arena's code."""
        return UserError(say("arena.wrong-code", name=self.arena, error=what))

    def call(
        self, what: str, function: Callable[..., Any], *arguments: object, refuses: bool = False
    ) -> Any:
        """Call a function of the arena.

        Args:
            what: its name.
            function: the function.
            arguments: what it is given.
            refuses: it may raise ValueError, for a setting or a state of a marker.

        Raises:
            UserError: with the line of the arena's code, if it raises what it should not.
            ValueError: as the function does, where it may.
        """
        try:
            return function(*arguments)
        except Exception as error:  # whatever a person's code may raise
            if isinstance(error, UserError) or (refuses and isinstance(error, ValueError)):
                raise
            raise self.wrong(self._raised(what, error)) from error

    def _raised(self, what: str, error: Exception) -> str:
        calls = traceback.extract_tb(error.__traceback__)
        own = [call for call in calls if call.filename.startswith(self.folder)]
        place = f" ({own[-1].filename}, line {own[-1].lineno})" if own else ""
        if isinstance(error, SyntaxError):
            place, error_text = f" ({error.filename}, line {error.lineno})", error.msg
        else:
            error_text = str(error)
        return f"{what}{place} raised {type(error).__name__}: {printable(error_text, 200)}"


def checked(source: Source, game: Any) -> AnyGame:
    """Hold a game to what every game is.

    Args:
        source: the arena, for the mistakes.
        game: what `make` gave back.

    Returns:
        The same game; its rules raise UserError from now on where they break, or give back what
        they must not.

    Raises:
        UserError: if it lacks something, or begins with what no game is.
    """
    missing = [name for name in _VALUES if not hasattr(game, name)]
    missing += [name for name in _RULES if not callable(getattr(game, name, None))]
    if missing:
        found = printable(repr(game), 80)
        raise source.wrong(
            f"make returned {found}, which has no {', '.join(missing)}. {_DESCRIBED}"
        )
    _check_values(source, game)
    held = CheckedGame(source, game)
    state = held.start()
    held.board(state)
    held.winner(state, held.score(state))
    held.over(state)
    return held


class CheckedGame:
    """A game, each of whose answers is looked at; else the game itself."""

    def __init__(self, source: Source, game: AnyGame) -> None:
        self._source = source
        self._game = game
        self.state_type = game.state_type
        self.markers = game.markers
        self.starts = game.starts
        self.size_m = game.size_m
        self._seats = len(game.starts)
        self._names = {marker.name for marker in game.markers}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._game, name)  # what a game has for its own field and bots

    def start(self) -> Any:
        """See `Game.start`."""
        state = self._state("start", self._source.call("start", self._game.start))
        try:
            packed = msgspec.msgpack.encode(state)
            again = msgspec.msgpack.decode(packed, type=self.state_type)
        except (TypeError, ValueError) as error:
            raise self._wrong("start", state, f"a state that can be recorded ({error})") from None
        if again != state:
            raise self._wrong("start", state, "a state that a record gives back as it was")
        return state

    def step(
        self,
        state: Any,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[Any, tuple[GameEvent, ...]]:
        """See `Game.step`."""
        found = self._source.call("step", self._game.step, state, observation, dt_s, struck)
        match found:
            case (after, tuple() as events):
                for event in events:
                    self._check_event(event)
                return self._state("step", after), events
        raise self._wrong("step", found, "the state after the tick, and a tuple of GameEvent")

    def board(self, state: Any) -> tuple[int, ...]:
        """See `Game.board`."""
        found = self._source.call("board", self._game.board, state)
        if not _whole_numbers(found, len(self.markers)) or any(not 0 <= s <= DOWN for s in found):
            expected = (
                f"a tuple of {len(self.markers)} numbers from 0 to {DOWN}, one for each marker"
            )
            raise self._wrong("board", found, expected)
        return tuple(found)

    def score(self, state: Any) -> tuple[int, ...]:
        """See `Game.score`."""
        found = self._source.call("score", self._game.score, state)
        if not _whole_numbers(found, self._seats):
            expected = f"a tuple of {self._seats} whole numbers, one for each seat"
            raise self._wrong("score", found, expected)
        return tuple(found)

    def over(self, state: Any) -> Phrase | None:
        """See `Game.over`."""
        found = self._source.call("over", self._game.over, state)
        if not (found is None or isinstance(found, Phrase)):
            expected = "a Phrase: why the match is over, or None while it is not"
            raise self._wrong("over", found, expected)
        return found

    def winner(self, state: Any, scores: tuple[int, ...]) -> int | None:
        """See `Game.winner`."""
        found: int | None = self._source.call("winner", self._game.winner, state, scores)
        if found is not None and not (_is_whole(found) and 0 <= found < self._seats):
            expected = f"the index of a seat, from 0 to {self._seats - 1}, or None for a draw"
            raise self._wrong("winner", found, expected)
        return found

    def set(self, state: Any, marker: int, value: int) -> Any:
        """See `Game.set`."""
        rule = self._game.set
        try:
            found = self._source.call("set", rule, state, marker, value, refuses=True)
        except NoSuchState:
            raise
        except ValueError as error:  # a sentence does as well
            raise NoSuchState(say("plain.text", text=str(error))) from error
        return self._state("set", found)

    def _state(self, rule: str, found: Any) -> Any:
        if not isinstance(found, self.state_type):
            raise self._wrong(rule, found, f"a {self.state_type.__name__}")
        return found

    def _check_event(self, event: Any) -> None:
        if not isinstance(event, GameEvent):
            raise self._wrong("step", event, "events that are each a GameEvent")
        if not (_is_whole(event.seat) and 0 <= event.seat < self._seats):
            raise self._wrong("step", event, f"a seat from 0 to {self._seats - 1}")
        unknown = [name for name in (event.marker, *event.also) if name not in self._names]
        if unknown:
            raise self._wrong("step", event, f"markers of this board; {unknown[0]!r} is none")
        if not isinstance(event.said, Phrase):
            raise self._wrong("step", event, "an event whose said is a Phrase")

    def _wrong(self, rule: str, found: object, expected: str) -> UserError:
        shown = printable(repr(found), 120)
        return self._source.wrong(f"{rule} returned {shown}. Expected {expected}. {_DESCRIBED}")


def _check_values(source: Source, game: AnyGame) -> None:
    """Look at what a game has beside its rules.

    Raises:
        UserError: at the first that is wrong.
    """

    def require(right: bool, name: str, expected: str) -> None:
        if not right:
            shown = printable(repr(getattr(game, name)), 120)
            raise source.wrong(f"{name} is {shown}. Expected {expected}. {_DESCRIBED}")

    kind: object = game.state_type
    is_struct = isinstance(kind, type) and issubclass(kind, msgspec.Struct)
    require(is_struct, "state_type", "a class made from msgspec.Struct")
    markers: Any = game.markers
    are_markers = isinstance(markers, tuple) and all(isinstance(m, MarkerInfo) for m in markers)
    require(are_markers, "markers", "a tuple of MarkerInfo; () for a game without a board")
    names = [marker.name for marker in game.markers]
    require(len(set(names)) == len(names), "markers", "another name for each marker")
    require(all(n and ":" not in n for n in names), "markers", "names without a colon")
    starts: Any = game.starts
    require(
        isinstance(starts, tuple)
        and bool(starts)
        and all(
            isinstance(s, tuple) and s and all(isinstance(p, Place) for p in s) for s in starts
        ),
        "starts",
        "for each seat a tuple of one or more Place",
    )
    size: Any = game.size_m
    require(
        isinstance(size, tuple) and len(size) == 2 and all(_is_length(length) for length in size),
        "size_m",
        "width and depth of the field, two lengths above 0 and at most 20 m",
    )


def marker_of_geom(game: AnyGame, geom: str) -> tuple[int, int]:
    """Which marker a geom shows, and in which state; (-1, -1): it is no marker's.

    Raises:
        UserError: if it is named as a marker's, and there is no such marker or state.
    """
    kind, _, rest = geom.partition(":")
    if kind != "marker":
        return -1, -1
    names = [marker.name for marker in game.markers]
    name, _, state = rest.partition(":")
    state = state.partition(":")[0]
    if name in names and state in MARKER_STATES:
        return names.index(name), MARKER_STATES.index(state)
    known = printable(", ".join(names), 80) or "there is none"
    raise UserError(
        f"The field has a geom {printable(geom, 80)!r}. Expected marker:NAME:STATE with the name "
        f"of a marker ({known}) and a state ({', '.join(MARKER_STATES)}). {_DESCRIBED}"
    )


def _are_places(found: object) -> bool:
    return isinstance(found, tuple) and bool(found) and all(isinstance(p, Place) for p in found)


def _whole_numbers(found: object, count: int) -> bool:
    return isinstance(found, tuple | list) and len(found) == count and all(map(_is_whole, found))


def _is_whole(found: object) -> bool:
    return isinstance(found, int) and not isinstance(found, bool)


def _is_length(found: object) -> bool:
    return isinstance(found, int | float) and 0 < found <= 20
