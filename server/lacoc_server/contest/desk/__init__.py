"""The desk of an office: it answers what an organiser and teams ask from pages.

`desk` answers a request; `admission` checks its secret. `entering` serves requests of teams,
`organising` those of the organiser, and `refereeing` those of referees. `overview` makes the view
of the organiser's page. `service` connects the desk to the network.
"""
