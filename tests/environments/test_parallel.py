"""The environment of both seats: the library's checks, seeds, saves, records and views."""

import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from pettingzoo.test import parallel_api_test

from lacoc_arenas import arena as arenas
from lacoc_arenas.bot import Key
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_server.simulate import Player, player, simulate
from lacoc_server.simulate.environments import LacocEnv, LacocParallelEnv
from lacoc_shared.command import installing
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Setup
from lacoc_shared.words import say

SHORT: dict[str, Any] = {"match": {"duration_s": 1.2, "countdown_s": 0.02}}
GAMES = ("othello", "flag-strike")


@pytest.fixture(scope="module", params=GAMES)
def env(request: pytest.FixtureRequest) -> LacocParallelEnv:
    return LacocParallelEnv(request.param, settings=SHORT)


def play(env: LacocParallelEnv, seed: int, steps: int = 10_000) -> list[Any]:
    """Play with random actions, drawn with a seed; return all that the environment gave."""
    chance = np.random.default_rng(seed)
    given: list[Any] = []
    while env.agents and len(given) < steps:
        acts = {agent: int(chance.integers(env.action_space(agent).n)) for agent in env.agents}
        given.append(env.step(acts))
    return given


def same(one: list[Any], other: list[Any]) -> bool:
    """Return whether two runs are equal: observations bit for bit, and all else."""
    return len(one) == len(other) and all(
        all(a[0][agent].tobytes() == b[0][agent].tobytes() for agent in a[0]) and a[1:] == b[1:]
        for a, b in zip(one, other, strict=True)
    )


@pytest.mark.slow
@pytest.mark.parametrize("arena", GAMES)
@pytest.mark.parametrize("actions", ["keys", "angles"])
def test_the_checks_of_pettingzoo(arena: str, actions: Any) -> None:
    """PettingZoo's own test finds no mistake and gives no warning."""
    env = LacocParallelEnv(arena, settings=SHORT, actions=actions)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(env, num_cycles=100)


@pytest.mark.long
def test_the_checks_of_pettingzoo_over_1000_cycles() -> None:
    """PettingZoo's own test also finds no mistake in 1,000 cycles of matches of usual length."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for arena in GAMES:
            parallel_api_test(LacocParallelEnv(arena), num_cycles=1000)


def test_a_seed_gives_the_same_episode(env: LacocParallelEnv) -> None:
    """Episodes with the same seed are equal bit for bit, also in two environments."""
    again = LacocParallelEnv(env.court.arena.name, settings=SHORT)
    runs, openings = [], []
    for seed, one in ((3, env), (4, env), (3, again), (4, again)):
        seen, infos = one.reset(seed=seed)
        openings.append(infos["left"])
        runs.append([(seen, 0), *play(one, seed)])
    assert openings[0] != openings[1]
    assert openings[:2] == openings[2:]
    assert same(runs[0], runs[2])
    assert same(runs[1], runs[3])
    assert not same(runs[0], runs[1])


def test_rewards_add_up_to_the_lead(env: LacocParallelEnv) -> None:
    """A seat's rewards add up to the change of its lead; the other seat gets their negatives.

    After the end there is no agent any more.
    """
    env.reset(seed=1)
    first = env._leads[0]
    given = play(env, 1)
    scores = given[-1][4]["left"]["scores"]
    assert sum(step[1]["left"] for step in given) == scores[0] - scores[1] - first
    assert all(step[1]["left"] == -step[1]["right"] for step in given)
    assert env.agents == []
    assert env.step({"left": 0}) == ({}, {}, {}, {}, {})
    assert [step[2]["left"] for step in given].count(True) == 1


def test_forks_are_equal_to_the_end(env: LacocParallelEnv, tmp_path: Path) -> None:
    """A save that is loaded goes on as the episode did, in its own environment and in a new one.

    The ends are equal bit for bit, and both environments write the same frames into their records.
    """
    chance = np.random.default_rng(5)
    new = LacocParallelEnv(env.court.arena.name, settings=SHORT)
    for number in range(5):
        env.reset(seed=number)
        play(env, number, int(chance.integers(0, 50)))
        saved = env.save()
        rest = play(env, 99)
        for one in (env, new):
            one.load(saved)
            assert one.observe("right").tobytes()
            assert same(play(one, 99), rest)
    files = [tmp_path / "one.mcap", tmp_path / "other.mcap"]
    for file, one in zip(files, (env, new), strict=True):
        one.write_record(file)
    frames = [Record.read(file).frames for file in files]
    assert frames[0] == frames[1]


def test_a_record_of_an_episode_is_proven(env: LacocParallelEnv, tmp_path: Path) -> None:
    """The record of an episode, whole or ended early, is proven; one that ended early is void."""
    for name, steps in (("whole", 10_000), ("half", 20)):
        env.reset(seed=8)
        play(env, 8, steps)
        file = tmp_path / f"{name}.mcap"
        env.write_record(file)
        *_, verdict = verify(Record.read(file), processes=1)
        assert isinstance(verdict, Verdict)
        assert verdict.kind is VerdictKind.SAME
    half = Record.read(tmp_path / "half.mcap")
    assert half.result is not None
    assert half.result.official == "void"
    *_, void = (event for event in half.events if event.kind == "decision")
    assert void.data["reason"] == msgspec.to_builtins(say("reason.ended-early"))
    result = Record.read(tmp_path / "whole.mcap").result
    assert result is not None
    env.reset(seed=8)
    assert result.scores == play(env, 8)[-1][4]["left"]["scores"]
    with pytest.raises(UserError, match=r"exists already.*another name"):
        env.write_record(tmp_path / "whole.mcap")
    with pytest.raises(UserError, match="mcap"):
        env.write_record(tmp_path / "record.txt")


@pytest.mark.parametrize("arena", GAMES)
def test_an_episode_is_the_match_that_is_simulated(arena: str, tmp_path: Path) -> None:
    """An episode ends in the state of a simulated match whose bots press the same keys."""
    env = LacocParallelEnv(arena, settings=SHORT)
    env.reset(options={"place": 0, "late_ticks": (7, 7)})
    while env.agents:
        tick = env._episode.match.ticks
        env.step({"left": 2 if tick < 30 else 1, "right": 3})
    digest = env._episode.frame.digest
    loaded = arenas.load(arena, SHORT)
    setup = Setup(
        match_id="m", court="c", match=1, arena=arena, settings=loaded.settings, limits={}
    )

    def presses(seat: int) -> Player:
        def bot(sheet: Any, index: int) -> Any:
            def brain(frame: Any) -> Key | None:
                wanted = 3 if seat else 2 if frame.clock_ticks < 30 else 1
                now = frame.seats[seat].key
                return Key(Level.LOCOMOTION, wanted) if now != wanted else None

            return brain

        return Player(player(loaded, seat, "straight").join, bot, late_ticks=7)

    assert simulate(setup, [presses(0), presses(1)]).digest == digest.hex()


def test_both_seats_see_the_same_when_the_field_is_turned(env: LacocParallelEnv) -> None:
    """While both seats do the same, they see the same numbers, except the last bits of physics."""
    seen, _ = env.reset(options={"late_ticks": (0, 0), "place": 0})
    assert seen["left"] == pytest.approx(seen["right"], abs=1e-6)
    for agent in env.possible_agents:
        assert seen[agent] in env.observation_space(agent)
        assert len(env.names) == len(seen[agent])
    for _ in range(30):
        seen = env.step({"left": 2, "right": 2})[0]
    assert seen["left"] == pytest.approx(seen["right"], abs=1e-5)
    other = env.step({"left": 2, "right": 1})[0]
    assert other["left"] != pytest.approx(other["right"], abs=1e-3)


def test_a_short_match_stays_in_its_space() -> None:
    """A restart may lock the keys for longer than the match; the space has such a number too."""
    env = LacocParallelEnv(settings=SHORT, restart=True)
    env.reset(seed=1)
    restart = {agent: env.action_space(agent).n - 1 for agent in env.agents}  # type: ignore[attr-defined]
    while env.agents:
        seen = env.step(restart)[0]
        assert all(seen[agent] in env.observation_space(agent) for agent in seen)
    assert seen["left"][env.names.index("own locked_s")] > env.court.arena.match.duration_s


def test_several_beats_in_a_step_are_the_same_match() -> None:
    """A step of ten beats equals ten steps of one beat with the same key."""
    one, ten = LacocParallelEnv(settings=SHORT), LacocParallelEnv(settings=SHORT, beats=10)
    for env in (one, ten):
        env.reset(seed=2, options={"late_ticks": (0, 0)})
    while ten.agents:
        acts = {"left": 2, "right": 1}
        last = ten.step(acts)
        for _ in range(10):
            step = one.step(acts)
            if not one.agents:
                break
        assert same([last[:1] + ((),) * 4], [step[:1] + ((),) * 4])
    assert one.agents == []


def test_angles_move_the_joints() -> None:
    """With `angles`, actions are shares of joints' ranges; saves work, records are refused."""
    env = LacocParallelEnv(settings=SHORT, actions="angles")
    env.reset(seed=0)
    raised = np.zeros(18, np.float32)
    raised[6:12] = 0.3
    for _ in range(40):
        env.step({"left": raised, "right": np.zeros(18, np.float32)})
    angles = env._episode.match.seats[0].state.angles
    assert np.degrees(angles) == pytest.approx(raised * 150)
    with pytest.raises(UserError, match="no record"):
        env.write_record("x.mcap")
    saved = env.save()
    rest = [env.step({"left": raised, "right": raised})[0]["left"].tobytes() for _ in range(9)]
    env.load(saved)
    assert rest == [
        env.step({"left": raised, "right": raised})[0]["left"].tobytes() for _ in range(9)
    ]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"arena": "chess"}, "chess"),
        ({"arena": "practice"}, "two seats"),
        ({"actions": "thoughts"}, "angles"),
        ({"actions": "angles", "restart": True}, "restart"),
        ({"beats": 0}, "at least 1"),
        *(({"beats": beats}, "beats is .* whole number") for beats in (1.5, float("nan"), "5")),
        ({"robots": ("hexapod",) * 3}, "exactly 2"),
        ({"robots": 5}, "robots is 5"),
        ({"render_mode": "human"}, "rgb_array"),
        ({"settings": {"match": {"duration_s": -1}}}, "settings .* match.duration_s"),
        ({"settings": {"match": {"duration": 5}}}, "settings .* duration_s, countdown_s"),
        ({"settings": [1]}, r"settings is \[1\]; it must be a dict"),
    ],
)
def test_wrong_arguments_are_refused(arguments: dict[str, Any], said: str) -> None:
    """A wrong argument raises an error that names it, or says what is allowed."""
    with pytest.raises(UserError, match=said):
        LacocParallelEnv(**arguments)


def test_numbers_of_numpy_are_numbers() -> None:
    """An environment that is made with numpy's numbers equals one that is made with Python's."""
    times = {"duration_s": np.float64(1.2), "countdown_s": np.float32(0.5)}
    env = LacocParallelEnv(settings={"match": times}, beats=np.int64(5))  # type: ignore[arg-type]
    assert env.court.arena.settings["match"]["duration_s"] == 1.2
    assert env.metadata["render_fps"] == 10
    late = np.array([3, 4])
    _, infos = env.reset(seed=np.int64(1), options={"place": np.int8(1), "late_ticks": late})  # type: ignore[arg-type]
    assert infos["left"] == {"place": 1, "late_ticks": (3, 4)}


def test_nothing_goes_before_the_first_reset(tmp_path: Path) -> None:
    """Before its first `reset` or `load` an environment asks for `reset`."""
    env, other = (LacocParallelEnv(settings=SHORT) for _ in range(2))
    file = tmp_path / "one.mcap"
    calls: list[Callable[[], Any]] = [
        lambda: env.step({}),
        env.save,
        lambda: env.observe("left"),
        env.render,
        lambda: env.write_record(file),
    ]
    for call in calls:
        with pytest.raises(UserError, match="No episode has begun"):
            call()
    assert not file.exists()
    other.reset()
    env.load(other.save())
    for call in calls:
        call()


@pytest.mark.parametrize("kind", ["keys", "angles"])
def test_a_missing_agent_goes_on(kind: Any) -> None:
    """An agent that is missing, or whose action is None, keeps its key or its angles."""
    env = LacocParallelEnv(settings=SHORT, actions=kind)
    action: Any = 2 if kind == "keys" else np.full(18, 0.2)
    ends = []
    for idle in ({}, {"left": None}, {"left": action}):
        env.reset(options={"place": 0, "late_ticks": (0, 0)})
        env.step({"left": action})
        ends.append([env.step(idle)[0]["left"].tobytes() for _ in range(20)])
    assert ends[0] == ends[1] == ends[2]


@pytest.mark.parametrize(
    ("kind", "action", "said"),
    [
        *(("keys", action, "no action") for action in (-1, 9, 1.5, [1], "2")),
        *(("angles", action, "18 finite numbers") for action in (0, np.full(17, np.nan), "up")),
        ("angles", [0] * 7 + [np.nan] * 11, r"angles: action\[7\] = nan\. "),
        ("angles", np.zeros(17), r"angles: array \(17,\) \[0\., 0\., \.\.\., 0\., 0\.\]\. "),
    ],
)
def test_actions_outside_the_space_are_refused(kind: Any, action: Any, said: str) -> None:
    """An action that the space does not have is refused and named; the episode stays as it was."""
    env = LacocParallelEnv(settings=SHORT, actions=kind)
    env.reset(seed=0)
    before = env.save()
    with pytest.raises(UserError, match=said):
        env.step({"left": action})
    for actions in ([action, action], action):
        with pytest.raises(UserError, match=r"actions is .* dict"):
            env.step(actions)
    with pytest.raises(UserError, match="red"):
        env.step({"red": action})
    assert env.save() == before


FULL = """
import resource, signal, sys
from lacoc_server.simulate.environments import LacocParallelEnv
from lacoc_shared.mistakes import UserError

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
env = LacocParallelEnv(settings={"match": {"duration_s": 1.0}})
env.reset(seed=1)
while env.agents:
    env.step({})
_, most = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, most))
try:
    env.write_record(sys.argv[1])
except UserError as error:
    print(error.phrase.code)
resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
env.write_record(sys.argv[1])
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs a limit on the size of files")
def test_a_full_disk_leaves_no_part_of_a_record(tmp_path: Path) -> None:
    """On a full disk the record is not written, and later it can be written under its name."""
    words = [sys.executable, "-c", FULL, str(tmp_path / "one.mcap")]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["record.no-room"]
    assert [path.name for path in tmp_path.iterdir()] == ["one.mcap"]


WRONG_OPTIONS: list[tuple[Any, str]] = [
    ({"place": 99}, "place is 99; .* at most"),
    ({"place": 0.5}, "place is 0.5"),
    *(
        ({"late_ticks": late}, "late_ticks is .* from 0 to 60")
        for late in ((1,), "ab", 3, (0, -1), (0, 61), (0, 1.5))
    ),
    ({"plase": 1}, 'no option "plase" here; "place" may be meant'),
    ({"Late_ticks": (0, 0)}, '"late_ticks" may be meant. The options are place and late_ticks'),
    ({"seat": "left"}, 'no option "seat" here. The options are place and late_ticks'),
    ([1], "options is .* dict"),
]


def test_wrong_bytes_and_options_are_refused(env: LacocParallelEnv) -> None:
    """A save of another environment is refused and changes nothing; a wrong option is named.

    The other environments differ in settings, robots or actions, or have a bot.
    """
    arena = env.court.arena.name
    others: list[LacocEnv | LacocParallelEnv] = [
        LacocParallelEnv(arena, settings={"match": {"duration_s": 2.0}}),
        LacocParallelEnv(arena, settings=SHORT, robots="quadruped"),
        LacocParallelEnv(arena, settings=SHORT, actions="angles"),
        LacocEnv(arena, settings=SHORT),
    ]
    env.reset(seed=1)
    before = env.save()
    for other in others:
        other.reset()
    for data in (*(other.save() for other in others), before[:-9], b"", b"no", "abc", None):
        with pytest.raises(UserError, match="same arguments"):
            env.load(data)  # type: ignore[arg-type]
        assert env.save() == before
    for options, said in WRONG_OPTIONS:
        with pytest.raises(UserError, match=said):
            env.reset(options=options)
        assert env.save() == before
    with pytest.raises(UserError, match="seed is -1"):
        env.reset(seed=-1)
    env.reset(options={"place": 0, "options": 1, "state": 2})


def test_a_picture(env: LacocParallelEnv) -> None:
    """A picture has 640 x 480 pixels, changes when the robots walk, and needs a render mode."""
    shown = LacocParallelEnv(env.court.arena.name, render_mode="rgb_array", settings=SHORT)
    shown.reset(seed=1)
    first = shown.render()
    play(shown, 1, 40)
    second = shown.render()
    shown.close()
    assert first is not None
    assert second is not None
    assert first.shape == (480, 640, 3)
    assert (first != second).any()
    env.reset()
    assert env.render() is None


@pytest.mark.parametrize("missing", ["mujoco", "pettingzoo"])
def test_without_the_extra_the_error_says_what_to_install(missing: str) -> None:
    """Without the extras, importing the environments says which packages are missing."""
    program = (
        f"import sys; sys.modules['{missing}'] = None\n"
        "from lacoc_shared.mistakes import UserError\n"
        "try:\n"
        "    import lacoc_server.simulate.environments\n"
        "except UserError as error:\n"
        "    print(error)\n"
    )
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert f"need {missing}, which" in told.stdout, told.stderr
    assert installing.command("server", "rl") in told.stdout
