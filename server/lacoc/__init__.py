"""LACOC in Python: gait tables, trials, matches without a network, records, environments.

    import lacoc

    print(lacoc.walk("Loco-data.xlsx"))                  # how a robot walks with a table
    match = lacoc.simulate("planner", "my_bot.py")       # a whole match, as numpy arrays
    env = lacoc.make("Walk-v0")                          # an environment of Gymnasium

Each function imports what it needs when it is called. Where Gymnasium is installed, `import lacoc`
also makes `gymnasium.make("lacoc/Walk-v0")` work (docs/python.md).
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lacoc_shared.command import installing
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

if TYPE_CHECKING:
    from lacoc_server.studio.answers import Trial
    from lacoc_shared.gait.tables import Gait
    from lacoc_shared.record.notebook import MatchArrays

__all__ = ["load_table", "make", "read_record", "simulate", "walk"]

_ROBOT = "hexapod"


def load_table(file: str | Path, robot: str = _ROBOT) -> Gait:
    """Read a gait file: Loco-data.xlsx, Loco-data.txt or LocoTra-data.txt.

    Postures (Loco-data) are joined into the sequences of the sample's keys: 0 stand, 1 turn left,
    2 forward, 3 turn right.

    Args:
        file: the gait file.
        robot: an installed robot, a robot's folder, or a robot file (.toml).

    Raises:
        UserError: if the file can't be read, or there is no such robot.
        FileRefused: with every mistake of a file.
    """
    from lacoc_robots.reading import load_gait, read_robot_file

    return load_gait(Path(file), read_robot_file(robot))


def walk(
    table: str | Path | Gait, *, robot: str = _ROBOT, keys: str = "", seconds: float | None = None
) -> Trial:
    """Let a robot walk alone with a gait, exactly as at a court, and measure how it walks.

    Args:
        table: a gait, or a gait file as in `load_table`.
        robot: as in `load_table`.
        keys: keys to press: "2", or "1:3, 2" for key 1 for 3 s and then key 2. The last one is
            measured. "": the key for forward.
        seconds: how long the last key is pressed [s]; None: whole cycles.

    Returns:
        The trial: `figures`, `walk` (arrays of each tick), `explained`; `print` shows the figures.

    Raises:
        UserError: if the keys or the time are wrong, something can't be read, or the packages of a
            court are missing.
        FileRefused: with every mistake of a file.
    """
    _need("mujoco", extra="server")
    from lacoc_robots.reading import load_gait, read_robot_file
    from lacoc_server.studio.answers import try_gait
    from lacoc_server.world.sensed import make_course

    spec = read_robot_file(robot)
    gait = load_gait(Path(table), spec) if isinstance(table, str | Path) else table
    return try_gait(make_course(spec), gait, keys, seconds)


def simulate(
    left: str,
    right: str,
    arena: str = "othello",
    *,
    seconds: float | None = None,
    robot: str = _ROBOT,
    record: str | Path | None = None,
) -> MatchArrays:
    """Play a match of two bots without a network, as fast as the machine can.

    Args:
        left: a bot of the arena ("planner"), a bot file ("my_bot.py"), or the ghost of a record
            ("ghost:RECORD.mcap:left"); with "@FOLDER" it steers the gait in that folder.
        right: the same for the right seat.
        arena: the game, or the path of an arena's folder.
        seconds: length of the match [s]; None: the arena's.
        robot: the robot of both, as in `load_table`.
        record: a folder in which the record is kept; None: it is not kept.

    Returns:
        The match as numpy arrays (docs/notebook.md).

    Raises:
        UserError: if there is no such bot, arena or robot, a bot fails, the record can't be
            written, or the packages of a court are missing.
        FileRefused: if the files of a bot have mistakes.
    """
    _need("mujoco", extra="server")
    if record is not None:
        return _play((left, right), arena, seconds, robot, Path(record).resolve())
    from lacoc_shared.command.scratch import Scratch

    with Scratch("simulate") as folder:
        return _play((left, right), arena, seconds, robot, folder)


def _play(
    bots: tuple[str, str], arena: str, seconds: float | None, robot: str, folder: Path
) -> MatchArrays:
    """Play a match and return its record, read from `folder`; raise errors as `simulate` does."""
    from lacoc_arenas.arena import load
    from lacoc_server.contest.headless.pool import Job, first_number, match_id, play_alone
    from lacoc_server.simulate.headless import seated

    folder.mkdir(parents=True, exist_ok=True)
    overrides = {"match": {"duration_s": seconds}} if seconds is not None else {}
    loaded = load(arena, overrides)
    job = Job(
        match_id=match_id(first_number(folder)),
        arena=arena,
        overrides=overrides,
        players=tuple(seated(loaded, seat, bot, robot) for seat, bot in enumerate(bots)),
        late_ticks=0,
        folder=str(folder),
    )
    play_alone(job)
    assert job.record is not None
    return read_record(job.record)


def read_record(file: str | Path) -> MatchArrays:
    """Read the record of a match as numpy arrays (docs/notebook.md).

    Raises:
        UserError: if it is no record, or is damaged.
    """
    from lacoc_shared.record import notebook

    return notebook.read(file)


def make(name: str, **options: Any) -> Any:
    """Make an environment of Gymnasium (docs/environments.md).

    Args:
        name: "Othello-v0", "FlagStrike-v0" or "Walk-v0".
        options: what `gymnasium.make` takes.

    Raises:
        UserError: if packages are missing.
        gymnasium.error.Error: if there is no such environment, or an option is wrong.
    """
    _need("mujoco", "gymnasium", "pettingzoo", extra="rl")
    import gymnasium

    return gymnasium.make(name if "/" in name else f"lacoc/{name}", **options)


def _need(*packages: str, extra: str) -> None:
    """Check that packages are installed.

    Raises:
        UserError: if a package is not installed; the message says what to install.
    """
    if missing := [name for name in packages if find_spec(name) is None]:
        extras = dict.fromkeys(("server", extra))
        raise UserError(
            say("python.not-installed", missing=missing, install=installing.command(*extras))
        )


if find_spec("gymnasium") is not None:
    from lacoc_server.simulate.registering import register

    register()
