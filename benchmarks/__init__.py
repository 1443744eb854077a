"""Benchmarks: what the software costs, mostly as ratios to a bare baseline in the same run."""
