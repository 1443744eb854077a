"""Matches without a network, as fast as the machine can play them."""

from lacoc_server.simulate.headless import SETTLE_BEATS, Player, Seated, player, seated, simulate

__all__ = ["SETTLE_BEATS", "Player", "Seated", "player", "seated", "simulate"]
