"""The six phases of the workshop (4-2) as steps with evidence (docs/studio.md 7).

`evidence` is what students do, `facts` what trials and edits show. `predicates` count evidence,
`conditions` say what is asked of it, `phases` has the six tasks, and `progress` how far a student
is. All of this is pure. `store` keeps a class on disk (`class_file`), and `export` hands it out.
"""
