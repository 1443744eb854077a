"""Gaits: tables of postures and sequences, and the files that contain them."""

from lacoc_shared.gait.tables import Level

__all__ = ["Level"]  # imported by other people's bots
