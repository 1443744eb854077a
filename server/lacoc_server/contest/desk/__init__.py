"""The desk of an office: it answers what an organiser and teams ask from pages.

`desk` answers a request; `admission` checks its secret. `entering` does what a team asks, and
`organising` what the organiser asks. `deciding` makes decisions about matches. `overview` is what
the organiser's page shows. `service` connects the desk to the network.
"""
