"""Groups of a class: two to four students share one table (section 4-2 of the workshop)."""
