"""Forks: a recorded match goes on from one of its beats, unchanged or with a change."""
