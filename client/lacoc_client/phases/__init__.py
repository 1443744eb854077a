"""The six phases of the workshop (4-2) as steps with evidence (docs/studio.md 5).

`evidence` is what students do, `facts` and `foot` what trials and edits show of it. `predicates`
decide from evidence whether a task is done, `phases` has the six tasks, and `progress` how far a
student is. All of this is pure. `store` keeps a class on disk, and `export` hands it out.
"""
