"""Tables that several pages edit at once.

`document` merges the pages' edits. `shared_table` sends each edit to the other pages.
"""
