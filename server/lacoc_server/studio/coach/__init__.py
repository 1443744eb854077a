"""Find which numbers of a key's table matter, and change few of them for a better walk.

`coach` does it all. `goal` says what better means. `table` is a key's sequence as whole degrees in
cells. `matter` changes each cell a little, `improve` searches, `undo` takes back what hardly helps.
`trials` runs all trials in processes. Everything is tried under the contest's drive and limits. The
same seed searches in the same order.
"""
