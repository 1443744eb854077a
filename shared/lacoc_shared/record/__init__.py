"""The record of a match: written while the match runs, and read again for replays and exports.

While a match runs, its record is one or several segments. After the match they are joined and
compressed into one file: the record is then *packed*.
"""
