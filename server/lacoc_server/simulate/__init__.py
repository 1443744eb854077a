"""Matches without a network, as fast as the machine can.

`headless` plays one match. `league` says who meets whom and where everybody stands (pure).
"""

from lacoc_server.simulate.headless import SETTLE_BEATS, Player, player, simulate

__all__ = ["SETTLE_BEATS", "Player", "player", "simulate"]
