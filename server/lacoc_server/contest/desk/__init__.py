"""The desk of an office: what an organiser and teams ask from pages, as facts and decisions.

`deciding` says what a decision changes; `admission` looks at secrets; `entering` and `organising`
answer; `service` is the place on the network.
"""
