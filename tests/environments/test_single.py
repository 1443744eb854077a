"""Environments of one agent: against a bot, many in rows, and a robot that learns to walk."""

import re
import warnings
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from every_third import every_third
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate.environments import (
    LacocEnv,
    LacocParallelEnv,
    LacocVectorEnv,
    WalkEnv,
    WalkVectorEnv,
    register,
)
from lacoc_server.trial import course
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record

SHORT: dict[str, Any] = {"match": {"duration_s": 0.8, "countdown_s": 0.02}}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("lacoc/Othello-v0", {"settings": SHORT}),
        ("lacoc/FlagStrike-v0", {"settings": SHORT, "restart": True, "opponent": "nearest"}),
        ("lacoc/Walk-v0", {"seconds": 0.5}),
        pytest.param(
            "lacoc/Walk-v0",
            {"actions": "table", "robot": "quadruped"},
            marks=pytest.mark.long,  # each of its steps is a whole trial
        ),
    ],
)
def test_the_checks_of_gymnasium(name: str, arguments: dict[str, Any]) -> None:
    """Gymnasium's own checks find no mistake and give no warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name, **arguments).unwrapped)


def test_the_entry_point_registers_them() -> None:
    """The entry point registers the environments; to register them twice does no harm."""
    from importlib.metadata import entry_points

    (entry,) = entry_points(group="gymnasium.envs", name="lacoc")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert entry.load() is register
        register()
    assert "lacoc/Walk-v0" in gymnasium.registry
    made = gymnasium.make("lacoc_server.simulate.environments:lacoc/Othello-v0", settings=SHORT)
    assert isinstance(made.unwrapped, LacocEnv)


def play(env: gymnasium.Env[Any, Any], actions: np.random.Generator) -> list[Any]:
    """Play to the end of the episode; return all that the environment gave."""
    given: list[Any] = []
    while not given or not (given[-1][2] or given[-1][3]):
        given.append(env.step(int(actions.integers(env.action_space.n))))  # type: ignore[attr-defined]
    return [(step[0].tobytes(), *step[1:]) for step in given]


@pytest.mark.parametrize("opponent", ["straight", "planner"])
def test_a_bot_remembers_after_a_load(opponent: str, tmp_path: Path) -> None:
    """An environment that loads a save goes on, with its bot, bit for bit as the one that saved it.

    The episode's record is proven.
    """
    one, other = (LacocEnv("othello", opponent, settings=SHORT) for _ in range(2))
    _, info = one.reset(seed=3)
    assert info["seat"] == one.court.seats[one.seat]
    for action in (2, 2, 1, 1, 1, 2, 3, 3):
        one.step(action)
    saved = one.save()
    rest = play(one, np.random.default_rng(1))
    other.load(saved)
    assert play(other, np.random.default_rng(1)) == rest
    assert set(rest[-1][4]) == {"scores", "winner", "won"}
    with pytest.raises(UserError, match="reset"):
        one.step(0)
    other.write_record(tmp_path / "episode.mcap")
    *_, verdict = verify(Record.read(tmp_path / "episode.mcap"), processes=1)
    assert isinstance(verdict, Verdict)
    assert verdict.kind is VerdictKind.SAME
    before = one.save()
    both = LacocParallelEnv(settings=SHORT)
    both.reset()
    for data in (b"", both.save(), "abc"):
        with pytest.raises(UserError, match="same arguments"):
            one.load(data)  # type: ignore[arg-type]
    assert one.save() == before


def test_a_seed_chooses_the_seat() -> None:
    """The seed chooses the learner's seat; in either seat the rewards are the learner's."""
    env = LacocEnv(settings=SHORT)
    openings = {tuple(sorted(env.reset(seed=seed)[1].items())) for seed in range(12)}
    assert {dict(opening)["seat"] for opening in openings} == {"left", "right"}
    assert len(openings) == 12
    for seat in ("left", "right"):
        env.reset(options={"seat": seat})
        steps = play(env, np.random.default_rng(2))
        scores = steps[-1][4]["scores"]
        assert sum(step[1] for step in steps) == scores[env.seat] - scores[1 - env.seat]


@pytest.mark.parametrize("arena", every_third(["othello", "flag-strike"]))
@pytest.mark.parametrize("threads", [pytest.param(1, marks=pytest.mark.long), 2])
def test_each_row_is_a_single_environment(arena: str, threads: int) -> None:
    """Each row of a vector environment equals a single one bit for bit, over several episodes."""
    rows(arena, threads, steps=80, count=2)


@pytest.mark.long
@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_each_row_is_a_single_environment_for_2_000_steps(arena: str) -> None:
    """Each row of a vector environment equals a single one, also over 2,000 steps."""
    rows(arena, 2, steps=2_000, count=2, seconds=30.0)


def rows(arena: str, threads: int, steps: int, count: int, seconds: float = 0.6) -> None:
    settings = {"match": {"duration_s": seconds, "countdown_s": 0.02}}
    many = LacocVectorEnv(count, arena, threads=threads, settings=settings)
    assert many.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    single = [LacocEnv(arena, settings=settings) for _ in range(count)]
    seen, infos = many.reset(seed=7)
    for index, env in enumerate(single):
        first, info = env.reset(seed=7 + index)
        assert seen[index].tobytes() == first.tobytes()
        assert {name: infos[name][index] for name in info} == info
    assert seen in many.observation_space
    over = [False] * count
    chance = np.random.default_rng(7)
    episodes = 0
    for _ in range(steps):
        actions = chance.integers(0, 4, count)
        seen, rewards, ended, stopped, infos = many.step(actions)
        for index, env in enumerate(single):
            if over[index]:
                first, info = env.reset()
                expected = (first, 0.0, False, False, info)
            else:
                expected = env.step(int(actions[index]))
            over[index] = expected[2] or expected[3]
            episodes += over[index]
            assert seen[index].tobytes() == expected[0].tobytes()
            assert (rewards[index], ended[index], stopped[index]) == expected[1:4]
            assert env.episode.frame.digest == many.rows[index].episode.frame.digest
            assert all(infos[name][index] == value for name, value in expected[4].items())
    assert episodes >= count
    many.close()


def test_a_mask_resets_some_rows() -> None:
    """Only rows in the mask begin an episode; a mask of another length is refused."""
    many = LacocVectorEnv(3, settings=SHORT)
    many.reset(seed=1)
    many.step(np.array([2, 2, 2]))
    ticks = [row.episode.match.ticks for row in many.rows]
    seen, infos = many.reset(options={"reset_mask": np.array([False, True, False])})
    now = [row.episode.match.ticks for row in many.rows]
    assert (now[0], now[2]) == (ticks[0], ticks[2])
    assert now[1] < ticks[1]
    assert infos["_place"].tolist() == [False, True, False]
    assert seen[0].tobytes() == many.rows[0].observe().tobytes()
    for wrong, said in (
        ({"options": {"reset_mask": np.array([True])}}, "reset_mask is array .* 3 rows"),
        ({"options": {"reset_mask": [True, [False]]}}, "reset_mask is"),
        ({"options": {"reset_masks": 1}}, '"reset_mask" may be meant'),
        ({"options": {"seat": "middle"}}, "seat is 'middle'; it must be left or right"),
        ({"options": {"seat": 2}}, "seat is 2"),
        ({"seed": [1, 2]}, r"seed is \[1, 2\]; .* each row"),
        ({"seed": 1.5}, "seed is 1.5"),
    ):
        with pytest.raises(UserError, match=said):
            many.reset(**wrong)  # type: ignore[arg-type]
    with pytest.raises(UserError, match="reset_mask"):
        many.rows[0].reset(options={"reset_mask": [True]})
    many.close()


def test_wrong_actions_change_no_row() -> None:
    """If an action is missing or is none of the space, no row goes on."""
    many = LacocVectorEnv(2, settings=SHORT)
    many.reset(seed=1)
    before = [row.save() for row in many.rows]
    for actions, said in (
        (np.array([2]), r"array \(1,\) \[2\]; .* each of the 2 rows"),
        (0, "actions are 0"),
        (np.array([2, -1]), "no action"),
    ):
        with pytest.raises(UserError, match=said):
            many.step(actions)
    assert [row.save() for row in many.rows] == before
    many.close()


@pytest.mark.slow
def test_rows_of_the_library() -> None:
    """`gymnasium.make_vec` makes rows, each with a seed and a picture of its own."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        many = gymnasium.make_vec(
            "lacoc/Othello-v0",
            num_envs=3,
            vectorization_mode="vector_entry_point",
            settings=SHORT,
            beats=10,
            render_mode="rgb_array",
        )
        many.reset(seed=[4, 5, 6])
        for _ in range(6):
            seen, *_ = many.step(many.action_space.sample())
            assert seen in many.observation_space
        pictures = many.render()
        many.close()
    assert pictures is not None
    assert [picture.shape for picture in pictures] == [(480, 640, 3)] * 3
    for wrong in ({"num_envs": 0}, {"num_envs": "2"}, {"threads": -1}):
        with pytest.raises(UserError, match="at least"):
            LacocVectorEnv(**wrong)  # type: ignore[arg-type]


def test_a_robot_walks_by_angles() -> None:
    """The speeds of a walk add up to its distance; seeds and saves repeat it bit for bit."""
    env = WalkEnv(seconds=2.0, beats=5)
    walks = []
    for _ in range(2):
        seen, _ = env.reset(seed=4)
        walks.append([seen.tobytes()])
        total, over = 0.0, False
        chance = np.random.default_rng(4)
        saved = b""
        while not over:
            if len(walks[-1]) == 8:
                saved = env.save()
            action = chance.uniform(-0.2, 0.2, 18)
            seen, reward, fell, over, info = env.step(action)
            assert not fell
            assert reward == sum(one for name, one in info.items() if name.startswith("reward_"))
            total += info["speed_m_s"] * 0.1
            walks[-1].append(seen.tobytes())
        assert total == pytest.approx(seen[0], abs=1e-6)
        assert len(walks[-1]) == 21
    assert walks[0] == walks[1]
    env.load(saved)
    chance = np.random.default_rng(4)
    for _ in range(7):
        chance.uniform(-0.2, 0.2, 18)
    again = [env.step(chance.uniform(-0.2, 0.2, 18))[0].tobytes() for _ in range(13)]
    assert again == walks[0][8:]
    with pytest.raises(UserError, match="reset"):
        env.step(np.zeros(18))
    for other, data in ((WalkEnv("quadruped"), saved), (env, "abc")):
        with pytest.raises(UserError, match="same arguments"):
            other.load(data)  # type: ignore[arg-type]
    env.reset(seed=1)
    one = env.step(np.full(18, 3.0))[0]
    env.reset(seed=1)
    assert env.step(np.ones(18))[0].tobytes() == one.tobytes(), "numbers beyond 1 count as 1"


def walked(act: Callable[[int], Any], **arguments: Any) -> tuple[dict[str, float], int, bool]:
    """Walk an episode; return its reward, the parts of it, its steps, and whether it fell."""
    env = WalkEnv(beats=5, **arguments)
    env.reset(seed=1)
    total = dict.fromkeys(
        ("reward", "reward_forward", "reward_ctrl", "reward_survive", "speed_m_s"), 0.0
    )
    for step in count():
        _, reward, fell, cut, info = env.step(act(step))
        for name, one in (("reward", reward), *info.items()):
            total[name] += one
        if fell or cut:
            return total, step + 1, fell
    raise AssertionError("an episode without end")


def sample_table() -> Any:
    """Return the sample gait's postures of key 2, as actions."""
    robot = weigh_in(SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    assert robot.gait.locomotion is not None
    return np.degrees(np.array(robot.gait.locomotion.sequences[2])) / 150


def test_a_walk_is_cut_where_the_floor_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """An episode is cut a metre before a wall, which would stop a robot that walks well."""
    monkeypatch.setitem(course._FIELD["game"], "size_m", [2.1, 2.1])
    table = sample_table()
    total, steps, fell = walked(lambda step: table[step // 3 % 4])
    assert not fell
    assert 0.05 < total["speed_m_s"] * 0.1 < 0.06
    assert steps < 50


@pytest.mark.slow
def test_to_walk_pays_and_to_fall_does_not() -> None:
    """The sample gait gets more than a robot that stands, and far more than one that falls.

    The robot that falls throws itself forward, farther than the other one walks in that time.
    """
    robot = weigh_in(SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    table = sample_table()
    stand = np.degrees(np.array(robot.robot.start_posture)) / 150
    throw = np.repeat([[0.96, 0.18, -0.36], [-0.62, 0.35, -0.61], [0.16, 0.2, 0.92]], 2, axis=1)
    throw = throw[:, [0, 2, 4, 5, 3, 1]].ravel()  # the legs of both sides do the same
    walks, steps, fell = walked(lambda step: table[step // 3 % 4])
    assert (steps, fell) == (200, False)
    stands, steps, fell = walked(lambda step: stand)
    assert (steps, fell) == (200, False)
    falls, steps, fell = walked(lambda step: throw)
    assert fell
    assert falls["reward_forward"] / steps > walks["reward_forward"] / 200
    assert 2 * falls["reward"] < stands["reward"] < 0.8 * walks["reward"]
    assert stands["reward_survive"] == walks["reward_survive"] == 200
    assert falls["reward_survive"] == steps - 1
    assert stands["reward_ctrl"] == pytest.approx(0, abs=0.1)
    assert -5 < walks["reward_ctrl"] < 0
    on, steps, fell = walked(lambda step: throw, terminate_when_unhealthy=False)
    assert (steps, fell) == (200, False)
    assert on["reward"] < stands["reward"]
    free, *_ = walked(
        lambda step: throw, forward_reward_weight=0, ctrl_cost_weight=0, healthy_reward=0
    )
    assert free["reward"] == 0


def test_the_docs_name_each_number_of_a_walk() -> None:
    """The table in the docs lists each number that is seen, in order."""
    docs = Path(__file__).parents[2] / "docs" / "environments.md"
    listed: list[str] = []
    for first, last, name in re.findall(
        r"^\| (\d+)(?: to (\d+))? \| `([^`]+)` \|", docs.read_text(encoding="utf-8"), re.MULTILINE
    ):
        assert int(first) == len(listed)
        listed += [name.replace("J", str(j)) for j in range(int(last or first) + 1 - int(first))]
    made = gymnasium.make("lacoc/Walk-v0")
    assert made.unwrapped.names == tuple(listed)  # type: ignore[attr-defined]
    assert made.observation_space.shape == (len(listed),)
    figures = WalkEnv(actions="table").names
    assert all(f"`{name}`" in docs.read_text(encoding="utf-8") for name in figures)


@pytest.mark.parametrize(
    ("arguments", "steps"),
    [
        ({"seconds": 1.0, "beats": 5}, 15),
        # Each step is a whole trial, and an episode.
        pytest.param({"actions": "table"}, 3, marks=pytest.mark.long),
    ],
)
def test_each_row_of_walks_is_a_single_walk(arguments: dict[str, Any], steps: int) -> None:
    """Each row of walks equals a single one bit for bit, over several episodes."""
    many = gymnasium.make_vec(
        "lacoc/Walk-v0", num_envs=2, vectorization_mode="vector_entry_point", **arguments
    )
    assert isinstance(many, WalkVectorEnv)
    single = [WalkEnv(**arguments) for _ in range(2)]
    seen, _ = many.reset(seed=3)
    for index, env in enumerate(single):
        assert seen[index].tobytes() == env.reset(seed=3 + index)[0].tobytes()
    many.action_space.seed(3)
    over = [False, False]
    for _ in range(steps):
        actions = many.action_space.sample()
        seen, rewards, ended, stopped, _ = many.step(actions)
        for index, env in enumerate(single):
            if over[index]:
                expected: tuple[Any, ...] = (env.reset()[0], 0.0, False, False)
            else:
                expected = env.step(actions[index])
            over[index] = expected[2] or expected[3]
            assert seen[index].tobytes() == expected[0].tobytes()
            assert (rewards[index], ended[index], stopped[index]) == expected[1:4]
    with pytest.raises(UserError, match=r"not an? (action|table) of angles"):
        many.step(np.zeros((2, 3)))
    with pytest.raises(UserError, match='no option "place"'):
        many.reset(options={"place": 1})
    many.close()


def test_a_table_is_tried_as_in_a_trial() -> None:
    """The reward of the sample table is its speed in a trial; a table that stands still gets 0."""
    env = WalkEnv(actions="table")
    gait = weigh_in(SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod")).gait
    assert gait.locomotion is not None
    env.reset(seed=0)
    table = np.degrees(np.array(gait.locomotion.sequences[2])) / 150
    seen, reward, ended, cut, info = env.step(table.astype(np.float32))
    assert (ended, cut) == (True, False)
    assert reward == pytest.approx(info["figures"]["speed_mm_s"] / 1000)
    assert 0.03 < reward < 0.2
    assert seen[0] == pytest.approx(reward)
    env.reset()
    with pytest.raises(UserError, match=r"not a table of angles: .* 4 rows"):
        env.step(np.zeros(18))
    assert env.step(np.zeros((4, 18), np.float32))[1] == pytest.approx(0, abs=0.01)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"actions": "keys"}, "angles"),
        ({"beats": 0}, "beats is 0"),
        ({"beats": "5"}, "beats is '5'"),
        ({"seconds": float("nan")}, "seconds is nan"),
        ({"seconds": "5"}, "seconds is '5'"),
        ({"actions": "table", "postures": 0}, "postures is 0; .* at most 100"),
        ({"postures": 5}, 'postures has no effect with actions "angles"'),
        ({"actions": "table", "beats": 5}, 'beats has no effect with actions "table"'),
        ({"actions": "table", "seconds": 5}, "seconds has no effect"),
        ({"actions": "table", "healthy_reward": 2}, "healthy_reward has no effect"),
        ({"healthy_reward": "1"}, "healthy_reward is '1'"),
        ({"ctrl_cost_weight": -1.0}, "ctrl_cost_weight is -1.0"),
        ({"robot": "no-such-robot"}, "no-such-robot"),
    ],
)
def test_wrong_arguments_of_a_walk(arguments: dict[str, Any], said: str) -> None:
    """Wrong arguments are refused with a sentence that names them."""
    with pytest.raises(UserError, match=said):
        WalkEnv(**arguments)


def test_nothing_goes_before_the_first_reset() -> None:
    """Before its first `reset` an environment refuses steps and saves, and asks for `reset`."""
    many, walk = LacocVectorEnv(1, settings=SHORT), WalkEnv()
    for call in (
        lambda: many.step(np.zeros(1, int)),
        lambda: many.rows[0].step(0),
        lambda: many.rows[0].save(),
        lambda: walk.step(np.zeros(18)),
        lambda: walk.save(),
        lambda: walk.observe(),
    ):
        with pytest.raises(UserError, match="No episode has begun"):
            call()
    many.close()


def test_a_walk_has_a_picture() -> None:
    """The picture of a walk shows the robot."""
    env = WalkEnv(render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    env.close()
    assert picture is not None
    assert picture.shape == (480, 640, 3)
    assert picture.std() > 5
