"""Matches without a network, as fast as the machine can play them."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lacoc_server.simulate.headless import (
        SETTLE_BEATS,
        Player,
        Seated,
        player,
        seated,
        simulate,
    )

__all__ = ["SETTLE_BEATS", "Player", "Seated", "player", "seated", "simulate"]


def __getattr__(name: str) -> Any:
    """Import what this package hands on when it is used.

    So the package `environments` in this one can be imported without MuJoCo, and then says what to
    install.
    """
    if name in __all__:
        return getattr(import_module(f"{__name__}.headless"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
