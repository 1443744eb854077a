"""The pages /office and /enter: their requests go to the desk of the contest's office.

`desk` is the connection to the desk, `links` makes links and their QR codes, `desk_page` is the
connection of one page, `hand_ins` limits how often files come, `site` has the paths. The desk
checks all secrets; this package checks none.
"""
