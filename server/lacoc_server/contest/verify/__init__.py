"""Checks a published contest: whether its standings follow from its entries, facts and records.

Nothing that was computed is believed. `published` computes the sheet and the tables again from the
facts, and `history` the draws; `games` compares each result with its record, and proves the record
by playing its inputs again. `sampling` says what a check of some games is worth.
"""
