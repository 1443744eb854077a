"""A class that designs gaits: students on /design, their teacher on /class.

`classroom` is the class while it runs. `door` lets students in, `cards` makes the teacher's card of
each student, and `tournament` lets the students' gaits play. `teacher` is the teacher's page;
`site` has the paths.
"""
