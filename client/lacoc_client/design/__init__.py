"""Designing a gait on a page: the files of a folder, and a studio that lets the robot walk."""
