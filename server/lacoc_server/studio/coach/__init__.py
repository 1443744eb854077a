"""The coach: finds the numbers of a key's table that matter, and improves the walk by few changes.

`coach` runs the whole search. `goal` scores a walk. `table` has a key's sequence as whole degrees
in cells. `matter` changes each cell a little, `improve` searches for a better table, and `undo`
takes back changes that hardly help. `trials` runs the trials in processes, with the contest's drive
and limits. With the same seed, a search tries tables in the same order.
"""
