"""Practice: an open field with nothing to win (rules 7)."""

import math

import pytest

from lacoc_arenas import arena
from lacoc_arenas.game import NoSuchState, Place, RobotView

GAME = arena.load("practice").game


def test_field() -> None:
    """The field is 2.4 x 2.4 m, and the robot starts in the middle and faces +y (rules 7)."""
    assert GAME.size_m == (2.4, 2.4)
    assert GAME.starts == ((Place(0.0, 0.0, math.pi / 2),),)


def test_the_start_may_be_anywhere_within_the_walls() -> None:
    """The start place is a setting and may be anywhere within the walls."""
    game = arena.load("practice", {"game": {"start": [1.1, -1.1]}}).game
    assert game.starts[0][0][:2] == (1.1, -1.1)


def test_nothing_happens() -> None:
    """Practice has no markers, points, end or winner, and a referee can set nothing."""
    state = GAME.start()
    view = RobotView(1.0, -1.0, 0.07, 1.0, 0.0, 0.0, 0.0, GAME.starts[0][0])
    assert GAME.step(state, (view,), 0.02, frozenset({(0, "x")})) == (state, ())
    assert GAME.board(state) == ()
    assert GAME.score(state) == (0,)
    assert GAME.over(state) is None
    assert GAME.winner(state, (3,)) is None
    with pytest.raises(NoSuchState, match=r"^practice has no board$"):
        GAME.set(state, 0, 1)
