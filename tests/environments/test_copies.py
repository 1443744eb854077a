"""Copies of environments: `copy.deepcopy`, `pickle`, and what SuperSuit does with them."""

import copy
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from every_third import every_third

from lacoc_arenas import arena as arenas
from lacoc_arenas.game import Place
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate.environments import (
    LacocEnv,
    LacocParallelEnv,
    LacocVectorEnv,
    WalkEnv,
    WalkVectorEnv,
)
from lacoc_server.trial.course import practice_field
from lacoc_server.world.sensed import SensedWorld
from lacoc_server.world.world import World
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError

STEPS = 80
SHORT: dict[str, Any] = {"match": {"duration_s": 1.2, "countdown_s": 0.02}}
"""An episode ends within the steps of a test, so a copy also draws the next opening."""

MAKE: dict[str, Callable[[], Any]] = {
    "othello": lambda: LacocEnv("othello", "planner", settings=SHORT),
    "flag-strike": lambda: LacocEnv("flag-strike", "nearest", settings=SHORT, restart=True),
    "parallel othello": lambda: LacocParallelEnv("othello", settings=SHORT),
    "parallel flag-strike": lambda: LacocParallelEnv("flag-strike", settings=SHORT),
    "parallel angles": lambda: LacocParallelEnv("othello", settings=SHORT, actions="angles"),
    "rows": lambda: LacocVectorEnv(2, "flag-strike", settings=SHORT),
    "walk": lambda: WalkEnv(seconds=1.2),
    "rows of walks": lambda: WalkVectorEnv(2, seconds=1.2),
}
COPY: dict[str, Callable[[Any], Any]] = {
    "deepcopy": copy.deepcopy,
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
}


def play(env: Any, steps: int) -> list[Any]:
    """Take steps with actions that the environment's own spaces draw; return all that it gave."""
    given: list[Any] = []
    for _ in range(steps):
        if isinstance(env, LacocParallelEnv):
            if not env.agents:
                given.append(env.reset())
            # An agent without an action goes on to what it chose last.
            acting = env.agents[: 1 + len(given) % 2]
            step = env.step({agent: env.action_space(agent).sample() for agent in acting})
            over = False
        else:
            step = env.step(env.action_space.sample())
            over = not hasattr(env, "rows") and (step[2] or step[3])
        given.append(step)
        if over:
            given.append(env.reset())
    return given


def bits(given: Any) -> Any:
    """Return what an environment gave, with its arrays as their bytes."""
    if isinstance(given, np.ndarray):
        return given.tolist() if given.dtype == object else given.tobytes()
    if isinstance(given, dict):
        return {name: bits(one) for name, one in given.items()}
    return [bits(one) for one in given] if isinstance(given, list | tuple) else given


def seeded(name: str) -> Any:
    env = MAKE[name]()
    env.reset(seed=5)
    spaces = getattr(env, "action_spaces", None) or {"": env.action_space}
    for space in spaces.values():
        space.seed(7)
    return env


@pytest.mark.slow
@pytest.mark.parametrize("name", every_third(MAKE))
@pytest.mark.parametrize("before", [pytest.param(0, marks=pytest.mark.long), 30])
def test_a_copy_steps_as_its_original(name: str, before: int) -> None:
    """A copy gives the same bits as its original, from the first step on and in mid-episode.

    None changes another: the original steps first, then each copy, then the original again.
    """
    env = seeded(name)
    play(env, before)
    copies = {way: make(env) for way, make in COPY.items()}
    first = bits(play(env, STEPS))
    for way, other in copies.items():
        assert bits(play(other, STEPS)) == first, way
    again = bits(play(env, 20))
    for way, other in copies.items():
        assert bits(play(other, 20)) == again, way


@pytest.mark.parametrize("name", MAKE)
def test_a_copy_before_the_first_episode(name: str) -> None:
    """A copy of an environment that has not begun is one that has not begun."""
    other = copy.deepcopy(MAKE[name]())
    with pytest.raises(UserError, match="No episode has begun"):
        other.step(np.zeros(2, int))
    other.reset(seed=1)


def test_a_copy_goes_on_in_another_process(tmp_path: Path) -> None:
    """A pickle is read in a process of its own, also if the arena is a folder of somebody."""
    folder = tmp_path / "mine"
    folder.mkdir()
    source = Path(sys.modules["lacoc_arenas.othello"].__path__[0])
    for file in source.glob("*.*"):
        (folder / file.name).write_bytes(file.read_bytes())
    env = LacocEnv(str(folder), settings=SHORT)
    env.reset(seed=2)
    env.step(2)
    saved = tmp_path / "env.pickle"
    saved.write_bytes(pickle.dumps(env))
    expected = b"".join(env.step(2)[0].tobytes() for _ in range(20)).hex()
    code = (
        f"import pickle; env = pickle.load(open({str(saved)!r}, 'rb'))\n"
        "print(b''.join(env.step(2)[0].tobytes() for _ in range(20)).hex())"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == expected


@pytest.mark.parametrize("chooses", ["random.randrange(1, 4)", "len(SEEN) % 3 + 1"])
def test_a_bot_that_plays_otherwise_is_named(tmp_path: Path, chooses: str) -> None:
    """A bot whose keys depend on more than its frames is no reason for a copy that goes astray."""
    bot = tmp_path / "bot.py"
    bot.write_text(
        "import random\nfrom lacoc_arenas.bot import Key\nSEEN = []\n"
        "def bot(sheet, seat):\n"
        "    def brain(frame):\n"
        "        SEEN.append(frame)\n"
        f"        return Key(1, {chooses})\n"
        "    return brain\n"
    )
    env = LacocEnv("othello", str(bot), settings=SHORT)
    env.reset(seed=3)
    for _ in range(40):
        env.step(2)
    saved = env.save()
    if "random" in chooses:  # the other bot is read anew by a copy, with an empty list
        for way in COPY.values():
            with pytest.raises(UserError, match=r"bot\.py saw the same frames"):
                way(env)
    with pytest.raises(UserError, match=r"bot\.py saw the same frames"):
        env.load(saved)


def test_a_load_keeps_the_angles_that_a_robot_moves_to() -> None:
    """An agent without an action goes on to its angles, also after a load, but not after a reset.

    Another episode of the same environment has left no angles behind.
    """
    env, other = (LacocParallelEnv(settings=SHORT, actions="angles") for _ in range(2))

    def rest(one: LacocParallelEnv) -> Any:
        return bits([one.step({}) for _ in range(30)])

    env.reset(seed=1, options={"place": 0})
    fresh = rest(env)
    env.reset(seed=1, options={"place": 0})
    for agent in env.agents:
        env.action_space(agent).seed(3)
    env.step({agent: env.action_space(agent).sample() for agent in env.agents})
    saved = env.save()
    expected = rest(env)
    other.load(saved)
    assert rest(other) == expected
    env.load(saved)
    assert rest(env) == expected
    env.reset(seed=1, options={"place": 0})
    assert rest(env) == fresh


@pytest.mark.parametrize("kind", [World, SensedWorld])
def test_a_world_is_copied(kind: Any) -> None:
    """A copied world has arrays of its own, and goes on as its original."""
    entry = weigh_in(SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    world = kind(practice_field(), [entry] if kind is World else entry)
    stand = entry.robot.start_posture
    for _ in range(10):
        world.step([stand])
    for way in COPY.values():
        other = way(world)
        assert other.model_hash == world.model_hash
        assert other.poses() == world.poses()
        before = world.save()
        other.step([stand])
        assert world.save() == before
        world.step([stand])
        assert (world.save(), world.poses()) == (other.save(), other.poses())
        assert world.touched() == other.touched()


def test_a_copied_world_feels_the_same_touches() -> None:
    """The touch test of a copy reads the copy's own robots: at a flag, and when one has gone."""
    entry = weigh_in(SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    arena = arenas.load("flag-strike")
    world, stand = World(arena, [entry, entry]), entry.robot.start_posture
    flag = next(index for index, m in enumerate(arena.game.markers) if m.kind == "flag")
    at = arena.game.markers[flag]
    world.place(0, Place(at.x_m, at.y_m, 0.0))
    world.step([stand, stand])
    assert flag in world.touched()[0]
    for way in COPY.values():
        other = way(world)
        assert other.touched() == world.touched()
        other.place(0, arena.game.starts[0][0])
        assert other.touched()[0] == ()
        assert flag in world.touched()[0]
        other.load(world.save())
        for _ in range(5):
            world.step([stand, stand])
            other.step([stand, stand])
            assert other.touched() == world.touched()


def test_a_program_that_closes_nothing_ends_quietly() -> None:
    """A program may end without `close` after it has drawn, also with several environments."""
    program = (
        "from lacoc_server.simulate.environments import WalkEnv\n"
        "envs = [WalkEnv(render_mode='rgb_array') for _ in range(3)]\n"
        "for env in envs:\n"
        "    env.reset(seed=1)\n"
        "    assert env.render() is not None\n"
        "del envs[0]\n"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_a_copy_draws_with_a_camera_of_its_own() -> None:
    """A copy and its original give the same picture, and either can be closed."""
    env = WalkEnv(render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    other = copy.deepcopy(env)
    again = other.render()
    assert picture is not None
    assert again is not None
    assert np.array_equal(picture, again)
    other.close()
    picture = env.render()
    assert picture is not None
    assert np.array_equal(picture, again)
    env.close()


@pytest.mark.slow
def test_supersuit_makes_rows_of_copies() -> None:
    """PettingZoo's own way to Stable-Baselines3 makes copies, also in processes of their own."""
    supersuit = pytest.importorskip("supersuit", reason="SuperSuit has no wheel for this machine")
    one = LacocParallelEnv(settings=SHORT, beats=10)
    seen = {
        processes: _rows_of_supersuit(
            supersuit, LacocParallelEnv(settings=SHORT, beats=10), processes
        )
        for processes in (1, 2)
    }
    one.reset(seed=1)
    expected = [one.step({"left": 2, "right": 1})[0] for _ in range(5)]
    for processes, found in seen.items():
        for step, rows in zip(expected, found, strict=True):
            assert rows.shape == (4, len(one.names)), processes
            assert rows[0].tobytes() == step["left"].tobytes()
            assert rows[1].tobytes() == step["right"].tobytes()


def _rows_of_supersuit(supersuit: Any, env: LacocParallelEnv, processes: int) -> list[Any]:
    agents = supersuit.pettingzoo_env_to_vec_env_v1(env)
    rows = supersuit.concat_vec_envs_v1(agents, 2, num_cpus=processes, base_class="gymnasium")
    rows.reset(seed=1)
    found = [rows.step(np.array([2, 1, 2, 1]))[0].copy() for _ in range(5)]
    rows.close()
    return found
