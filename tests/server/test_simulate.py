"""Headless matches: bots and ghosts in the seats, as fast as the machine can."""

from pathlib import Path

import pytest
from stage import join, setup

from lacoc_arenas import arena as arenas
from lacoc_server.match import Match
from lacoc_server.simulate import SETTLE_BEATS, Player, player, simulate
from lacoc_server.world import World
from lacoc_shared.codec import decode
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Result
from lacoc_shared.seat import Phase

SHORT = {"match": {"duration_s": 4.0}}
OTHELLO = arenas.load("othello")


def play(
    folder: Path | None = None, bots: tuple[str, str] = ("nearest", "straight"), late: int = 0
) -> Result:
    players = [player(OTHELLO, 0, bots[0]), player(OTHELLO, 1, bots[1], late_ticks=late)]
    return simulate(setup("othello", SHORT), players, folder)


def test_a_match_to_its_end(tmp_path: Path) -> None:
    """Issue 2, `lacoc simulate`: result and record; robots settle, then the whole ceremony."""
    result = play(tmp_path)
    assert (result.reason, result.clock_s, sum(result.scores)) == ("time is up", 4.0, 36)
    assert result.official == result.computed != ""
    assert result.teams == ("nearest", "straight")
    record = Record.read(tmp_path / "m.mcap")
    assert [path.name for path in tmp_path.iterdir()] == ["m.mcap"]
    assert record.result == result
    frames = [decode(encoded, Frame) for _, encoded in record.frames]
    by_phase = [frame.phase for frame in frames]
    assert by_phase == sorted(by_phase)
    assert by_phase.count(Phase.PLAYING) == 199  # tick 200 ends the match
    assert by_phase.count(Phase.READY) == SETTLE_BEATS
    assert frames[-1].digest.hex() == result.digest


@pytest.mark.slow
def test_the_same_players_play_the_same_match() -> None:
    """Rules 4: the same inputs give the same match, bit for bit, recorded or not."""
    assert play() == play()
    assert play(late=30).digest != play().digest


def test_it_can_be_watched() -> None:
    """Every frame is shown, so that a progress bar or a picture can follow."""
    seen: list[int] = []
    ground = setup("othello", SHORT)
    players = [player(OTHELLO, seat, "straight") for seat in (0, 1)]
    simulate(ground, players, watch=lambda frame: seen.append(frame.beat))
    assert seen == list(range(len(seen)))


def test_ghosts_of_both_seats_play_their_match_again(tmp_path: Path) -> None:
    """Design, "The rooms": a ghost is a brain that reads a record; it brings its own files."""
    result = play(tmp_path)
    ghosts = [
        player(OTHELLO, n, f"ghost:{tmp_path}/m.mcap:{s}") for n, s in ((0, "left"), (1, "right"))
    ]
    again = simulate(setup("othello", SHORT), ghosts)
    assert again.digest == result.digest
    assert again.teams == ("nearest's ghost", "straight's ghost")


def test_a_match_without_end_is_refused() -> None:
    """A headless match of practice would never end: the sentence says what to give."""
    ground = arenas.load("practice")
    with pytest.raises(UserError, match="no end of its own: give --seconds"):
        simulate(setup("practice"), [player(ground, 0, next(iter(ground.bots)))])


def test_practice_with_an_end() -> None:
    """One seat, no referee: it starts by itself."""
    made = setup("practice", {"match": {"duration_s": 1.0}})
    ground = arenas.load("practice")
    result = simulate(made, [player(ground, 0, next(iter(ground.bots)))])
    assert (result.clock_s, result.reason) == (1.0, "time is up")


def test_files_with_mistakes_are_refused() -> None:
    """Issue 2, Done 6: a wrong file at start: every mistake."""
    good = player(OTHELLO, 0, "straight")
    bad = Player(join(1, robot_file=b"legs = 3"), good.bot)
    with pytest.raises(FileRefused) as refused:
        simulate(setup("othello", SHORT), [good, bad])
    assert len(refused.value.mistakes) > 1


def test_a_match_knows_nothing_of_how_it_is_run() -> None:
    """Design, "The rooms": the headless match is the live one, made from the same setup."""
    match = Match(setup("othello", SHORT), World)
    assert match.duration_ticks == 200


def test_a_record_is_never_overwritten(tmp_path: Path) -> None:
    """A match of a name whose record is there already is not even begun; the record stays."""
    there = tmp_path / "m.mcap"
    there.write_bytes(b"yesterday's match")

    with pytest.raises(UserError, match="never overwritten"):
        play(tmp_path)
    assert there.read_bytes() == b"yesterday's match"
    assert list(tmp_path.iterdir()) == [there]
