"""How an episode begins: all that a seed chooses. A match itself has no randomness."""

from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any

import msgspec
import numpy as np

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_arenas.learned.arguments import short, table, whole
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import say

_NEAR = 0.75
"""Similarity (`difflib`) from which an unknown name counts as a misspelt option. "late_tick" is
similar to "late_ticks" by 0.95; "state", which is another word, to "seat" by 0.67."""
OPTIONS = ("place", "late_ticks", "seat", "reset_mask")
"""Names of the options of all environments of a game."""
MOST_LATE_TICKS = 25
"""Largest number of ticks by which a seed delays a seat's first key."""
_PLACES = ("start_cells", "starts")
"""Entries of [game] that list the start places of the left team, in the arenas of LACOC."""


class Opening(msgspec.Struct, frozen=True):
    """One way in which an episode can begin."""

    place: int = 0
    """Index of the start place in the arena file's list; the right robot begins opposite to it."""
    late_ticks: tuple[int, ...] = ()
    """For each seat, the number of ticks of play that pass before its keys count."""
    seat: int = 0
    """The seat of the learner, in an environment with a bot."""


def draw(arena: Arena, chance: np.random.Generator) -> Opening:
    """Draw an opening: the start place, how late each seat begins, and the learner's seat."""
    seats = len(arena.seats)
    late = chance.integers(0, MOST_LATE_TICKS + 1, seats)
    return Opening(
        place=int(chance.integers(0, start_place_count(arena))),
        late_ticks=tuple(int(ticks) for ticks in late),
        seat=int(chance.integers(0, seats)),
    )


def known_options(options: Any, known: Sequence[str]) -> dict[str, Any]:
    """Check the names of options of `reset`, and return the options.

    Libraries and wrappers have options of their own, so an unknown name is allowed. But a name that
    is nearly the name of an option in `OPTIONS` is a mistake.

    Args:
        options: the options that were given.
        known: the names in `OPTIONS` that this environment uses.

    Raises:
        UserError: if the options are not a dict, or a name that is not in `known` is the same as,
            or nearly, a name in `OPTIONS`.
    """
    given = table("options", options, '{"place": 0}')
    for name in (one for one in given if one not in known):
        near = get_close_matches(str(name).lower(), OPTIONS, 1, _NEAR)
        if near:
            meant = near[0] if near[0] in known else None
            raise UserError(
                say(
                    "environment.option",
                    found=printable(str(name)),
                    near=meant,
                    options=list(known),
                )
            )
    return given


def with_options(drawn: Opening, options: dict[str, Any], arena: Arena) -> Opening:
    """Return the drawn opening, with the values that the options give in place of its own.

    Raises:
        UserError: if a value of the options does not fit; the message says what is allowed.
    """
    seats = [seat.id for seat in arena.seats]
    place, late, seat = drawn.place, drawn.late_ticks, drawn.seat
    if "place" in options:
        place = whole("place", options["place"], 0, start_place_count(arena) - 1)
    if "late_ticks" in options:
        late = _late_ticks(options["late_ticks"], len(seats), arena.match.duration_s)
    if "seat" in options:
        seat = _seat(options["seat"], seats)
    return Opening(place, late, seat)


def _seat(given: Any, seats: list[str]) -> int:
    """Return the index of a seat that is given by its id or its index."""
    try:
        named = isinstance(given, str)
        return seats.index(given) if named else whole("seat", given, 0, len(seats) - 1)
    except (ValueError, UserError):
        raise UserError(say("environment.seat", found=short(given), seats=seats)) from None


def _late_ticks(given: Any, seats: int, duration_s: float) -> tuple[int, ...]:
    most = round(duration_s * BEATS_PER_S)
    try:
        late = tuple(whole("late_ticks", ticks, 0, most) for ticks in given)
    except (TypeError, UserError):
        late = ()
    if len(late) != seats:
        raise UserError(say("environment.late-ticks", found=short(given), seats=seats, most=most))
    return late


def start_place_count(arena: Arena) -> int:
    """Return how many start places an opening can choose from; 1 if the game lists none."""
    found = _listed(arena.settings)
    return len(found[1]) if found else 1


def begun_at(arena: Arena, place: int) -> Arena:
    """Return the arena with the start place of this index moved to the front of its list."""
    found = _listed(arena.settings)
    if place == 0 or found is None:
        return arena
    name, listed = found
    first = [listed[place], *listed[:place], *listed[place + 1 :]]
    settings = arenas.merge(arena.settings, {"game": {name: first}})
    return arenas.from_settings(arena.name, settings, arena.folder)


def _listed(settings: dict[str, Any]) -> tuple[str, list[Any]] | None:
    game = settings.get("game", {})
    for name in _PLACES:
        if isinstance(game.get(name), list) and game[name]:
            return name, game[name]
    return None
