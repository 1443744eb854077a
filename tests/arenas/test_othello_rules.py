"""Robot-Othello, rule by rule (workshop 5-1, rules 5)."""

import math
import random

import pytest

from lacoc_arenas import arena
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
from lacoc_arenas.othello.rules import NO_CELL, Othello, State
from lacoc_shared.words import Phrase, faults, say

GAME: Othello = arena.load("othello").game
INDEX = {marker.name: index for index, marker in enumerate(GAME.markers)}
GAP = "gap"


def with_settings(**settings: object) -> Othello:
    return arena.load("othello", {"game": settings}).game


def view(where: str, placed: str | None = None, game: Othello = GAME) -> RobotView:
    """Return the view of a robot at the middle of a disc, or in the gap at the field's middle."""
    x_m, y_m = (0.0, 0.0) if where == GAP else middle(where, game)
    start = None if placed is None else Place(*middle(placed, game), 0.0)
    return RobotView(x_m, y_m, 0.07, 1.0, 0.0, 0.0, 0.0, start)


def middle(name: str, game: Othello = GAME) -> tuple[float, float]:
    disc = game.markers[INDEX[name]]
    return disc.x_m, disc.y_m


def board(*rows: str) -> tuple[int, ...]:
    """Return the cells of a board picture whose first line is row 5; missing rows are neutral."""
    filled = [*rows, *["......"] * (6 - len(rows))]
    return tuple(".LR".index(cell) for row in reversed(filled) for cell in row)


def picture(cells: tuple[int, ...]) -> tuple[str, ...]:
    rows = ["".join(".LR"[cell] for cell in cells[6 * row : 6 * row + 6]) for row in range(6)]
    return tuple(reversed(rows))


def state(cells: tuple[int, ...], left: str, right: str = "c5r0") -> State:
    return State(cells, (INDEX[left], INDEX[right]))


def tick(
    before: State,
    left: str = GAP,
    right: str = GAP,
    *,
    game: Othello = GAME,
    struck: frozenset[Claim] = frozenset(),
) -> tuple[State, tuple[GameEvent, ...]]:
    return game.step(before, (view(left, game=game), view(right, game=game)), 0.02, struck)


# Board (workshop 5-1 rule 1, rules 5)


def test_board_is_six_by_six() -> None:
    """The board has 6 x 6 discs (workshop 5-1 rule 1); c0r0 is at the lower left."""
    assert len(GAME.markers) == 36
    assert {(disc.kind, disc.points) for disc in GAME.markers} == {("disc", 1)}
    assert middle("c0r0") == (-0.75, -0.75)
    assert middle("c5r0") == (0.75, -0.75)
    assert middle("c0r5") == (-0.75, 0.75)
    assert math.isclose(middle("c1r0")[0] - middle("c0r0")[0], 0.30)
    assert {disc.radius_m for disc in GAME.markers} == {0.12}
    assert [disc.name for disc in GAME.markers[:7]] == [f"c{c}r0" for c in range(6)] + ["c0r1"]


def test_wall_stands_outside_the_outer_discs() -> None:
    """The walls stand 0.15 m outside the edge of the outer discs (rules 5)."""
    assert GAME.size_m == pytest.approx((2.04, 2.04))
    assert with_settings(wall_m=0.3).size_m == pytest.approx((2.34, 2.34))


# Opening (rules 5)

OPENINGS = {
    "halves": ("LLLRRR",) * 6,
    "neutral": ("......", "......", ".....R", "L.....", "......", "......"),
    "checkers": ("RLRRLR", "LRLLRL", "RLRRLR", "LRLLRL", "RLRRLR", "LRLLRL"),
    "reversi": ("......", "......", "..LR.R", "L.LR..", "......", "......"),
}


@pytest.mark.parametrize("name", OPENINGS)
def test_opening(name: str) -> None:
    """Each of the four openings gives the expected board."""
    assert picture(with_settings(opening=name).start().cells) == OPENINGS[name]


@pytest.mark.parametrize("name", OPENINGS)
def test_opening_is_fair(name: str) -> None:
    """Each opening turned by 180 degrees is the same with the colours swapped."""
    cells = with_settings(opening=name).start().cells
    assert tuple((NEUTRAL, RIGHT, LEFT)[cell] for cell in reversed(cells)) == cells


def test_start_cells_are_owned_where_they_are_set() -> None:
    """The opening `neutral` gives each team only its first start cell, wherever that is."""
    game = with_settings(opening="neutral", start_cells=[[2, 5], [0, 0]])
    cells = game.start().cells
    assert cells[INDEX["c2r5"]] == LEFT
    assert cells[INDEX["c3r0"]] == RIGHT
    assert cells.count(NEUTRAL) == 34


# Start places (workshop 5-1 rule 3, rules 5)


def test_starts() -> None:
    """The left robot starts on column 0 and faces +x; the right one faces -x on column 5."""
    left, right = GAME.starts
    assert [GAME.markers[GAME.cell_at(p.x_m, p.y_m)].name for p in left] == [
        "c0r2",
        "c0r3",
        "c0r1",
        "c0r4",
        "c0r0",
        "c0r5",
    ]
    assert [GAME.markers[GAME.cell_at(p.x_m, p.y_m)].name for p in right] == [
        "c5r3",
        "c5r2",
        "c5r4",
        "c5r1",
        "c5r5",
        "c5r0",
    ]
    assert {p.heading_rad for p in left} == {0.0}
    assert {p.heading_rad for p in right} == {math.pi}


def test_start_cell_is_the_last_cell() -> None:
    """A robot's start cell is its last cell, so the robot can flip from there (rules 5)."""
    game = with_settings(opening="neutral")
    assert game.start().last == (INDEX["c0r2"], INDEX["c5r3"])
    after, events = tick(game.start(), "c1r2", game=game)
    assert [event.marker for event in events] == ["c1r2"]
    assert after.cells[INDEX["c1r2"]] == LEFT


def test_being_put_down_flips_nothing() -> None:
    """After [x], the robot's start cell is its last cell, and nothing flips (rules 5)."""
    before = state(board("......", "......", "......", "RL...."), "c1r2")
    after, events = GAME.step(before, (view("c0r2", placed="c0r2"), view(GAP)), 0.02)
    assert events == ()
    assert after.cells == before.cells
    assert after.last[0] == INDEX["c0r2"]
    again, _ = GAME.step(after, (view("c0r2", placed="c0r2"), view(GAP)), 0.02)
    assert again is after, "the same object where nothing changed"


def test_being_put_down_and_in_a_gap_at_once() -> None:
    """After [x], the start cell is the last cell even if the robot is in a gap in that tick."""
    before = state(board("LR...."), "c0r5", "c1r5")
    after, _ = GAME.step(before, (view(GAP, placed="c0r2"), view(GAP)), 0.02)
    assert after.last == (INDEX["c0r2"], INDEX["c1r5"])
    after, _ = GAME.step(before, (view(GAP), view(GAP, placed="c5r3")), 0.02)
    assert after.last == (INDEX["c0r5"], INDEX["c5r3"])


def test_walking_off_the_start_in_the_tick_of_being_put_down() -> None:
    """A robot that leaves its start cell in the tick of [x] can flip the next disc from there."""
    before = state(board("......", "......", "......", "LR...."), "c4r4")
    after, events = GAME.step(before, (view("c1r2", placed="c0r2"), view(GAP)), 0.02)
    assert [event.marker for event in events] == ["c1r2"]
    assert after.last[0] == INDEX["c1r2"]


# Entering a disc (rules 5)


@pytest.mark.parametrize(("offset_m", "inside"), [(0.0, True), (0.125, True), (0.1250001, False)])
def test_entering_at_the_radius(offset_m: float, inside: bool) -> None:
    """A robot is on a disc when its middle is within the disc's radius, edge included."""
    game = with_settings(pitch_m=0.5, disc_radius_m=0.125)
    x_m, y_m = 0.25, -0.25
    cell = INDEX["c3r2"]
    assert (game.cell_at(x_m + offset_m, y_m) == cell) is inside
    assert (game.cell_at(x_m - offset_m, y_m) == cell) is inside
    assert (game.cell_at(x_m, y_m + offset_m) == cell) is inside


@pytest.mark.parametrize(
    ("x_m", "y_m"),
    [
        (0.0, 0.0),
        (0.0, 0.15),
        (0.3, 0.15),
        (0.9, 0.15),
        (1.05, 0.15),  # where a seventh column would have its middle
        (-0.15, -1.05),
        (-3.15, 0.15),
        (math.nan, 0.0),
        (math.inf, 0.15),
    ],
)
def test_between_and_outside_the_discs(x_m: float, y_m: float) -> None:
    """A point between discs, outside the board, or with NaN or infinity belongs to no cell."""
    assert GAME.cell_at(x_m, y_m) == NO_CELL


def test_touching_discs_share_no_point() -> None:
    """A point where two discs touch belongs to the outer one of them.

    A point where two discs touch on a middle line of the field belongs to neither.
    """
    game = with_settings(pitch_m=0.5, disc_radius_m=0.25)
    assert game.cell_at(0.5, 0.25) == INDEX["c4r3"]
    assert game.cell_at(-0.5, -0.25) == INDEX["c1r2"]
    assert game.cell_at(0.0, 0.25) == game.cell_at(0.25, 0.0) == NO_CELL
    assert game.cell_at(1.5, 0.25) == game.cell_at(0.25, 1.5) == NO_CELL


def test_entered_cell_becomes_the_last_whatever_happens() -> None:
    """A disc that is entered diagonally does not flip but becomes the last cell (rules 5)."""
    before = state(board("......", "......", "......", ".R....", "L....."), "c0r1")
    after, events = tick(before, "c1r2")
    assert events == ()
    assert after.last[0] == INDEX["c1r2"]


def test_nothing_happens_on_the_last_cell() -> None:
    """A robot that leaves a disc for a gap and comes back has not entered it again."""
    before = state(board("......", "......", "......", "R....."), "c0r2")
    for where in (GAP, "c0r2"):
        after, events = tick(before, where, "c5r0")
        assert after is before
        assert events == ()


# Flips by walking (workshop 5-1 rules 4 and 5, rules 5)

WALKS = {
    "the other's colour along the row": ("LR....", "c0r5", "c1r5", True),
    "a neutral disc along the row": ("L.....", "c0r5", "c1r5", True),
    "backward along the row": ("RL....", "c1r5", "c0r5", True),
    "from a disc of the other colour": ("RR....", "c0r5", "c1r5", False),
    "from a neutral disc": (".R....", "c0r5", "c1r5", False),
    "over a gap of one disc": ("LRR...", "c0r5", "c2r5", False),
    "one's own colour": ("LL....", "c0r5", "c1r5", False),
}


@pytest.mark.parametrize("what", WALKS)
def test_flip_by_walking(what: str) -> None:
    """A robot flips a disc that it enters from a neighbour of its colour (workshop 5-1 rule 4)."""
    row, origin, cell, flips = WALKS[what]
    before = state(board(row), origin)
    after, events = tick(before, cell)
    assert bool(events) is flips
    assert (after.cells != before.cells) is flips
    assert after.last[0] == INDEX[cell]
    if flips:
        assert after.cells[INDEX[cell]] == LEFT


@pytest.mark.parametrize("cell", ["c2r3", "c2r1", "c1r2", "c3r2"])
def test_flip_vertically_and_horizontally(cell: str) -> None:
    """Discs flip along the column and along the row, in both directions (workshop 5-1 rule 5)."""
    before = state(board("......", "......", "..R...", ".RLR..", "..R..."), "c2r2")
    after, events = tick(before, cell)
    assert [event.marker for event in events] == [cell]
    assert after.cells[INDEX[cell]] == LEFT


@pytest.mark.parametrize("cell", ["c1r1", "c1r3", "c3r1", "c3r3"])
def test_never_diagonally(cell: str) -> None:
    """A disc that is entered diagonally stays as it is (rules 5)."""
    before = state(board("......", "......", ".RRR..", ".RLR..", ".RRR.."), "c2r2")
    after, events = tick(before, cell)
    assert events == ()
    assert after.cells == before.cells


def test_colour_of_the_last_cell_counts_now() -> None:
    """A robot flips no disc from a last cell that has lost the robot's colour (rules 5)."""
    before = state(board("LR...."), "c0r5")
    lost = GAME.set(before, INDEX["c0r5"], RIGHT)
    assert tick(lost, "c1r5")[1] == ()
    assert len(tick(before, "c1r5")[1]) == 1


def test_right_robot_flips_too() -> None:
    """The right robot flips discs as the left one does."""
    before = state(board("....LR"), "c0r0", "c5r5")
    after, events = tick(before, right="c4r5")
    assert [(event.seat, event.marker, event.points) for event in events] == [(1, "c4r5", 1)]
    assert after.cells[INDEX["c4r5"]] == RIGHT


# Runs (workshop 5-1 rule 5, rules 5)

RUNS = {
    "one disc to one's own": ("LRRL..", "LLLL..", ("c2r5",)),
    "three discs to one's own": ("LRRRRL", "LLLLLL", ("c2r5", "c3r5", "c4r5")),
    "none to the edge": ("LRRRRR", "LLRRRR", ()),
    "none across a neutral disc": ("LRR.RL", "LLR.RL", ()),
    "none beyond the nearest of one's own": ("LRRLRL", "LLLLRL", ("c2r5",)),
    "from a neutral disc": ("L.RL..", "LLLL..", ("c2r5",)),
    "none where the next is one's own": ("LRLRL.", "LLLRL.", ()),
}


@pytest.mark.parametrize("what", RUNS)
def test_flip_in_a_row(what: str) -> None:
    """A run of the other colour flips, up to the next disc of the robot's own colour (rules 5)."""
    row, expected, also = RUNS[what]
    after, events = tick(state(board(row), "c0r5"), "c1r5")
    assert picture(after.cells)[0] == expected
    assert events[0].marker == "c1r5"
    assert events[0].also == also
    assert events[0].points == 1 + len(also)


def test_flip_in_row_and_column_at_once() -> None:
    """A flip by walking also flips runs in the row and the column, never diagonally (rules 5)."""
    before = state(
        board(
            "..L..L",
            "..R.R.",
            "..RR..",
            "LLRRRL",
            "..R...",
            "..L...",
        ),
        "c1r2",
    )
    after, events = tick(before, "c2r2")
    assert picture(after.cells) == (
        "..L..L",
        "..L.R.",
        "..LR..",
        "LLLLLL",
        "..L...",
        "..L...",
    )
    assert set(events[0].also) == {"c3r2", "c4r2", "c2r3", "c2r4", "c2r1"}


def test_no_run_without_a_flip_by_walking() -> None:
    """A run of discs flips only together with a disc that a robot flips by walking (rules 5)."""
    before = state(board("......", "RRRL.."), "c0r3")
    after, events = tick(before, "c0r4")
    assert events == ()
    assert after.cells == before.cells


def test_flank_off() -> None:
    """With `flank = false`, no run of discs flips."""
    game = with_settings(flank=False)
    after, events = tick(state(board("LRRL.."), "c0r5"), "c1r5", game=game)
    assert picture(after.cells)[0] == "LLRL.."
    assert events[0].also == ()


# Both robots in the same tick (rules 4 and 5)


def test_both_enter_the_same_neutral_disc() -> None:
    """A neutral disc that both robots enter at once stays neutral and is the last cell of both."""
    before = state(board("L.R..."), "c0r5", "c2r5")
    after, events = tick(before, "c1r5", "c1r5")
    assert events == ()
    assert after.cells == before.cells
    assert after.last == (INDEX["c1r5"], INDEX["c1r5"])


def test_second_robot_may_claim_a_disc_the_first_stands_on() -> None:
    """A robot may take a neutral disc on which the other robot stands already."""
    before = state(board("..R..."), "c1r5", "c2r5")
    _, events = tick(before, "c1r5", "c1r5")
    assert [event.seat for event in events] == [1]


def test_a_disc_that_is_the_others_last_cell_can_be_entered() -> None:
    """A robot can flip a disc that is the other robot's last cell."""
    before = state(board("LR...."), "c0r5", "c1r5")
    after, events = tick(before, "c1r5")
    assert [(event.seat, event.marker) for event in events] == [(0, "c1r5")]
    assert after.last == (INDEX["c1r5"], INDEX["c1r5"])


def test_last_cell_that_flips_in_the_same_tick_still_counts() -> None:
    """Flips are judged on the board before the tick, so two robots can flip each other's disc."""
    before = state(board("LR....", "RL...."), "c0r5", "c1r5")
    after, events = tick(before, "c1r5", "c0r5")
    assert {(event.seat, event.marker) for event in events} == {(0, "c1r5"), (1, "c0r5")}
    assert picture(after.cells)[0] == "RL...."


def test_end_disc_that_flips_in_the_same_tick_still_counts() -> None:
    """A run still flips when the other robot takes the disc at its end in the same tick."""
    before = state(board("LRRLR.", "......"), "c0r5", "c4r5")
    after, events = tick(before, "c1r5", "c3r5")
    assert picture(after.cells)[0] == "LLLRR."
    assert events[0].also == ("c2r5",)


def test_events_come_in_the_order_of_the_discs() -> None:
    """Events of the same tick are listed in the order of the discs, not of the seats."""
    before = state(board("RL....", "LR...."), "c0r4", "c0r5")
    _, events = tick(before, "c1r4", "c1r5")
    assert [event.marker for event in events] == ["c1r4", "c1r5"]
    mirrored = state(board("LR....", "RL...."), "c0r5", "c0r4")
    _, events = tick(mirrored, "c1r5", "c1r4")
    assert [event.marker for event in events] == ["c1r4", "c1r5"]
    assert [event.seat for event in events] == [1, 0]


# Score and end (workshop 5-1 rules 6 and 7, rules 5)


def test_score_is_the_number_of_discs() -> None:
    """The score is a team's number of discs, without neutral ones (workshop 5-1 rule 6)."""
    before = state(board("LLL.RR"), "c0r5")
    assert GAME.score(before) == (3, 2)
    assert GAME.score(GAME.start()) == (18, 18)


@pytest.mark.parametrize(
    ("scores", "winner"), [((19, 17), 0), ((17, 19), 1), ((18, 18), None), ((0, 0), None)]
)
def test_winner_has_more_discs(scores: tuple[int, int], winner: int | None) -> None:
    """The team with more discs wins; equal numbers make a draw (workshop 5-1 rule 7)."""
    assert GAME.winner(GAME.start(), scores) == winner


def test_lasts_three_minutes() -> None:
    """A match lasts 3 minutes (workshop 5-1 rule 2), its countdown 3 s, the pause after [x] 5 s."""
    match = arena.load("othello").match
    assert (match.duration_s, match.countdown_s, match.restart_freeze_s) == (180.0, 3.0, 5.0)
    assert match.levels == ("B",)


def test_over_when_a_team_has_no_disc_left() -> None:
    """The match ends as soon as a team has no disc left (rules 5)."""
    before = state(board("LR...."), "c0r5")
    assert GAME.over(before) is None
    after, _ = tick(before, "c1r5")
    assert GAME.over(after) == say("over.no-disc", seat="right")
    assert GAME.winner(after, GAME.score(after)) == 0
    assert GAME.over(state(board("R....."), "c1r5")) == say("over.no-disc", seat="left")


# Referee (workshop 5-1 rule 8, rules 4.1)


def test_referee_sets_a_disc() -> None:
    """When the referee sets a disc, the score changes; a disc can't be set to "down"."""
    before = GAME.start()
    after = GAME.set(before, INDEX["c5r5"], LEFT)
    assert GAME.score(after) == (19, 17)
    assert after.last == before.last
    assert GAME.score(GAME.set(before, INDEX["c5r5"], NEUTRAL)) == (18, 17)
    one = GAME.set(State((NEUTRAL,) * 36, before.last), INDEX["c2r5"], LEFT)
    assert one.cells == board("..L...")
    with pytest.raises(NoSuchState, match=r"^a disc can be neutral, left or right$"):
        GAME.set(before, 0, DOWN)


def test_struck_flip_has_no_effect_but_the_step() -> None:
    """A flip that was taken back does not happen, but its disc becomes the last cell."""
    before = state(board("LRRL.."), "c0r5")
    after, events = tick(before, "c1r5", struck=frozenset({(0, "c1r5")}))
    assert events == ()
    assert after.cells == before.cells
    assert after.last[0] == INDEX["c1r5"]
    assert tick(after, "c1r5") == (after, ())


def test_struck_is_one_claim_only() -> None:
    """If one seat's flip is taken back, the other seat's flip in the same tick stays."""
    before = state(board("LR....", "....LR"), "c0r5", "c5r4")
    _, events = tick(before, "c1r5", "c4r4", struck=frozenset({(0, "c1r5"), (0, "c4r4")}))
    assert [(event.seat, event.marker) for event in events] == [(1, "c4r4")]


def test_event_says_what_happened() -> None:
    """The event of a flip names the entered disc and the discs that flip with it."""
    _, events = tick(state(board("LRRL.."), "c0r5"), "c1r5")
    assert events[0].said == say("event.flip", team="", marker="c1r5", also=["c2r5"])
    assert events[0].kind == "flip"
    _, events = tick(state(board("LR...."), "c0r5"), "c1r5")
    assert events[0].said == say("event.flip", team="", marker="c1r5", also=[])
    _, events = tick(state(board("LRRRL."), "c0r5"), "c1r5")
    assert events[0].said == say("event.flip", team="", marker="c1r5", also=["c2r5", "c3r5"])
    assert not faults(events[0].said)


# What a page says of them


def test_rule_follows_the_settings() -> None:
    """The sentence on the pages leaves out rows where they do not flip."""
    assert GAME.rule == say("rule.othello")
    assert with_settings(flank=False).rule == say("rule.othello-single")


@pytest.mark.parametrize("flank", [True, False])
def test_gains_are_what_the_next_step_flips(flank: bool) -> None:
    """A disc is marked if and only if walking onto it now flips discs, and with their number."""
    game = with_settings(flank=flank)
    draws = random.Random(7)
    marked = 0
    for _ in range(300):
        cells = tuple(draws.choice((NEUTRAL, LEFT, LEFT, RIGHT, RIGHT)) for _ in range(36))
        last = tuple(draws.sample(range(36), 2))
        before = State(cells, (last[0], last[1]))
        seat = draws.randrange(2)
        points = game.gains(before, seat).points
        for disc in game.markers:
            views = [view(game.markers[cell].name, game=game) for cell in last]
            views[seat] = view(disc.name, game=game)
            _, events = game.step(before, tuple(views), 0.02)
            assert [event.points for event in events] == (
                [points[disc.name]] if disc.name in points else []
            )
        marked += len(points)
    assert marked > 100


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        (board("RL....", "RR...."), say("gains.their-disc", marker="c0r5")),
        (board(".L....", "RR...."), say("gains.neutral-disc", marker="c0r5")),
        (board("LL....", "LR...."), say("gains.inside", marker="c0r5")),
        (board("LL....", "RR...."), say("gains.flip", marker="c0r5")),
    ],
)
def test_player_is_told_what_its_last_disc_allows(cells: tuple[int, ...], said: Phrase) -> None:
    """From a disc that is not its own nothing flips, and the player is told what to do first."""
    gains = GAME.gains(state(cells, "c0r5"), 0)
    assert gains.said == said
    assert faults(said) == []
    assert bool(gains.points) == (said.code == "gains.flip")
