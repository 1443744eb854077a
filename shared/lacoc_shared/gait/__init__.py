"""Gaits: tables of postures and their files."""

from lacoc_shared.gait.tables import Level

__all__ = ["Level"]  # imported by other people's bots
