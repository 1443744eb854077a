"""A match that is saved and loaded goes on as if it had never been saved."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stage import LEFT, QUICK, RIGHT, Script, Stage, X, decide, join, key, setup

from lacoc_server.match.match import Match
from lacoc_server.match.physics import Fault
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.inputs import Advice, HeardSeat, Input, LeaveSeat, ReadySeat, SilentSeat
from lacoc_shared.messages import Frame
from lacoc_shared.seat import NOBODY, Phase
from lacoc_shared.words import say

P = Phase
SEATS = st.sampled_from([LEFT, RIGHT])
EVENTS = st.integers(1, 40)
DECISIONS: st.SearchStrategy[d.Decision] = st.one_of(
    st.sampled_from(
        [d.Start(), d.Start(), d.Halt(), d.Resume(), d.Resume(), d.Official(), d.Declare("left")]
    ),
    st.builds(d.TakeBack, EVENTS, st.booleans()),
    st.builds(d.Adjust, st.sampled_from(["left", "right"]), st.sampled_from([-2, 3])),
    st.builds(d.Set, st.sampled_from(["c1r1", "flag3", "corner2"]), st.just("right")),
    st.builds(d.Freeze, st.sampled_from(["left", "right"]), st.just(0.1)),
    st.builds(d.Restart, st.sampled_from(["left", "right"])),
    st.builds(d.Clock, st.sampled_from([-1.0, 0.5])),
)
INPUTS: st.SearchStrategy[Input] = st.one_of(
    st.builds(key, SEATS, st.sampled_from([0, 1, 2, 3, 9, X])),
    DECISIONS.map(decide),
    DECISIONS.map(decide),
    st.builds(SilentSeat, SEATS),
    st.builds(HeardSeat, SEATS),
    st.builds(LeaveSeat, SEATS),
    st.builds(ReadySeat, SEATS, st.booleans()),
    st.builds(join, SEATS, st.sampled_from(["Ants", "Cats"])),
    st.just(Advice((say("over.time"),))),
)
SPOTS = {
    "othello": [((c - 2.5) * 0.3, (r - 2.5) * 0.3) for c in range(6) for r in range(6)],
    "flag-strike": [(x, y) for x in (-0.8, 0.0, 0.8) for y in (-0.8, 0.0, 0.8)],
}


@st.composite
def scripts(draw: st.DrawFn, arena: str) -> Script:
    """Draw a script of ticks in which robots jump about or touch flags, or physics stops."""
    ticks = st.integers(1, 60)
    spots = st.dictionaries(SEATS, st.sampled_from(SPOTS[arena]), min_size=1)
    flags = st.dictionaries(SEATS, st.sampled_from([(5,), (6, 9), (23,)]), min_size=1)
    return Script(
        poses=draw(st.dictionaries(ticks, spots, max_size=25)),
        touches=draw(st.dictionaries(ticks, flags, max_size=8)) if arena != "othello" else {},
        faults={t: Fault(NOBODY, say("fault.position")) for t in draw(st.sets(ticks, max_size=1))},
    )


def shown(match: Match, items: tuple[Input, ...]) -> tuple[Any, ...]:
    """Play a beat; return all that it gives, and the match's sheet, result and legal decisions."""
    return match.beat(items), match.sheet(), match.result(), match.legality()


@pytest.mark.parametrize("arena", list(SPOTS))
@given(data=st.data())
def test_a_saved_match_goes_on_as_if_it_was_not_saved(arena: str, data: st.DataObject) -> None:
    """After any inputs, a loaded match and one that was never saved give the same beats.

    The save is loaded into a new match, or into the saved match, which has gone on since.
    """
    script = data.draw(scripts(arena))
    stages = [
        Stage(arena, QUICK, script=Script(script.poses, script.touches, dict(script.faults)))
        for _ in range(2)
    ]
    never, stage = (one.to_ready() for one in stages)
    beats = data.draw(st.lists(st.lists(INPUTS, max_size=2).map(tuple), min_size=5, max_size=40))
    saves = data.draw(st.sets(st.integers(0, len(beats) - 1), min_size=1, max_size=3))
    twin, match = never.match, stage.match
    start = decide(d.Start())
    assert shown(twin, (start,)) == shown(match, (start,))
    for number, items in enumerate(beats):
        if number in saves:
            saved = match.save()
            if data.draw(st.booleans()):
                match = Match(setup(arena, QUICK), stage._make)
            else:
                ticks = dict(stage.script.faults)
                for ahead in data.draw(st.lists(INPUTS, max_size=3)):
                    match.beat((ahead,))
                stage.script.faults |= ticks
            match.load(saved)
            assert match.save() == saved
        assert shown(match, items) == shown(twin, items)
    assert match.save() == twin.save()


@pytest.mark.parametrize("phase", [p for p in P if p is not P.CREATED])
def test_every_phase_can_be_saved(phase: Phase) -> None:
    """A match can be saved in any phase; a new match that loads it goes on like the saved one."""
    stage = Stage("othello", QUICK).to(phase)
    match = Match(setup("othello", QUICK), stage._make)
    match.load(stage.match.save())
    assert (match.phase, match.halted_by) == (phase, stage.match.halted_by)
    for _ in range(5):
        assert shown(match, ()) == shown(stage.match, ())


def test_a_match_goes_back_to_the_lobby_and_to_other_robots() -> None:
    """Loading an older state takes robots off the field, or puts the older robots on it."""
    stage = Stage("othello", QUICK).to(P.LOBBY)
    match, lobby = stage.match, stage.match.save()
    match.beat((ReadySeat(LEFT, True), ReadySeat(RIGHT, True)))
    assert match.phase is P.READY
    hexapods = match.save()
    match.load(lobby)
    assert (match.phase, match.staging.poses) == (P.LOBBY, b"")
    match.beat((join(LEFT, robot="quadruped"),))
    match.beat((ReadySeat(LEFT, True), ReadySeat(RIGHT, True)))
    match.load(hexapods)
    assert [seat.robot for seat in match.sheet().seats] == ["Hexapod", "Hexapod"]
    assert match.save() == hexapods


def test_a_match_that_keeps_nothing_loses_only_take_backs() -> None:
    """It forgets which events can be taken back, loaded ones and new ones, and nothing else."""
    script = Script(
        poses={
            2: {LEFT: SPOTS["othello"][14]},
            4: {LEFT: SPOTS["othello"][20]},
            1505: {LEFT: SPOTS["othello"][21]},
        }
    )
    stage = Stage("othello", QUICK, script=script).to_playing()
    stage.run(1500)
    (flip,) = stage.numbers("flip")
    whole = stage.match.save()
    match = Match(setup("othello", QUICK), stage._make)
    match.history.keep_nothing()
    match.load(whole)
    lean = match.save()
    assert len(lean) < 10_000 < 100_000 < len(whole)
    for _ in range(10):
        assert shown(match, ()) == shown(stage.match, ())
    second = stage.match.event_count
    assert second > flip
    assert all(map(stage.match.history.knows, (flip, second)))
    assert not any(map(match.history.knows, (flip, second)))
    assert len(match.save()) < 10_000
    match.load(lean)
    assert match.save() == lean


def test_bytes_of_another_game_are_refused() -> None:
    """A save from other settings is refused with a reason, and so are bytes that are no save."""
    saved = Stage("othello", QUICK).to(P.PLAYING).match.save()
    other = Stage("othello").to(P.PLAYING).match
    for data in (saved, saved[:-40], b"", b"\x93abc"):
        with pytest.raises(ValueError, match=r"was saved|msgpack|Expected|truncated|trailing"):
            other.load(data)
    assert other.phase is P.PLAYING


@pytest.mark.slow
@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
@given(cut=st.integers(0, 70), keys=st.lists(st.sampled_from([0, 1, 2, 3, X]), min_size=9))
@settings(max_examples=3)
def test_physics_goes_on_bit_for_bit(arena: str, cut: int, keys: list[int]) -> None:
    """With MuJoCo, a match loaded into a new one gives the same bits to the last beat."""

    def frames(loads: bool) -> list[bytes]:
        match = Stage.real(arena, QUICK).to_playing().match
        seen: list[Frame] = []
        for beat in range(80):
            if loads and beat == cut:
                saved = match.save()
                match = Match(setup(arena, QUICK), World)
                match.load(saved)
            digit = keys[beat // 10 % len(keys)]
            inputs = [key(seat, digit, seq=beat + 1) for seat in (LEFT, RIGHT)]
            seen.append(match.beat(inputs if beat % 10 == 0 else ()).frame)
        return [encode(frame) for frame in seen]

    assert frames(loads=True) == frames(loads=False)
