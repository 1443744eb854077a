"""Benchmarks: the cost of the software as ratios against a bare baseline in the same run."""
