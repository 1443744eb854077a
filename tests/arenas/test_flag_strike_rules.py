"""Flag-Strike, rule by rule (workshop 5-2, rules 6)."""

import math
import random

import pytest

from lacoc_arenas import arena
from lacoc_arenas.flag_strike.rules import NO_CORNER, FlagStrike, State
from lacoc_arenas.game import (
    DOWN,
    LEFT,
    NEUTRAL,
    RIGHT,
    Claim,
    GameEvent,
    NoSuchState,
    Place,
    RobotView,
)
from lacoc_shared.words import faults, say

GAME: FlagStrike = arena.load("flag-strike").game
INDEX = {marker.name: index for index, marker in enumerate(GAME.markers)}
CORNERS = [(marker.x_m, marker.y_m) for marker in GAME.markers[:4]]
START = GAME.start()
MIDDLE = (0.0, 0.0)
Spot = tuple[float, float]


def view(
    where: Spot = MIDDLE, touched: tuple[str, ...] = (), placed: Spot | None = None
) -> RobotView:
    start = None if placed is None else Place(*placed, 0.0)
    indices = tuple(INDEX[name] for name in touched)
    return RobotView(*where, 0.07, 1.0, 0.0, 0.0, 0.0, start, indices)


def tick(
    before: State,
    left: RobotView | None = None,
    right: RobotView | None = None,
    *,
    game: FlagStrike = GAME,
    struck: frozenset[Claim] = frozenset(),
) -> tuple[State, tuple[GameEvent, ...]]:
    return game.step(before, (left or view(), right or view()), 0.02, struck)


def claims(events: tuple[GameEvent, ...]) -> list[Claim]:
    return [(event.seat, event.marker) for event in events]


# Field, corners, flags and start places (rules 6)


def test_field() -> None:
    """The field is 2.0 x 2.0 m, with a circle of radius 0.15 m in each corner (rules 6)."""
    assert GAME.size_m == (2.0, 2.0)
    assert CORNERS == [(-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8), (0.8, 0.8)]
    assert {(marker.kind, marker.radius_m) for marker in GAME.markers[:4]} == {("corner", 0.15)}
    assert [marker.name for marker in GAME.markers[:5]] == [
        "corner0",
        "corner1",
        "corner2",
        "corner3",
        "flag0",
    ]


def test_twenty_flags_in_four_colours() -> None:
    """The 20 flags (8, 6, 4 and 2 of 1, 2, 3 and 5 points) make 42 points (workshop 5-2 rule 6)."""
    flags = [marker for marker in GAME.markers if marker.kind == "flag"]
    worth = [flag.points for flag in flags]
    assert {points: worth.count(points) for points in set(worth)} == {1: 8, 2: 6, 3: 4, 5: 2}
    assert (len(flags), sum(worth)) == (20, 42)
    assert len({colour.rgb for colour in GAME.settings.colour}) == 4
    assert {flag.radius_m for flag in flags} == {0.01}
    assert GAME.settings.pole_height_m == 0.25


def test_starts() -> None:
    """Each side has three start places; the right ones are the left ones turned (rules 6)."""
    left, right = GAME.starts
    assert [(p.x_m, p.y_m, p.heading_rad) for p in left] == [
        (-0.6, 0.0, 0.0),
        (-0.6, 0.4, 0.0),
        (-0.6, -0.4, 0.0),
    ]
    assert [(p.x_m, p.y_m, p.heading_rad) for p in right] == [
        (0.6, 0.0, math.pi),
        (0.6, -0.4, math.pi),
        (0.6, 0.4, math.pi),
    ]


def test_neutral_at_the_start() -> None:
    """At the start all markers are neutral and nobody has points."""
    assert set(GAME.board(START)) == {NEUTRAL}
    assert GAME.score(START) == (0, 0)


def test_lasts_three_minutes() -> None:
    """A match lasts 3 minutes (workshop 5-2 rule 1), its countdown 3 s, the pause after [x] 5 s."""
    match = arena.load("flag-strike").match
    assert (match.duration_s, match.countdown_s, match.restart_freeze_s) == (180.0, 3.0, 5.0)
    assert match.levels == ("B",)


# Corners (workshop 5-2 rules 2 and 3, rules 6)


@pytest.mark.parametrize("corner", range(4))
def test_corner_takes_the_colour(corner: int) -> None:
    """A robot whose middle comes into a corner takes this corner (workshop 5-2 rule 2)."""
    after, events = tick(START, view(CORNERS[corner]))
    assert claims(events) == [(0, f"corner{corner}")]
    assert events[0].kind == "capture"
    assert events[0].said == say("event.capture", team="", marker=f"corner{corner}", points=5)
    assert not faults(events[0].said)
    assert after.board[corner] == LEFT
    assert GAME.score(after) == (5, 0)


@pytest.mark.parametrize(
    ("x_m", "inside"), [(0.75, True), (0.9375, True), (0.5625, True), (0.5624, False)]
)
def test_corner_edge(x_m: float, inside: bool) -> None:
    """A corner is a circle, and its edge belongs to it."""
    game = arena.load(
        "flag-strike",
        {"game": {"corner_inset_m": 0.25, "corner_radius_m": 0.1875, "clearance_m": 0.2}},
    ).game
    assert (game.corner_at(x_m, 0.75) == 3) is inside
    assert (game.corner_at(-x_m, -0.75) == 0) is inside


def test_corner_is_nowhere_for_no_number() -> None:
    """A position of NaN lies in no corner."""
    assert GAME.corner_at(math.nan, 0.8) == NO_CORNER


def test_corner_can_be_retaken() -> None:
    """A robot can take a corner while the other robot is still inside (workshop 5-2 rule 3)."""
    held, _ = tick(START, view(CORNERS[0]))
    after, events = tick(held, view(CORNERS[0]), view(CORNERS[0]))
    assert claims(events) == [(1, "corner0")]
    assert GAME.score(after) == (0, 5)
    stays, events = tick(after, view(CORNERS[0]), view(CORNERS[0]))
    assert stays is after
    assert events == ()
    left_out, _ = tick(after, view(), view(CORNERS[0]))
    again, events = tick(left_out, view(CORNERS[0]), view(CORNERS[0]))
    assert claims(events) == [(0, "corner0")]
    assert GAME.score(again) == (5, 0)


def test_own_corner_is_no_event() -> None:
    """A robot that comes into its own corner again changes nothing."""
    held, _ = tick(START, view(CORNERS[2]))
    outside, _ = tick(held)
    assert GAME.board(outside)[2] == LEFT
    _, events = tick(outside, view(CORNERS[2]))
    assert events == ()


def test_both_come_in_one_tick() -> None:
    """If both robots come into a corner in the same tick, its owner does not change (rules 6)."""
    for owner in (NEUTRAL, LEFT, RIGHT):
        before = GAME.set(START, 1, owner)
        after, events = tick(before, view(CORNERS[1]), view(CORNERS[1]))
        assert events == ()
        assert after.board == before.board
        assert after.inside == (1, 1)


def test_both_take_other_corners_in_one_tick() -> None:
    """Captures in the same tick are listed in the order of the markers, not of the seats."""
    _, events = tick(START, view(CORNERS[3]), view(CORNERS[1]))
    assert claims(events) == [(1, "corner1"), (0, "corner3")]


def test_put_down_outside_and_in_again_in_one_tick() -> None:
    """After [x], a robot in a corner captures it only if its start place is outside this corner."""
    held, _ = tick(START, view(CORNERS[0]), view())
    lost = GAME.set(held, 0, RIGHT)
    _, events = tick(lost, view(CORNERS[0], placed=(-0.6, 0.0)))
    assert claims(events) == [(0, "corner0")]
    _, events = tick(lost, view(CORNERS[0], placed=CORNERS[0]))
    assert events == ()


def test_start_inside_a_corner_takes_nothing() -> None:
    """A robot that starts inside a corner does not take it (rules 6)."""
    game = arena.load("flag-strike", {"game": {"starts": [[-0.8, 0.8]]}}).game
    _, events = tick(game.start(), view((-0.8, 0.8)), game=game)
    assert game.start().inside == (2, 1)
    assert events == ()


def test_corner_points_are_a_setting() -> None:
    """The points of a held corner are a setting."""
    game = arena.load("flag-strike", {"game": {"corner_points": 7}}).game
    after, events = tick(game.start(), view(CORNERS[0]), game=game)
    assert game.score(after) == (7, 0)
    assert events[0].points == 7


# All four corners (workshop 5-2 rule 4, rules 6)


def all_corners_for_left(game: FlagStrike = GAME) -> State:
    state = game.start()
    for corner in range(4):
        assert game.over(state) is None
        state = game.set(state, corner, LEFT)
    return state


def test_all_four_end_the_match() -> None:
    """The match ends when one robot holds all four corners; the team with more points wins."""
    state = all_corners_for_left()
    assert GAME.over(state) == say("over.all-corners", seat="left")
    assert GAME.winner(state, (20, 22)) == 1
    assert GAME.winner(state, (20, 20)) is None
    assert GAME.over(GAME.set(state, 3, RIGHT)) is None
    for corner in range(4):
        state = GAME.set(state, corner, RIGHT)
    assert GAME.over(state) == say("over.all-corners", seat="right")
    assert GAME.score(state) == (0, 20)


def test_ends_after_all_events_of_the_tick() -> None:
    """The end is checked after all events of a tick: a corner lost in it keeps the match going."""
    three = GAME.set(all_corners_for_left(), 3, NEUTRAL)
    after, events = tick(three, view(CORNERS[3]), view(CORNERS[0]))
    assert claims(events) == [(1, "corner0"), (0, "corner3")]
    assert GAME.over(after) is None


def test_all_corners_win() -> None:
    """With `all_corners_win`, the robot that holds all corners wins with any score."""
    game = arena.load("flag-strike", {"game": {"all_corners_win": True}}).game
    assert game.winner(all_corners_for_left(game), (20, 22)) == 0
    assert game.winner(game.start(), (20, 22)) == 1


# Flags (workshop 5-2 rule 5, rules 6)


@pytest.mark.parametrize(("flag", "points"), [("flag0", 1), ("flag8", 2), ("flag19", 5)])
def test_strike(flag: str, points: int) -> None:
    """A flag that one robot touches falls; its points stay with the robot (workshop 5-2 rule 5)."""
    after, events = tick(START, view(touched=(flag,)))
    assert claims(events) == [(0, flag)]
    assert events[0].kind == "strike"
    assert events[0].points == points
    assert events[0].said == say("event.strike", team="", marker=flag, points=points)
    assert not faults(events[0].said)
    assert GAME.score(after) == (points, 0)
    later, events = tick(after, view(), view(touched=(flag,)))
    assert events == ()
    assert later is after


def test_touched_by_both_it_stands() -> None:
    """A flag that both robots touch stands until one of them lets go (rules 6)."""
    both = view(touched=("flag4",))
    after, events = tick(START, both, both)
    assert events == ()
    assert after.board == START.board
    _, events = tick(after, view(), both)
    assert claims(events) == [(1, "flag4")]


def test_several_flags_in_one_tick() -> None:
    """All flags touched in a tick fall, and their events follow the order of the markers."""
    _, events = tick(START, view(touched=("flag9", "flag3")), view(touched=("flag5", "flag3")))
    assert claims(events) == [(1, "flag5"), (0, "flag9")]


def test_capture_and_strike_in_one_tick() -> None:
    """A score is the sum of the points of corners and flags (workshop 5-2 rule 7)."""
    after, events = tick(START, view(CORNERS[0], touched=("flag19",)))
    assert claims(events) == [(0, "corner0"), (0, "flag19")]
    assert GAME.score(after) == (10, 0)


# Winner (workshop 5-2 rule 8)


@pytest.mark.parametrize(("scores", "winner"), [((9, 8), 0), ((8, 9), 1), ((8, 8), None)])
def test_winner_has_more_points(scores: tuple[int, int], winner: int | None) -> None:
    """The team with more points wins; equal points make a draw (workshop 5-2 rule 8)."""
    assert GAME.winner(START, scores) == winner


# Referee (workshop 5-2 rule 9, rules 4.1)


def test_referee_sets_corners_and_flags() -> None:
    """When the referee sets a marker, the score changes; only a flag can be set to "down"."""
    state = GAME.set(GAME.set(START, 0, LEFT), INDEX["flag19"], RIGHT)
    assert GAME.score(state) == (5, 5)
    down = GAME.set(state, INDEX["flag19"], DOWN)
    assert GAME.score(down) == (5, 0)
    assert tick(down, view(touched=("flag19",)))[1] == ()
    stands = GAME.set(down, INDEX["flag19"], NEUTRAL)
    assert claims(tick(stands, view(touched=("flag19",)))[1]) == [(0, "flag19")]
    assert sum(now != was for now, was in zip(down.board, START.board, strict=True)) == 2
    assert GAME.board(GAME.set(START, INDEX["flag0"], DOWN))[INDEX["flag0"]] == DOWN
    with pytest.raises(NoSuchState, match=r"^a corner can be neutral, left or right$"):
        GAME.set(START, 0, DOWN)


def test_struck_capture() -> None:
    """A capture that was taken back does not happen again until the robot has left the corner."""
    after, events = tick(START, view(CORNERS[0]), struck=frozenset({(0, "corner0")}))
    assert events == ()
    assert after.inside == (0, NO_CORNER)
    assert tick(after, view(CORNERS[0])) == (after, ())
    outside, _ = tick(after)
    assert claims(tick(outside, view(CORNERS[0]))[1]) == [(0, "corner0")]


def test_struck_touch_is_void_until_let_go() -> None:
    """A strike that was taken back does not happen again until the robot has let go of the flag."""
    touching = view(touched=("flag6",))
    after, events = tick(START, touching, struck=frozenset({(0, "flag6")}))
    assert events == ()
    assert after.board == START.board
    assert tick(after, touching) == (after, ())
    free, _ = tick(after)
    assert free.void == ()
    assert claims(tick(free, touching)[1]) == [(0, "flag6")]


def test_void_touch_does_not_protect_the_flag() -> None:
    """After one robot's strike is taken back, the other robot can still strike the same flag."""
    touching = view(touched=("flag6",))
    after, _ = tick(START, touching, struck=frozenset({(0, "flag6")}))
    fallen, events = tick(after, touching, touching)
    assert claims(events) == [(1, "flag6")]
    again = GAME.set(fallen, INDEX["flag6"], NEUTRAL)
    assert tick(again, touching)[1] == ()


def test_nothing_happens() -> None:
    """A tick without events returns the same state."""
    before = tick(START)[0]
    assert tick(before, view((0.1, 0.1)), view((-0.3, 0.3))) == (before, ())
    assert tick(before)[0] is before


# What a page says of them


def test_rule_follows_the_settings() -> None:
    """The sentence on the pages has the points of a corner, and what all four are worth."""
    assert GAME.rule == say("rule.flag-strike", corner=5)
    game = arena.load("flag-strike", {"game": {"corner_points": 7, "all_corners_win": True}}).game
    assert game.rule == say("rule.flag-strike-corners", corner=7)


def test_gains_are_what_scores_now() -> None:
    """A marker is marked if and only if going there now brings it, and with its points."""
    draws = random.Random(7)
    for _ in range(200):
        corners = [draws.choice((NEUTRAL, LEFT, RIGHT)) for _ in range(4)]
        flags = [draws.choice((NEUTRAL, NEUTRAL, LEFT, RIGHT, DOWN)) for _ in range(20)]
        inside = draws.choice((NO_CORNER, 0, 1, 2, 3))
        void = tuple((0, flag) for flag in range(4, 24) if draws.random() < 0.1)
        before = State((*corners, *flags), (inside, NO_CORNER), void)
        here = MIDDLE if inside == NO_CORNER else CORNERS[inside]
        held = tuple(GAME.markers[flag].name for _, flag in void)
        points = GAME.gains(before, 0).points
        for index, marker in enumerate(GAME.markers):
            there = CORNERS[index] if index < 4 else here
            touched = held if index < 4 else tuple({*held, marker.name})
            _, events = tick(before, view(there, touched))
            assert [(event.marker, event.points) for event in events] == (
                [(marker.name, points[marker.name])] if marker.name in points else []
            )


@pytest.mark.parametrize(
    ("corners", "flags", "inside", "code"),
    [
        ((LEFT, LEFT, LEFT, RIGHT), NEUTRAL, NO_CORNER, "last-corner"),
        ((LEFT, RIGHT, NEUTRAL, NEUTRAL), NEUTRAL, 0, "flags"),
        ((LEFT, RIGHT, NEUTRAL, NEUTRAL), NEUTRAL, 1, "enter-again"),
        ((LEFT, RIGHT, NEUTRAL, NEUTRAL), DOWN, NO_CORNER, "corners"),
    ],
)
def test_player_is_told_what_scores(
    corners: tuple[int, ...], flags: int, inside: int, code: str
) -> None:
    """The sentence names the corner that ends the match, and one that must be entered again."""
    said = GAME.gains(State((*corners, *[flags] * 20), (inside, NO_CORNER)), 0).said
    assert said is not None
    assert said.code == f"gains.{code}"
    assert faults(said) == []
