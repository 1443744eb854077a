"""Tables that several pages edit: `document` merges edits, `shared_table` sends them on."""
