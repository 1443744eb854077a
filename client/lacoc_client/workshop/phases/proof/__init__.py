"""Shows that a student has learnt the subject of a phase, and has not only pressed keys.

`numbers` finds which numbers of a table are the student's own. `work` has the rules for this work.
`questions` asks about the subject, with the student's own table and trial. All of it is pure: it
uses only evidence.
"""
