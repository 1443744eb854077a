"""The gateway between a court and browsers (docs/gateway.md).

One event loop serves all pages; calls that wait for the court's answer run on other threads. No
page has a queue: a page that is too slow misses messages, except those that must arrive.
"""
