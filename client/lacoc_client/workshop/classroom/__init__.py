"""A class that designs gaits: students on /design, their teacher on /class.

`classroom` is the class while it runs. `door` lets students in, `cards` has what the teacher sees
of each, and `tournament` lets gaits play. `teacher` is the teacher's page; `site` connects pages.
"""
