"""The gateway between a court and browsers (docs/gateway.md).

One event loop holds all pages; what asks the court and waits runs on other threads. A
page never gets a queue: what it is too slow for, it misses, except what must arrive.
"""
