"""Benchmarks of speed; each is a command, `python -m benchmarks.courts` and so on."""

import tests  # noqa: F401 - makes the helper modules of tests importable
