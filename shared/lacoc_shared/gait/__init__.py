"""Gaits: tables of postures and their files."""
