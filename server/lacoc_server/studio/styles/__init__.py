"""Finds gaits that look different from a student's own: a map of gaits, and variants to choose.

`style` changes a table in visible ways, such as higher steps. `archive` keeps the best
gait of each cell of a map, and `gait_map` fills one. `variants` breeds six gaits that differ. All
trials run as the coach's do (`studio.coach.trials`).
"""
