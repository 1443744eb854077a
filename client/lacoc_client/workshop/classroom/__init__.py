"""A class that designs gaits: students on /design, their teacher on /class.

`classroom` is the class while it runs. `admission` says who may come in, `cards` what the teacher
sees of each student, and `tournament` lets gaits play. `teacher_page` and `site` connect the pages.
"""
