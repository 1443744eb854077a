"""Tests of the take-back: the match is judged as if an event had not happened (rules 4.1)."""

import tracemalloc
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from stage import LEFT, QUICK, RIGHT, Script, Stage, X, key, seen

from lacoc_arenas import arena as arenas
from lacoc_arenas.game import GameEvent, Observation, Place, RobotView
from lacoc_server.match.kept.history import History
from lacoc_shared import decisions as d
from lacoc_shared.messages import DecisionReply, Event, Refusal
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say

P = Phase
CORNERS = ((-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8), (0.8, 0.8))
AWAY = (0.0, 0.0)


def cell(name: str) -> tuple[float, float]:
    """Return the centre of a disc, such as "c2r1" (column 2, row 1) [m]."""
    return (int(name[1]) - 2.5) * 0.3, (int(name[3]) - 2.5) * 0.3


def othello(walks: dict[int, dict[int, str]], ticks: int = 100) -> Stage:
    """Play Othello up to a tick; `walks` says in which tick which seat steps on which disc."""
    poses = {tick: {s: cell(c) for s, c in step.items()} for tick, step in walks.items()}
    return play(Stage("othello", QUICK, script=Script(poses=poses)), ticks)


def flag_strike(
    walks: dict[int, dict[int, tuple[float, float]]],
    touches: dict[int, dict[int, tuple[int, ...]]] | None = None,
    ticks: int = 100,
) -> Stage:
    script = Script(poses=dict(walks), touches=touches or {})
    return play(Stage("flag-strike", QUICK, script=script), ticks)


def play(stage: Stage, ticks: int) -> Stage:
    """Play to a tick, or to the end of the match if that comes first; then halt."""
    if not stage.beats:
        stage.to_playing()
    while stage.match.ticks < ticks and stage.phase is not P.FINISHED:
        stage.beat()
    if stage.phase is P.PLAYING:
        stage.decide(d.Halt())
    return stage


def event(stage: Stage, kind: str, marker: str) -> Event:
    """Return the newest event of a kind about a marker."""
    return [e for e in stage.events if e.kind == kind and e.data.get("marker") == marker][-1]


def take_back(stage: Stage, number: int, dry_run: bool = False) -> DecisionReply:
    reply = stage.decide(d.TakeBack(number, dry_run))
    assert isinstance(reply, DecisionReply), reply
    return reply


def idle(stage: Stage, *seats: int) -> Stage:
    """Return a stage at its first tick of play, in which no key has moved some robots yet."""
    stage.to_playing()
    for seat in seats:
        stage.match.seats[seat].idle = True
    return stage


def test_nobody_scores_before_a_key_has_moved_the_robot() -> None:
    """Rules 4: a robot that only stands or is pushed flips, takes and strikes nothing.

    With its first digit all of this counts, and after [x] it needs a digit again.
    """
    walks = {10: {LEFT: CORNERS[0]}, 20: {LEFT: AWAY}, 40: {LEFT: CORNERS[1]}, 60: {LEFT: AWAY}}
    touches = {5: {LEFT: (4,), RIGHT: (9,)}, 45: {LEFT: (4,)}, 70: {LEFT: (6,)}}
    stage = idle(Stage("flag-strike", QUICK, script=Script(dict(walks), touches)), LEFT)
    stage.run(30)
    assert [(e.seat, e.kind) for e in stage.events if e.kind in ("strike", "capture")] == [
        (RIGHT, "strike")
    ]
    stage.beat(key(LEFT, 2))
    stage.run(20)
    assert [e.kind for e in stage.events if e.seat == LEFT and e.data.get("marker")] == [
        "capture",
        "strike",
    ]
    before = stage.scores
    stage.beat(key(LEFT, X, seq=2))
    stage.run(30)
    assert stage.match.ticks > 70
    assert stage.scores == before


def test_a_take_back_lets_no_robot_score_that_no_key_had_moved() -> None:
    """Rules 4: judged again, an idle robot's steps count as little as they did before."""
    walks = {5: {RIGHT: "c3r2"}, 10: {LEFT: "c2r2"}, 15: {LEFT: "c3r2"}, 20: {LEFT: "c4r2"}}
    poses = {tick: {s: cell(c) for s, c in step.items()} for tick, step in walks.items()}
    stage = idle(Stage("othello", QUICK, script=Script(poses=poses)), LEFT)
    stage.run(12)
    stage.decide(d.Halt())
    decided = stage.decide(d.Set("c3r3", "left")).event
    stage.decide(d.Resume())
    stage.until(P.PLAYING)
    stage.run(20)
    assert stage.scores == (19, 17)
    stage.decide(d.Halt())
    reply = take_back(stage, decided)
    assert reply.changes == ()
    assert stage.scores == (18, 18)


# A chain of flips: the flip in tick 30 needs the one in tick 20.
CHAIN = {10: {LEFT: "c2r2"}, 20: {LEFT: "c3r2"}, 30: {LEFT: "c4r2"}, 40: {RIGHT: "c5r2"}}


def test_a_flip_and_what_came_of_it() -> None:
    """Rules 4.1: if a flip is taken back, later flips that needed it vanish and are listed."""
    stage = othello(CHAIN)
    assert stage.scores == (20, 16)
    first, second = event(stage, "flip", "c3r2"), event(stage, "flip", "c4r2")
    reply = take_back(stage, first.number)
    assert reply.changes == (
        say("change.vanishes", kind="flip", marker="c3r2"),
        say("change.vanishes", kind="flip", marker="c4r2"),
    )
    assert reply.scores == stage.scores == (18, 18)
    assert stage.board["c3r2"] == stage.board["c4r2"] == "right"
    assert (stage.match.result().reason, stage.match.result().computed) == ("", "")
    logged = next(e for e in stage.beats[-1].events if e.kind == "decision")
    assert logged.number == reply.event
    assert logged.data["vanished"] == [first.number, second.number]
    assert stage.phase is P.HALTED


def test_an_event_may_appear() -> None:
    """Rules 4.1: if a flip is taken back, a later flip may appear as a new event."""
    stage = othello(
        {
            5: {RIGHT: "c3r2", LEFT: "c2r1"},
            10: {LEFT: "c2r2"},
            15: {LEFT: "c3r2"},  # takes the disc that the right robot stands on
            20: {RIGHT: "c2r2"},  # flips nothing: it comes from a disc that it has lost
        }
    )
    assert stage.scores == (19, 17)
    reply = take_back(stage, event(stage, "flip", "c3r2").number)
    assert reply.changes[1:] == (say("change.appears", kind="flip", marker="c2r2"),)
    assert reply.scores == stage.scores == (17, 19)
    new = event(stage, "flip", "c2r2")
    assert render(new.said).startswith("Judged again: Bees flips disc C3")
    assert new.number == stage.match.next_number - 1
    assert reply.event is not None
    assert new.number > reply.event
    assert take_back(stage, new.number).scores == (18, 18)


def test_a_capture() -> None:
    """If a capture is taken back, the robot's next entry into that corner becomes a capture."""
    stage = flag_strike({10: {LEFT: CORNERS[0]}, 20: {LEFT: AWAY}, 30: {LEFT: CORNERS[0]}})
    first = event(stage, "capture", "corner0")
    assert stage.numbers("capture") == [first.number]
    reply = take_back(stage, first.number)
    assert reply.changes == (
        say("change.vanishes", kind="capture", marker="corner0"),
        say("change.appears", kind="capture", marker="corner0"),
    )
    assert stage.scores == (5, 0)
    assert take_back(stage, event(stage, "capture", "corner0").number).scores == (0, 0)


def test_a_strike() -> None:
    """If a strike is taken back, the flag stands, even if the robot keeps touching it."""
    on = {tick: {RIGHT: (22,)} for tick in range(10, 20)}  # flag18 has 5 points
    stage = flag_strike({}, on)
    assert stage.scores == (0, 5)
    reply = take_back(stage, event(stage, "strike", "flag18").number)
    assert (reply.scores, reply.changes) == (
        (0, 0),
        (say("change.vanishes", kind="strike", marker="flag18"),),
    )
    assert "flag18" not in stage.board


def test_adjust_and_set() -> None:
    """The decisions `adjust` and `set` can be taken back."""
    stage = othello(CHAIN)
    adjust, put = stage.decide(d.Adjust("right", 7)), stage.decide(d.Set("c0r0", "right"))
    assert stage.scores == (19, 24)
    reply = take_back(stage, adjust.event)
    assert (reply.scores, reply.changes) == ((19, 17), ())
    assert take_back(stage, put.event).scores == (20, 16)
    assert stage.scores == (20, 16)


def test_a_set_that_a_later_flip_needed() -> None:
    """If a `set` is taken back, everything after it is judged again, and a flip may appear."""
    stage = Stage("othello", QUICK, script=Script(poses={20: {LEFT: cell("c2r2")}})).to_playing()
    stage.run(10)
    stage.decide(d.Set("c3r2", "left"))
    number = stage.numbers("decision")[-1]
    stage.script.poses.update({30: {LEFT: cell("c3r2")}, 40: {LEFT: cell("c4r2")}})
    play(stage, 50)
    assert stage.scores == (20, 16)
    reply = take_back(stage, number)
    assert reply.changes == (say("change.appears", kind="flip", marker="c3r2"),)
    assert stage.scores == (20, 16)


@pytest.mark.parametrize("kind", ["flip", "adjust", "set"])
def test_a_dry_run_changes_nothing_and_tells_the_truth(kind: str) -> None:
    """A dry run shows what a take-back would change, and changes nothing."""
    stage, twin = othello(CHAIN), othello(CHAIN)
    for both in (stage, twin):
        both.decide(d.Set("c0r0", "right"))
        both.decide(d.Adjust("left", 2))
    number = {
        "flip": event(stage, "flip", "c3r2").number,
        "set": stage.numbers("decision")[-2],
        "adjust": stage.numbers("decision")[-1],
    }[kind]
    dry = take_back(stage, number, dry_run=True)
    twin.beat()
    unexplained = stage.decide(d.TakeBack(number, dry_run=True), reason="")
    assert isinstance(unexplained, DecisionReply), "asking needs no reason"
    assert (unexplained.changes, unexplained.scores) == (dry.changes, dry.scores)
    twin.beat()
    assert seen(stage) == seen(twin)
    assert (dry.event, stage.beats[-1].events) == (None, ())
    assert unexplained.beat == dry.beat + 1 == stage.frame.beat
    wet = take_back(stage, number)
    assert (dry.scores, dry.changes, dry.said) == (wet.scores, wet.changes, wet.said)
    assert stage.scores == wet.scores != twin.scores


@pytest.mark.parametrize("dry_run", [True, False])
def test_a_take_back_in_which_the_game_breaks_is_refused(
    dry_run: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the game's code breaks in a take-back, the referee is told why, and nothing changes."""
    stage = othello(CHAIN)
    before, number = stage.match.history.state, event(stage, "flip", "c3r2").number

    def broken(*_: object) -> None:
        raise UserError(say("plain.text", text="the game breaks"))

    monkeypatch.setattr(type(stage.match.history._game), "step", broken)
    reply = stage.decide(d.TakeBack(number, dry_run))
    assert isinstance(reply, Refusal)
    assert "the game breaks" in render(reply.why)
    assert stage.match.history.state is before
    assert stage.match.history.knows(number)


def test_what_is_gone_cannot_be_taken_back() -> None:
    """Events that are gone, take-backs, joins and changes of phase can't be taken back."""
    stage = othello(CHAIN)
    gone = [event(stage, "flip", name).number for name in ("c3r2", "c4r2")]
    gone += [stage.decide(d.Adjust("left", 1)).event, stage.decide(d.Set("c0r0", "right")).event]
    taken = [take_back(stage, number).event for number in (gone[0], *gone[2:])]
    before = seen(stage)
    for number in (*gone, *taken, *stage.numbers("phase", "join")):
        assert isinstance(stage.decide(d.TakeBack(number)), Refusal)
    assert seen(stage) == before


ALL_FOUR = {10 * n: {LEFT: at} for n, at in enumerate(CORNERS, start=1)}


def test_a_match_that_the_event_had_ended_goes_on() -> None:
    """If the event that ended the match is taken back, the match is HALTED and can be resumed."""
    stage = flag_strike(ALL_FOUR)
    assert (stage.phase, stage.match.ticks) == (P.FINISHED, 40)
    number = event(stage, "capture", "corner3").number
    assert take_back(stage, number, dry_run=True).changes[-1] == say("change.goes-on")
    reply = take_back(stage, number)
    assert stage.phase is P.HALTED
    assert reply.scores == (15, 0)
    result = stage.beats[-1].result
    assert result is not None
    assert (result.computed, result.reason) == ("", "")
    stage.decide(d.Resume())
    stage.script.poses.update({50: {LEFT: AWAY}, 60: {LEFT: CORNERS[3]}})
    stage.until(P.FINISHED)
    assert stage.match.ticks == 60
    assert stage.match.winner() == "left"


def test_the_end_stays_what_it_was_if_a_later_set_is_taken_back() -> None:
    """If a `set` after the end is taken back, the match stays finished for the same reason."""
    stage = flag_strike(ALL_FOUR)
    numbers = [stage.decide(d.Set(flag, "right")).event for flag in ("flag0", "flag1")]
    take_back(stage, numbers[1])
    assert (stage.phase, stage.match.ended) == (P.FINISHED, say("over.all-corners", seat="left"))
    take_back(stage, numbers[0])
    assert stage.phase is P.FINISHED
    assert stage.scores == (20, 0)


def test_a_match_may_turn_out_to_have_been_over() -> None:
    """If one event alone kept a match from its end, taking back that event ends the match."""
    walks = dict(ALL_FOUR)
    walks[35] = {RIGHT: CORNERS[0]}
    stage = flag_strike(walks, {60: {RIGHT: (22,)}})
    assert (stage.phase, stage.scores) == (P.HALTED, (15, 10))
    retaken = event(stage, "capture", "corner0").number
    dry = take_back(stage, retaken, dry_run=True)
    assert dry.changes[-1] == say("change.ends", why=say("over.all-corners", seat="left"))
    reply = take_back(stage, retaken)
    assert stage.phase is P.FINISHED
    assert stage.match.ended == say("over.all-corners", seat="left")
    assert reply.scores == stage.scores == (20, 0)
    assert say("change.vanishes", kind="strike", marker="flag18") in reply.changes
    # Without the fourth corner the match was not over, so the strike counts again.
    reply = take_back(stage, event(stage, "capture", "corner3").number)
    assert stage.phase is P.HALTED
    assert reply.scores == (15, 5)


def test_a_match_that_a_take_back_ended_stays_finished() -> None:
    """A match that a take-back has finished stays finished after another take-back."""
    stage = flag_strike({**ALL_FOUR, 35: {RIGHT: CORNERS[0]}})
    put = stage.decide(d.Set("flag0", "right")).event
    take_back(stage, event(stage, "capture", "corner0").number)
    assert (stage.phase, stage.scores) == (P.FINISHED, (20, 1))
    take_back(stage, put)
    assert (stage.phase, stage.scores) == (P.FINISHED, (20, 0))
    assert stage.match.history.over == stage.match.ended == say("over.all-corners", seat="left")


def test_a_match_whose_time_is_up_stays_finished() -> None:
    """If the time is up, a take-back can change the winner, but does not change the clock."""
    short = {"match": {"duration_s": 1.0, "countdown_s": 0.02}}
    poses = {10: {LEFT: cell("c2r2")}, 20: {LEFT: cell("c3r2")}}
    stage = play(Stage("othello", short, script=Script(poses=poses)), 50)
    assert (stage.phase, stage.match.winner()) == (P.FINISHED, "left")
    take_back(stage, stage.numbers("flip")[0])
    result = stage.beats[-1].result
    assert result is not None
    assert (stage.phase, result.computed, result.reason) == (P.FINISHED, "draw", say("over.time"))
    assert stage.frame.clock_ticks == 50


def test_over_in_the_tick_in_which_time_is_up() -> None:
    """If time is up anyway, taking back the capture that ended the match leaves it finished."""
    short = {"match": {"duration_s": 0.8, "countdown_s": 0.02}}
    stage = play(Stage("flag-strike", short, script=Script(poses=dict(ALL_FOUR))), 40)
    assert (stage.phase, stage.match.ticks) == (P.FINISHED, 40)
    assert stage.match.ended == say("over.all-corners", seat="left")
    take_back(stage, event(stage, "capture", "corner3").number)
    assert (stage.phase, stage.match.ended) == (P.FINISHED, say("over.time"))


def test_time_is_never_up_in_a_match_without_end() -> None:
    """If a match has no time limit, taking back the event that ended it makes it HALTED."""
    endless = {"match": {"duration_s": 0.0, "countdown_s": 0.02}}
    stage = play(Stage("flag-strike", endless, script=Script(poses=dict(ALL_FOUR))), 100)
    assert (stage.phase, stage.match.ticks) == (P.FINISHED, 40)
    take_back(stage, event(stage, "capture", "corner3").number)
    assert stage.phase is P.HALTED


def test_a_declared_end_stays() -> None:
    """A take-back does not change a result that the referee has declared."""
    stage = flag_strike(ALL_FOUR)
    stage.decide(d.Declare("right"))
    take_back(stage, event(stage, "capture", "corner3").number)
    assert stage.phase is P.FINISHED
    assert stage.match.declared == "right"
    assert stage.match.ended == say("over.all-corners", seat="left")


def test_paths_restarts_clock_and_other_decisions_stay() -> None:
    """Rules 4.1: a take-back does not change paths, restarts, the clock or other decisions."""
    stage = Stage("othello", QUICK, script=Script()).to_playing()
    stage.script.poses.update({10: {LEFT: cell("c2r2")}, 20: {LEFT: cell("c3r2")}})
    stage.run(30)
    stage.beat(key(LEFT, X))
    stage.decide(d.Clock(-3.0))
    stage.decide(d.Adjust("right", 1))
    stage.decide(d.Set("c5r5", "neutral"))
    play(stage, 50)
    was = stage.frame
    take_back(stage, stage.numbers("flip")[0])
    assert (stage.frame.poses, stage.frame.clock_ticks) == (was.poses, was.clock_ticks)
    assert stage.match.history.state.last == (12, 23)  # put back on its start cell
    assert stage.scores == (18, 17 + 1)


def test_both_orders_give_the_same() -> None:
    """If three independent events are taken back, the order of the take-backs does not matter."""
    walks = {
        10: {LEFT: "c2r2", RIGHT: "c3r4"},
        20: {LEFT: "c3r2", RIGHT: "c2r4"},
        30: {LEFT: "c2r1"},
        40: {LEFT: "c3r1", RIGHT: "c1r4"},
    }
    ends = set()
    for order in permutations(range(3)):
        stage = othello(walks)
        put = stage.decide(d.Set("c0r5", "right")).event
        numbers = [event(stage, "flip", "c3r1").number, event(stage, "flip", "c1r4").number, put]
        for index in order:
            take_back(stage, numbers[index])
        ends.add((stage.match.history.state, stage.scores))
    assert len(ends) == 1


# Folding: judging a history again without an event.

NO_TOUCH: tuple[int, ...] = ()


def view(x_m: float, y_m: float, touched: tuple[int, ...] = (), placed: bool = False) -> RobotView:
    place = Place(x_m, y_m, 0.0) if placed else None
    return RobotView(x_m, y_m, 0.07, 1.0, 0.0, 0.0, 0.0, place, touched)


@st.composite
def observations(draw: st.DrawFn, arena: str) -> list[Observation]:
    """Draw observations of two robots that hop about the field, touch flags and are put back."""
    size = 6 if arena == "othello" else 3
    pitch = 0.3 if arena == "othello" else 0.8
    half = (size - 1) / 2
    markers = range(4, 24)

    def robot() -> st.SearchStrategy[RobotView]:
        touched = st.sets(st.sampled_from(markers), max_size=2).map(lambda s: tuple(sorted(s)))
        return st.builds(
            lambda c, r, t, p: view((c - half) * pitch, (r - half) * pitch, t, p == 9),
            st.integers(0, size - 1),
            st.integers(0, size - 1),
            touched if arena == "flag-strike" else st.just(NO_TOUCH),
            st.integers(0, 9),
        )

    return draw(st.lists(st.tuples(robot(), robot()), min_size=5, max_size=60))


GAMES = {name: arenas.load(name).game for name in ("othello", "flag-strike")}


def kept_bytes(stage: Stage, ticks: int) -> float:
    """Return the memory that a match keeps for each tick in which nothing happens [bytes]."""
    tracemalloc.start()
    marks = []
    for _ in range(2):
        for _ in range(ticks):
            stage.match.beat()
        marks.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    return (marks[1] - marks[0]) / ticks


@pytest.mark.parametrize("arena", ["practice", "othello", "flag-strike"])
def test_ticks_that_nothing_can_be_taken_back_from_are_not_kept(arena: str) -> None:
    """Ticks before the first event of a match are not kept in memory.

    In the arena practice, which has no end, 440 bytes a tick would fill 1.9 GB a day.
    """
    stage = Stage(arena).to_playing()
    assert kept_bytes(stage, 2000) < 10
    assert stage.numbers("flip", "capture", "strike") == []


def test_the_first_event_of_a_match_is_taken_back_as_exactly_as_any() -> None:
    """A match's first event can be taken back exactly, although no tick before it is kept."""
    late = {tick + 3000: step for tick, step in CHAIN.items()}
    stage, twin = othello(late, ticks=3100), othello({3030: CHAIN[30]}, ticks=3100)
    reply = take_back(stage, event(stage, "flip", "c3r2").number)
    assert len(reply.changes) == 2
    assert (stage.scores, stage.board) == (twin.scores, twin.board)
    before = stage.scores
    stage.decide(d.Resume())
    stage.until(P.PLAYING)
    assert kept_bytes(stage, 1000) < 10, "no event stands"
    assert stage.scores == before


class Stopwatch:
    """A game whose state is the time since the start, so it needs to know how long a tick is."""

    def start(self) -> float:
        return 0.0

    def step(
        self, state: float, observation: Observation, dt_s: float, struck: object = ()
    ) -> tuple[float, tuple[GameEvent, ...]]:
        return state + dt_s, ()

    def over(self, state: float) -> str:
        return ""

    def set(self, state: float, marker: int, value: int) -> float:
        return state


def test_a_tick_is_20_ms_in_play_and_in_a_fold() -> None:
    """A tick is 20 ms for the rules, in play and when the match is judged again."""
    history = History(Stopwatch())  # type: ignore[arg-type]
    history.set(0, 0, number=1)
    for _ in range(3):
        history.observe((), 2)
    assert history.state == pytest.approx(0.06)
    assert history.without(1).state == history.state


@pytest.mark.parametrize("arena", list(GAMES))
@given(data=st.data())
def test_taking_back_a_set_without_effect_changes_nothing(arena: str, data: st.DataObject) -> None:
    """If a `set` that changed nothing is taken back, the match stays the same."""
    game = GAMES[arena]
    history = History(game)
    history.set(0, game.board(game.start())[0], number=1)  # changes nothing
    number = 2
    judged = data.draw(observations(arena))
    sets = data.draw(st.dictionaries(st.integers(0, len(judged)), st.integers(0, 23), max_size=3))
    for tick, observation in enumerate(judged):
        if tick in sets:
            history.set(sets[tick], data.draw(st.integers(0, 2)), number)
            number += 1
        number += len(history.observe(observation, number))
        if history.over:
            break
    fold = history.without(1)
    assert (fold.state, fold.over, fold.vanished, fold.appeared) == (
        history.state,
        history.over,
        (),
        (),
    )
    state = history.state
    history.accept(fold, number)
    assert history.state == state
    assert all(history.knows(n) for n in range(2, number))
    assert not history.knows(1)


@pytest.mark.parametrize("arena", list(GAMES))
@given(data=st.data())
def test_a_fold_leaves_the_history_alone_and_can_be_repeated(
    arena: str, data: st.DataObject
) -> None:
    """`History.without` does not change its history, and a second call repeats the result."""
    history = History(GAMES[arena])
    number = 1
    for observation in data.draw(observations(arena)):
        number += len(history.observe(observation, number))
        if history.over:
            break
    if number == 1:
        return
    struck = data.draw(st.integers(1, number - 1))
    state, over = history.state, history.over
    dry = history.without(struck)
    assert (history.state, history.over) == (state, over)
    assert history.knows(struck)
    wet = history.without(struck)
    assert (wet.state, wet.over, wet.vanished, wet.appeared) == (
        dry.state,
        dry.over,
        dry.vanished,
        dry.appeared,
    )
    history.accept(wet, number)
    assert history.state == dry.state
    gone = {old for old, _ in dry.vanished}
    assert struck in gone
    assert {n for n in range(1, number) if not history.knows(n)} == gone
    assert all(history.knows(number + new) for new in range(len(dry.appeared)))
