"""A match as fast as the machine can run it: the same beats, with bots in the seats."""

from collections.abc import Callable, Generator, Iterator, Sequence
from pathlib import Path

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_robots.library import GAIT_NAMES, find_robot, robot_folder, sample_gait_files
from lacoc_robots.seat_files import SeatFiles, as_text, files_in, with_level_b
from lacoc_server.journal.journal import Journal
from lacoc_server.match.match import Beat, Match
from lacoc_server.simulate.inputs import Inputs, Player, opening, whole_match
from lacoc_server.world.world import World
from lacoc_shared.inputs import Input, JoinSeat
from lacoc_shared.messages import Frame, Refusal, SentFile
from lacoc_shared.mistakes import FileRefused, UserError, text_of
from lacoc_shared.record.packed import PackedWriter
from lacoc_shared.record.schema import Result, Setup
from lacoc_shared.words import say

_BROUGHT = "@"
"""Sign in a player's name between the bot and the folder of the files that it steers."""
_Files = tuple[SentFile, SentFile | None, SentFile | None]
"""Robot, postures (level A), locomotion (level B)."""


class Seated(msgspec.Struct, frozen=True):
    """A player of a seat in a form for other processes: files, and the name of a bot."""

    join: JoinSeat
    """The join; its `seat` is the player's seat."""
    bot: str
    """Name of the bot as in `brains.find`; with a program, a name for messages."""
    program: bytes | None = None
    """Python source of the bot; None: the name says where the bot is."""


def player(
    arena: arenas.Arena,
    seat: int,
    bot: str,
    robot: str = "hexapod",
    team: str | None = None,
    late_ticks: int = 0,
) -> Player:
    """Make the player of a seat: a bot, and the files that it steers.

    Args:
        arena: the arena.
        seat: index of the seat.
        bot: name of the bot, as in `seated`.
        robot: an installed robot, or a robot file.
        team: name of the team, as in `seated`.
        late_ticks: see `Player`.

    Raises:
        UserError: as `seated`, or if the bot's file has a mistake.
    """
    one = seated(arena, seat, bot, robot, team)
    return Player(one.join, brains.find(arena, one.bot), late_ticks)


def seated(
    arena: arenas.Arena, seat: int, bot: str, robot: str = "hexapod", team: str | None = None
) -> Seated:
    """Seat a bot, or the ghost of a record with the files that it played with.

    Args:
        arena: the arena.
        seat: index of the seat.
        bot: name as in `brains.find`. With "@FOLDER" after it, the bot steers the files in that
            folder: gait files, and `robot.toml` if there is one.
        robot: an installed robot, or a robot file with its gait beside it; a ghost has its own.
        team: name of the team; None: the folder's or the bot's, or "TEAM's ghost".

    Raises:
        UserError: if there is no such bot, robot, folder, gait or record.
    """
    if bot.startswith(brains.GHOST):
        was = brains.ghost_join(*brains.open_ghost(bot))
        files = (was.robot, was.postures, was.locomotion)
        team = team or f"{was.team}'s ghost"
    else:
        bot, brought, folder = _parted(bot)
        files = _of_folder(arena, Path(folder), robot) if brought else _of_robot(arena, robot)
        team = team or text_of(Path(folder).resolve().name) if brought else team
    join = JoinSeat(seat, team or text_of(Path(bot).stem), *files, token_hash="")
    return Seated(join, bot)


def _parted(name: str) -> tuple[str, str, str]:
    """Split a player's name into the bot, "@" and the folder; both are "" if there is no folder.

    The name of a bot file ends with ".py"; a folder in its path may have an "@".
    """
    file, ended, folder = name.partition(f".py{_BROUGHT}")
    if ended:
        return f"{file}.py", _BROUGHT, folder
    return (name, "", "") if name.endswith(".py") else name.partition(_BROUGHT)


def _of_robot(arena: arenas.Arena, robot: str) -> _Files:
    files = (SentFile(*find_robot(robot)), *sample_gait_files(robot))
    _require_gait(arena, files, robot_folder(robot))
    return files


def _of_folder(arena: arenas.Arena, folder: Path, robot: str) -> _Files:
    """Read the files of a team, as for a contest; mistakes name each file with its folder."""
    folder = folder.expanduser().resolve()
    if not folder.is_dir():
        raise UserError(say("simulate.no-folder", folder=str(folder)))
    own = folder / "robot.toml"
    chosen = SentFile(*find_robot(str(own) if own.exists() else robot))
    named = (
        file and msgspec.structs.replace(file, name=f"{text_of(folder.name)}/{file.name}")
        for file in files_in(folder)._replace(robot=chosen)
    )
    sent, postures, locomotion = with_level_b(as_text(SeatFiles(*named)))
    assert sent is not None
    _require_gait(arena, (sent, postures, locomotion), folder)
    return sent, postures, locomotion


def _require_gait(arena: arenas.Arena, files: _Files, folder: Path) -> None:
    """Check that there is a gait file for an open level.

    Raises:
        UserError: if there is none; the message names the folder that was searched.
    """
    levels = arena.match.open_levels
    if not any(files[1 + level] for level in levels):
        wanted = " or ".join(GAIT_NAMES[level] for level in levels)
        raise UserError(say("simulate.no-gait", wanted=wanted, folder=str(folder)))


def simulate(
    setup: Setup,
    players: Sequence[Player],
    folder: Path | None = None,
    watch: Callable[[Frame], None] | None = None,
    arena: Path | None = None,
) -> Result:
    """Play one match to its end.

    Args:
        setup: the match.
        players: one for each seat.
        folder: folder of the record; None: no record.
        watch: called with every frame.
        arena: folder of the arena, if it is not installed.

    Returns:
        The result: official; void if physics stopped or a robot did not stay on its start place.

    Raises:
        UserError: if the arena's matches have no end, or if the record exists already or can't be
            written.
        BotFailed: if a bot fails.
        FileRefused: if a player's files have mistakes.
    """
    match = Match(setup, World, arena)
    if not match.duration_ticks:
        raise UserError(say("simulate.no-end", arena=setup.arena))
    match.history.keep_nothing()  # nobody is there who could take an event back
    journal = Journal(match, folder, writer=PackedWriter)
    try:
        for beat in _play(match, journal, players):
            if watch is not None:
                watch(beat.frame)
        journal.close()
    except BaseException:  # Ctrl-C too: the match can be played again
        journal.leave()
        raise
    return match.result()


def _play(match: Match, journal: Journal, players: Sequence[Player]) -> Iterator[Beat]:
    yield from _follow(whole_match(players, match.sheet), lambda inputs: journal.beat(inputs)[0])


def to_play(
    joins: Sequence[JoinSeat], pass_beat: Callable[[Sequence[Input]], Beat]
) -> Iterator[Beat]:
    """Lead a new match to its first beat of PLAYING: teams join, robots settle, the match starts.

    Args:
        joins: a join for each seat.
        pass_beat: lets a beat of the match pass.

    Yields:
        Each beat. If physics stops, or a robot does not stay on its start place, the match is not
        in PLAYING at the end.

    Raises:
        FileRefused: if a file has mistakes.
    """
    yield from _follow(opening(joins), pass_beat)


def _follow(
    script: Generator[Inputs, Frame, object], pass_beat: Callable[[Sequence[Input]], Beat]
) -> Iterator[Beat]:
    """Let beats pass with the inputs that `script` yields; yield each beat; errors as `to_play`."""
    inputs = next(script)
    while True:
        beat = pass_beat(inputs)
        for item, outcome in zip(inputs, beat.outcomes, strict=True):
            if isinstance(item, JoinSeat) and isinstance(outcome, Refusal):
                raise FileRefused(list(outcome.mistakes))
        yield beat
        try:
            inputs = script.send(beat.frame)
        except StopIteration:
            return
