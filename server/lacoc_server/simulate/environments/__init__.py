"""Environments for training: both games, and a robot that learns to walk (docs/environments.md).

Importing this package registers `lacoc/Othello-v0`, `lacoc/FlagStrike-v0` and `lacoc/Walk-v0` with
Gymnasium.
"""

from importlib.util import find_spec

from lacoc_shared.command import installing
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

if _missing := [name for name in ("mujoco", "gymnasium", "pettingzoo") if find_spec(name) is None]:
    _install = installing.command("server", "rl")
    raise UserError(say("environment.not-installed", missing=_missing, install=_install))

from lacoc_server.simulate.environments.parallel import LacocParallelEnv
from lacoc_server.simulate.environments.single import LacocEnv
from lacoc_server.simulate.environments.vector import LacocVectorEnv, WalkVectorEnv
from lacoc_server.simulate.environments.walk import WalkEnv
from lacoc_server.simulate.registering import register

__all__ = [
    "LacocEnv",
    "LacocParallelEnv",
    "LacocVectorEnv",
    "WalkEnv",
    "WalkVectorEnv",
    "parallel_env",
    "register",
]

parallel_env = LacocParallelEnv
"""The name under which libraries look for a `ParallelEnv`."""

register()
