"""The page /design, on which a student designs a gait: its files, its studio and its phases."""
