"""The workshop's six-legged robot, with the gait of workshop Fig. 4-1 and Fig. 4-2."""
