"""How an episode begins. A match has no randomness: all that a seed chooses is here."""

from typing import Any

import msgspec
import numpy as np

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena

MOST_LATE_TICKS = 25
"""Largest number of ticks by which a seed lets a seat begin later."""
_PLACES = ("start_cells", "starts")
"""Entries of [game] that list the start places of the left team, in the arenas of LACOC."""


class Opening(msgspec.Struct, frozen=True):
    """One way to begin."""

    place: int = 0
    """Index of the start place in the arena file's list; the right robot begins opposite to it."""
    late_ticks: tuple[int, ...] = ()
    """For each seat the ticks of play before its first key counts."""
    seat: int = 0
    """The seat of the learner, in an environment with a bot."""


def draw(arena: Arena, chance: np.random.Generator) -> Opening:
    """Draw an opening: the start place, how late each seat begins, and the learner's seat."""
    seats = len(arena.seats)
    late = chance.integers(0, MOST_LATE_TICKS + 1, seats)
    return Opening(
        place=int(chance.integers(0, places(arena))),
        late_ticks=tuple(int(ticks) for ticks in late),
        seat=int(chance.integers(0, seats)),
    )


def places(arena: Arena) -> int:
    """Return how many start places an opening can choose from: 1 in a game that lists none."""
    found = _listed(arena.settings)
    return len(found[1]) if found else 1


def begun_at(arena: Arena, place: int) -> Arena:
    """Return the arena with the start place of this index as its first one."""
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
