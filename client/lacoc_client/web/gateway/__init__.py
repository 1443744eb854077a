"""The gateway between a court and browsers (docs/gateway.md).

One event loop serves all pages; calls that wait for the court's answer run on other threads. No
page has a queue. Some messages must arrive, such as events and scenes: they are written to every
page, and a page that does not take them is closed. A page that is too slow misses all others, such
as most frames, and gets a newer one of the same kind later.
"""
