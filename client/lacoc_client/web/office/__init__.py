"""The pages /office and /enter: their requests go to the desk of the contest's office.

`desk` is the connection to the desk, `links` makes a team's link and its QR code, `desk_page` is
one page's connection, `site` has the paths. Secrets are checked by the desk, not here.
"""
