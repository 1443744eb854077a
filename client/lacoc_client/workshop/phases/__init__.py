"""The six phases of the workshop as tasks that evidence shows to be done (docs/studio.md 7).

`evidence` has the kinds of evidence of what students do. `facts` has what trials and edits show.
`predicates` has general rules that count evidence, and `conditions` has the rules of the phases.
`phases` has the six tasks, and `progress` says how far a student is. All of this is pure.

`store` keeps the evidence and tables of a class, or of one student, in a file on disk. `class_file`
is this file, and `export` makes files for a teacher from it.
"""
