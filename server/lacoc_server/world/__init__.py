"""The robots and their field in MuJoCo."""
