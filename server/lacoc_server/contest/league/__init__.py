"""A contest of many matches, computed from its facts; pure.

Facts are appended: entries, draws, results and decisions. Everything else is computed from them:
who meets whom, who may play next, the standings and the ratings. docs/contest.md defines the words.
"""
