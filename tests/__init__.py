"""Tests; importing this package makes the helper modules of its folders importable by name."""

import sys
from pathlib import Path

_HELPERS = (
    *("common", "processes", "played", "league", "network", "server", "contest"),
    *("client", "gateway", "classroom", "design", "phases", "pages", "pages/core"),
)
_FOLDERS = [str(Path(__file__).parent / name) for name in _HELPERS]
sys.path += [folder for folder in _FOLDERS if folder not in sys.path]
