"""The contest file, secrets and links: all that people and programs need to reach a contest."""
