"""Matches without a network, as fast as the machine can play them."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lacoc_server.simulate.headless import Seated, player, seated, simulate
    from lacoc_server.simulate.inputs import SETTLE_BEATS, Player

_FROM = {
    "SETTLE_BEATS": "inputs",
    "Player": "inputs",
    "Seated": "headless",
    "player": "headless",
    "seated": "headless",
    "simulate": "headless",
}
__all__ = ["SETTLE_BEATS", "Player", "Seated", "player", "seated", "simulate"]


def __getattr__(name: str) -> Any:
    """Import a name of `__all__` from its module when the name is used first.

    So `simulate.environments` can be imported without MuJoCo, and can then say which packages to
    install.
    """
    if name in _FROM:
        return getattr(import_module(f"{__name__}.{_FROM[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
