"""A trial: one robot walks alone, under the contest's drive, and its walking is measured.

`course` runs it. `walk` holds what was seen, tick by tick. `feet` and `support` find steps and
balance in it, and `figures` puts numbers to it. No part of this package knows MuJoCo.
"""
