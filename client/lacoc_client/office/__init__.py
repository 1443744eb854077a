"""The pages of a contest's organiser and of teams that enter: requests go to the office's desk.

`desk` is the way to the office, `links` makes a team's link and its QR code, `desk_page` is one
page's connection, `site` has the paths. Nothing here decides: the desk looks at each secret.
"""
