"""Registers the environments with Gymnasium, which imports them only when it makes one."""

import gymnasium

_PACKAGE = "lacoc_server.simulate.environments"


def register() -> None:
    """Register the environments with Gymnasium; a second call changes nothing."""
    for name, arena in (("Othello", "othello"), ("FlagStrike", "flag-strike")):
        if f"lacoc/{name}-v0" not in gymnasium.registry:
            gymnasium.register(
                f"lacoc/{name}-v0",
                entry_point=f"{_PACKAGE}.single:LacocEnv",
                vector_entry_point=f"{_PACKAGE}.vector:LacocVectorEnv",
                kwargs={"arena": arena},
            )
    if "lacoc/Walk-v0" not in gymnasium.registry:
        gymnasium.register(
            "lacoc/Walk-v0",
            entry_point=f"{_PACKAGE}.walk:WalkEnv",
            vector_entry_point=f"{_PACKAGE}.vector:WalkVectorEnv",
        )
