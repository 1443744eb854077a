"""The page /design, on which a student designs a gait and does the tasks of the phases."""
