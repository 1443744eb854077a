"""What shows that a student has learnt what a phase is about, and did not only press keys.

`numbers` says which numbers of a table are the student's own. `work` has the rules that this work
must keep. `questions` asks for what the work is about, with the student's own table and trial.
All of it is pure: it looks at evidence alone.
"""
