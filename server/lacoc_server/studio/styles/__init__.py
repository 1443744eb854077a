"""Other ways of walking with a student's own table: a map of gaits, and variants to choose from.

`style` turns a table in directions that people see, such as higher steps. `archive` keeps the best
gait of each cell of a map, and `gait_map` fills one. `variants` breeds six gaits that differ. All
trials run as the coach's do (`studio.coach.trials`).
"""
