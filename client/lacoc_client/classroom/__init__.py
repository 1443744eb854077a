"""A class that designs gaits: students on /design, their teacher on /class.

`admission`, `cards` and `tournament` decide; `classroom` is the class while it runs; `teacher_page`
and `site` are its doors.
"""
