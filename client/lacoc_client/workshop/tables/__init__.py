"""Tables that several pages edit: `document` merges edits, `shared_table` passes them on."""
