"""Routes of a bot over several markers, and the search for a good route. Pure."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

from lacoc_arenas.steering import Pose


class Route(NamedTuple):
    """Markers that a robot visits one after another, as planned."""

    worth: float = 0.0
    """What the robot gains on this route; later gains count less."""
    time_s: float = 0.0
    """Time from the start until the last marker is reached."""
    pose: Pose = Pose(0.0, 0.0, 0.0, 1.0)
    """Where the robot stands at the end of the route."""
    markers: tuple[int, ...] = ()
    """Indices of the markers, in the order of the visits."""
    board: tuple[int, ...] = ()
    """State of each marker at the end, for a game in which a route changes the worth of later
    markers."""


def best_route(
    start: Route, grow: Callable[[Route], Iterable[Route]], depth: int, width: int
) -> Route:
    """Search for the route of the highest worth (a beam search), of equal ones the shortest.

    Args:
        start: the route without markers.
        grow: returns all routes that continue a route by one marker.
        depth: how many markers a route has at most.
        width: how many routes are kept at each step.
    """
    beam, best = [start], start
    for _ in range(depth):
        beam = [grown for route in beam for grown in grow(route)]
        if not beam:
            break
        beam.sort(key=lambda route: (-route.worth, route.time_s))
        del beam[width:]
        best = max(best, beam[0], key=lambda route: route.worth)
    return best
