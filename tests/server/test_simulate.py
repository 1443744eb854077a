"""Tests of headless matches: bots and ghosts play them as fast as the machine can."""

import os
from pathlib import Path

import msgspec
import pytest
from handed_in import handed_in, players_of, sample
from stage import (
    FORWARD,
    LEFT,
    RIGHT,
    STAND,
    TURN_LEFT,
    TURN_RIGHT,
    B,
    Stage,
    X,
    decide,
    join,
    key,
    setup,
)

from lacoc_arenas import arena as arenas
from lacoc_arenas.bot import Key
from lacoc_arenas.brains import ghost
from lacoc_robots.library import find_robot, robot_folder
from lacoc_server.commands import simulate as simulate_commands
from lacoc_server.commands.simulate import simulate_command
from lacoc_server.match.match import Match
from lacoc_server.simulate import SETTLE_BEATS, Player, player, simulate
from lacoc_server.world.world import World
from lacoc_shared.codec import decode, encode
from lacoc_shared.decisions import Halt, Resume, Start
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import Input, KeySeat
from lacoc_shared.messages import Done, Frame
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Result
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

SHORT = {"match": {"duration_s": 4.0}}
OTHELLO = arenas.load("othello")


def play(
    folder: Path | None = None, bots: tuple[str, str] = ("nearest", "straight"), late: int = 0
) -> Result:
    both = [player(OTHELLO, 0, bots[0]), player(OTHELLO, 1, bots[1], late_ticks=late)]
    return simulate(setup("othello", SHORT), both, folder)


def test_a_match_to_its_end(tmp_path: Path) -> None:
    """A simulated match has a result and a record, and its phases come in their order."""
    result = play(tmp_path)
    assert (result.reason, result.clock_s, sum(result.scores)) == (say("over.time"), 4.0, 36)
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


def test_the_table_of_results_names_the_winner() -> None:
    """The winner's column has a team's name, or says that the match is a draw or void."""
    result = play()
    ends = ("right", "draw", "void")
    results = [msgspec.structs.replace(result, official=end) for end in ends]
    table = simulate_commands._results_table(results, ("left", "right"))
    assert [*table.columns[3].cells] == [result.teams[1], "draw", "void"]


@pytest.mark.slow
def test_the_same_players_play_the_same_match() -> None:
    """The same players give the same match, bit for bit; a bot that begins later gives another."""
    assert play() == play()
    assert play(late=30).digest != play().digest


def test_it_can_be_watched() -> None:
    """`watch` is called with the frame of every beat."""
    seen: list[int] = []
    ground = setup("othello", SHORT)
    players = [player(OTHELLO, seat, "straight") for seat in (0, 1)]
    result = simulate(ground, players, watch=lambda frame: seen.append(frame.beat))
    assert seen == list(range(result.beats))


def test_ghosts_of_both_seats_play_their_match_again(tmp_path: Path) -> None:
    """Two ghosts that repeat the keys of a record give the same match again."""
    result = play(tmp_path)
    ghosts = [
        player(OTHELLO, n, f"ghost:{tmp_path}/m.mcap:{s}") for n, s in ((0, "left"), (1, "right"))
    ]
    again = simulate(setup("othello", SHORT), ghosts)
    assert again.digest == result.digest
    assert again.teams == ("nearest's ghost", "straight's ghost")


def test_a_ghost_presses_only_keys_that_had_an_effect() -> None:
    """Keys that were refused before play, in a halt and after an [x] are not pressed again."""
    stage = Stage(overrides={"match": {"countdown_s": 0.2, "restart_freeze_s": 0.2}}).to_ready()
    inputs: dict[int, list[Input]] = {}
    had_effect: dict[int, Key] = {}

    def beat(*items: Input) -> None:
        inputs[stage.match.beats + 1] = [*items]
        for item, outcome in zip(items, stage.beat(*items).outcomes, strict=True):
            if isinstance(item, KeySeat) and item.seat == LEFT and outcome == Done():
                had_effect[stage.match.beats] = Key(Level(item.level), item.key)

    beat(key(LEFT, FORWARD, 1))
    beat(decide(Start()))
    beat(key(LEFT, X, 2))
    stage.until(Phase.PLAYING)
    for number, one in enumerate((FORWARD, TURN_LEFT, X, STAND)):
        beat(key(LEFT, one, 3 + number), key(RIGHT, FORWARD, 3 + number))
    beat(decide(Halt()))
    beat(key(LEFT, X, 7))
    beat(decide(Resume()))
    stage.until(Phase.PLAYING)
    stage.run(20)
    beat(key(LEFT, TURN_RIGHT, 8))
    assert [*had_effect.values()] == [(B, FORWARD), (B, TURN_LEFT), (B, X), (B, TURN_RIGHT)]
    frames = [one.frame for one in stage.beats]
    record = Record(inputs=inputs, frames=[(frame.beat, encode(frame)) for frame in frames])
    brain = ghost(record, LEFT)
    pressed = {frame.beat + 1: brain(frame) for frame in frames}
    assert {at: one for at, one in pressed.items() if one is not None} == had_effect


def test_a_match_without_end_is_refused() -> None:
    """A simulated match needs an end; for practice the message asks for --seconds."""
    ground = arenas.load("practice")
    with pytest.raises(UserError, match="of practice has no time limit: give --seconds"):
        simulate(setup("practice"), [player(ground, 0, next(iter(ground.bots)))])


def test_practice_with_an_end() -> None:
    """A simulated practice of one second starts by itself and ends in time."""
    made = setup("practice", {"match": {"duration_s": 1.0}})
    ground = arenas.load("practice")
    result = simulate(made, [player(ground, 0, next(iter(ground.bots)))])
    assert (result.clock_s, result.reason) == (1.0, say("over.time"))


def test_files_with_mistakes_are_refused() -> None:
    """A player's file with mistakes is refused, and the error lists all mistakes."""
    good = player(OTHELLO, 0, "straight")
    bad = Player(join(1, robot_file=b"legs = 3"), good.bot)
    with pytest.raises(FileRefused) as refused:
        simulate(setup("othello", SHORT), [good, bad])
    assert len(refused.value.mistakes) > 1


def test_the_length_of_a_match_comes_from_its_setup() -> None:
    """`Match` takes its length from its setup: 4 s are 200 ticks."""
    match = Match(setup("othello", SHORT), World)
    assert match.duration_ticks == 200


def test_a_record_is_never_overwritten(tmp_path: Path) -> None:
    """A match whose record exists already is refused, and that record does not change."""
    there = tmp_path / "m.mcap"
    there.write_bytes(b"yesterday's match")

    with pytest.raises(UserError, match="never overwritten"):
        play(tmp_path)
    assert there.read_bytes() == b"yesterday's match"
    assert list(tmp_path.iterdir()) == [there]


def test_a_bot_steers_what_lies_in_a_folder(tmp_path: Path) -> None:
    """`BOT@FOLDER` lets a bot play with a folder's gait, and with its robot if there is one."""
    anna = handed_in(tmp_path / "anna", sample().replace(b"45", b"40"))
    one = player(OTHELLO, 0, f"straight@{anna}")
    assert (one.join.team, one.join.robot.name) == ("anna", "anna/robot.toml")
    assert one.join.locomotion is not None
    assert one.join.locomotion.data == (anna / "LocoTra-data.txt").read_bytes()
    result = simulate(setup("othello", SHORT), [one, player(OTHELLO, 1, "straight")])
    assert result.teams == ("anna", "straight")

    (anna / "robot.toml").write_bytes(find_robot("long-legs")[1])
    assert player(OTHELLO, 0, f"straight@{anna}").join.robot.data == find_robot("long-legs")[1]


def test_a_folder_may_have_an_at(tmp_path: Path) -> None:
    """The path of a bot file, and that of the folder which it steers, may have an "@"."""
    anna = handed_in(tmp_path / "anna@example.org", sample())
    bot = anna / "my_bot.py"
    bot.write_text("def bot(sheet, seat):\n    return lambda frame: None\n")
    assert player(OTHELLO, 0, str(bot)).join.team == "my_bot"
    assert player(OTHELLO, 0, f"{bot}@{anna}").join.team == "anna@example.org"
    assert player(OTHELLO, 0, f"straight@{anna}").join.team == "anna@example.org"


def test_a_workbook_in_a_folder_is_enough(tmp_path: Path) -> None:
    """The workbook is sent as text, and level B is made from it, as when a team enters."""
    ben = handed_in(tmp_path / "ben", None)
    book = (robot_folder("hexapod") / "Loco-data.xlsx").read_bytes()
    (ben / "Loco-data.xlsx").write_bytes(book)
    join = player(OTHELLO, 0, f"straight@{ben}").join
    assert join.postures is not None
    assert join.locomotion is not None
    assert join.postures.name == "ben/Loco-data.xlsx"
    assert b"\0" not in join.postures.data

    (ben / "Loco-data.xlsx").write_bytes(book[:1000])
    with pytest.raises(FileRefused) as refused:
        player(OTHELLO, 0, f"straight@{ben}")
    assert refused.value.mistakes[0].file == "ben/Loco-data.xlsx"


def test_where_a_gait_is_looked_for_is_said(tmp_path: Path) -> None:
    """If no gait is found, the message names the folder and the command that makes a gait."""
    empty = handed_in(tmp_path / "empty", None)
    (empty / "mine.toml").write_bytes(find_robot("hexapod")[1])
    for word, robot in ((f"straight@{empty}", "hexapod"), ("straight", str(empty / "mine.toml"))):
        with pytest.raises(UserError, match=r"no LocoTra-data\.txt in .*empty.* gait convert"):
            player(OTHELLO, 0, word, robot)
    with pytest.raises(UserError, match=r"There is no folder .*nobody"):
        player(OTHELLO, 0, "straight@nobody")


def test_the_mistakes_of_all_are_listed_before_any_match(tmp_path: Path) -> None:
    """The mistakes of all folders are listed before any match, each file with its folder's name."""
    names = players_of(tmp_path, "anna", "ben", "chie", locomotion=b"1\n1\n5")
    with pytest.raises(FileRefused) as refused:
        simulate_command(names, seconds=1.0)
    assert {mistake.file for mistake in refused.value.mistakes} == {
        f"{name}/LocoTra-data.txt" for name in ("anna", "ben", "chie")
    }


def test_a_folder_whose_name_is_no_text(tmp_path: Path) -> None:
    """Bytes of a folder's name that are no text are in the team's name as hexadecimal numbers."""
    folder = tmp_path / os.fsdecode(b"team\x98\x8b")
    handed_in(folder, sample())
    players = [player(OTHELLO, 0, f"straight@{folder}"), player(OTHELLO, 1, "straight")]
    result = simulate(setup("othello", SHORT), players, tmp_path / "records")
    assert result.teams == (r"team\x98\x8b", "straight")


def test_a_match_that_breaks_off_leaves_no_record(tmp_path: Path) -> None:
    """A simulated match that is interrupted leaves no record, so it can be played again."""

    def stop(frame: Frame) -> None:
        if frame.phase == Phase.PLAYING:
            raise KeyboardInterrupt

    players = [player(OTHELLO, seat, "straight") for seat in (0, 1)]
    with pytest.raises(KeyboardInterrupt):
        simulate(setup("othello", SHORT), players, tmp_path, stop)
    assert list(tmp_path.iterdir()) == []
