"""Checks a published contest: whether its standings follow from its entries, facts and records.

No computed file is trusted. `published` computes the sheet and the tables again from the facts, and
`history` draws again. `games` compares each result with its record, and proves the record by
simulating its inputs again. `alone` checks the inputs of games without a network. `sampling` says
how likely a check of only some games finds a forged one.
"""
