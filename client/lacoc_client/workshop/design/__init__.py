"""The page /design, on which a student designs a gait: with files, a studio and the phases."""
