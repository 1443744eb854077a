"""Fairness: if the field is turned and the seats are swapped, the rules give the turned match."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_arenas import arena
from lacoc_arenas.game import LEFT, NEUTRAL, RIGHT, AnyGame, Claim, GameEvent, Place, RobotView
from lacoc_arenas.layout import turned

GAMES: dict[str, AnyGame] = {
    "othello": arena.load("othello").game,
    "othello-touching": arena.load("othello", {"game": {"disc_radius_m": 0.15}}).game,
    "othello-reversi": arena.load("othello", {"game": {"opening": "reversi"}}).game,
    "flag-strike": arena.load("flag-strike").game,
}
SWAPPED = {NEUTRAL: NEUTRAL, LEFT: RIGHT, RIGHT: LEFT, 3: 3}


def opposites(game: AnyGame) -> list[int]:
    """Return, for each marker, the index of the marker at its place in the turned field."""
    at = {(marker.x_m, marker.y_m): index for index, marker in enumerate(game.markers)}
    return [at[-marker.x_m, -marker.y_m] for marker in game.markers]


def turn_place(place: Place | None) -> Place | None:
    return None if place is None else turned(place)


def turn_view(view: RobotView, opposite: list[int]) -> RobotView:
    return view._replace(
        x_m=-view.x_m,
        y_m=-view.y_m,
        placed=turn_place(view.placed),
        touched=tuple(opposite[marker] for marker in view.touched),
    )


def turn_board(board: tuple[int, ...], opposite: list[int]) -> tuple[int, ...]:
    return tuple(SWAPPED[board[marker]] for marker in opposite)


def turn_claim(claim: Claim, game: AnyGame, opposite: list[int]) -> Claim:
    seat, name = claim
    index = next(i for i, marker in enumerate(game.markers) if marker.name == name)
    return 1 - seat, game.markers[opposite[index]].name


def said(events: tuple[GameEvent, ...]) -> set[tuple[Any, ...]]:
    """Return events as a set, so that their order within a tick does not matter."""
    return {(e.kind, e.seat, e.marker, frozenset(e.also), e.points) for e in events}


@st.composite
def observations(draw: st.DrawFn, game: AnyGame) -> list[tuple[tuple[RobotView, ...], bool]]:
    """Draw a walk of both robots.

    Returns:
        For each tick: the view of each seat's robot, and whether the referee takes back a claim.
    """
    flags = [index for index, marker in enumerate(game.markers) if marker.kind == "flag"]
    spots = [(marker.x_m, marker.y_m) for marker in game.markers if marker.kind != "flag"]
    at = [draw(st.integers(0, len(spots) - 1)) for _ in range(2)]
    stride = st.sampled_from([0, 1, -1, 6, -6, 7])  # neighbours on a 6 x 6 board, and a diagonal
    offset = st.sampled_from([0.0, 0.0, 0.0, 0.05, -0.05, 0.12, -0.15])
    touches = st.sets(st.sampled_from(flags), max_size=3) if flags else st.just(set())
    walk = []
    for _ in range(draw(st.integers(1, 30))):
        views = []
        for seat in range(2):
            at[seat] = (at[seat] + draw(stride)) % len(spots)
            x_m, y_m = spots[at[seat]]
            place = draw(st.sampled_from([None, None, None, None, *game.starts[seat]]))
            touched = tuple(sorted(draw(touches)))
            x_m, y_m = x_m + draw(offset), y_m + draw(offset)
            views.append(RobotView(x_m, y_m, 0.07, 1.0, 0.0, 0.0, 0.0, place, touched))
        walk.append((tuple(views), draw(st.booleans())))
    return walk


@pytest.mark.slow
@pytest.mark.parametrize("name", GAMES)
@given(data=st.data())
def test_turned_match(name: str, data: st.DataObject) -> None:
    """If paths are turned and seats swapped, the rules give exactly the turned match (rules 4)."""
    game = GAMES[name]
    opposite = opposites(game)
    state = mirror = game.start()
    assert turn_board(game.board(state), opposite) == game.board(mirror)
    for views, strikes in data.draw(observations(game)):
        struck: frozenset[Claim] = frozenset()
        if strikes:
            _, events = game.step(state, views, 0.02)
            struck = frozenset((event.seat, event.marker) for event in events[:1])
        state, events = game.step(state, views, 0.02, struck)
        mirror_views = tuple(turn_view(view, opposite) for view in reversed(views))
        mirror_struck = frozenset(turn_claim(claim, game, opposite) for claim in struck)
        mirror, mirror_events = game.step(mirror, mirror_views, 0.02, mirror_struck)
        assert turn_board(game.board(state), opposite) == game.board(mirror)
        assert game.score(state) == game.score(mirror)[::-1]
        assert bool(game.over(state)) == bool(game.over(mirror))
        expected = {
            (
                kind,
                *turn_claim((seat, marker), game, opposite),
                frozenset(turn_claim((seat, other), game, opposite)[1] for other in also),
                points,
            )
            for kind, seat, marker, also, points in said(events)
        }
        assert said(mirror_events) == expected
        winner, mirror_winner = (game.winner(s, game.score(s)) for s in (state, mirror))
        assert winner == (None if mirror_winner is None else 1 - mirror_winner)


@pytest.mark.slow
@pytest.mark.parametrize("name", GAMES)
@given(data=st.data())
def test_score_is_the_board(name: str, data: st.DataObject) -> None:
    """A tick changes only the markers in its events; a score is the points of a team's markers."""
    game = GAMES[name]
    state = game.start()
    for views, _ in data.draw(observations(game)):
        before = state
        state, events = game.step(state, views, 0.02)
        board = game.board(state)
        assert len(board) == len(game.markers)
        assert set(board) <= {NEUTRAL, LEFT, RIGHT}
        for seat in range(2):
            held = [
                marker.points
                for marker, own in zip(game.markers, board, strict=True)
                if own == seat + 1
            ]
            assert game.score(state)[seat] == sum(held)
        changed = {
            game.markers[index].name
            for index, (old, new) in enumerate(zip(game.board(before), board, strict=True))
            if old != new
        }
        assert changed == {name for event in events for name in (event.marker, *event.also)}


@pytest.mark.parametrize("name", GAMES)
def test_starts_are_turned(name: str) -> None:
    """Each start place of the right seat is the turned place of the left seat."""
    left, right = GAMES[name].starts
    assert tuple(turned(place) for place in left) == right
    for here, there in zip(left, (turned(place) for place in right), strict=True):
        assert (here.x_m, here.y_m) == (there.x_m, there.y_m)
        assert math.isclose(math.remainder(here.heading_rad - there.heading_rad, math.tau), 0)
