"""A trial: one robot walks alone, under the contest's drive, and its walk is measured.

`course` runs a trial, and `walk` holds what was measured in each tick. `feet` and `support` find
steps and balance, `figures` computes the figures, and `explain` explains them. `steps` computes
from the table alone where the feet go. No module of this package knows MuJoCo.
"""
